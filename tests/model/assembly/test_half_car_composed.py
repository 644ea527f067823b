"""The half car with rider as a composed car: the same model in its plane has the same poles and responses.

Each wheel of an axle has half of its numbers; hubs shift along z alone, the rider is `seat_rider`. The seat rail is at
the height of the centre of gravity, so that pitch does not move it along x, and gravity is off, whose preloads the half
car does not know. Then both are the same equations; the composed ones come from differences of forces, good to 1e-8.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.lumped.half_car_rider_model import half_car_rider
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from tests.validation import validated
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.natural_modes import natural_modes
from vehicle.engines.linear.response import frequency_response
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car

CAR = half_car_rider_parameters()
HALF = """
mirrored = true
wheel = { part = "hub", center = "center", patch = "patch" }
joint = [{ kind = "slide", child = "hub", at = "center", axis = [0, 0, 1] }]
connection = [
  { name = "tyre", moving = "hub", carrier = "plate", at = "patch" },
  { name = "suspension", moving = "hub", carrier = "body", at = "center" },
]

[hardpoints]
center = "wheel centre"
patch = "contact patch"

[parts]
hub = { shape = "none", points = ["center"] }
"""
HEIGHT, COG = 0.7, 2.2
SAME = {"seat": "seat", "upper_limb": "upper_limb", "lower_limb": "lower_limb", "rail": "seat_base"}
"""Places of the composed car and what the half car calls them."""


def vertical(stiffness: float, damping: float) -> dict[str, Any]:
    return {"stiffness": [0.0, 0.0, stiffness], "damping": [0.0, 0.0, damping], "rotational_stiffness": 0.0}


def composed() -> dict[str, Any]:
    def axle(x: float, numbers: Any) -> dict[str, Any]:
        half = 0.5 * numbers.unsprung_mass
        return {
            "template": "half",
            "hardpoints": {"center": [x, 0.7, HEIGHT], "patch": [x, 0.7, HEIGHT - 0.3]},
            "parts": {"hub": {"mass": half, "inertia": [0.02 * half] * 3}},
            "bushings": {
                "tyre": vertical(0.5 * numbers.tyre_stiffness, 0.5 * numbers.tyre_damping),
                "suspension": vertical(0.5 * numbers.suspension_stiffness, 0.5 * numbers.suspension_damping),
            },
        }

    body, limbs = CAR.body, {"lower_limb": CAR.lower_limb, "upper_limb": CAR.upper_limb}
    cushion = vertical(CAR.seat.stiffness, CAR.seat.damping)
    seat = {
        "template": "seat_rider",
        "hardpoints": {"rail": [COG - body.seat_arm, 0.0, HEIGHT]},
        "parts": {
            name: {"mass": one.mass, "inertia": [0.02 * one.mass] * 3}
            for name, one in {"seat": CAR.seat, **limbs}.items()
        },
        "bushings": {"cushion": cushion | {"stiffness": [1e5, 1e5, CAR.seat.stiffness]}},
        **{f"{name}_spring": {"stiffness": one.stiffness, "damping": one.damping} for name, one in limbs.items()},
    }
    far = body.mass * (COG**2 + HEIGHT**2)
    about = {"about": "origin", "ixx": 900.0, "iyy": body.pitch_inertia + far, "izz": 900.0 + body.mass * COG**2}
    about["izx"] = body.mass * COG * HEIGHT
    return {
        "name": "half_car",
        "gravity": 0.0,
        "body": {"mass": body.mass, "cog": [COG, 0.0, HEIGHT], "flexible": False, "attachment_flexibility": False}
        | {"inertia": about},
        "front": axle(COG - body.front_arm, CAR.front),
        "rear": axle(COG + body.rear_arm, CAR.rear),
        "seat": seat,
        # Held sideways at the height of its centre of gravity, where that turns nothing.
        "connection": {
            name: {"moving": "body", "carrier": "world", "at": [COG + reach, 0.0, HEIGHT]}
            | vertical(0.0, 0.0)
            | {"stiffness": [1e4, 1e4, 0.0]}
            for name, reach in (("ahead", -1.0), ("behind", 1.0))
        },
        "outputs": {"rail": {"on": "body", "at": [COG - body.seat_arm, 0.0, HEIGHT]}},
        "solver": {"timestep": 1e-3, "record_rate": 1000.0},
    }


@pytest.fixture(scope="module")
def car(tmp_path_factory) -> Car:
    folder: Path = tmp_path_factory.mktemp("half")
    (folder / "half.toml").write_text(HALF, encoding="utf-8")
    return Car(vehicle_of(composed(), folder))


def test_all_poles_of_the_half_car_are_poles_of_the_car(car):
    poles = natural_modes(first_order(half_car_rider(CAR))).pole
    assert len(poles) == 7
    found = car.poles.poles
    worst = [np.min(np.abs(found - pole)) / abs(pole) for pole in poles]
    validated(
        "Linear system", "poles of the half car with rider, composed from a vehicle file, relative distance",
        np.array(worst), 0.0, abs=1e-8, source="second derivation: lumped half car",
    )  # fmt: skip


@pytest.mark.parametrize("driven", [(1.0, 0.0), (0.0, 1.0)])
def test_the_responses_are_those_of_the_half_car(car, driven):
    """To the road under one axle: both plates of the composed car move alike."""
    frequency = np.array([0.3, 0.8, 1.2, 2.5, 3.7, 5.5, 8.7, 13.0, 25.0, 50.0])
    theirs = frequency_response(first_order(half_car_rider(CAR)), frequency, list(SAME.values()), driven=driven)
    share = [driven["fr".index(wheel[0])] for wheel in car.vehicle.wheels]
    channels = [f"{place}_acc_z" for place in SAME]
    ours = frequency_response(first_order(car.matrices.system), frequency, channels, driven=share)
    validated(
        "Linear system",
        f"FRF of seat, limbs and rail to the {'front' if driven[0] else 'rear'} axle, composed half car", ours, theirs,
        rel=1e-8, unit="(m/s2)/m", source="second derivation: lumped half car",
    )  # fmt: skip
