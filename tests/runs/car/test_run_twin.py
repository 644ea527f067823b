"""Errors of a run on a road that repeats: from its linear twin, in Python, summary, saved run, report and sweep."""

import math
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, load_run, road, sweep
from vehicle.engines.reduced.twin_run import damping_of_run, twin_run
from vehicle.names import across
from vehicle.runs.car.run import Run
from vehicle.runs.car.run_twin import TwinLines, signal_period, twin_lines_of
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.runs.figures.run_batch import evaluated
from vehicle.runs.figures.value import values_of
from vehicle.runs.output.run_comfort import comfort_values
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.run_input import change_half_width
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.comfort_error import NORMAL_95, STUDENT_95, difference_error
from vehicle.signals.analysis.comfort_lines import comfort_lines
from vehicle.signals.analysis.ride_comfort import comfort_columns, waves_of

DURATION = 8.0

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in "xyz")


def drive(car: Car, **settings: Any) -> Run:
    """Return a run of 6 s after the lead-in on class B at 80 km/h."""
    return car.run(road("B", 80, duration=DURATION, **settings), engine="reduced")


@pytest.fixture(scope="module")
def car() -> Car:
    return Car.load("sedan")


@pytest.fixture(scope="module")
def run(car: Car) -> Run:
    return drive(car)


def test_the_twin_explains_nearly_all_of_the_scatter(run: Run):
    comfort = run.comfort()
    assert {*comfort.explained} == {
        f"{name}{axis}" for name in ("unweighted", "weighted") for axis in ("", "_x", "_y", "_z")
    }
    # Waves from side to side are a small part: there, friction matters more.
    assert all(share > 0.9 for name, share in comfort.explained.items() if not name.endswith("_y"))
    # The interval of the run alone is +- 8 to 10 %.
    assert all(0.001 < comfort.errors[name] < 0.01 for name in ("unweighted", "weighted"))
    stored = comfort_values(run)["seat_rail"]
    assert stored.half_interval is not None and stored.explained_by_linear_car is not None
    for name in ("weighted", "weighted_z"):
        assert stored.half_interval[name] == pytest.approx(1.96 * comfort.errors[name] * comfort.values[name])
        assert stored.explained_by_linear_car[name] == pytest.approx(comfort.explained[name], abs=5e-5)


def test_other_roads_and_spans_have_the_error_of_the_run_alone(car: Car, run: Run):
    others = [
        drive(car, period="record"),
        drive(car, contact="cams"),
        car.run(road("B", 80, duration=7.5), engine="reduced"),  # 5.5 s: fewer than 6 s
        Run(car=run.car, signal=run.signal, recording=run.recording, skip=2.5),
    ]
    for other in others:
        comfort = other.comfort()
        assert comfort.explained == {} and 0.02 < comfort.errors["weighted"] < 0.1


@pytest.mark.parametrize("seed", [1, 2])
def test_a_road_that_does_not_repeat_has_the_value_of_its_class(car: Car, run: Run, seed: int):
    """Second derivation: the run on a road that repeats, whose value is that of the class within its own error."""
    other = drive(car, period="record", seed=seed)
    stored = comfort_values(other)["seat_rail"]
    assert stored.over_class is not None and comfort_values(run)["seat_rail"].over_class is None
    comfort, alone = run.comfort(), other.comfort()
    for name, of_class in stored.over_class.items():
        wanted, half = comfort.values[name], 1.96 * comfort.errors[name] * comfort.values[name]
        assert abs(of_class["value"] - wanted) < math.hypot(half, of_class["half_interval"])
        assert of_class["half_interval"] < 0.3 * 1.96 * alone.errors[name] * alone.values[name]
        assert of_class["explained"] > 0.9


