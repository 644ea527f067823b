"""Length of a road from the wanted precision: in Python, in sweeps and as an option."""

import math
from dataclasses import replace
from typing import Any

import pytest

from vehicle import Car, road, sweep
from vehicle.commands.shaker import main as shaker
from vehicle.commands.sweep import main as sweep_command
from vehicle.errors import ConfigurationError
from vehicle.runs.car import road_precision
from vehicle.runs.car.road_precision import with_duration
from vehicle.runs.car.run import Run
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.optimisation.car_search import plan_search
from vehicle.studies.optimisation.search_settings import SearchSettings
from vehicle.studies.sweeps.sweep_inputs import inputs_of


@pytest.fixture(scope="module")
def car() -> Car:
    return Car.load("sedan")


def chosen(car: Car, name: str = "C", **settings: Any) -> RoadDrive:
    """Return the drive at 80 km/h with the duration for a precision."""
    drive = with_duration(car, road(name, 80, **settings).under(car.vehicle))
    assert isinstance(drive, RoadDrive) and drive.duration is not None and drive.precision is None
    return drive


def half_interval(run: Run) -> float:
    """Return half of the stated 95 % interval of the weighted comfort [%]."""
    return 196.0 * run.comfort().errors["weighted"]


def test_the_span_follows_the_stated_error_of_a_pilot(car: Car):
    """T' = T (e/P)^2 from a run of 6 s, and the run of the chosen span states at most the precision."""
    pilot = half_interval(car.run(road("C", 80, duration=8), engine="reduced", stated_errors=False))
    wanted = 0.8 * pilot
    drive = chosen(car, precision=wanted)
    assert drive.duration == drive.skip + math.ceil(6.0 / 0.8**2)
    run = car.run(road("C", 80, precision=wanted), engine="reduced", stated_errors=False)
    assert run.signal.duration == pytest.approx(drive.duration) and half_interval(run) <= wanted
    (text,) = run.signal.notices
    assert text == drive.chosen
    stated = float(text.rpartition("states ")[2].removesuffix(" %"))
    assert stated == pytest.approx(half_interval(run), abs=0.005) and "10 s of road_C_80" in text
    assert chosen(car, precision=1.01 * pilot).duration == drive.skip + 6.0


def test_the_stated_error_is_at_most_a_third_above_the_precision(car: Car):
    for seed in range(1, 5):
        run = car.run(road("A", 80, precision=1, seed=seed), engine="reduced", stated_errors=False)
        assert half_interval(run) < 1.3 and 6.0 <= run.signal.duration - run.skip <= 60.0


def test_a_limit_of_the_span_is_said(car: Car, monkeypatch):
    monkeypatch.setattr(road_precision, "LONGEST_SPAN_S", 8.0)
    drive = chosen(car, precision=0.2)
    assert drive.duration == drive.skip + 8.0 and "8 s of road_C_80 evaluated (the maximum)" in drive.chosen


def test_all_cars_of_a_sweep_drive_the_length_that_their_base_chooses(car: Car):
    """The table is that of a sweep with this duration, and --skip counts."""
    source, start = road("B", 80, precision=1), 3.0
    (drive,) = inputs_of(car, source, start)
    assert isinstance(drive, RoadDrive) and drive.skip == start and drive.duration is not None
    assert drive.span is not None and drive.span == math.floor(drive.span) >= 6.0
    changes = {"front.damper.coulomb_friction": [40.0, 90.0]}
    given = replace(source, precision=None, duration=drive.duration)
    tables = [sweep(car, changes, each, engine="reduced", skip=start) for each in (source, given)]
    assert tables[0].column("weighted").tolist() == tables[1].column("weighted").tolist()
    assert tables[0].made["inputs"] == tables[1].made["inputs"]


@pytest.mark.parametrize(
    ("name", "settings", "words"),
    [
        ("C", {"duration": 9.0}, "duration exclude each other"),
        ("C", {"period": "record"}, "needs a road that repeats"),
        ("C", {"contact": "cams"}, "cams, which have no linear twin"),
        ("cleat:20x50", {}, "works only with a road class"),
        ("C", {"precision": 0.0}, "must be above 0"),
    ],
)
def test_other_roads_are_refused(car: Car, name: str, settings: dict[str, Any], words: str):
    with pytest.raises(ConfigurationError, match=words):
        car.run(road(name, 80, **{"precision": 1.0, **settings}), engine="reduced")


def test_controlled_dampers_need_a_longer_road_than_passive_ones():
    """Their linear twin explains less, and the run states what it leaves."""
    passive, skyhook = (Car.load("focus_road", change) for change in ({}, {"front.damper.control.law": "skyhook"}))
    first, second = (chosen(each, precision=2.0).duration for each in (passive, skyhook))
    assert first is not None and second is not None and second > first


def test_nothing_drives_a_road_whose_length_is_not_chosen(car: Car):
    drive = road("C", 80, precision=1).under(car.vehicle)
    with pytest.raises(ConfigurationError, match="works in shaker, sweep and optimise"):
        drive.signal()


def test_commands_take_the_precision(tmp_path, capsys):
    road_options = ["--vehicle", "sedan", "--road", "C", "--speed", "80", "--precision", "1"]
    output = ["--engine", "reduced", "--output", str(tmp_path / "run")]
    assert shaker([*road_options, *output, "--no-figures"]) == 0
    assert "--precision 1: 9 s of road_C_80 evaluated, the pilot states" in capsys.readouterr().out
    estimate = ["--estimate", "--vary", "rear.damper.viscous=1500,1600", "--output", str(tmp_path / "sweep")]
    assert sweep_command([*road_options, *estimate]) == 2
    assert "--estimate runs nothing" in capsys.readouterr().err
    assert shaker([*road_options, "--duration", "9", "--output", str(tmp_path / "other")]) == 2
    assert "exclude each other" in capsys.readouterr().err


def test_a_search_takes_the_precision(car: Car):
    settings = SearchSettings(cars=8, population=8)
    plan = plan_search(car, {"rear.damper.viscous": (1500, 2500)}, road("C", 80, precision=1), ["weighted"], settings)
    (source,) = plan.trials.inputs
    assert isinstance(source, RoadDrive) and source.duration == chosen(car, precision=1).duration
