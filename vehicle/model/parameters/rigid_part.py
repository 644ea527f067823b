"""Mass properties of rigid parts, and of loads on them: passengers, luggage, fuel, a battery."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.quantity import quantity, validate

ROD_RADIUS = 0.01
"""Default radius [m] of a rod without inertia, assumed: a steering or stabilizer rod."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """A rigid part; its axes are those of the vehicle frame in the design position."""

    mass: float = quantity("kg", "mass", above=0.0)
    inertia: Point | None = quantity(
        "kg m2",
        "Ixx, Iyy, Izz about the part's own centre of gravity; default: a rod between its first two points",
        above=0.0,
        length=3,
        default=None,
    )
    products: Point = quantity(
        "kg m2",
        "integrals of x y, z x, y z about the part's own centre of gravity, right side",
        length=3,
        default=(0.0, 0.0, 0.0),
    )
    between: tuple[str, ...] | None = quantity(
        "-", "hardpoints whose mean is the centre of gravity; default: the points of the template", default=None
    )
    radius: float = quantity(
        "m",
        "radius of a rod without inertia",
        above=0.0,
        at_most=0.2,
        why="steering and stabilizer rods have 5 to 15 mm",
        default=ROD_RADIUS,
    )
    offset: Point = quantity(
        "m",
        "offset of the centre of gravity from the mean of these hardpoints; right side",
        length=3,
        default=(0.0, 0.0, 0.0),
    )

    def as_rod(self, start: Point, end: Point) -> Part:
        """Return the part as a rod if it has no inertia: m L2/12 + m r2/4 across, m r2/2 about its axis.

        Args:
            start, end: ends of the rod, right side [m].
        """
        if self.inertia is not None:
            return self
        way = [b - a for a, b in zip(start, end, strict=True)]
        square = sum(x * x for x in way)
        across, along = self.mass * (square / 12.0 + self.radius**2 / 4.0), self.mass * self.radius**2 / 2.0
        x, y, z = (each / math.sqrt(square) for each in way)
        less = across - along
        moments = (across - less * x * x, across - less * y * y, across - less * z * z)
        return replace(self, inertia=moments, products=(less * x * y, less * z * x, less * y * z))

    def cog(self, center: Point, side: float) -> Point:
        """Return the centre of gravity of the part on one side [m].

        Args:
            center: mean of its points [m].
            side: +1 on the right, -1 on the left.
        """
        return (center[0] + self.offset[0], center[1] + side * self.offset[1], center[2] + self.offset[2])

    def __post_init__(self) -> None:
        validate(self)
        if self.between is not None and not self.between:
            raise ConfigurationError("Part.between: found no hardpoint; give one or more, or remove the key")
        if self.inertia is None:
            return
        a, b, c = sorted(self.inertia)
        if a + b < c * (1.0 - 1e-9):
            raise ConfigurationError(
                f"Part.inertia: found {list(self.inertia)} kg m2; the sum of the two smaller must be at least "
                f"the largest (it is {c - a - b:.3g} kg m2 less), as in every real body"
            )
        self._require_products(self.inertia)

    def _require_products(self, moments: Point) -> None:
        """Check the products: the matrix of the integrals of x x, x y, ... must have no negative minor."""
        total = sum(moments)
        if not any(self.products) or total == 0.0:
            return
        xx, yy, zz = ((0.5 * total - moment) / total for moment in moments)
        xy, zx, yz = (product / total for product in self.products)
        minors = (xx * yy - xy**2, xx * zz - zx**2, yy * zz - yz**2,
                  xx * (yy * zz - yz**2) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx))  # fmt: skip
        if min(minors) < -1e-12:
            raise ConfigurationError(
                f"Part.products: found {list(self.products)} kg m2, too large for the moments {list(moments)} kg "
                "m2: no real body has this inertia"
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class Load:
    """Mass properties of a load of a vehicle file; axes are those of the vehicle frame in the design position."""

    mass: float = quantity(
        "kg", "mass of the load; 0: no load", at_least=0.0, at_most=5000.0, why="a loaded van carries 3000 kg"
    )
    inertia: Point | None = quantity(
        "kg m2", "Ixx, Iyy, Izz about the load's own centre of gravity; a point mass by default", above=0.0,
        at_most=5000.0, length=3, default=None,
    )  # fmt: skip
    products: Point = quantity(
        "kg m2", "integrals of x y, z x, y z about the load's own centre of gravity", length=3, default=(0.0, 0.0, 0.0)
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.inertia is None and any(self.products):
            raise ConfigurationError(f"Load.products: found {list(self.products)} kg m2 without inertia; set both")
        try:
            Part(mass=1.0, inertia=self.inertia, products=self.products)
        except ConfigurationError as error:
            raise ConfigurationError(str(error).replace("Part.", "Load.", 1)) from None
