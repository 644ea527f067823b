"""Batches of cases: values independent of the other cases of a batch, single failures, and reruns with MuJoCo."""

import math
import os
from dataclasses import dataclass, replace

import numpy as np
import pytest

from scenarios.signals.bump import bump_shape
from tests.studies.sweeps.sweep_samples import ShortRoad, grid
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED, wave_names
from vehicle.signals.analysis.seat_value import weighted_rms_of
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.signal_file import write_signal
from vehicle.studies.sweeps import case_evaluation
from vehicle.studies.sweeps.case import Case, SignalFile, signal_of
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.measure import ComfortMeasure, FigureMeasure, SingleMeasure, chosen_measure, measure_of
from vehicle.studies.sweeps.plan import sweep

MEASURE = ComfortMeasure(skip=0.2)
ROADS = [ShortRoad(name="one"), ShortRoad(name="two", seed=2)]


def numbers(results):
    return [repr((result.values, result.engine, result.reason)) for result in results]  # with all digits, and NaN


@pytest.fixture(scope="module")
def cases():
    """Return nine cars, more than a SIMD vector holds, on a road, and five of the cars on another road."""
    cars = grid({"damper.coulomb_friction": [62.5, 125.0, 250.0], "damper.viscous": [900.0, 2250.0, 4000.0]}, ROADS)
    return cars[:14]


@pytest.fixture(scope="module")
def batch_results(cases):
    return evaluate(cases, MEASURE)


def test_a_file_that_changes_between_two_sweeps_of_a_process_is_read_again(tmp_path):
    found = []
    for number in (1, 2):
        path = tmp_path / f"{number}.csv"
        write_signal(path, ShortRoad(seed=number).signal(), plain=True)
        os.utime(path, (number, number))  # a clock of files may be coarse
        found.append(signal_of(SignalFile(path=path.replace(tmp_path / "road.csv"), wheel="fr")))
    assert not np.array_equal(found[0].displacement["fr"], found[1].displacement["fr"])
    assert signal_of(SignalFile(path=tmp_path / "road.csv", wheel="fr")) is found[1]


def test_a_row_is_independent_of_the_batch(cases, batch_results):
    # Bitwise equal as a single case, in another order, and in a small batch.
    assert not any(result.reason for result in batch_results)
    for subset in ([3], [13], [12, 0, 5], list(reversed(range(14)))):
        assert numbers(evaluate([cases[i] for i in subset], MEASURE)) == numbers([batch_results[i] for i in subset])


def test_rows_are_those_of_single_runs(cases, batch_results):
    for case, result in list(zip(cases, batch_results, strict=True))[::5]:
        run = Car.load(None, case.overrides).run(case.source.signal(), engine="reduced", channels=MEASURE.channels)
        for name, value in MEASURE(run).items():
            # Error of the longer step. A second of road has 800 samples after the lead: a share changes by one sample.
            slack = {"rel": 2e-3} if "weighted" in name else {"abs": 1.5 / 800}
            if name in (
                *wave_names(UNWEIGHTED),
                *wave_names(WEIGHTED),
            ):  # parts of a complex number, which may be near zero
                slack = {"abs": 2e-3 * result.values["unweighted"]}
            assert result.values[name] == pytest.approx(value, nan_ok=True, **slack)
        weighted = weighted_rms_of(
            run.recording.timestep, [run[f"seat_rail_acc_{axis}"] for axis in "xyz"], skip=MEASURE.skip
        )
        assert result.values["weighted"] == pytest.approx(weighted[3], rel=2e-3)
        fine = replace(MEASURE, timestep=1.25e-4)
        (near,) = evaluate([case], fine)
        assert near.values["unweighted"] == pytest.approx(fine(run)["unweighted"], rel=2e-4)


@dataclass(frozen=True)
class Picky(ComfortMeasure):
    """Measure that raises an error for runs with much slip, and returns infinity for runs with little slip."""

    def of(self, runs):
        values = super().of(runs)
        if (values["slip_share_fr"] > 0.25).any():
            raise ValueError("slips too much")
        return values | {"unweighted_x": np.where(values["slip_share_fr"] < 0.1, math.inf, values["unweighted_x"])}


def test_only_the_run_that_fails_fails(cases, batch_results):
    shares = [result.values["slip_share_fr"] for result in batch_results]
    assert min(shares) < 0.1 and max(shares) > 0.25
    bad = [
        Case(source=ROADS[0], overrides=("damper.viscous=-1",)),
        Case(source=ROADS[0], overrides=("damper.viscosity=1",)),
        Case(source=Signal(time=uniform_time(samples=501, timestep=1e-3), displacement={"rr": np.zeros(501)})),
    ]
    results = evaluate([*bad, *cases], Picky(skip=0.2))
    assert "viscous: found -1.0" in results[0].reason and "viscosity" in results[1].reason
    for share, result, before in zip(shares, results[3:], batch_results, strict=True):
        if share > 0.25:
            assert result.reason == "ValueError: slips too much" and not result.values
        elif share < 0.1:
            assert result.reason.startswith("SimulationError: unweighted_x: infinite")
        else:
            assert numbers([result]) == numbers([before])


