"""Viscous damper: the force is proportional to the velocity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.laws.law import Numbers, validate
from vehicle.parameters.quantity import quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class Viscous:
    """F = D v.

    Source: Bommer 2006, section 2.2.2.
    """

    damping: Numbers = quantity("N s/m", "viscous damping constant D", at_least=0.0)

    def __post_init__(self) -> None:
        validate(self)

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Force [N] at a velocity [m/s]."""
        return np.asarray(self.damping * np.asarray(velocity))

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Derivative d F / d v = D [N s/m]."""
        return self.damping * np.ones_like(velocity, dtype=float)
