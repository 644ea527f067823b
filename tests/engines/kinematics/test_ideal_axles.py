"""Ideal joints: strut and twist beam of a car against own solvers, and five rods on the places of its strut.

Asked for are 1e-3 mm and 1e-4 degree.
"""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from tests.engines.kinematics.strut import camber_and_toe
from tests.validation import validated
from vehicle.engines.kinematics.axle_statics import AxleStatics, WheelPose
from vehicle.errors import SimulationError
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car

Vector = npt.NDArray[np.float64]

REFERENCE = "kinematic_reference"
FREEDOMS = ("lateral_m", "longitudinal_m", "camber_deg", "toe_deg")


@pytest.fixture(scope="module")
def reference() -> Car:
    return Car.load(REFERENCE)


def lifted(car: Car, axle: str) -> AxleStatics:
    wheels = [wheel for wheel in car.vehicle.composition.wheels if wheel.axle == axle]
    return AxleStatics(car.model.model, car.model.static.preload, wheels=wheels, ideal=True)


def require_pose(words: str, pose: WheelPose, moved: Vector, turn: Vector) -> None:
    own = "second derivation: own solver of the rigid linkage"
    validated(
        "Suspension kinematics", f"{words}: longitudinal and lateral motion of the wheel",
        np.array([pose.longitudinal_m, pose.lateral_m]), moved[:2], abs=1e-6, unit="m", source=own,
    )  # fmt: skip
    validated(
        "Suspension kinematics", f"{words}: camber and toe", np.array([pose.camber_deg, pose.toe_deg]),
        np.array(camber_and_toe(turn)), abs=1e-4, unit="deg", source=own,
    )  # fmt: skip


def about(point: Vector, axis: Vector, place: Vector, height: float) -> tuple[Vector, Vector]:
    """Displacement of a place and rotation about an axis through a point that lift the place by a height [m]."""

    def turned(angle: float) -> Vector:
        return np.asarray(Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix())

    def rise(angle: float) -> float:
        return float(((turned(angle) - np.eye(3)) @ (place - point))[2] - height)

    turn = turned(float(brentq(rise, -0.4, 0.4, xtol=1e-15)))
    return (turn - np.eye(3)) @ (place - point), turn


@pytest.mark.parametrize("travel", [-0.06, 0.04, 0.07])
def test_the_beam_swings_about_its_pivots(reference, travel):
    pivot, center = (np.array(reference.vehicle.points[f"{name}_rr"]) for name in ("pivot", "wheel_center"))
    moved, turn = about(pivot, np.array([0.0, 1.0, 0.0]), center, travel)
    require_pose(
        f"twist beam at {1e3 * travel:g} mm", lifted(reference, "rear").solve([travel, travel])[0], moved, turn
    )
    assert abs(moved[0]) > 1e-4


def test_the_beam_twists_about_its_shear_centre(reference):
    """Wheels against each other: each half turns about the line from its pivot to the middle of the beam.

    That is exact for small travel alone: the axes of the hinge part with the square of the turn, and only bushings
    give way to that.
    """
    points, travel = reference.vehicle.points, 1e-3
    pivot, beam, center = (np.array(points[f"{name}_rr"]) for name in ("pivot", "beam", "wheel_center"))
    middle = beam * [1.0, 0.0, 1.0]
    moved, turn = about(pivot, middle - pivot, center, travel)
    pose = lifted(reference, "rear").solve([travel, -travel])[0]
    require_pose("twist beam, wheels 1 mm against each other", pose, moved, turn)
    assert abs(pose.camber_deg) > 0.02 and abs(pose.toe_deg) > 1e-3
    with pytest.raises(SimulationError, match=r"cannot reach wheel travels of .* mm .*, or elastic bushings"):
        lifted(reference, "rear").solve([0.03, -0.03])


def rods(reach: float) -> dict[str, Any]:
    """The car on five rods in front: three on the places of its arm and its tie rod, two that hold the strut top.

    A point of the knuckle's line stays at the strut top where rods across that line hold it; over a travel s along
    the line they yield by s^2 / 2 l.

    Args:
        reach: length l of these two [m].
    """
    table = vehicle_table(Path(REFERENCE))
    p, old = table["front"]["hardpoints"], table["front"]
    line = np.subtract(p["strut_top"], p["damper_bottom"])
    along = np.cross(line, [0.0, 1.0, 0.0])
    across = np.cross(along, line)
    top = np.array(p["strut_top"])
    held = {
        "lower_front": (p["lower_ball"], p["arm_front"]),
        "lower_rear": (p["lower_ball"], p["arm_rear"]),
        "trailing_lower": (p["tie_outer"], p["tie_inner"]),
        "trailing_upper": ((top + reach * along / np.linalg.norm(along)).tolist(), p["strut_top"]),
        "upper": ((top + reach * across / np.linalg.norm(across)).tolist(), p["strut_top"]),
    }
    hardpoints = {name: p[name] for name in ("wheel_center", "tyre_patch")}
    for name, ends in held.items():
        hardpoints |= dict(zip((f"{name}_outer", f"{name}_inner"), ends, strict=True))
    hardpoints |= {"spring_lower": [0.75, 0.55, 0.62], "spring_upper": [0.75, 0.5, 1.0]}
    hardpoints |= {"damper_lower": p["damper_bottom"], "damper_upper": [0.82, 0.5, 1.2]}
    wheel = {name: old["parts"][name] for name in ("knuckle", "tyre", "brake_disc", "caliper")}
    damper = {name: old["parts"][name] for name in ("damper_bottom", "damper_top")}
    front = {
        "template": "five_link",
        "hardpoints": hardpoints,
        "parts": {**wheel, **damper, **{f"{name}_link": {"mass": 1.0} for name in held}},
        "bushings": {"tyre": old["bushings"]["tyre"], "damper_mount": table["rear"]["bushings"]["damper_mount"]},
        "main_spring": old["main_spring"],
        "damper": old["damper"],
    }
    return {**copy.deepcopy(table), "front": front}


def test_five_rods_on_the_places_of_a_strut_have_its_kinematics(reference):
    """Slopes are the same whatever the length of the two rods; over travel, what parts them falls as one over it."""
    strut = lifted(reference, "front")
    axles = [lifted(Car(vehicle_of(rods(reach))), "front") for reach in (1.25, 2.5)]

    def found(axle: AxleStatics, travel: float) -> Vector:
        pose = axle.solve([travel, travel])[0]
        return np.array([getattr(pose, name) for name in FREEDOMS])

    slopes = [found(axle, 1e-3) - found(axle, -1e-3) for axle in (strut, *axles)]
    for reach, slope in zip((1.25, 2.5), slopes[1:], strict=True):
        validated(
            "Suspension kinematics", f"slopes of five rods of {reach:g} m on the places of a strut", slope, slopes[0],
            rel=1e-4, source="second derivation: the strut",
        )  # fmt: skip
    exact, short, long = (found(axle, 0.02) for axle in (strut, *axles))
    asked = np.array([1e-6, 1e-6, 1e-4, 1e-4])
    seen = np.abs(short - exact) > 10.0 * asked
    assert seen.sum() == 3  # along the car hardly anything
    np.testing.assert_allclose(((short - exact) / (long - exact))[seen], 2.0, rtol=0.05)
    assert np.all(np.abs(2.0 * long - short - exact) < asked)
