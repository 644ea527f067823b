"""Targets: every figure equals the value of its run elsewhere; verdict, error, inputs, and wrong files."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle import road
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.figures.run_batch import Runs, evaluated
from vehicle.runs.figures.value import require_unit, shown_figures, values_of
from vehicle.runs.output.run_obstacle import obstacle_values
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.targets.target import Target
from vehicle.runs.targets.verdict import (
    MET,
    MISSED,
    NOT_RUN,
    UNDECIDED,
    Rated,
    read_targets,
    sentence,
    state_of,
    verdict,
)
from vehicle.signals.analysis.comfort import COMFORT_BAND

RAIL = ("seat rail x", "seat rail y", "seat rail z")


def ride_of(run, **changes):
    """Return a run that was not saved as the verdict takes it: values have an error on a random road."""
    return replace(evaluated(run), random=obstacle_values(run) is None, **changes)


def value_of(target, ride):
    """Return value and standard error of a target on a batch of one run."""
    chosen = target.recorded_in(tuple(ride.channels))
    require_unit(chosen, target.unit, dict.fromkeys(ride.channels, "m/s2"))
    values = values_of(chosen, ride)
    return values.value[0], None if values.error is None else values.error[0]


def figure(quantity, **keys):
    unit = FIGURES[quantity].unit or "m/s2"
    return Target(**{"quantity": quantity, "unit": unit, "at_most": 1.0, **keys})


@pytest.fixture(scope="module")
def on_road(sedan):
    return sedan.run(road("B", 60, duration=10), engine="reduced")


@pytest.fixture(scope="module")
def on_cleat(sedan):
    return sedan.run(road("cleat:20x50", 30), engine="reduced")


def test_figures_of_a_road_are_those_of_run_and_search(sedan, on_road):
    ride = ride_of(on_road)
    comfort, bands = on_road.comfort(), {"band": (2.0, 50.0)}
    pairs = {
        "weighted": (figure("rms", channels=RAIL, weighting="seat"), comfort.weighted.overall),
        "unweighted": (figure("rms", channels=RAIL, **bands), comfort.unweighted.overall),
        "weighted z": (figure("rms", channels=("seat rail z",), weighting="Wk"), comfort.weighted.z),
        "stick": (figure("stick_share", wheels=("fr",)), 1.0 - on_road.slip_share("fr")),
    }
    for name, *wheels in (("tyre_load",), ("tyre_load", "rl"), ("travel",), ("travel", "fr")):
        column = "_".join([name, *wheels])
        pairs[column] = figure(name, wheels=tuple(wheels)), on_road.figure(column)
    for name, (each, expected) in pairs.items():
        assert value_of(each, ride)[0] == pytest.approx(expected, rel=1e-12), name
    value, found = value_of(pairs["unweighted"][0], ride)
    # The error of comfort also has what the phases of this road add to the linear car.
    assert found == pytest.approx(comfort.errors["unweighted"] * value, rel=0.02)
    assert found < comfort.errors["unweighted"] * value
    assert value_of(pairs["travel"][0], ride)[1] is None


def test_largest_of_all_wheels_and_channels(on_road):
    ride = ride_of(on_road)
    every = value_of(figure("stick_share"), ride)[0]
    assert every == max(value_of(figure("stick_share", wheels=(wheel,)), ride)[0] for wheel in ("fr", "fl", "rr", "rl"))
    peaks = [value_of(figure("peak", channels=(channel,)), ride)[0] for channel in RAIL]
    assert value_of(figure("peak", channels=RAIL), ride)[0] == max(peaks)


def test_ratio_of_two_waves():
    """A tone of 2 m/s2 over one of 5: the ratio is 0.4, with no scatter over the blocks."""
    time = np.linspace(0.0, 16.0, 16_001)
    waves = {"above": 2.0 * np.sin(2.0 * np.pi * 4.0 * time), "below": 5.0 * np.sin(2.0 * np.pi * 4.0 * time + 1.0)}
    channels = {name: wave[None] for name, wave in waves.items()}
    ride = Runs(time=time, channels=channels, vehicles=(load_vehicle(),), tyre_load={})
    value, error = value_of(figure("ratio", channels=("above",), over=("below",), band=(1.0, 10.0)), ride)
    assert value == pytest.approx(0.4, rel=1e-12) and error == pytest.approx(0.0, abs=1e-12)


def test_a_run_whose_channel_rests_does_not_hide_a_miss(on_road):
    """Two runs of one car, in both orders; over the channel of the first a ratio is no number."""
    ride = ride_of(on_road)
    rest = replace(ride, channels={**ride.channels, "seat_rail_acc_y": 0.0 * ride["seat_rail_acc_y"]})
    ratio = figure("ratio", channels=("seat_rail_acc_z",), over=("seat_rail_acc_y",), unit="-", at_most=1e-3)
    summary = SimpleNamespace(input=SimpleNamespace(file="", road=None))
    runs: list[Any] = [
        SimpleNamespace(name=name, label="sedan", summary=summary, value_of=partial(value_of, ride=histories),
                        runs=histories)
        for name, histories in (("rest", rest), ("ride", ride), ("event", replace(ride, random=False)))
    ]  # fmt: skip
    peak = {"peak": figure("peak", channels=("seat_rail_acc_z",))}
    assert [verdict(peak, [run])["sedan"]["peak"].unknown for run in runs] == [True, True, False]
    for order in (runs[:2], runs[1::-1]):
        rated = verdict({"loud": ratio}, order)["sedan"]["loud"]
        assert (rated.state, rated.run, rated.runs) == (MISSED, "ride", 2)


def test_figures_of_an_obstacle_are_those_of_its_summary(on_cleat):
    ride, summary = ride_of(on_cleat), obstacle_values(on_cleat)
    assert summary is not None
    peak, error = value_of(figure("peak_to_peak", channels=("seat rail z",)), ride)
    assert peak == pytest.approx(summary.peak_to_peak["seat_rail"]["z"], rel=1e-12) and error is None
    dose = value_of(figure("vdv", channels=RAIL, weighting="seat"), ride)[0]
    assert dose == pytest.approx(summary.vdv["seat_rail"]["overall"], rel=1e-12)
    assert value_of(figure("settling", channels=("seat rail z",)), ride)[0] == summary.settling_s["seat_rail"]
    never = {name: np.ones((1, ride.time.size)) for name in on_cleat.channels}
    assert value_of(figure("settling", channels=("seat rail z",)), ride_of(on_cleat, channels=never))[0] == np.inf


def test_error_of_a_share_over_random_records():
    """Stick share of coloured noise: the scatter of 200 records against the mean of their stated errors."""
    rng, slow = np.random.default_rng(7), load_vehicle(None, ["damper.slip_velocity=0.5"])
    shares, errors = [], []
    for _ in range(200):
        noise = np.convolve(rng.standard_normal(20_000 + 99), np.ones(100) / 10.0, mode="valid")
        ride = Runs(
            time=np.linspace(0.0, 19.999, 20_000), channels={"damper_fr_velocity": noise[None]}, vehicles=(slow,),
            tyre_load={},
        )  # fmt: skip
        share, error = value_of(figure("stick_share", wheels=("fr",)), ride)
        shares.append(share)
        assert error is not None
        errors.append(error**2)
    # The standard deviation of 200 values is known to 5 %, the stated variance to 4 %.
    validated(
        "Statistics and intervals", "standard error of a share of time, mean of the stated ones",
        float(np.sqrt(np.mean(errors))), float(np.std(shares, ddof=1)), rel=0.15,
        source="second derivation: scatter of 200 random records",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("keys", "value", "error", "state"),
    [
        ({"at_most": 1.0}, 0.9, None, MET),
        ({"at_most": 1.0}, 0.9, np.nan, MET),
        ({"at_most": 1.0}, 1.1, None, MISSED),
        ({"at_most": 1.0}, 0.9, 0.049, MET),
        ({"at_most": 1.0}, 0.9, 0.051, UNDECIDED),
        ({"at_most": 1.0}, 1.1, 0.051, UNDECIDED),
        ({"at_most": 1.0}, 1.1, 0.049, MISSED),
        ({"at_most": None, "at_least": 1.0}, 1.1, 0.049, MET),
        ({"at_most": None, "at_least": 1.0}, 0.9, 0.0, MISSED),
        ({"at_most": 1.0}, np.inf, None, MISSED),
    ],
)
def test_state(keys, value, error, state):
    assert state_of(figure("peak", channels=("a",), **keys), value, error) == state


def test_inputs_of_a_figure():
    on_c = {"class": "C", "speed_kmh": 80.0}
    cleat = {"class": None, "speed_kmh": 30.0, "obstacle": "cleat (height 20 mm, length 50 mm) both sides, at 12 m"}
    each = figure("peak", channels=("a",), road="c", speed=80.0)
    assert each.on("x", "", on_c) and not each.on("x", "", on_c | {"speed_kmh": 60.0}) and not each.on("x", "", cleat)
    assert not each.on("x", "low.csv", None)
    assert figure("peak", channels=("a",), obstacle="cleat").on("x", "", cleat)
    assert figure("peak", channels=("a",), signal="low.csv").on("x", "/some/low.csv", None)
    assert figure("peak", channels=("a",), run="laden*").on("laden_C", "", on_c)
    assert each.where == "class c, 80 km/h"


def test_sentence():
    figures = {name: figure("peak", channels=("a",), words=name) for name in ("one", "two", "three", "four")}
    rated = dict(zip(figures, (Rated(state=state) for state in (MET, MISSED, MISSED, NOT_RUN)), strict=True))
    assert sentence(figures, "sedan", rated) == "sedan meets 1 of 3 targets and misses two and three; four had no run."
    assert sentence(figures, "sedan", dict.fromkeys(figures, Rated())).startswith("No target was checked for sedan")
    rated["one"] = replace(rated["one"], unknown=True)
    assert "on another road of this kind one may differ by an amount that is not known" in sentence(
        figures, "sedan", rated
    )


FAULTS = {
    "quantity = 'noise'\nunit = 'm/s2'\nat_most = 1": "a.quantity: must be one of unweighted",
    "quantity = 'rms'\nunit = 'm/s2'\nat_most = 1": "a.channels: missing; rms needs it",
    "quantity = 'peak'\nunit = 'm/s2'\nat_most = 1\nchannels = ['b']\nband = [1, 2]": "a.band: not used by peak",
    "quantity = 'tyre_load'\nunit = '-'": "a.at_most: set exactly one of at_most and at_least",
    "quantity = 'tyre_load'\nunit = '-'\nat_most = 1\nat_least = 0": "a.at_most: set exactly one of",
    "quantity = 'tyre_load'\nunit = '-'\nat_most = nan": "a.at_most: found limit nan and weight 1",
    "quantity = 'tyre_load'\nunit = '-'\nat_most = 1\nweight = 0": "a.at_most: found limit 1 and weight 0",
    "quantity = 'rms'\nunit = 'm/s2'\nat_most = 1\nchannels = ['b']\nband = [5, 2]": "a.band: found [5.0, 2.0]",
    "quantity = 'rms'\nunit = 'm/s2'\nat_most = 1\nchannels = ['b']\nweighting = 'Wx'": "a.weighting: must be",
    "quantity = 'tyre_load'\nunit = '-'\nat_most = 1\nspede = 3": "a.spede: unknown parameter",
    "quantity = 'tyre_load'\nat_most = 1": "a.unit: missing",
}


@pytest.mark.parametrize(("text", "message"), FAULTS.items(), ids=range(len(FAULTS)))
def test_wrong_tables(tmp_path, text, message):
    file = tmp_path / "targets.toml"
    file.write_text(f"[a]\n{text}\n", encoding="utf-8")
    with pytest.raises(ConfigurationError) as refusal:
        read_targets(file)
    assert str(refusal.value).startswith(str(file)) and message in str(refusal.value)


def test_wrong_files(tmp_path):
    empty, plain = tmp_path / "empty.toml", tmp_path / "plain.toml"
    empty.write_text("", encoding="utf-8")
    plain.write_text("limit = 3\n", encoding="utf-8")
    with pytest.raises(ConfigurationError, match="contains no target; write a section"):
        read_targets(empty)
    with pytest.raises(ConfigurationError, match="must be a section"):
        read_targets(plain)
    with pytest.raises(ConfigurationError, match="the file does not exist; give"):
        read_targets(tmp_path / "missing.toml")


def test_what_a_run_does_not_have(on_road):
    ride = ride_of(on_road)
    for wrong, message in (
        (figure("peak", channels=("seat rail z",), unit="g"), "unit: found 'g'"),
        (figure("stick_share", wheels=("xx",)), "wheels: found xx"),
        (figure("settling", channels=("seat rail z",)), "the run has no obstacle"),
        (figure("vdv", channels=("damper fr force",), weighting="seat"), "has no axis x, y or z"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            value_of(wrong, ride)


def test_shipped_targets():
    figures = read_targets("ride")
    assert len(figures) >= 10 and all(each.source for each in figures.values())


def test_a_saved_run_keeps_the_band_of_a_slow_input(sedan, tmp_path):
    """A record at 100 Hz ends below 50 Hz, and the figure of the saved run is that of the run."""
    time = np.arange(0.0, 12.0, 0.01)
    level = 1e-3 * np.sin(2 * np.pi * 1.5 * time) + 1e-4 * np.sin(2 * np.pi * 30.0 * time)
    rows = "".join(f"{t:.2f},{z:.9f}\n" for t, z in zip(time, level, strict=True))
    (tmp_path / "slow.csv").write_text(f"time [s],displacement [m]\n{rows}", encoding="utf-8")
    run = sedan.run(tmp_path / "slow.csv", engine="reduced")
    run.save(tmp_path / "run")
    saved = read_run(tmp_path / "run").runs
    assert saved.band == evaluated(run).band != COMFORT_BAND
    assert shown_figures(["unweighted"], saved)[0].value == pytest.approx(run.figure("unweighted"), rel=1e-6)
