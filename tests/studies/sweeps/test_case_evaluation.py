"""Cases side by side: no row depends on its neighbours, and each fails or leaves the reduced engine by itself."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from tests.studies.sweeps.sweep_samples import Peak, ShortRoad, grid
from vehicle.runs.car import Car
from vehicle.signals.analysis.seat_value import weighted_rms_of
from vehicle.signals.excitation.bump import bump_shape
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.measure import WAVE_NAMES, ComfortMeasure

MEASURE = ComfortMeasure(skip=0.2)
ROADS = [ShortRoad(name="one"), ShortRoad(name="two", seed=2)]


def numbers(results):
    return [repr((result.values, result.engine, result.reason)) for result in results]  # with all digits, and NaN


@pytest.fixture(scope="module")
def cases():
    """Nine cars, more than fill a vector unit, and five of them on another road too."""
    cars = grid({"damper.coulomb_friction": [62.5, 125.0, 250.0], "damper.viscous": [900.0, 2250.0, 4000.0]}, ROADS)
    return cars[:14]


@pytest.fixture(scope="module")
def together(cases):
    return evaluate(cases, MEASURE)


def test_a_row_does_not_depend_on_its_neighbours(cases, together):
    # To the last digit: alone, in another order, and one among few.
    assert not any(result.reason for result in together)
    for some in ([3], [13], [12, 0, 5], list(reversed(range(14)))):
        assert numbers(evaluate([cases[i] for i in some], MEASURE)) == numbers([together[i] for i in some])


def test_rows_are_those_of_the_runs_by_themselves(cases, together):
    for case, result in list(zip(cases, together, strict=True))[::5]:
        run = Car.load(None, case.overrides).run(case.source.signal(), engine="reduced", channels=MEASURE.channels)
        for name, value in MEASURE(run).items():
            # What the longer step costs. A second of road has 800 samples behind the lead: a share moves by one.
            slack = {"rel": 2e-3} if "comfort" in name or "weighted" in name else {"abs": 1.5 / 800}
            if name in WAVE_NAMES:  # parts of a complex number, which may be near zero
                slack = {"abs": 2e-3 * result.values["comfort_overall"]}
            assert result.values[name] == pytest.approx(value, nan_ok=True, **slack)
        weighted = weighted_rms_of(
            run.recording.timestep, [run[f"seat_rail_acc_{axis}"] for axis in "xyz"], skip=MEASURE.skip
        )
        assert result.values["seat_rail_weighted_overall"] == pytest.approx(weighted[3], rel=2e-3)
        fine = replace(MEASURE, timestep=1.25e-4)
        (near,) = evaluate([case], fine)
        assert near.values["comfort_overall"] == pytest.approx(fine(run)["comfort_overall"], rel=2e-4)


@dataclass(frozen=True)
class Picky(ComfortMeasure):
    """Refuses runs that slip much, and finds no number in those that slip little."""

    def of(self, runs):
        found = super().of(runs)
        if (found["slip_share_fr"] > 0.25).any():
            raise ValueError("slips too much")
        return found | {"comfort_x": np.where(found["slip_share_fr"] < 0.1, math.inf, found["comfort_x"])}


def test_only_the_run_that_fails_fails(cases, together):
    shares = [result.values["slip_share_fr"] for result in together]
    assert min(shares) < 0.1 and max(shares) > 0.25
    bad = [
        Case(source=ROADS[0], overrides=("damper.viscous=-1",)),
        Case(source=ROADS[0], overrides=("damper.viscosity=1",)),
        Case(source=Signal(time=uniform_time(samples=501, timestep=1e-3), displacement={"rr": np.zeros(501)})),
    ]
    found = evaluate([*bad, *cases], Picky(skip=0.2))
    assert "viscous: found -1.0" in found[0].reason and "viscosity" in found[1].reason
    for share, result, before in zip(shares, found[3:], together, strict=True):
        if share > 0.25:
            assert result.reason == "ValueError: slips too much" and not result.values
        elif share < 0.1:
            assert result.reason.startswith("SimulationError: comfort_x: infinite")
        else:
            assert numbers([result]) == numbers([before])


def test_a_car_beyond_the_matrices_goes_to_mujoco_alone():
    # A bump of 40 mm turns the stabilizer beyond the limit; one of 5 mm does not.
    time = uniform_time(samples=601, timestep=1e-3)
    bumps = [Signal(time=time, displacement={"fr": bump_shape(time, amplitude=a, start=0.1)}) for a in (0.04, 0.005)]
    found = evaluate([Case(source=one, engine=engine) for one in bumps for engine in ("auto", "reduced")], MEASURE)
    assert [result.engine for result in found] == ["mujoco", "reduced", "reduced", "reduced"]
    run = Car.load().run(bumps[0], engine="auto", channels=MEASURE.channels)
    assert run.recording.statistics.engine == "mujoco"
    assert found[0].values == pytest.approx(MEASURE(run), rel=1e-12, nan_ok=True)
    assert found[2].values == found[3].values


def test_a_measure_of_single_runs_still_does(cases):
    (result,) = evaluate(cases[:1], Peak())
    run = Car.load(None, cases[0].overrides).run(cases[0].source.signal(), engine="reduced")
    assert result.values["peak"] == pytest.approx(float(abs(run["seat_rail_acc_z"]).max()), rel=1e-9)
