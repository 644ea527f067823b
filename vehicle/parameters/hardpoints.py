"""Hardpoints of a MacPherson front end and of the rest of the car, in the vehicle frame."""

from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.names import CENTER_POINTS, SIDE_POINTS, WHEEL_SIGN
from vehicle.parameters.quantity import quantity, validate

Point = tuple[float, float, float]

COINCIDENT_M = 1e-3
"""Two hardpoints of one part closer than this are taken for the same point."""

LARGEST_M = 20.0
"""No car has a hardpoint farther from its origin: larger numbers are millimetres."""


def _point(meaning: str) -> Point:
    point: Point = quantity("m", meaning, length=3)
    return point


@dataclass(frozen=True, kw_only=True, slots=True)
class Hardpoints:
    """Points [m]; x to the rear, y to the driver's right, z up; side points of the right side, the left is mirrored."""

    wheel_center: Point = _point("wheel centre, right")
    tyre_patch: Point = _point("middle of the tyre contact patch, right")
    lower_ball: Point = _point("ball joint A-arm to knuckle, right")
    arm_front: Point = _point("front joint of the A-arm on the body, right")
    arm_rear: Point = _point("rear bushing of the A-arm on the body, right")
    strut_top: Point = _point("suspension mount on the body, right")
    damper_bottom: Point = _point("clamp of the damper on the knuckle, right")
    spring_lower: Point = _point("lower seat of the main spring, right")
    tie_outer: Point = _point("steering rod on the knuckle, right")
    tie_inner: Point = _point("steering rod on the body, right")
    stab_body: Point = _point("stabilizer bar on the body, right")
    stab_end: Point = _point("stabilizer bar end, right")
    stab_rod_top: Point = _point("stabilizer rod on the damper housing, right")
    engine_cog: Point = _point("centre of gravity of the engine")
    hydromount: Point = _point("hydromount of the engine")
    linear_mount: Point = _point("linear mount of the engine")
    bottom_engine: Point = _point("torque arm on the engine")
    bottom_body: Point = _point("torque arm on the body")
    seat_rail: Point = _point("output point seat rail")
    seat: Point = _point("output point seat")
    roof_left_rear: Point = _point("output point roof, left rear")
    body_front: Point = _point("output point body front")
    rear_support: Point = _point("rubber block under the rear of the body, right")

    def __post_init__(self) -> None:
        validate(self, "hardpoints")
        for name in (*SIDE_POINTS, *CENTER_POINTS, "rear_support"):
            point = getattr(self, name)
            if max(abs(value) for value in point) > LARGEST_M:
                raise ConfigurationError(
                    f"hardpoints.{name}: found {list(point)} m, farther than {LARGEST_M} m: looks like mm; give metres"
                )
        for name in (*SIDE_POINTS, "rear_support"):
            if getattr(self, name)[1] <= 0.0:
                raise ConfigurationError(
                    f"hardpoints.{name}: found y = {getattr(self, name)[1]} m, side points are those of the right "
                    "side (y > 0); the left side is mirrored from them"
                )
        self._apart("lower_ball", "arm_front", "arm_rear", "damper_bottom", "strut_top", "tie_outer", "tie_inner")
        self._apart("stab_body", "stab_end", "stab_rod_top")
        self._apart("wheel_center", "tyre_patch")
        self._apart("bottom_engine", "bottom_body")
        self._apart("hydromount", "linear_mount", "bottom_body")
        if self.strut_top[2] <= self.lower_ball[2]:
            raise ConfigurationError(
                f"hardpoints.strut_top: found z = {self.strut_top[2]} m, must lie above hardpoints.lower_ball "
                f"(z = {self.lower_ball[2]} m)"
            )
        if self.spring_lower[2] >= self.strut_top[2] or self.damper_bottom[2] >= self.strut_top[2]:
            raise ConfigurationError(
                "hardpoints.spring_lower, hardpoints.damper_bottom: must lie below hardpoints.strut_top "
                f"(z = {self.strut_top[2]} m)"
            )
        if _sine(self.lower_ball, self.arm_front, self.arm_rear) < 0.02:
            raise ConfigurationError(
                "hardpoints.lower_ball, hardpoints.arm_front, hardpoints.arm_rear: lie on one line; "
                "an A-arm needs three points that span a triangle"
            )

    def _apart(self, *names: str) -> None:
        for first, second in itertools.combinations(names, 2):
            distance = math.dist(getattr(self, first), getattr(self, second))
            if distance < COINCIDENT_M:
                raise ConfigurationError(
                    f"hardpoints.{first}, hardpoints.{second}: coincide (distance {distance:.3g} m); "
                    f"they must be more than {COINCIDENT_M} m apart"
                )

    def all_points(self) -> dict[str, Point]:
        """Every hardpoint by name; side points as `<name>_fr` and `<name>_fl`, rear supports right and left [m]."""
        points: dict[str, Point] = {}
        for entry in dataclasses.fields(self):
            point: Point = getattr(self, entry.name)
            if entry.name in SIDE_POINTS:
                for wheel, sign in WHEEL_SIGN.items():
                    points[f"{entry.name}_{wheel}"] = mirrored(point, sign)
            elif entry.name == "rear_support":
                points["rear_support_right"] = point
                points["rear_support_left"] = mirrored(point, -1.0)
            else:
                points[entry.name] = point
        return points


def mirrored(point: Point, sign: float) -> Point:
    """The point for the right side (sign 1) or its mirror image on the left side (sign -1)."""
    return (point[0], sign * point[1], point[2])


def _sine(corner: Point, first: Point, second: Point) -> float:
    """Sine of the angle at `corner` of a triangle."""
    u = [b - a for a, b in zip(corner, first, strict=True)]
    v = [b - a for a, b in zip(corner, second, strict=True)]
    cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return math.hypot(*cross) / (math.hypot(*u) * math.hypot(*v))
