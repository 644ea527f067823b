"""Orders at steady points: limits of the linear car, peaks at the modes, the command with its refusals and files."""

import json
import math
import re
from typing import Any

import numpy as np
import pytest

from tests.validation import validated
from vehicle import Car, road
from vehicle.__main__ import main
from vehicle.digits import number
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.natural_modes import natural_modes
from vehicle.errors import VehicleError
from vehicle.runs.car.order_points import OrderPoints, order_points
from vehicle.runs.report.order_page import order_points_sentences, order_rows

IMBALANCE = {"front.right.imbalance.mass": 0.004, "front.right.imbalance.radius": 0.2}
NO_FRICTION = {f"{axle}.damper.coulomb_friction": 0.0 for axle in ("front", "rear")}
SPEEDS = (60.0, 140.0)


@pytest.mark.parametrize("limit", ["stuck", "without friction"])
def test_steady_points_lie_at_their_limit(limit):
    """4 g move no damper; without friction the dampers have the slope of their curve at rest."""
    car = Car.load("sedan", {**IMBALANCE, **(NO_FRICTION if limit != "stuck" else {})})
    found = order_points(car, "seat rail z", speed=SPEEDS, orders=[1], duration=8.0)
    validated(
        "Applied forces",
        f"order cut of an imbalance of 4 g over 60 to 140 km/h, dampers {limit}: seat rail against the linear car",
        np.abs(found.amplitude[0]),
        (found.stuck if limit == "stuck" else found.free)[0],
        source="second derivation: equations of second order, line by line",
        rel=2e-3,  # of motions of 1.5 % that have not decayed, and of the curve beyond its slope at rest
        unit="m/s2",
    )
    assert found.angle == "wheel_fr" and found.point_unit == "km/h"
    turns = [speed / 3.6 / (2.0 * math.pi * 0.3056) for speed in SPEEDS]
    assert found.turns == pytest.approx(turns, rel=5e-3)


def swept(order: float = 2.0) -> OrderPoints:
    """A moment of constant amplitude on the engine of the Focus, locked dampers, around a mode of the body."""
    force = {"force.a.on": "engine", "force.a.moment": [0, 1, 0], "force.a.angle": "crank"}
    car = Car.load("focus_road", {**force, "force.a.harmonics": [[order, 2.0, 0]]})
    return order_points(car, "seat rail z", rpm=np.arange(750.0, 900.0, 24.0).tolist(), orders=[2], duration=4.0)


def test_a_peak_lies_at_a_named_mode():
    found = swept()
    # A steady sinusoid has its peak at the mode within the half width of its resonance.
    frequency = 2.0 * float(found.turns[int(np.argmax(np.abs(found.amplitude[0])))])
    car = Car.load("focus_road", {"force.a.on": "engine", "force.a.moment": [0, 1, 0]})
    natural = natural_modes(first_order(car.matrices.system, stuck=True)).frequency
    # The engine pitches below the range, and makes most of the amplitude; a mode of the body makes its peak.
    ((mode, largest),) = found.parts
    assert max(np.min(np.abs(natural - each.frequency)) for each in (largest, mode)) < 1e-6
    assert largest.name.startswith("engine pitch") and largest.share > 1.0 > mode.share > 0.2
    assert abs(mode.frequency - frequency) < 2.0 * mode.damping_ratio * frequency
    (sentence,) = order_points_sentences(found)
    assert mode.resonant and not largest.resonant and largest.name not in sentence
    assert f"; in resonance, {100.0 * mode.share:.0f} %: {mode.name}, natural frequency " in sentence
    assert "no damper slips" in sentence and "dampers that stick would give" in sentence
    # The spectrum of the map has the amplitude of the order in its line, within the scallop of a Hann window.
    point = 3
    line = int(np.argmin(np.abs(found.frequency - 2.0 * found.turns[point])))
    assert 0.84 < found.spectrum[point, line] / np.abs(found.amplitude[0, point]) < 1.01


def test_rounding_is_no_result_and_limits_have_the_friction_that_acts():
    """Order 2 has no force; of the rack, which its friction holds or not, both limits enclose the run."""
    imbalance = {"front.right.imbalance.mass": 0.06, "front.right.imbalance.radius": 0.2}
    car = Car.load("sedan_steering", imbalance)
    found = order_points(car, "steering wheel rim y", speed=[90.0], orders=[1, 2], duration=4.0)
    size = float(np.abs(found.amplitude[0, 0]))
    assert found.stuck[0, 0] < size < found.free[0, 0] and found.frictions == "dampers and bushings"
    row, none = order_rows(found)
    assert none[:3] == ("2", f"< {number(float(found.floor[0]), 1)}", "–") and row[0] == "1"
    # The limit without friction is a car whose bushings have none.
    guides = {f"steering.bushings.rack_guide_{side}.friction_force.y": 0.0 for side in ("right", "left")}
    without = order_points(car.with_(guides), "steering wheel rim y", speed=[90.0], orders=[1], duration=4.0)
    assert without.free[0, 0] == pytest.approx(found.free[0, 0], rel=1e-6)
    assert without.stuck[0, 0] == pytest.approx(found.free[0, 0], rel=0.05)  # locked dampers
    # Where an unimportant harmonic is below the accuracy, no peak of it is named.
    weak = Car.load("sedan", {"force.a.on": "engine", "force.a.moment": [0, 1, 0], "force.a.angle": "crank",
                              "force.a.harmonics": [[2.0, 40.0, 0.0], [4.0, 1e-5, 0.0]]})  # fmt: skip
    (sentence,) = order_points_sentences(order_points(weak, rpm=[900.0], orders=[2, 4], duration=4.0))
    assert sentence.startswith("Order 2 ")


