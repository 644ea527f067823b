"""What every force law offers, and laws side by side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

Numbers = float | npt.NDArray[np.float64]


class ForceLaw(Protocol):
    """A force that depends on the relative velocity alone; positive against a positive velocity."""

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Force [N] at a relative velocity [m/s], of the shape of both broadcast together."""

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Derivative d F / d v [N s/m] at a relative velocity [m/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Constant:
    """F = F0, as of a gas."""

    value: Numbers

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """F0 [N] at every velocity."""
        return np.asarray(self.value + 0.0 * np.asarray(velocity))

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Zero."""
        return np.zeros(np.shape(velocity))


@dataclass(frozen=True, kw_only=True, slots=True)
class Parallel:
    """Laws side by side on the same velocity: F(v) = sum of F_i(v)."""

    laws: tuple[ForceLaw, ...]

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Sum of the forces [N] at a velocity [m/s]."""
        total = np.zeros_like(velocity, dtype=float)
        for law in self.laws:
            total = total + law.force(velocity)
        return total

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Sum of the derivatives [N s/m] at a velocity [m/s]."""
        total = np.zeros_like(velocity, dtype=float)
        for law in self.laws:
            total = total + law.slope(velocity)
        return total
