"""Kelvin element: a spring and a viscous damper in parallel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import Validated, quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class Kelvin(Validated):
    """F = K u + B u', the linear bushing."""

    stiffness: Numbers = quantity("N/m", "stiffness K", at_least=0.0)
    damping: Numbers = quantity("N s/m", "damping constant B", at_least=0.0)

    def force(self, extension: Numbers, rate: Numbers) -> npt.NDArray[np.float64]:
        """Return the force [N] at an extension [m] and its rate [m/s]."""
        return np.asarray(self.stiffness * np.asarray(extension) + self.damping * np.asarray(rate))

    def complex_stiffness(self, angular_frequency: Numbers) -> npt.NDArray[np.complex128]:
        """Return K + j w B [N/m] at angular frequencies w [rad/s]."""
        return np.asarray(self.stiffness + 1j * np.asarray(angular_frequency) * self.damping)
