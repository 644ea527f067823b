"""Smallest change of a car that meets targets: brute force over cars, figures of single runs, what is refused."""

import json
from typing import Any

import numpy as np
import pytest

from vehicle import Car, road
from vehicle.commands.optimise import main
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range
from vehicle.runs.targets.target import Target
from vehicle.signals.analysis.comfort_error import overall_error, weighted_lines
from vehicle.signals.analysis.weighting import weighted_record
from vehicle.studies.optimisation.target_search import meet_targets
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep_settings import SweepSettings

RAIL = ("seat rail x", "seat rail y", "seat rail z")
ON_ROAD: dict[str, Any] = {"road": "C", "speed": 80.0}


def targets(weighted, travel):
    return {
        "weighted": Target(
            quantity="rms", channels=RAIL, weighting="seat", unit="m/s2", at_most=weighted, words="the ride", **ON_ROAD
        ),
        "travel": Target(quantity="travel", unit="m", at_most=travel, words="the travel", **ON_ROAD),
    }


RANGES = (
    Range(path="rear.damper.viscous", low=800.0, high=3000.0),
    Range(path="front.bushings.tyre.stiffness.z", low=1.7e5, high=2.7e5),
)


def test_change_against_a_grid_of_cars(sedan):
    """Of 21 x 21 cars on the same road, none that is allowed has a change smaller than 0.98 of the one found."""
    ride = road("C", 80, duration=3)
    run = sedan.run(ride, engine="reduced")
    limit = 0.95 * run.comfort().weighted.overall
    found = meet_targets(sedan, targets(limit, 0.1), RANGES, duration=3.0)
    assert found.change.feasible and found.after[0] <= limit
    axes = [np.geomspace(each.low, each.high, 21).tolist() for each in RANGES]
    start = np.array([each.start for each in found.ranges])
    grid = [(a, b) for a in axes[0] for b in axes[1]]
    cars = [car for car in grid if np.linalg.norm(np.log(np.array(car) / start)) < found.change.cost / 1.02]
    assert len(cars) > 10
    changes = [tuple(f"{each.path}={value!r}" for each, value in zip(RANGES, car, strict=True)) for car in cars]
    table = plan_sweep(sedan, changes, ride, SweepSettings(engine="reduced")).run()
    assert table.column("weighted")[-len(cars) :].min() > limit
    # The figures are those of a single run of the changed car within 0.03 %: a search steps at 0.5 ms.
    again = found.car.run(ride, engine="reduced")
    assert found.after[0] == pytest.approx(again.comfort().weighted.overall, rel=3e-4)
    assert found.before[0] == pytest.approx(run.comfort().weighted.overall, rel=3e-4)
    assert found.change.active == (0,) and "the ride" in found.sentence


def test_targets_that_exclude_each_other(sedan):
    shares: list[float] = []
    found = meet_targets(sedan, targets(0.5, 0.1), RANGES, duration=2.2, progress=shares.append)
    # The cars of the sample are counted one task after the other, so the bar tells early how long they take.
    assert len(shares) >= 5 and shares == sorted(shares) and shares[1] < 0.1 and shares[-1] == 1.0
    assert not found.change.feasible and found.change.active == (0,)
    assert "No car within the bounds meets both targets; the best one misses the ride" in found.sentence
    assert "the bound of" in found.sentence and "front.bushings.tyre.stiffness.z" in found.sentence


def test_a_coordinate_is_changed_by_a_length(sedan):
    """The change of a coordinate through 0 has a size and a text in mm."""
    car = sedan.with_({"hardpoints.seat_rail.y": 0.0})
    limit = 0.999 * car.run(road("C", 80, duration=3.0), engine="reduced").comfort().weighted.overall
    ranges = [Range(path="hardpoints.seat_rail.y", low=-0.4, high=0.4)]
    found = meet_targets(car, targets(limit, 0.1), ranges, duration=3.0)
    assert found.change.feasible and found.ranges[0].is_linear
    assert found.values[0] == pytest.approx(0.05 * found.change.position[0])
    assert next(line for line in found.lines() if "seat_rail.y" in line).split()[4] == "mm"