def test_only_a_car_outside_the_valid_range_runs_in_mujoco():
    # A bump of 40 mm rotates the stabilizer beyond the limit; a bump of 5 mm does not.
    time = uniform_time(samples=601, timestep=1e-3)
    bumps = [Signal(time=time, displacement={"fr": bump_shape(time, amplitude=a, start=0.1)}) for a in (0.04, 0.005)]
    results = evaluate([Case(source=bump, engine=engine) for bump in bumps for engine in ("auto", "reduced")], MEASURE)
    assert [result.engine for result in results] == ["mujoco", "reduced", "reduced", "reduced"]
    # A single run states its errors, and stays with the reduced engine where they are small; a batch states none.
    run = Car.load().run(bumps[0], engine="mujoco", channels=MEASURE.channels)
    assert results[0].values == pytest.approx(MEASURE(run), rel=1e-12, nan_ok=True)
    assert results[2].values == results[3].values


def test_cars_with_rubber_friction_are_run_in_batches():
    rubber = ("front.bushings.arm_rear.friction_force=[0,50,0]", "front.bushings.arm_rear.friction_stroke=[0,2e-4,0]")
    cases = [
        Case(source=ROADS[0], overrides=overrides, engine=engine)
        for overrides, engine in (((), "auto"), (rubber, "auto"), (rubber, "mujoco"))
    ]
    plain, batch, stepped = evaluate(cases, MEASURE)
    assert (plain.engine, batch.engine, stepped.engine) == ("reduced", "reduced", "mujoco")
    assert batch.values["unweighted"] == pytest.approx(stepped.values["unweighted"], rel=5e-3)
    assert abs(batch.values["unweighted"] / plain.values["unweighted"] - 1.0) > 1e-4


def test_standing_and_rolling_cars_are_simulated_apart():
    # Only rolling cars have forces of the current wheel load on the slope. Other elements are another group of a batch.
    stop = ("front.damper.stop.displacement=[-0.1, -0.05, 0.05]", "front.damper.stop.force=[-9000.0, 0.0, 0.0]")
    cases = [
        Case(source=ROADS[0], vehicle=vehicle_file("focus_road"), overrides=overrides, engine="reduced")
        for overrides in (stop, ("driving.speed=22.0",))
    ]
    results = evaluate(cases, MEASURE)
    assert not any(result.reason for result in results)
    assert numbers(evaluate(cases[::-1], MEASURE)) == numbers(results)[::-1]


@pytest.mark.parametrize(("name", "locked"), [("frequency:heave", True), ("travel", False)])
def test_only_a_figure_of_the_car_itself_takes_the_lock_of_mujoco(monkeypatch, cases, name, locked):
    """MuJoCo builds the car for it, and an executor may use threads."""
    held, of = [], FigureMeasure.of

    def seen(measure, runs):
        held.append(case_evaluation._ONE_AT_A_TIME.locked())
        return of(measure, runs)

    monkeypatch.setattr(FigureMeasure, "of", seen)
    figures = {each: chosen_figure(each, Car.load().vehicle) for each in (name, "weighted")}
    batch = measure_of(Car.load().vehicle, figures, 0.2)
    assert isinstance(batch, FigureMeasure)
    assert not any(result.reason for result in evaluate(cases[:1], batch))
    assert not any(result.reason for result in evaluate(cases[:1], SingleMeasure(each=batch)))
    assert held == [locked, locked]


def test_a_function_beside_figures_takes_the_lock_of_mujoco(cases):
    def held(run):
        return float(case_evaluation._ONE_AT_A_TIME.locked())

    measure = chosen_measure({"held": held, "travel": "travel"}, Car.load().vehicle, 0.2)
    (result,) = evaluate(cases[:1], measure)
    assert result.values["held"] == 1.0


def test_a_figure_of_the_car_alone_reads_no_channel():
    """A sweep of a natural frequency divided by the number of channels: 0."""
    found = sweep(Car.load(), {"body.mass": [1200.0, 1500.0]}, ROADS[0], measure="frequency:heave", engine="reduced")
    cars = [Car.load(overrides=[f"body.mass={mass}"]) for mass in (1200, 1500)]
    alone = [car.run(ROADS[0].signal(), engine="reduced").figure("frequency:heave") for car in cars]
    assert found.column("frequency_heave") == pytest.approx(alone) and alone[0] > alone[1]
