"""The slip velocity of each damper counts in runs, figures, tables, summaries and texts, not that of the first."""

import json
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from vehicle import Car, road, sweep
from vehicle.commands.summary_text import summary_text
from vehicle.runs.figures.run_batch import evaluated
from vehicle.runs.report.differences import key_figures
from vehicle.runs.report.findings import damper_sentences
from vehicle.runs.report.sections import dampers
from vehicle.signals.records.run_summary import read_summary
from vehicle.studies.sweeps.measure import chosen_measure

FRONT, REAR = 0.006, 0.05
LIMITS = {"fr": FRONT, "fl": FRONT, "rr": REAR, "rl": REAR}
PATH = "rear.damper.slip_velocity"
FIGURES = ("slip_share", "slip_share_fr", "slip_share_rr", "stick_share", "first_slip_rr")


@pytest.fixture(scope="module")
def ride():
    return road("C", 80, duration=4)


@pytest.fixture(scope="module")
def runs(ride):
    """Runs with equal and with different limits; the motion is the same."""
    return [Car.load("sedan", {PATH: rear}).run(ride, engine="reduced") for rear in (FRONT, REAR)]


def by_hand(run, limits):
    """Shares of the evaluated time and first times of |v| above the limits, from the recorded velocities."""
    speeds = {wheel: np.abs(run[f"damper_{wheel}_velocity"]) for wheel in limits}
    late = (run.time >= run.skip - 1e-9) & (run.time < run.signal.duration - 1e-9)
    shares = {wheel: np.mean(speeds[wheel][late] > limit) for wheel, limit in limits.items()}
    return shares, {wheel: run.time[speeds[wheel] > limit][0] for wheel, limit in limits.items()}


def test_a_run_takes_the_limit_of_each_damper(runs):
    equal, other = runs
    shares, first = by_hand(other, LIMITS)
    for wheel in LIMITS:
        assert other.slip_share(wheel) == pytest.approx(shares[wheel], abs=1e-12)
        assert other.first_slip(wheel) == pytest.approx(first[wheel], abs=1e-12)
        assert (other.slip_share(wheel) < equal.slip_share(wheel) - 0.1) == (wheel in ("rr", "rl"))
    assert other.first_slip("rr") > equal.first_slip("rr")


def test_figures_and_rows_of_a_sweep_take_the_limit_of_each_damper(runs, ride):
    measure = chosen_measure(FIGURES, runs[1].car.vehicle, runs[1].skip)
    table = sweep(Car.load("sedan"), {PATH: [FRONT, REAR]}, ride, measure=list(FIGURES), engine="reduced")
    for row, (run, limits) in enumerate(zip(runs, (dict.fromkeys(LIMITS, FRONT), LIMITS), strict=True)):
        shares, first = by_hand(run, limits)
        expected = {
            "slip_share": np.mean(list(shares.values())),
            "slip_share_fr": shares["fr"],
            "slip_share_rr": shares["rr"],
            "stick_share": 1.0 - min(shares.values()),
            "first_slip_rr": first["rr"],
        }
        assert {name: measure(run)[name] for name in FIGURES} == pytest.approx(expected, abs=1e-12)
        # A sweep has a longer time step.
        assert {name: table.column(name)[row] for name in FIGURES} == pytest.approx(expected, abs=0.02)
    np.testing.assert_array_equal(evaluated(runs[1]).slip_velocities(["rr", "fr"]), [[REAR, FRONT]])


def test_the_summary_and_its_texts_state_the_limits(runs, tmp_path):
    folders = [run.save(tmp_path / name) for run, name in zip(runs, ("equal", "other"), strict=True)]
    equal, other = (json.loads((folder / "summary.json").read_text(encoding="utf-8")) for folder in folders)
    shares, first = by_hand(runs[1], LIMITS)
    assert other["slip_share"] == pytest.approx({**shares, "slip_velocity": FRONT}, abs=1e-12)
    assert other["first_slip_s"] == pytest.approx(first, abs=1e-12)
    assert other["slip_velocities"] == LIMITS
    # Dampers that agree need no further key.
    assert list(equal["slip_share"]) == [*LIMITS, "slip_velocity"] and "slip_velocities" not in equal
    assert [key for key in other if key != "slip_velocities"] == list(equal)
    for run, folder, limits, words in zip(
        runs, folders, (dict.fromkeys(LIMITS, FRONT), LIMITS), ("6 mm/s", "6 (front) and 50 (rear) mm/s"), strict=True
    ):
        summary = read_summary(folder)
        assert summary.slip_limits == limits
        assert f"(|v| > {words})" in summary_text(summary)
        page: Any = SimpleNamespace(summary=summary, recording=run.recording, friction=True, comfort={}, peaks=[])
        assert f"time above {words}<" in str(dampers(page))
        said = " ".join(damper_sentences(summary))
        rows = key_figures(page)
        for wheel, corner in (("fr", "front right"), ("rr", "rear right")):
            limit = f"{1e3 * limits[wheel]:g} mm/s"
            assert rows[f"{corner} damper: time above {limit}", "%"] == 100.0 * run.slip_share(wheel)
            assert limit in said or words in said