REFUSED: dict[str, tuple[dict[str, float], dict[str, Any], str]] = {
    "no force": ({}, {"rpm": [750.0]}, "level: moves no plate"),
    "both": (IMBALANCE, {"rpm": [750.0], "speed": [80.0]}, "of the crankshaft [1/min] or speeds of the car [km/h]"),
    "no crank": (IMBALANCE, {"rpm": [750.0], "angle": "wheel_fr"}, "wheel_fr does not turn with the crankshaft"),
    "not the crank": (IMBALANCE, {"rpm": [750.0]}, "sedan has no force that turns with crank"),
    "too many": (IMBALANCE, {"speed": np.linspace(60.0, 90.0, 500).tolist()}, "found 500 points, must be at most 400"),
    "too short": (IMBALANCE, {"speed": [60.0], "duration": 2.5}, "turns, must be at least 16"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_wrong_points_are_refused(name):
    forces, values, message = REFUSED[name]
    with pytest.raises(VehicleError) as error:
        order_points(Car.load("sedan", forces), **values)
    assert message in str(error.value)


def test_the_command_writes_table_pictures_and_report(tmp_path, capsys):
    sets = [word for path, value in IMBALANCE.items() for word in ("--set", f"{path}={value}")]
    command = ["orders", "--vehicle", "sedan", "--speed", "100:120:20", "--orders", "1,3", "--duration", "4", *sets]
    folder = tmp_path / "orders"
    assert main([*command, "--output", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "Order 1 is largest at 120 km/h" in said and "the end of the range" in said
    assert {"orders.csv", "orders.png", "campbell.png", "report.html"} <= {path.name for path in folder.iterdir()}
    assert "Order 1 is largest at 120 km/h" in (folder / "report.html").read_text(encoding="utf-8")
    table = np.genfromtxt(folder / "orders.csv", delimiter=",", skip_header=2)
    assert main([*command, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    rows = data["rows"]
    assert data["parts"]["3"] == [] and "channels" not in data
    part = data["parts"]["1"][0]
    share = f"{100.0 * part['share']:.0f} %"
    assert f"no mode is in resonance, largest part, {share}: {part['name']}, natural frequency " in said
    assert [row["amplitude"] for row in rows] == pytest.approx(table[:, 3].tolist(), rel=1e-6)
    assert rows[0]["stuck"] is not None and rows[-1]["stuck"] is None  # no force has order 3


def test_several_channels_come_from_the_same_runs(tmp_path, capsys):
    sets = [word for path, value in IMBALANCE.items() for word in ("--set", f"{path}={value}")]
    command = ["orders", "--vehicle", "sedan", "--speed", "100:120:20", "--orders", "1", "--duration", "4", *sets]
    both = ["--channel", "seat rail z,knuckle fr x", "--channel", "seat rail x", "--output", str(tmp_path / "orders")]
    assert main([*command, *both, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    names = ["seat_rail_acc_z", "knuckle_fr_acc_x", "seat_rail_acc_x"]
    assert [each["channel"] for each in data["channels"]] == names
    first = data.pop("channels")[0]
    assert first == data  # the keys of a single channel, as without the others
    alone = order_points(Car.load("sedan", IMBALANCE), "knuckle fr x", speed=[100.0, 120.0], orders=[1], duration=4.0)
    table = np.genfromtxt(tmp_path / "orders" / "orders_knuckle_fr_acc_x.csv", delimiter=",", skip_header=2)
    assert table[:, 3] == pytest.approx(np.abs(alone.amplitude[0]), rel=1e-5)
    page = (tmp_path / "orders" / "report.html").read_text(encoding="utf-8")
    assert all(f"orders_{name}" in page for name in names)


@pytest.mark.parametrize(("words", "message"), [
    ([], ("error: orders: the speeds are missing")),
    (["--rpm", "700:3000"], "the step between the speeds is missing, for example 700:3000:115; for a run-up type"),
    (["--rpm", "900:700:50"], "must be A:B:STEP with 0 < A < B, for example 700:3000:50"),
    (["--rpm", "700:3000:1"], "gives 2301 points, but at most 400 are allowed; use a larger step"),
    (["--rpm", "700:900:50", "--speed", "60:80:5"], "only one can be a range"),
    (["--rpm", "700:900:50", "--orders", "2,2"], "must be up to 12 whole or half orders, each once"),
    (["--rpm", "700:900:50", "--orders", "1.3"], "must be up to 12 whole or half orders, each once"),
])  # fmt: skip
def test_wrong_options_are_refused(words, message, capsys):
    assert main(["orders", *words]) == 2
    assert message in capsys.readouterr().err


SHAKER = {
    "700:3000": "the length of the run-up is missing",
    "x": "must be a speed, for example 750, or a run-up, for example 700:3000",
    "100": "crank.rpm: found 100.0 1/min, must be at least 300.0",
}


@pytest.mark.parametrize("rpm", SHAKER)
def test_a_wrong_speed_of_the_shaker_is_refused(rpm, capsys):
    assert main(["shaker", "--vehicle", "sedan", "--rpm", rpm]) == 2
    assert SHAKER[rpm] in capsys.readouterr().err


def test_steady_points_of_the_shaker_are_those_of_orders(capsys):
    force = ["on=engine", "moment=[0, 1, 0]", "angle=crank", "harmonics=[[2, 10, 0]]"]
    words = ["--vehicle", "sedan", "--rpm", "900:1100:200", "--duration", "4"]
    words += [word for text in force for word in ("--set", f"force.a.{text}")]
    assert main(["orders", *words]) == 0
    expected = capsys.readouterr().out
    assert main(["shaker", *words]) == 0
    assert capsys.readouterr().out == expected and "2 runs of 4 s" in expected
    assert main(["shaker", *words, "--input", "low.csv"]) == 2
    assert re.search("--rpm A:B:STEP: .*remove --input", capsys.readouterr().err)
    assert main(["shaker", *words, "--law-band"]) == 2
    assert "--law-band: belongs to a run of a whole road, but --rpm A:B:STEP runs many" in capsys.readouterr().err


def test_the_shaker_runs_up(tmp_path, capsys):
    sets = {"on": "engine", "moment": [0, 1, 0], "angle": "crank", "harmonics": [[2, 10, 0]]}
    words = [word for key, value in sets.items() for word in ("--set", f"force.a.{key}={value}")]
    folder = tmp_path / "run_up"
    command = ["shaker", "--vehicle", "sedan", "--rpm", "800:1600", "--duration", "8", "--engine", "reduced", *words]
    assert main([*command, "--no-figures", "--output", str(folder)]) == 0
    assert "Order 2 of the crankshaft is largest at" in capsys.readouterr().out
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    assert [line["order"] for line in summary["run_up"]] == [2.0] and "orders" not in summary


def test_a_sweep_measures_an_order(tmp_path, capsys):
    sets = [word for path, value in IMBALANCE.items() for word in ("--set", f"{path}={value}")]
    where = ["--vehicle", "sedan", "--road", "level", "--speed", "100", "--duration", "5"]
    values = ["--vary", "front.right.imbalance.mass=0.004,0.04", "--measure", "order:1:seat_rail_acc_z"]
    folder = tmp_path / "sweep"
    command = ["sweep", *where, *sets, *values, "--engine", "reduced", "--jobs", "1", "--output", str(folder)]
    assert main(command) == 0
    table = (folder / "table.csv").read_text(encoding="utf-8").splitlines()
    rows = [dict(zip(table[0].split(","), line.split(","), strict=True)) for line in table[1:]]
    found = [float(row["order_1_seat_rail_acc_z [m/s2]"]) for row in rows]
    cars = [Car.load("sedan", {**IMBALANCE, "front.right.imbalance.mass": mass}) for mass in (0.004, 0.04)]
    points = [order_points(car, speed=[100.0], orders=[1], duration=5.0).amplitude[0, 0] for car in cars]
    assert sorted(found) == pytest.approx(sorted(map(abs, points)), rel=1e-5)
    small, large = (f"order:1:seat_rail_acc_{axes}" for axes in ("z", "y+seat_rail_acc_x+seat_rail_acc_z"))
    car = Car.load("sedan", {**IMBALANCE, "front.right.imbalance.mass": 0.04})
    run = car.run(road("level", 100, duration=5), engine="reduced")
    each = [run.figure(f"order:1:seat_rail_acc_{axis}") for axis in "xyz"]
    assert run.figure(small) == each[2] and run.figure(large) == max(each) > each[1]
    for wrong in ("order:0:seat_rail_acc_z", "order:1"):
        assert main([*command[:-4], "--measure", wrong, "--output", str(tmp_path / "b")]) == 2
        assert f"--measure '{wrong}': must have the form order:N:CHANNELS[:ANGLE]" in capsys.readouterr().err
