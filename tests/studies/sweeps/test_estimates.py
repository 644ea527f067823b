"""Sweeps and searches whose cars are estimated without a run: their values are those of `Car.estimate`."""

import json
import math

import numpy as np
import pytest

from vehicle import Car, optimise, parameter_effects, road, sobol, sweep
from vehicle.commands.optimise import main as optimise_command
from vehicle.commands.sweep import main as sweep_command
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.errors import ConfigurationError
from vehicle.runs.car import linear_part
from vehicle.studies.optimisation.screening import best_rows

FRICTION, VISCOUS = "front.damper.coulomb_friction", "rear.damper.viscous"


@pytest.fixture(scope="module")
def sedan() -> Car:
    """Return the sedan."""
    return Car.load("sedan")


def test_each_car_of_a_sweep_has_its_estimate(sedan: Car):
    """On two roads of two speeds; comfort has columns of errors, which stay empty, and no slip."""
    roads = [road("C", 80), road("B", 60)]
    table = sweep(sedan, {FRICTION: [60.0, 90.0], "body.mass": [1200.0, 1300.0]}, roads, estimate=True)
    row = 0
    for each in roads:
        for friction in (60.0, 90.0):
            for mass in (1200.0, 1300.0):
                estimate = Car.load("sedan", {FRICTION: friction, "body.mass": mass}).estimate(each)
                assert table.column("weighted")[row] == pytest.approx(estimate.values["weighted"], rel=1e-7)
                row += 1
    assert np.isnan(table.column("weighted_error")).all()
    assert not any("slip" in name for name in table.units)
    assert {each["engine"] for each in table.rows()} == {"estimate"}
    assert "estimates without a run" in str(table)


def test_many_cars_that_differ_in_the_same_parameters_are_estimated_by_ports(sedan: Car, monkeypatch):
    """64 cars of tyres and friction: as by poles within 1e-4, in any order, and without the poles of a single car."""
    tyre = "front.bushings.tyre.stiffness.z"
    vary = {tyre: np.linspace(1.9e5, 2.4e5, 16).tolist(), FRICTION: [60.0, 70.0, 80.0, 90.0]}
    solved: list[int] = []

    def by_poles(*arguments, **options):
        solved.append(1)
        return linear_twin(*arguments, **options)

    monkeypatch.setattr(linear_part, "linear_twin", by_poles)
    found = sweep(sedan, vary, road("C", 80), estimate=True).column("weighted")
    assert not solved
    alone = [sedan.with_({tyre: vary[tyre][at], FRICTION: 70.0}).estimate(road("C", 80)) for at in (0, 15)]
    assert len(solved) == 2
    assert found[[1, 61]] == pytest.approx([each.values["weighted"] for each in alone], rel=1e-4)
    backwards = {path: values[::-1] for path, values in vary.items()}
    assert sweep(sedan, backwards, road("C", 80), estimate=True).column("weighted")[::-1].tolist() == found.tolist()


def test_figures_of_mean_squares_are_those_of_runs(sedan: Car):
    """Tyre load, RMS in a band and ratio of two channels, within the error of the linearisation."""
    figures = ["tyre_load", "tyre_load_rms_fr", "rms:seat_rail_acc_z:5-25", "ratio:seat_rail_acc_z:seat_rail_acc_x"]
    drive = road("C", 80, duration=12)
    tables = [sweep(sedan, [{}, {FRICTION: 70}], drive, measure=figures, estimate=how) for how in (True, False)]
    for name in tables[0].units:
        # One seed of 10 s, 0.3 %, and the linearisation. The linear car lacks the present load on slopes, 2 % of the
        # motion along x.
        assert tables[0].column(name) == pytest.approx(tables[1].column(name), rel=0.03 if "ratio" in name else 0.01)


def test_a_car_that_is_not_covered_is_a_failed_row(sedan: Car):
    """The other cars have their values."""
    table = sweep(sedan, {FRICTION: [60.0, 600.0]}, road("B", 50), estimate=True)
    values = table.column("weighted")
    assert math.isfinite(values[0]) and math.isnan(values[1])
    assert "front.damper would stick too often" in table.failed[0][1]