@pytest.mark.parametrize(
    ("figure", "ranges", "message"),
    [
        ({"road": ""}, RANGES, "weighted: .*road"),
        ({"speed": None}, RANGES, r"weighted: speed \[km/h\]"),
        ({"channels": ("seat rail q",)}, RANGES, "weighted: "),
        ({"unit": "g"}, RANGES, "weighted: unit: found 'g'"),
        ({}, (), "--vary: .*0 .*8"),
        ({}, (Range(path="rear.damper.viscous", low=2000.0, high=3000.0),), "2000:3000: .*1500"),
    ],
)
def test_what_is_refused(sedan, figure, ranges, message):
    keys = {"quantity": "rms", "channels": RAIL, "weighting": "seat", "unit": "m/s2", "at_most": 0.5, **ON_ROAD}
    with pytest.raises(ConfigurationError, match=message):
        meet_targets(sedan, {"weighted": Target(**(keys | figure))}, ranges, duration=3.0)


def test_command(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (
        '[ride]\nquantity = "rms"\nchannels = ["seat rail z"]\nweighting = "Wk"\nroad = "C"\nspeed = 80\n'
        'at_most = 0.9\nunit = "m/s2"\n'
    )
    (tmp_path / "targets.toml").write_text(text, encoding="utf-8")
    words = ["--vehicle", "sedan", "--targets", "targets.toml", "--vary", "front.bushings.tyre.stiffness.z=1.6e5:2.4e5"]
    assert main([*words, "--duration", "3", "--output", "change"]) == 0
    said = capsys.readouterr().out
    assert "front.bushings.tyre.stiffness.z" in said
    # Before the first run: how many cars, and what makes it shorter.
    assert said.startswith("note        64 cars") and "3 starts" in said.splitlines()[0]
    summary = json.loads((tmp_path / "change" / "summary.json").read_text(encoding="utf-8"))
    changed = Car.load(tmp_path / "change" / "vehicle.toml")
    # The error is that of the targets page: of the figure of a single run of this car, on the screen twice it.
    run = changed.run(road("C", 80, duration=3), engine="reduced")
    weighted = weighted_record(run.recording.timestep, run["seat_rail_acc_z"], "Wk")[run.evaluated]
    lines = weighted_lines(run.recording.timestep, weighted[None], [1.0])
    error, figure = float(overall_error(lines[None])[0]), summary["figures"]["ride"]
    assert figure["after_error"] == pytest.approx(error * figure["after"], rel=5e-4)
    assert f"{number(figure['after'])} +- {number(2.0 * figure['after_error'], 2)}  met within +-" in said
    path = "front.bushings.tyre.stiffness.z"
    assert changed[path].value == pytest.approx(summary["parameters"][path]["after"])
    for more, message in (
        (["--minimise", "weighted"], "remove --minimise"),
        (["--road", "C", "--speed", "80"], "remove --input and --road"),
        (["--cost", "a"], "--cost a: "),
    ):
        assert main([*words, *more, "--output", "wrong"]) == 2
        assert message in capsys.readouterr().err


def test_a_car_that_meets_its_targets_and_an_exact_figure_without_an_error(sedan):
    """A natural frequency has no column of errors, which ended in a KeyError."""
    heave = Target(quantity="frequency", motion="heave", unit="Hz", at_most=5.0, **ON_ROAD)
    found = meet_targets(sedan, targets(2.0, 0.1) | {"heave": heave}, RANGES[:1], duration=2.2)
    assert found.change.cost == 0.0 and np.isnan(found.after_error[2]) and found.after_error[0] > 0.0
    assert "+-" not in found.rows()[2][4] and found.rows()[2][5] == "met"