def test_whole_numbers_of_seconds_are_stored_as_a_period_too(car: Car, tmp_path):
    """From Python, without a decimal point: the saved run lost its twin."""
    run = car.run(road("B", 80, duration=9), engine="reduced", skip=3)
    assert load_run(run.save(tmp_path / "run")).comfort().explained == pytest.approx(run.comfort().explained, abs=1e-3)


def test_forces_of_the_car_have_no_value_of_the_class(car: Car):
    """The ratio would scale the vibration by the forces with the road: 2.3 % wrong in the mean of three roads."""
    forced = car.with_({"front.imbalance.mass": 0.05, "front.imbalance.radius": 0.2})
    for each, present in ((car, True), (forced, False)):
        assert bool(comfort_values(drive(each, period="record"))["seat_rail"].over_class) is present


def test_the_twin_of_controlled_dampers_explains_most_of_the_scatter(tmp_path):
    """And the change to them has an error far below the scatter of one record, 5 % of the value."""
    car = Car.load("focus_road")
    runs = [drive(each) for each in (car, car.with_({"front.damper.control.law": "skyhook"}))]
    assert runs[1].comfort().explained["weighted"] > 0.5
    folders = [run.save(tmp_path / name) for run, name in zip(runs, "ab", strict=True)]
    width = change_half_width(*map(read_run, folders))
    assert width is not None and 0.1 < width < 4.0


def test_a_change_to_a_car_without_a_twin_compares_whole_scatters(car: Car, tmp_path):
    """The waves of both runs alone: those that one twin leaves would hide that both follow one road."""
    changed = drive(car.with_({"rear.damper.viscous": 1600.0}))
    folders = [run.save(tmp_path / name) for run, name in ((drive(car), "a"), (changed, "b"))]
    first, second = map(read_run, folders)
    dict.pop(cast(dict[str, Any], second.recording.channels), "damper_fr_force")  # without it the run has no twin
    alone = [comfort_columns(each.runs.timestep, each.runs.stacked(*(f"seat_rail_acc_{a}" for a in "xyz")),
                             skip=each.skip) for each in (first, second)]  # fmt: skip
    error = difference_error(*(waves_of(columns, "weighted") for columns in alone))[0]
    width = change_half_width(first, second)
    assert (
        width is not None
        and width == pytest.approx(100.0 * STUDENT_95 * error / alone[0]["weighted"][0], rel=1e-9)
        and width < 1.0
    )


@pytest.fixture(scope="module")
def twin(run: Run) -> tuple[TwinLines, dict[str, np.ndarray]]:
    """Return the lines of the seat rail of the twin of a run, and its histories over one period."""
    period, step, car = signal_period(run.signal), run.recording.timestep, run.car
    assert period is not None and period.begin == pytest.approx(run.skip)
    rows = {name: history[None] for name, history in run.recording.channels.items()}
    lines = twin_lines_of([car], period, rows, step, RAIL)
    samples = round(period.length / step)
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    damping = damping_of_run(car.poles, laws, run.recording.channels, run.evaluated)
    assert lines is not None
    return lines, twin_run(car.poles, damping, period.plates, period.length, RAIL, samples)


def test_the_twin_drives_on_the_road_of_the_run(run: Run, twin: tuple[TwinLines, dict[str, np.ndarray]]):
    rail, history = run["seat rail z"][run.evaluated], twin[1]["seat_rail_acc_z"]
    assert np.std(rail - history) < 0.2 * np.std(rail)


def test_comfort_of_lines_is_that_of_the_record_that_they_make(twin: tuple[TwinLines, dict[str, np.ndarray]]):
    """Second derivation: periodogram and filter of a record of many periods, of which the last one is evaluated."""
    lines, histories = twin
    samples = histories[RAIL[0]].size
    record = np.stack([np.tile(histories[name], 5) for name in RAIL])
    record = np.concatenate([record, record[:, :1]], axis=1)[None]
    step = 1.0 / (lines.frequency[0] * samples)
    of_record = comfort_columns(step, record, skip=4 * samples * step, axes=True)
    rail = np.stack([lines.channels[name] for name in RAIL], axis=1)
    found = comfort_lines(lines.frequency, rail, band=COMFORT_BAND, axes=True)
    assert {*found} == {name for name in of_record if not name.endswith("_error")}
    for name, value in found.items():
        whole = name.partition("_wave")[0]
        # The filter of the record follows its impulse until it has decayed to 2e-8 (`Weighting.decay_s`).
        assert value == pytest.approx(of_record[name], rel=1e-7, abs=1e-7 * of_record[whole][0]), name


