"""Rigid parts: mass, moments of inertia and where their centre of gravity lies."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.parameters.hardpoints import Point
from vehicle.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """A rigid part; its axes are those of the vehicle frame in the design position."""

    mass: float = quantity("kg", "mass", above=0.0)
    inertia: Point = quantity("kg m2", "Ixx, Iyy, Izz about the part's own centre of gravity", above=0.0, length=3)
    products: Point = quantity(
        "kg m2", "integrals of x y, z x, y z about it, right side", length=3, default=(0.0, 0.0, 0.0)
    )
    between: tuple[str, ...] | None = quantity(
        "-", "hardpoints whose mean is the centre of gravity; by default those of the template", default=None
    )
    offset: Point = quantity("m", "added to that mean; right side", length=3, default=(0.0, 0.0, 0.0))

    def __post_init__(self) -> None:
        validate(self)
        a, b, c = sorted(self.inertia)
        if a + b < c * (1.0 - 1e-9):
            raise ConfigurationError(
                f"Part.inertia: found {list(self.inertia)} kg m2, the two smaller must add up to the largest at least "
                f"(short by {c - a - b:.3g}); no mass distribution has such moments"
            )
