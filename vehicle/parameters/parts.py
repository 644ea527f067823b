"""Rigid parts: mass, principal moments of inertia and where their centre of gravity lies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.parameters.hardpoints import Hardpoints, Point
from vehicle.parameters.quantity import quantity, validate

SIDE_PARTS = (
    "a_arm",
    "knuckle",
    "tyre",
    "brake_disc",
    "caliper",
    "damper_bottom",
    "damper_top",
    "suspension_mount",
    "main_spring_lower",
    "steering_rod",
    "stabilizer_half",
    "stabilizer_rod",
)
"""Parts that exist on each side."""

CENTER_PARTS = ("engine", "torque_arm")


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """A rigid part; its axes are those of the vehicle frame in the design position."""

    mass: float = quantity("kg", "mass", above=0.0)
    inertia: Point = quantity("kg m2", "Ixx, Iyy, Izz about the part's own centre of gravity", above=0.0, length=3)
    between: tuple[str, ...] = quantity("-", "hardpoints whose mean is the centre of gravity")
    offset: Point = quantity("m", "added to that mean; right side", length=3)

    def __post_init__(self) -> None:
        validate(self)
        if not self.between:
            raise ConfigurationError("Part.between: found an empty list, needed is at least one hardpoint name")
        a, b, c = sorted(self.inertia)
        if a + b < c * (1.0 - 1e-9):
            raise ConfigurationError(
                f"Part.inertia: found {list(self.inertia)} kg m2, the two smaller must add up to the largest at least "
                f"(short by {c - a - b:.3g}); no mass distribution has such moments"
            )

    def cog(self, points: Hardpoints) -> Point:
        """Centre of gravity [m] in the design position, right side."""
        chosen: list[Point] = [getattr(points, name) for name in self.between]
        x, y, z = (sum(axis) / len(chosen) for axis in zip(*chosen, strict=True))
        return (x + self.offset[0], y + self.offset[1], z + self.offset[2])


def require_parts(parts: Mapping[str, Part], points: Hardpoints) -> None:
    """Check that every part of the car is given and refers to existing hardpoints.

    Raises:
        ConfigurationError: a part is missing or unknown, or names a hardpoint that does not exist.
    """
    expected = (*SIDE_PARTS, *CENTER_PARTS)
    for name in expected:
        if name not in parts:
            raise ConfigurationError(f"parts.{name}: missing; needed are {', '.join(expected)}")
    for name, part in parts.items():
        if name not in expected:
            raise ConfigurationError(f"parts.{name}: unknown part; known are {', '.join(expected)}")
        for point in part.between:
            if not hasattr(points, point):
                raise ConfigurationError(f"parts.{name}.between: unknown hardpoint {point!r}")