def test_cars_with_shared_poles_have_the_twins_of_single_cars(run: Run):
    """In a batch the responses of a car serve all cars with its poles, each with its own damping constants."""
    period, step = signal_period(run.signal), run.recording.timestep
    assert period is not None
    changed = [run.car.with_({"front.damper.coulomb_friction": friction}) for friction in (70.0, 90.0)]
    runs = [each.run(run.signal, engine="reduced", skip=run.skip) for each in changed]
    assert runs[0].car.poles is runs[1].car.poles
    rows = [each.recording.channels for each in runs]
    both = {name: np.stack([row[name] for row in rows]) for name in rows[0]}
    batch = twin_lines_of([each.car for each in runs], period, both, step, RAIL)
    assert batch is not None
    for number, (each, row) in enumerate(zip(runs, rows, strict=True)):
        alone = twin_lines_of([each.car], period, {name: row[name][None] for name in row}, step, RAIL)
        assert alone is not None
        for name in RAIL:
            assert batch.channels[name][number] == pytest.approx(alone.channels[name][0], rel=1e-12)
    first, second = batch.channels["seat_rail_acc_z"]
    assert np.max(np.abs(first - second)) > 1e-3 * np.max(np.abs(first))


PHASED = ("weighted", "unweighted:z", "rms:knuckle fr z:8-20", "tyre_load_rms:fr")


def test_cars_without_friction_have_the_error_of_the_phases_of_their_road():
    """Second derivation: half of the difference between the runs on the road and on the road with its tracks exchanged.

    The cars are nearly their own twins. A run begins with a rise from rest, which moves its values by about 1e-4.
    """
    free = {f"{axle}.damper.coulomb_friction": 0.0 for axle in ("front", "rear")}
    cars = [Car.load("focus_road", free | {"front.damper.viscous": viscous}) for viscous in (2250.0, 1800.0)]
    runs = [drive(each) for each in cars]
    found = []
    for run in runs:
        plates, profile = ({w: rows[across(w)] for w in rows} for rows in (run.signal.displacement, run.signal.profile))
        signal = replace(run.signal, displacement=plates, profile=profile)
        mirrored = run.car.run(signal, engine="reduced", skip=run.skip)
        chosen = [chosen_figure(name, run.car.vehicle) for name in PHASED]
        found.append([[values_of(figure, evaluated(each)) for each in (run, mirrored)] for figure in chosen])
    for name, first, second in zip(PHASED, *found, strict=True):
        halves = []
        for here, there in (first, second):
            value = float(here.value[0])
            halves.append(0.5 * float(here.value[0] - there.value[0]))
            assert abs(halves[-1]) > 5e-4 * value or name not in ("weighted", "rms:knuckle fr z:8-20"), name
            for each in (here, there):
                assert each.error is not None
                assert each.error[0] == pytest.approx(abs(halves[-1]), abs=5e-4 * value), name
        waves = [each[0].waves for each in (first, second)]
        stated = STUDENT_95 * difference_error(*waves)[0] / NORMAL_95
        assert stated == pytest.approx(abs(halves[1] - halves[0]), abs=1e-4 * value), name
    of_knuckle = [each[0].value[0] - each[1].value[0] for each in (found[0][2], found[1][2])]
    assert abs(of_knuckle[0] - of_knuckle[1]) > 2e-4 * found[0][2][0].value[0]  # above the tolerance


