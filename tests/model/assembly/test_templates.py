"""Templates of other axles and of a seat: a double wishbone against closed form in the plane, a beam, an occupant."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import brentq

from vehicle.engines.kinematics.axle_statics import AxleStatics
from vehicle.model.parameters.vehicle import load_vehicle, vehicle_of
from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]

X = 0.85
LOWER_IN, UPPER_IN, LOWER_OUT, UPPER_OUT, WHEEL = (
    np.array(p) for p in ([0.35, 0.60], [0.42, 0.83], [0.68, 0.58], [0.66, 0.85], [0.744, 0.695])
)
"""Joints of the double wishbone in its plane, (y, z) [m]."""

FRICTION = load_vehicle().table["front"]["damper"]
RUBBER = {"stiffness": [3e5] * 3, "damping": [300.0] * 3, "rotational_stiffness": 20.0}
TYRE = {"stiffness": [1.5e5, 1.5e5, 2e5], "damping": [0.0, 0.0, 300.0], "rotational_stiffness": 100.0}
OCCUPANT, FRAME = 52.0, 6.0


def at(point: Vector, x: float = X) -> list[float]:
    return [x, *point.tolist()]


def mass(kg: float) -> dict[str, Any]:
    return {"mass": kg, "inertia": [0.02 * kg] * 3}


def wheel_parts() -> dict[str, Any]:
    return {"tyre": mass(16.0), "brake_disc": mass(5.0), "caliper": mass(3.0)}


def damper_parts() -> dict[str, Any]:
    return {"damper_bottom": mass(1.6), "damper_top": mass(1.6)}


def table() -> dict[str, Any]:
    """A rigid car: double wishbones in front, a twist beam behind, one occupant."""
    double = {
        "template": "double_wishbone",
        "hardpoints": {
            "wheel_center": at(WHEEL),
            "tyre_patch": at(WHEEL - [0.0, 0.3]),
            "lower_ball": at(LOWER_OUT),
            "lower_front": at(LOWER_IN, X - 0.15),
            "lower_rear": at(LOWER_IN, X + 0.2),
            "upper_ball": at(UPPER_OUT),
            "upper_front": at(UPPER_IN, X - 0.12),
            "upper_rear": at(UPPER_IN, X + 0.12),
            # A rod beside the lower arm and as long: the wheel does not steer.
            "tie_outer": at(LOWER_OUT, X + 0.12),
            "tie_inner": at(LOWER_IN, X + 0.12),
            "spring_lower": [X + 0.02, 0.55, 0.6],
            "spring_upper": [X + 0.02, 0.5, 1.0],
            "damper_lower": [X - 0.03, 0.55, 0.6],
            "damper_upper": [X - 0.03, 0.5, 1.05],
        },
        "parts": {
            "lower_arm": mass(4.0),
            "upper_arm": mass(2.0),
            "knuckle": mass(7.0),
            "tie_link": {"mass": 0.8},
            **wheel_parts(),
            **damper_parts(),
        },
        "bushings": {"tyre": TYRE, "damper_mount": RUBBER, "lower_rear": RUBBER, "upper_rear": RUBBER},
        "main_spring": {"stiffness": 6e4},
        "damper": FRICTION,
    }
    beam = {
        "template": "twist_beam",
        "hardpoints": {
            "wheel_center": [3.4, 0.73, 0.695],
            "tyre_patch": [3.4, 0.73, 0.395],
            "pivot": [2.95, 0.55, 0.7],
            "beam": [3.1, 0.45, 0.72],
            "spring_lower": [3.35, 0.5, 0.65],
            "spring_upper": [3.35, 0.5, 0.95],
            "damper_lower": [3.5, 0.6, 0.6],
            "damper_upper": [3.52, 0.55, 1.1],
        },
        "parts": {"arm": {"mass": 16.0, "inertia": [0.5, 0.6, 0.9]}, **wheel_parts(), **damper_parts()},
        "bushings": {"tyre": TYRE, "damper_mount": RUBBER, "pivot": RUBBER},
        "beam_torsion": {"torsional_stiffness": 8e3},
        "main_spring": {"stiffness": 4e4},
        "damper": FRICTION,
    }
    w = 2.0 * np.pi * 5.0
    seat = {
        "template": "seat_occupant",
        "hardpoints": {"rail": [2.1, -0.37, 0.85]},
        "parts": {"seat": mass(FRAME), "occupant": mass(OCCUPANT)},
        "bushings": {"cushion": {"stiffness": [1e5, 1e5, 4e4], "damping": [500.0] * 3, "rotational_stiffness": 0.0}},
        "occupant_spring": {"stiffness": OCCUPANT * w**2, "damping": 2.0 * 0.475 * w * OCCUPANT},
    }
    body = {"mass": 1100.0, "cog": [1.9, 0.0, 0.9], "flexible": False, "attachment_flexibility": False}
    body["inertia"] = {"about": "origin", "ixx": 1350.0, "iyy": 6900.0, "izz": 5900.0, "izx": 1881.0}
    return {
        "name": "other",
        "gravity": 9.81,
        "body": body,
        "front": double,
        "rear": beam,
        "seat": {"driver": seat},
        "outputs": {"seat_rail": {"on": "body", "at": [2.1, -0.37, 0.7]}},
        "solver": {"timestep": 5e-4, "record_rate": 1000.0},
    }


@pytest.fixture(scope="module")
def other() -> Car:
    return Car(vehicle_of(table()))


def turned(angle: float, arm: Vector) -> Vector:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]])


def closed_form(travel: float) -> tuple[float, float]:
    """Camber, top outwards [rad], and lateral place of the wheel centre [m]: a four-bar linkage by two circles."""
    long, short = np.linalg.norm(UPPER_OUT - UPPER_IN), np.linalg.norm(UPPER_OUT - LOWER_OUT)

    def pose(angle: float) -> tuple[float, Vector]:
        ball = LOWER_IN + turned(angle, LOWER_OUT - LOWER_IN)
        way = ball - UPPER_IN
        far = float(np.linalg.norm(way))
        along = (far**2 + long**2 - short**2) / (2.0 * far)
        aside = np.sqrt(long**2 - along**2) * np.array([-way[1], way[0]]) / far
        both = [UPPER_IN + way / far * along + sign * aside for sign in (1.0, -1.0)]
        top = min(both, key=lambda point: float(np.linalg.norm(point - UPPER_OUT)))
        tilt = float(np.arctan2(*(top - ball)[::-1]) - np.arctan2(*(UPPER_OUT - LOWER_OUT)[::-1]))
        return tilt, ball + turned(tilt, WHEEL - LOWER_OUT)

    found = brentq(lambda angle: pose(angle)[1][1] - WHEEL[1] - travel, -0.4, 0.4, xtol=1e-14)
    tilt, place = pose(found)
    return -tilt, float(place[0])


@pytest.mark.parametrize("travel", [-0.05, -0.02, 0.01, 0.05])
def test_a_double_wishbone_against_closed_form(other, travel):
    wheels = [wheel for wheel in other.vehicle.composition.wheels if wheel.axle == "front"]
    statics = AxleStatics(other.model.model, other.model.static.preload, wheels=wheels, ideal=True)
    pose = statics.solve([travel, travel])[0]
    camber, lateral = closed_form(travel)
    assert pose.camber_deg == pytest.approx(np.degrees(camber), abs=1e-4)
    assert pose.toe_deg == pytest.approx(0.0, abs=1e-4)
    assert pose.lateral_m == pytest.approx(lateral - WHEEL[0], abs=1e-6)


def test_the_car_stands_with_its_occupant(other):
    static, model = other.model.static, other.model.model
    weight = other.vehicle.gravity * model.body_mass.sum()
    assert sum(static.tyre_load.values()) == pytest.approx(weight, rel=1e-9) and static.residual < 1e-6
    assert other.vehicle.wheels == ("fr", "fl", "rr", "rl")
    # At rest the cushion carries the sitting mass: that of the frame and of what moves on it.
    names = [model.equality(index).name for index in range(model.neq)]
    rows = {name: 3 * index for index, name in enumerate(names) if name.startswith(("bushing", "ball"))}
    vertical = static.preload[rows["bushing/cushion_driver"] + 2]
    assert vertical == pytest.approx((OCCUPANT + FRAME) * other.vehicle.gravity, rel=1e-9)


def test_the_beam_twists_in_roll_alone(other):
    softer = table()
    softer["rear"]["beam_torsion"]["torsional_stiffness"] = 4e3
    frequencies = [
        {next(iter(mode.motions)): mode.frequency for mode in car.modes("sliding")}
        for car in (other, Car(vehicle_of(softer)))
    ]
    assert frequencies[1]["body roll (Rx)"] < 0.995 * frequencies[0]["body roll (Rx)"]
    assert frequencies[1]["body heave (z)"] == pytest.approx(frequencies[0]["body heave (z)"], rel=1e-4)
