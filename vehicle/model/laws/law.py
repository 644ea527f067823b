"""Protocol of force laws, and laws in parallel."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vehicle.arrays import Vector

Numbers = float | Vector


class ForceLaw(Protocol):
    """Force that depends on the relative velocity alone; positive against a positive velocity."""

    def force(self, velocity: Numbers) -> Vector:
        """Return the force [N] at a relative velocity [m/s]; parameters and velocity broadcast together."""

    def slope(self, velocity: Numbers) -> Vector:
        """Return dF/dv [N s/m] at a relative velocity [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Constant:
    """F = F0, for example the force of a gas."""

    value: Numbers

    def force(self, velocity: Numbers) -> Vector:
        """Return the constant force F0 [N], one value for each velocity [m/s]."""
        return np.asarray(self.value + 0.0 * np.asarray(velocity))

    def slope(self, velocity: Numbers) -> Vector:
        """Return zero [N s/m] at every velocity."""
        return np.zeros(np.shape(velocity))


@dataclass(frozen=True, kw_only=True, slots=True)
class Parallel:
    """Laws in parallel: F(v) = sum of F_i(v)."""

    laws: tuple[ForceLaw, ...]

    def force(self, velocity: Numbers) -> Vector:
        """Return the sum of the forces [N] at a velocity [m/s]."""
        total = np.zeros_like(velocity, dtype=float)
        for law in self.laws:
            total = total + law.force(velocity)
        return total

    def slope(self, velocity: Numbers) -> Vector:
        """Return the sum of the derivatives [N s/m] at a velocity [m/s]."""
        total = np.zeros_like(velocity, dtype=float)
        for law in self.laws:
            total = total + law.slope(velocity)
        return total
