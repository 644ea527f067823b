"""Cars on four wheels: the seven-coordinate ride model as a limit, cars turned around and exchanged, both engines."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.visuals import visible_shapes
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

ROAD_CAR = VEHICLES / "focus_road" / "vehicle.toml"
WHEELS = ("fr", "fl", "rr", "rl")

RIDE = """
mirrored = true
wheel = { part = "hub", center = "center", patch = "patch" }
joint = [
  { kind = "free", child = "guide" },
  { kind = "slide", name = "damper", child = "hub", parent = "guide", at = "center", axis = [0, 0, 1] },
]
connection = [
  { name = "tyre", moving = "hub", carrier = "plate", at = "patch" },
  { name = "first", moving = "guide", carrier = "body", at = "first" },
  { name = "second", moving = "guide", carrier = "body", at = "second" },
  { name = "third", moving = "guide", carrier = "body", at = "third" },
]
spring = [{ name = "main_spring", lower = { part = "hub", at = "center" }, upper = { part = "body", at = "seat" } }]
damper = [{ name = "damper", joint = "damper" }]

[hardpoints]
center = "wheel centre"
patch = "contact patch"
first = "guide on the body"
second = "guide on the body"
third = "guide on the body"
seat = "upper spring seat"

[parts]
hub = { shape = "none", points = ["center"] }
guide = { shape = "none", points = ["center"] }
"""
HEIGHT, BODY, HUB, GUIDE = 0.7, 1000.0, 40.0, 0.1
AXLES = {  # x, half track, main spring, damper, tyre
    "front": (0.9, 0.75, 2.2e4, 1400.0, 2.0e5),
    "rear": (3.5, 0.72, 2.6e4, 1700.0, 2.1e5),
}
COG = 2.1
HUB_MOMENT, GUIDE_MOMENT = 0.8, 0.02
MOMENTS = {"ixx": 500.0, "iyy": 1600.0, "izz": 1900.0}  # about the centre of gravity
FRICTION = load_vehicle().table["front"]["damper"]


def ride_table(stiff: float) -> dict[str, Any]:
    """A car whose wheels move along z alone, on guides that are held to the rigid body by stiff bushings."""

    def held(k: float) -> dict[str, Any]:
        return {"stiffness": [k] * 3, "damping": [0.0] * 3, "rotational_stiffness": 0.0}

    def axle(x: float, y: float, spring: float, damper: float, tyre: float) -> dict[str, Any]:
        at = {"center": [x, y, HEIGHT], "patch": [x, y, HEIGHT - 0.3], "seat": [x, y, HEIGHT + 0.4]}
        at |= {"first": [x + 0.3, y, HEIGHT], "second": [x - 0.3, y, HEIGHT], "third": [x, y - 0.3, HEIGHT]}
        rubber = {"stiffness": [0.0, 0.0, tyre], "damping": [0.0, 0.0, 300.0], "rotational_stiffness": 0.0}
        return {
            "template": "ride",
            "hardpoints": at,
            "parts": {
                "hub": {"mass": HUB, "inertia": [HUB_MOMENT] * 3},
                "guide": {"mass": GUIDE, "inertia": [GUIDE_MOMENT] * 3},
            },
            "bushings": {"tyre": rubber, **{name: held(stiff) for name in ("first", "second", "third")}},
            "main_spring": {"stiffness": spring},
            "damper": {**FRICTION, "viscous": damper},
        }

    about = {
        "ixx": MOMENTS["ixx"] + BODY * HEIGHT**2,
        "iyy": MOMENTS["iyy"] + BODY * (COG**2 + HEIGHT**2),
        "izz": MOMENTS["izz"] + BODY * COG**2,
    }
    body = {"mass": BODY, "cog": [COG, 0.0, HEIGHT]}
    body["inertia"] = {"about": "origin", **about, "izx": BODY * COG * HEIGHT}
    body |= {"flexible": False, "attachment_flexibility": False}
    return {
        "name": "ride",
        "gravity": 0.0,
        "body": body,
        **{name: axle(*numbers) for name, numbers in AXLES.items()},
        # Held sideways at the height of its centre of gravity, where that turns nothing.
        "connection": {
            name: {"moving": "body", "carrier": "world", "at": [COG + reach, 0.0, HEIGHT], **held(0.0)}
            | {"stiffness": [1e4, 1e4, 0.0]}
            for name, reach in (("ahead", -1.0), ("behind", 1.0))
        },
        "outputs": {"seat": {"on": "body", "at": [2.0, -0.4, 0.8]}},
        "solver": {"timestep": 1e-3, "record_rate": 1000.0},
    }


def ride_car(folder: Path, stiff: float) -> Car:
    (folder / "ride.toml").write_text(RIDE, encoding="utf-8")
    return Car(vehicle_of(ride_table(stiff), folder))


def seven_coordinates() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """M, C, K of heave, pitch, roll and four wheels, and what the plates put in by K and C; typed from the picture."""
    rows, springs, dampers, tyres = [], [], [], []
    mass = np.diag([BODY, MOMENTS["iyy"], MOMENTS["ixx"], *[HUB] * 4])
    for index, wheel in enumerate(WHEELS):
        x, y, spring, damper, tyre = AXLES["front" if wheel[0] == "f" else "rear"]
        at = np.array([1.0, -(x - COG), y if wheel[1] == "r" else -y])
        # A guide rides on the body, and turns with it, as the hub does too.
        mass[:3, :3] += GUIDE * np.outer(at, at) + np.diag([0.0, *[GUIDE_MOMENT + HUB_MOMENT] * 2])
        rows.append(np.concatenate([at, -np.eye(4)[index]]))
        springs.append(spring)
        dampers.append(damper)
        tyres.append(tyre)
    travel = np.array(rows)
    to_road = np.hstack([np.zeros((4, 3)), np.eye(4)])
    stiffness = travel.T @ np.diag(springs) @ travel + to_road.T @ np.diag(tyres) @ to_road
    damping = travel.T @ np.diag(dampers) @ travel + to_road.T @ np.diag([300.0] * 4) @ to_road
    return mass, damping, stiffness, to_road.T * np.array(tyres), to_road.T * 300.0


FREQUENCY = np.array([0.7, 1.3, 2.4, 5.0, 11.0, 14.0, 20.0])


def exact_answers() -> np.ndarray:
    """The seven poles, then the responses of the seat to each plate."""
    mass, damping, stiffness, by_height, by_rate = seven_coordinates()
    inverse = np.linalg.inv(mass)
    state = np.block([[np.zeros((7, 7)), np.eye(7)], [-inverse @ stiffness, -inverse @ damping]])
    poles = [p for p in scipy.linalg.eigvals(state) if p.imag > 0.0]
    assert len(poles) == 7
    seat = np.array([1.0, -(2.0 - COG), -0.4, 0.0, 0.0, 0.0, 0.0])
    answers = []
    for push, rate in zip(by_height.T, by_rate.T, strict=True):
        for s in 2j * np.pi * FREQUENCY:
            answers.append(s**2 * seat @ np.linalg.solve(mass * s**2 + damping * s + stiffness, push + s * rate))
    return np.array([*poles, *answers])


def ride_answers(folder: Path, stiff: float, exact: np.ndarray) -> np.ndarray:
    """The same of the composed car: its poles nearest to the exact ones."""
    car = ride_car(folder, stiff)
    found = car.poles.poles
    poles = [found[np.argmin(np.abs(found - pole))] for pole in exact[:7]]
    responses = [car.matrix_frf(["seat_acc_z"], FREQUENCY, damper="sliding", wheel=wheel)[0] for wheel in WHEELS]
    return np.array([*poles, *np.concatenate(responses)])


def test_the_rigid_limit_is_the_ride_model(tmp_path):
    """Over the compliance c = 1/k of the guides an answer is exact + a c + b c^2 + ...

    Two stiffnesses a factor 4 apart show errors in the ratio 4, and together the limit c = 0 (Richardson). What is left
    there is b c^2 and the differences by which the matrices are taken: 4e-7.
    """
    exact = exact_answers()
    soft, stiff = (ride_answers(tmp_path, k, exact) for k in (1e8, 4e8))
    errors = [np.abs(answer / exact - 1.0) for answer in (soft, stiff)]
    ours = errors[0] > 1e-5
    assert ours.sum() > 20 and errors[0].max() < 1e-3
    np.testing.assert_allclose(errors[0][ours] / errors[1][ours], 4.0, rtol=0.02)
    limit = (4.0 * stiff - soft) / 3.0
    for words, part in (("poles", slice(7)), ("FRF of the seat to each plate", slice(7, None))):
        validated(
            "Linear system", f"{words} of a car on four wheels in the rigid limit", limit[part], exact[part], rel=1e-6,
            source="second derivation: ride model of seven coordinates, on paper",
        )  # fmt: skip


def test_a_car_turned_around_answers_turned_around():
    """Every point mirrored in x, front and rear exchanged: the same poles, and each plate does what its mirror did."""
    table = rigid_road()
    turned: dict[str, Any] = copy.deepcopy(table)
    span = 5.0

    def flip(point: list[float]) -> list[float]:
        return [span - point[0], point[1], point[2]]

    turned["front"], turned["rear"] = turned["rear"], turned["front"]
    for name in ("front", "rear", "engine"):
        turned[name]["hardpoints"] = {key: flip(point) for key, point in turned[name]["hardpoints"].items()}
        for part in turned[name]["parts"].values():
            part["offset"] = [-part.get("offset", [0.0])[0], *part.get("offset", [0.0] * 3)[1:]]
    turned["hardpoints"] = {key: flip(point) for key, point in turned["hardpoints"].items()}
    body, x = turned["body"], table["body"]["cog"][0]
    body["cog"] = flip(body["cog"])
    inertia = body["inertia"]
    inertia["iyy"] += body["mass"] * ((span - x) ** 2 - x**2)
    inertia["izz"] += body["mass"] * ((span - x) ** 2 - x**2)
    inertia["izx"] = span * body["mass"] * body["cog"][2] - inertia["izx"]
    inertia["ixy"] = span * body["mass"] * body["cog"][1] - inertia["ixy"]
    same_answers(table, turned, {"fr": "rr", "fl": "rl", "rr": "fr", "rl": "fl"})


def test_left_and_right_exchanged():
    table = rigid_road()
    other: dict[str, Any] = copy.deepcopy(table)

    def flip(point: list[float]) -> list[float]:
        return [point[0], -point[1], point[2]]

    other["hardpoints"] = {key: flip(point) for key, point in other["hardpoints"].items()}
    other["engine"]["hardpoints"] = {key: flip(point) for key, point in other["engine"]["hardpoints"].items()}
    for key in ("ixy", "iyz"):
        other["body"]["inertia"][key] = -other["body"]["inertia"][key]
    same_answers(table, other, {"fr": "fl", "fl": "fr", "rr": "rl", "rl": "rr"})


def rigid_road() -> dict[str, Any]:
    """The car on the road with a rigid body of its improved inertia, which needs no repair."""
    table = read_table(ROAD_CAR)
    table["body"] |= {"flexible": False, "attachment_flexibility": False}
    table["body"]["inertia"]["ixx"] = 1200.0
    del table["body"]["superelement"]
    for name in ("rear_support_right", "rear_support_left"):
        del table["hardpoints"][name]  # nodes of the flexible body
    return table


def same_answers(one: dict[str, Any], two: dict[str, Any], other: dict[str, str]) -> None:
    """Poles of both cars agree, and the responses of the seat rail to each plate with those to its counterpart."""
    cars = [Car(vehicle_of(table)) for table in (one, two)]
    frequency = np.array([1.0, 3.0, 8.0, 13.0, 30.0])
    for stuck in ("stuck", "sliding"):
        first, second = (np.array([mode.frequency for mode in car.modes(stuck)]) for car in cars)
        # Stiffness is taken by differences of forces; its round-off is seen in the softest modes.
        words = "turned around" if other["fr"] == "rr" else "with left and right exchanged"
        validated(
            "Linear system", f"frequencies of a car {words}, dampers {stuck}", second, first, rel=1e-5, unit="Hz",
            source="conservation: symmetry, the same car from its other side",
        )  # fmt: skip
    for wheel, counterpart in other.items():
        for axis in ("x", "y", "z"):
            a = cars[0].matrix_frf([f"seat_rail_acc_{axis}"], frequency, wheel=wheel)
            b = cars[1].matrix_frf([f"seat_rail_acc_{axis}"], frequency, wheel=counterpart)
            np.testing.assert_allclose(np.abs(b), np.abs(a), rtol=1e-5)
    loads = [car.model.static.tyre_load for car in cars]
    assert {wheel: loads[1][counterpart] for wheel, counterpart in other.items()} == pytest.approx(loads[0], rel=1e-8)


def test_a_wheel_is_drawn_whatever_its_points_are_called(tmp_path):
    own = RIDE.replace('hub = { shape = "none"', 'hub = { shape = "wheel"')
    (tmp_path / "ride.toml").write_text(own, encoding="utf-8")
    shapes = visible_shapes(vehicle_of(ride_table(1e8), tmp_path))
    assert {f"wheel_bolts_{wheel}" for wheel in WHEELS} <= set(shapes)


@pytest.fixture(scope="module")
def road():
    return Car.load(ROAD_CAR)


def test_the_road_car_stands_and_rides(road):
    static, model = road.model.static, road.model.model
    assert road.vehicle.wheels == WHEELS and static.support_load == {} and static.residual < 1e-6
    weight = road.vehicle.gravity * (model.body_mass.sum() - 9e-9)
    validated(
        "Static equilibrium", "focus on four wheels: sum of the wheel loads", sum(static.tyre_load.values()), weight,
        rel=1e-9, unit="N", source="conservation: m g from the masses of all bodies",
    )  # fmt: skip
    sliding = {next(iter(mode.motions)): mode.frequency for mode in road.modes("sliding")}
    assert 1.2 < sliding["body heave (z)"] < 1.6
    # The body keeps its modes: what the rear axle is fixed to is carried by its nodes.
    np.testing.assert_allclose(road.trimmed_body.frequencies, Car.load().trimmed_body.frequencies, rtol=1e-9)


def test_both_engines_drive_four_plates(road):
    time = np.arange(1001) / 1000.0
    rise = 0.5 * (1.0 - np.cos(2.0 * np.pi * np.clip(time - 0.1, 0.0, 0.25) / 0.25))
    plates = {wheel: 5e-3 * np.roll(rise, 50 * index) for index, wheel in enumerate(WHEELS)}
    runs = [road.run(Signal(time=time, displacement=plates), engine=engine) for engine in ("mujoco", "reduced")]
    for channel in ("seat_rail_acc_z", *(f"tyre_{wheel}_force_z" for wheel in WHEELS)):
        stepped, reduced = (run[channel] for run in runs)
        assert np.std(reduced - stepped) < 0.03 * np.std(stepped), channel
    with pytest.raises(ConfigurationError, match=r"wheel rr \(rear_right\): focus has no such wheel; choose"):
        Car.load().run(Signal(time=time, displacement=plates))
