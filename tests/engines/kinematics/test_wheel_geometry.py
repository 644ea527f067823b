"""Roll centre, swing arms, support angles and steering axis of all shipped axles against their own geometry.

Required are 1e-6 m, and as much in radians.
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from tests.engines.kinematics.instant_centres import Centres, across, centres, motion, rod, rod_axle
from tests.engines.kinematics.strut import strut_geometry
from tests.model.assembly.test_templates import table
from tests.validation import validated
from vehicle.engines.kinematics.axle_curves import geometry_curve
from vehicle.engines.kinematics.wheel_geometry import WheelGeometry, WheelMotion, roll_centre, wheel_geometry
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.runs.car.axle import axle_statics

Vector = npt.NDArray[np.float64]

SUBJECT = "Suspension kinematics"
OWN = "second derivation: instant centres from the hardpoints"
FIVE = ("trailing_upper", "trailing_lower", "upper", "lower_front", "lower_rear")


@pytest.fixture(scope="module")
def cars() -> dict[str, Car]:
    return {name: Car.load(name) for name in ("focus_road", "sedan", "kinematic_reference")}


def right_points(car: Car, axle: str) -> dict[str, Vector]:
    wheel = next(one for one in car.vehicle.composition.wheels if one.axle == axle)
    end = f"_{wheel.name}"
    return {name.removesuffix(end): np.array(at) for name, at in car.vehicle.points.items() if name.endswith(end)}


def computed(car: Car, axle: str, travel: float = 0.0) -> WheelGeometry:
    towards = 1.0 if axle == "front" else -1.0
    return geometry_curve(axle_statics(car, axle, ideal=True), [travel], towards=towards)[0]


def require_centres(words: str, found: WheelGeometry, expected: Centres) -> None:
    validated(
        SUBJECT, f"{words}: height of the roll centre", found.roll_centre_height_m, expected.roll_centre, abs=1e-6,
        unit="m", source=OWN,
    )  # fmt: skip
    validated(
        SUBJECT, f"{words}: tangents of the support angles, brake and drive force",
        np.tan(np.radians([found.brake_support_deg, found.drive_support_deg])),
        np.tan(np.radians([expected.brake, expected.drive])), abs=1e-6, source=OWN,
    )  # fmt: skip
    # A long arm is the reciprocal of a small rotation.
    for name, value, arm in (
        ("front-view", found.front_swing_arm_m, expected.front_arm),
        ("side-view", found.side_swing_arm_m, expected.side_arm),
    ):
        validated(SUBJECT, f"{words}: reciprocal of the {name} swing arm", 1.0 / value, 1.0 / arm, abs=1e-6,
                  unit="1/m", source=OWN)  # fmt: skip


def strut_lines(p: dict[str, Vector]) -> list[tuple[Vector, Vector]]:
    links = [rod(p, "lower_ball", "arm_front"), rod(p, "lower_ball", "arm_rear"), rod(p, "tie_outer", "tie_inner")]
    return [*links, *across(p["strut_top"], p["strut_top"] - p["damper_bottom"])]


@pytest.mark.parametrize("travel", [-0.04, 0.0, 0.04])
@pytest.mark.parametrize("name", ["focus_road", "sedan", "kinematic_reference"])
def test_macpherson_struts(cars, name, travel):
    car = cars[name]
    p = right_points(car, "front")
    moved, turn = strut_geometry(car.vehicle.points, travel) if travel else (np.zeros(3), np.eye(3))
    centre = p["wheel_center"]
    now = {
        one: centre + moved + turn @ (p[one] - centre) for one in ("lower_ball", "tie_outer", "damper_bottom")
    }  # fixed to the knuckle
    now = {**p, **now, "wheel_center": centre + moved}
    spin = turn[:, 1]
    down = np.array([0.0, 0.0, -1.0]) + spin[2] * spin
    radius = p["wheel_center"][2] - p["tyre_patch"][2]
    contact = now["wheel_center"] + radius * down / np.linalg.norm(down)
    found, words = computed(car, "front", travel), f"strut of {name} at {1e3 * travel:g} mm"
    screw = motion(strut_lines(now), now["wheel_center"])
    require_centres(words, found, centres(screw, screw, now["wheel_center"], contact, 1.0))
    # The steering axis meets the ground where a line from the strut top through the ball joint does.
    ball, top = now["lower_ball"], p["strut_top"]
    ground = top + (ball - top) * (top[2] - contact[2]) / (top[2] - ball[2])
    validated(
        SUBJECT, f"{words}: caster trail and scrub radius",
        np.array([found.caster_trail_m, found.scrub_radius_m]), (contact - ground)[:2], abs=1e-6, unit="m", source=OWN,
    )  # fmt: skip
    angles = np.degrees(
        [math.atan2(top[0] - ball[0], top[2] - ball[2]), math.atan2(ball[1] - top[1], top[2] - ball[2])]
    )
    validated(
        SUBJECT, f"{words}: caster and kingpin inclination",
        np.array([found.caster_deg, found.kingpin_inclination_deg]), angles, abs=6e-5, unit="deg", source=OWN,
    )  # fmt: skip


@pytest.mark.parametrize("travel", [-0.03, 0.0, 0.03])
def test_five_links(cars, travel):
    p = right_points(cars["focus_road"], "rear")
    rods = [(f"{name}_outer", f"{name}_inner") for name in FIVE]
    place = rod_axle(p, rods, travel)
    now = {**p, **{outer: place(outer) for outer, _ in rods}}
    centre = place("wheel_center")
    # A second point on the axle of the wheel gives its direction.
    across_axis = rod_axle({**p, "axis": p["wheel_center"] + [0.0, 0.1, 0.0]}, rods, travel)("axis") - centre
    spin = across_axis / np.linalg.norm(across_axis)
    down = np.array([0.0, 0.0, -1.0]) + spin[2] * spin
    contact = centre + (p["wheel_center"][2] - p["tyre_patch"][2]) * down / np.linalg.norm(down)
    screw = motion([rod(now, *pair) for pair in rods], centre)
    found = computed(cars["focus_road"], "rear", travel)
    require_centres(
        f"five links of focus_road at {1e3 * travel:g} mm", found, centres(screw, screw, centre, contact, -1.0)
    )
    assert math.isnan(found.caster_deg) and math.isnan(found.scrub_radius_m)


@pytest.mark.parametrize("name", ["sedan", "kinematic_reference"])
def test_twist_beam(cars, name):
    """Both wheels swing about the pivots; against each other each half turns about pivot and middle of the beam."""
    p = right_points(cars[name], "rear")
    pivot, centre, contact = p["pivot"], p["wheel_center"], p["tyre_patch"]

    def swinging(axis: Vector) -> tuple[Vector, Vector]:
        velocity = np.cross(axis, centre - pivot)
        return velocity / velocity[2], axis / velocity[2]

    bounce = swinging(np.array([0.0, 1.0, 0.0]))
    roll = swinging(p["beam"] * [1.0, 0.0, 1.0] - pivot)
    found = computed(cars[name], "rear")
    require_centres(f"twist beam of {name}", found, centres(bounce, roll, centre, contact, -1.0))
    # In the side view the swing centre is the pivot.
    assert found.side_swing_arm_m == pytest.approx(centre[0] - pivot[0], abs=1e-6)
    assert found.side_swing_height_m == pytest.approx(pivot[2] - contact[2], abs=1e-6)


def tilted() -> dict[str, Any]:
    """A double wishbone with inclined arm axes, whose tie rod points at the line where the planes of the arms meet."""
    car = table()
    p = car["front"]["hardpoints"]
    for name, shift in {
        "lower_front": (0.0, 0.02, 0.03),
        "lower_rear": (0.0, -0.01, -0.02),
        "upper_front": (0.0, 0.01, -0.015),
        "upper_rear": (0.0, -0.015, 0.02),
        "upper_ball": (0.03, 0.0, 0.0),
    }.items():
        p[name] = np.add(p[name], shift).tolist()
    start, direction = arm_planes(p)
    outer = np.array(p["tie_outer"])
    aim = start + direction * ((outer - start)[0] / direction[0])
    p["tie_inner"] = (outer + 0.3 * (aim - outer) / np.linalg.norm(aim - outer)).tolist()
    return car


def arm_planes(p: dict[str, Any]) -> tuple[Vector, Vector]:
    """Point and direction of the line where the planes of both arms meet."""
    normals, levels = [], []
    for arm in ("lower", "upper"):
        ball, front, rear = (np.array(p[f"{arm}_{end}"]) for end in ("ball", "front", "rear"))
        normals.append(np.cross(front - ball, rear - ball))
        levels.append(normals[-1] @ ball)
    direction = np.cross(normals[0], normals[1])
    start = np.linalg.lstsq(np.array(normals), np.array(levels), rcond=None)[0]
    return start, direction / np.linalg.norm(direction)


def test_double_wishbone_against_the_planes_of_its_arms():
    """The wheel turns about the line where both planes meet: its crossings of two planes are the swing centres."""
    car = Car(vehicle_of(tilted()))
    p = right_points(car, "front")
    start, direction = arm_planes(p)
    centre, contact = p["wheel_center"], p["tyre_patch"]
    front = start + direction * (centre[0] - start[0]) / direction[0]
    side = start + direction * (centre[1] - start[1]) / direction[1]
    expected = Centres(
        roll_centre=(front[2] - contact[2]) * contact[1] / (contact[1] - front[1]),
        front_arm=centre[1] - front[1],
        side_arm=side[0] - centre[0],
        brake=math.degrees(math.atan((side[2] - contact[2]) / (side[0] - contact[0]))),
        drive=math.degrees(math.atan((side[2] - centre[2]) / (side[0] - centre[0]))),
    )
    found = computed(car, "front")
    require_centres("double wishbone, planes of the arms", found, expected)
    lines = [rod(p, f"{arm}_ball", f"{arm}_{end}") for arm in ("lower", "upper") for end in ("front", "rear")]
    screw = motion([*lines, rod(p, "tie_outer", "tie_inner")], centre)
    require_centres("double wishbone, five links", found, centres(screw, screw, centre, contact, 1.0))
    low, high = p["lower_ball"], p["upper_ball"]
    ground = low + (high - low) * (contact[2] - low[2]) / (high[2] - low[2])
    validated(
        SUBJECT, "double wishbone: caster trail and scrub radius",
        np.array([found.caster_trail_m, found.scrub_radius_m]), (contact - ground)[:2], abs=1e-6, unit="m", source=OWN,
    )  # fmt: skip


def wheel(side: float, **changed: Any) -> WheelMotion:
    values = {
        "side": side,
        "centre": np.array([0.0, 0.75 * side, 0.3]),
        "contact": np.array([0.0, 0.75 * side, 0.0]),
        "velocity": np.array([0.0, 0.0, side]),
        "rotation": np.zeros(3),
    }
    return WheelMotion(**{**values, **changed})


def test_signs():
    """Brake forces oppose dive if the contact point of a front wheel moves forwards as it rises."""
    rolling = [wheel(1.0), wheel(-1.0)]
    rising = [wheel(side, velocity=np.array([-0.1, 0.0, 1.0])) for side in (1.0, -1.0)]
    found = wheel_geometry(rolling, rising, 1.0)
    assert found.brake_support_deg == pytest.approx(math.degrees(math.atan(0.1))) == found.drive_support_deg
    assert wheel_geometry(rolling, rising, -1.0).brake_support_deg == pytest.approx(-found.brake_support_deg)
    assert math.isnan(found.side_swing_arm_m) and math.isnan(found.front_swing_arm_m) and math.isnan(found.caster_deg)
    assert found.roll_centre_height_m == 0.0 == found.roll_centre_lateral_m  # straight up: on the ground
    # A top that leans inwards and to the rear, and an axis that meets the ground inboard and ahead of the wheel.
    axis = np.array([[-0.02, 0.7, 0.0], [0.02, 0.6, 0.5]])
    steered = wheel_geometry(rolling, [wheel(1.0, steering_axis=axis), wheel(-1.0)], 1.0)
    assert steered.caster_deg > 0.0 and steered.kingpin_inclination_deg > 0.0
    assert (steered.caster_trail_m, steered.scrub_radius_m) == pytest.approx((0.02, 0.05))


def test_roll_centre_of_a_car_that_leans():
    """Lines of different slopes meet beside the middle plane; parallel lines do not meet."""
    right = wheel(1.0, velocity=np.array([0.0, 0.2, 1.0]))
    left = wheel(-1.0, velocity=np.array([0.0, 0.1, -1.0]))  # outwards as it rises: 0.1
    assert roll_centre(right, left) == pytest.approx((0.25, 0.1))
    outwards = wheel(-1.0, velocity=np.array([0.0, -0.2, -1.0]))
    assert all(math.isnan(value) for value in roll_centre(right, outwards))
