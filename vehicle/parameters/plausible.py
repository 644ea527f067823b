"""What no road vehicle is, from a micro car to a loaded van: refused by the parameter's name, its value and the reason.

Ranges of single numbers stand in their declarations; here are those that need the name of a part, or two parameters.
They are wide on purpose: they are there for slips of the pen and of the unit, not for taste.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.names import AXES

if TYPE_CHECKING:
    from vehicle.parameters.vehicle import Vehicle

ENGINE_MASS = (20.0, 1000.0, "an electric motor has 30 kg, a large diesel with its gearbox 600 kg")
PART_MASS = (0.02, 150.0, "from the screw of a rod to the wheel of a van")
GYRATION = (1e-3, 1.0, "radius of gyration: thicker than a wire, smaller than the car is wide")
OFFSET_M = 1.0
"""No part lies farther from the mean of its own hardpoints [m]."""

HOLDING = {
    "tyre": (1e4, "the tyre carries the car; a car tyre has 1e5 to 4e5 N/m"),
    "rear_support": (5e3, "the rear of the car stands on it; an air spring has 1e4 N/m"),
    "suspension_mount": (1e4, "the strut leans on it"),
    "arm_rear": (1e4, "the A-arm is held by it; a soft comfort bushing has 1e5 N/m"),
}
"""Least stiffness along each axis [N/m] of the bushings without which something falls."""

WHEEL_RADIUS = (0.15, 0.7, "loaded radius: 0.23 m of a micro car, 0.4 m of a van")
HALF_TRACK = (0.3, 1.3, "half the track: 0.45 m of a micro car, 0.95 m of a van")
REACH_BEHIND = (0.5, 8.0, "the rear supports stand in for the rear axle, a wheelbase of 1.5 to 5 m behind")
PATCH_ASIDE_M = 0.2
"""The contact patch lies below the wheel centre, give or take camber and trail [m]."""

BODY_GYRATION = (0.2, 4.0, "radius of gyration of a body 2 to 8 m long")


def require_plausible(vehicle: Vehicle) -> None:
    """Refuse a car that no engineer could mean.

    Raises:
        ConfigurationError: naming the parameter, the value, what is allowed and why.
    """
    _parts(vehicle)
    _holding(vehicle)
    _corner(vehicle)
    _body(vehicle)


def _within(path: str, value: float, unit: str, limits: tuple[float, float, str]) -> None:
    low, high, why = limits
    if not low <= value <= high:
        raise ConfigurationError(f"{path}: found {value:g} {unit}, allowed are {low:g} to {high:g} {unit} ({why})")


def _parts(vehicle: Vehicle) -> None:
    for name, part in vehicle.parts.items():
        _within(f"parts.{name}.mass", part.mass, "kg", ENGINE_MASS if name == "engine" else PART_MASS)
        for axis, moment in zip(AXES, part.inertia, strict=True):
            low, high, why = GYRATION
            limits = (part.mass * low**2, part.mass * high**2, f"{why}, at {part.mass:g} kg")
            _within(f"parts.{name}.inertia.{axis}", moment, "kg m2", limits)
        for axis, offset in zip(AXES, part.offset, strict=True):
            limits = (-OFFSET_M, OFFSET_M, "a part lies near its own hardpoints; give metres")
            _within(f"parts.{name}.offset.{axis}", offset, "m", limits)


def _holding(vehicle: Vehicle) -> None:
    for name, (least, why) in HOLDING.items():
        for axis, stiffness in zip(AXES, getattr(vehicle.bushings, name).stiffness, strict=True):
            if stiffness < least:
                raise ConfigurationError(
                    f"bushings.{name}.stiffness.{axis}: found {stiffness:g} N/m, must be at least {least:g} N/m ({why})"
                )


def _corner(vehicle: Vehicle) -> None:
    points = vehicle.hardpoints
    wheel, patch = points.wheel_center, points.tyre_patch
    _within("hardpoints.wheel_center.z less hardpoints.tyre_patch.z", wheel[2] - patch[2], "m", WHEEL_RADIUS)
    _within("hardpoints.wheel_center.y", wheel[1], "m", HALF_TRACK)
    for axis, a, b in zip(AXES[:2], patch[:2], wheel[:2], strict=True):
        limits = (-PATCH_ASIDE_M, PATCH_ASIDE_M, "the tyre touches the plate below the wheel centre")
        _within(f"hardpoints.tyre_patch.{axis} less hardpoints.wheel_center.{axis}", a - b, "m", limits)
    behind = points.rear_support[0] - wheel[0]
    _within("hardpoints.rear_support.x less hardpoints.wheel_center.x", behind, "m", REACH_BEHIND)
    for entry in dataclasses.fields(points):
        if getattr(points, entry.name)[2] < patch[2]:
            height = getattr(points, entry.name)[2]
            raise ConfigurationError(
                f"hardpoints.{entry.name}.z: found {height:g} m, must not lie below the plate "
                f"(hardpoints.tyre_patch.z = {patch[2]:g} m)"
            )


def _body(vehicle: Vehicle) -> None:
    body, points = vehicle.body, vehicle.hardpoints
    every = [getattr(points, entry.name) for entry in dataclasses.fields(points)]
    for index, axis in enumerate(AXES):
        # Side points are those of the right side: the left is their mirror image.
        low, high = min(point[index] for point in every), max(point[index] for point in every)
        low = -high if axis == "y" else low
        why = "between the outermost hardpoints; a centre of gravity in metres lies inside the car"
        _within(f"body.cog.{axis}", body.cog[index], "m", (low, high, why))
    for name in ("ixx_published", "ixx_improved", "iyy", "izz"):
        low, high, why = BODY_GYRATION
        far = sum(value**2 for value in body.cog)
        limits = (body.mass * low**2, body.mass * (high**2 + far), f"about the origin; {why}")
        _within(f"body.{name}", getattr(body, name), "kg m2", limits)