def test_the_mean_dose_of_random_phases_is_that_of_its_lines(run: Run):
    """Closed form: E[a^4] = 3 s^4 - 3/2 sum P_k^2; with 5 lines 8 % below that of a Gaussian vibration."""
    figure, runs = chosen_figure("vdv:seat rail z:Wk", run.car.vehicle), evaluated(run)
    rng, power = np.random.default_rng(3), np.array([3.0, 1.0, 2.0, 1.0, 2.0])
    lines = np.zeros((4000, 1, 97), dtype=np.complex128)
    lines[:, 0, [30, 37, 55, 71, 96]] = np.sqrt(power) * np.exp(2j * np.pi * rng.random((4000, 5)))
    twin, reduce = TwinLines(np.arange(1.0, 98.0) / 6.0, {}, {}), figure.figure.reduces.lines
    assert reduce is not None
    values = reduce(lines, figure, runs, twin)
    duration = runs.evaluated.stop * runs.timestep - run.skip
    closed = duration * (3.0 * 9.0**2 - 1.5 * np.sum(power**2))
    validated(
        "Statistics and intervals", "mean fourth power of a dose of five lines, over the closed form",
        np.mean(values.value**4) / closed, 1.0, abs=0.02, source="closed form: 3 s^4 - 3/2 sum P_k^2",
    )  # fmt: skip
    assert values.expected == pytest.approx(closed**0.25, rel=1e-9)


def test_a_dose_has_an_error_on_a_road_that_repeats_alone(car: Car, run: Run):
    figure = chosen_figure("vdv:seat rail z:Wk", car.vehicle)
    values, other = (values_of(figure, evaluated(each)) for each in (run, drive(car, period="record")))
    assert values.explained is not None and values.explained[0] > 0.5 and other.first()[1] is None
    _, error = values.first()
    # A Gaussian vibration with a bandwidth of 3 Hz scatters by about 1/sqrt(B T) in its dose.
    assert error is not None and 2e-3 < error / values.value[0] < 1.0 / math.sqrt(3.0 * 6.0)


@pytest.mark.parametrize("name", ["weighted", "unweighted:x", "rms:seat rail z:5-25", "tyre_load"])
def test_figures_have_the_error_that_the_twin_leaves(run: Run, name: str):
    values = values_of(chosen_figure(name, run.car.vehicle), evaluated(run))
    assert values.explained is not None and values.error is not None
    assert values.explained[0] > 0.95
    # Below a fifth of the error of a record of this length, 1/(2 sqrt(B T)) with half-power bandwidths B of 1 to 6 Hz.
    assert values.error[0] < 0.2 * values.value[0] * 0.5 / math.sqrt(6.0 * DURATION)


def test_saved_runs_reports_and_sweeps_state_the_same_errors(car: Car, run: Run, tmp_path):
    changed = drive(car.with_({"rear.damper.viscous": 1600.0}))
    first, second = (each.save(tmp_path / name) for each, name in ((run, "a"), (changed, "b")))
    assert load_run(first).comfort().errors == pytest.approx(run.comfort().errors, rel=1e-4)
    width = change_half_width(read_run(first), read_run(second))
    table = sweep(car, {"rear.damper.viscous": [1500.0, 1600.0]}, road("B", 80, duration=DURATION), engine="reduced")
    rows = [result.values for result in table.results]
    assert rows[0]["weighted_error"] == pytest.approx(run.comfort().errors["weighted"], rel=0.02)
    waves = [waves_of({key: np.array([value]) for key, value in row.items()}, "weighted") for row in rows]
    of_sweep = 100.0 * STUDENT_95 * difference_error(*waves)[0] / rows[0]["weighted"]
    # The sweep computes many cars in single precision.
    assert width == pytest.approx(of_sweep, rel=0.05) and 0.005 < of_sweep < 0.1
