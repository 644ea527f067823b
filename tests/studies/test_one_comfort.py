"""One comfort everywhere: report, run in Python, sweep and search give the same numbers under the same names."""

import json
from dataclasses import replace

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.digits import number
from vehicle.engines.reduced.batch_simulation import COARSE_STEP
from vehicle.engines.reduced.reduced_run import LONGEST_STEP
from vehicle.runs.car import Car
from vehicle.runs.figures.catalogue import FIGURES
from vehicle.runs.output.saved_run import save_run
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.sections import comfort as report_section
from vehicle.signals.analysis.ride_comfort import comfort_columns, comfort_units
from vehicle.studies.sweeps.measure import ComfortMeasure, FigureMeasure, chosen_measure
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep_settings import SweepSettings

VISCOUS = "front.damper.viscous"
NAMES = [f"{name}{axis}" for name in ("unweighted", "weighted") for axis in ("", "_x", "_y", "_z")]


@pytest.fixture(scope="module")
def source():
    return random_road(rms=1e-3, seed=4, wheel="fl", duration=2.0, lower_band_edge=2.0)


@pytest.fixture(scope="module")
def car():
    return Car.load("focus_road_seated", {VISCOUS: 1500.0})


def swept(car, source, engine, **step):
    """Return the values of the car in a sweep and in a search, without a start of the evaluation that is asked for.

    Args:
        step: `timestep` of both measures, in place of their own.
    """
    plan = plan_sweep(car, {VISCOUS: [1500.0, 2000.0]}, source, SweepSettings(engine=engine))
    assert plan.skip == 0.0  # as in `Car.run`
    assert isinstance(plan.measure, ComfortMeasure)
    from vehicle.studies.sweeps.case_evaluation import evaluate

    names = tuple(name for name in comfort_units(seated=car.vehicle.seated) if not name.endswith("_error"))
    ride = chosen_measure(names, car.vehicle, plan.skip)
    assert isinstance(ride, FigureMeasure) and ride.timestep == plan.measure.timestep
    results = [
        evaluate(plan.cases[:1], measure)[0] for measure in (replace(plan.measure, **step), replace(ride, **step))
    ]
    assert [result.reason for result in results] == ["", ""]
    assert [result.engine for result in results] == [engine, engine]
    return [{name: result.values[name] for name in names} for result in results]


def test_report_sweep_python_and_search_are_equal_to_the_last_digit(car, source, tmp_path):
    run = car.run(source, engine="mujoco")
    comfort = run.comfort()
    table, search = swept(car, source, "mujoco")
    alone = {name: comfort.values[name] for name in table}
    assert table == search == alone and all(np.isfinite(list(alone.values())))
    seated = car.vehicle.seated
    assert set(NAMES) <= set(alone) and ("seat_value" in alone) == seated
    folder = save_run(run, tmp_path / "run", figures=False)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["comfort"]["seat_rail"]
    assert summary["rms_2_50_hz"]["overall"] == comfort.unweighted.overall == alone["unweighted"]
    assert summary["iso2631"]["vector_sum"]["weighted_rms"] == comfort.weighted.overall == alone["weighted"]
    for axis in "xyz":
        assert summary["rms_2_50_hz"][axis] == alone[f"unweighted_{axis}"]
        assert summary["iso2631"][axis]["weighted_rms"] == alone[f"weighted_{axis}"]
    page = report_section(read_run(folder))
    for name in ("unweighted", "weighted"):
        assert number(alone[name]) in page


def test_the_reduced_engine_gives_all_printed_digits(car, source):
    alone = car.run(source, engine="reduced").comfort().values
    # A batch is computed in single precision: 24 bit, 1e-7, after some thousand steps. At its own step a measure is up
    # to 0.05 % off (`batch_simulation`), a single run a tenth of that, and neither is exact to the last digit.
    for step, close in (({"timestep": LONGEST_STEP}, 1e-5), ({}, 5e-4)):
        table, search = swept(car, source, "reduced", **step)
        assert table == search  # to the last digit
        assert table == pytest.approx({name: alone[name] for name in table}, rel=close)
    assert table != {name: alone[name] for name in table}


def test_a_measure_of_sharp_peaks_has_the_step_of_a_run(car):
    for name, step in (("peak:damper_top_fl_acc_z", LONGEST_STEP), ("travel", COARSE_STEP)):
        measure = chosen_measure([name], car.vehicle, 0.0)
        assert isinstance(measure, FigureMeasure) and measure.timestep == step


def test_a_cushion_has_both_names_and_the_seat_value():
    rng = np.random.default_rng(2)
    rail, cushion = rng.normal(size=(2, 2, 3, 4000))
    columns = comfort_columns(1e-3, rail, cushion, skip=0.5)
    assert set(comfort_units(seated=True)) <= set(columns)
    for prefix, records in (("", rail), ("seat_", cushion)):
        one = comfort_columns(1e-3, records[1:], skip=0.5)
        for name in NAMES:
            assert columns[f"{prefix}{name}"][1] == one[name][0]
    assert columns["seat_value"][1] == pytest.approx(
        columns["seat_weighted_z"][1] / columns["weighted_z"][1], rel=1e-12
    )
    assert {*NAMES[::4], "seat_unweighted", "seat_weighted", "seat_value"} <= set(FIGURES)


@pytest.mark.parametrize(("name", "other"), [("unweighted", "weighted"), ("weighted", "unweighted")])
def test_values_that_are_not_asked_are_not_computed(name, other):
    rail, cushion = np.random.default_rng(3).normal(size=(2, 2, 3, 4000))
    both, alone = comfort_columns(1e-3, rail, cushion), comfort_columns(1e-3, rail, cushion, names=[name])
    assert {f"{name}_x", name, f"seat_{name}", "seat_value"} <= set(alone) <= set(both)
    assert not {f"{other}_x", other, f"seat_{other}"} & set(alone)
    for key, values in alone.items():
        np.testing.assert_array_equal(values, both[key])