@pytest.mark.parametrize(
    ("inputs", "measure", "words"),
    [
        (road("cleat:20x50", 30), None, "cleat:20x50 is no class"),
        ("low.csv", None, "low is no class"),
        (road("C", 80), "travel", "damper travel is unknown without a run"),
        (road("C", 80), "rms:damper_fr_velocity", "only accelerations are estimated"),
        (road("C", 80), lambda run: 1.0, "this measure needs runs"),
    ],
)
def test_a_sweep_of_estimates_refuses_what_has_none(sedan: Car, inputs, measure, words):
    """Before the first car."""
    with pytest.raises(ConfigurationError, match=words):
        sweep(sedan, {FRICTION: [60.0, 90.0]}, inputs, measure=measure, estimate=True)


def test_effects_and_indices_of_estimates(sedan: Car):
    """All designs of a sweep take estimates; friction has no effect in the rear axle of this sample."""
    effects = parameter_effects(sedan, road("C", 80), groups=("front.damper.coulomb_friction",), estimate=True)
    assert "neither a single event nor an estimate" in str(effects)
    indices = sobol(sedan, {FRICTION: (60, 100), VISCOUS: (1400, 1600)}, road("C", 80), base=64, estimate=True)
    first = dict(zip(indices["weighted"].paths, indices["weighted"].first, strict=True))
    # Both act alone here: their shares add up to one.
    assert sum(first.values()) == pytest.approx(1.0, abs=0.2)
    assert set(first) == {FRICTION, VISCOUS}


def test_a_screening_runs_the_best_beside_their_estimates(sedan: Car):
    """The best by estimate have the values of runs, and the text says how far the estimates are off."""
    found = optimise(
        sedan, {FRICTION: (40, 120), VISCOUS: (1000, 2500)}, road("C", 80, duration=12), ["weighted", "tyre_load"],
        screen=5, cars=64,
    )  # fmt: skip
    screened = found.screened
    assert screened is not None and screened.estimated == 64
    assert len(found.outcome.tried.reasons) == 5
    best = found.cars["best weighted"]
    run = best.run(road("C", 80, duration=12), "reduced").comfort().weighted.overall
    value = found.values["best weighted"]["weighted"]
    assert value is not None
    assert value == pytest.approx(run, rel=5e-4)  # steps of 0.5 ms in single precision: 0.05 %
    error = best.estimate(road("C", 80)).comfort.weighted.overall / value - 1.0
    assert screened.errors["best weighted"]["weighted"] == pytest.approx(error, abs=1e-6)
    assert abs(error) < 0.01
    assert "64 cars estimated without a run; the 5 best run" in found.text()


def test_the_best_rows_are_those_of_successive_fronts():
    """Of two objectives the front first, then the front of the others; of one objective the lowest."""
    costs = np.array([[0.0, 3.0], [1.0, 1.0], [3.0, 0.0], [2.0, 2.0], [4.0, 4.0]])
    assert sorted(best_rows(costs, 4)) == [0, 1, 2, 3]
    # Ends first: they are farthest apart.
    assert sorted(best_rows(costs, 2)) == [0, 2]
    assert best_rows(costs[:, 1:], 2).tolist() == [2, 1]


def test_the_commands_estimate(tmp_path, monkeypatch, capsys):
    """--estimate and --screen, with the words that say so."""
    monkeypatch.chdir(tmp_path)
    words = ["--vehicle", "sedan", "--road", "C", "--speed", "80"]
    assert sweep_command([*words, "--vary", f"{FRICTION}=60,90", "--estimate", "--output", "sweep"]) == 0
    assert "values are estimates without a run" in capsys.readouterr().out
    search = ["--vary", f"{FRICTION}=60:90", "--minimise", "weighted", "--cars", "16", "--population", "8"]
    assert optimise_command([*words, *search, "--duration", "8", "--screen", "2", "--output", "search"]) == 0
    assert "16 cars estimated without a run; the 2 best run" in capsys.readouterr().out
    summary = json.loads((tmp_path / "search" / "summary.json").read_text())
    assert summary["estimate"]["cars_estimated"] == 16
