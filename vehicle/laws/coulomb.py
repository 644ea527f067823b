"""Coulomb friction in three forms: smooth (atan), regularised (clamped line) and set-valued.

The complete car computes the clamped line, in both engines: the slope of the published atan at rest, up to the limit
Fd. At eps = 1e5 s/m it reaches Fd at pi/(2 eps) = 16 um/s, where the atan has 64 % of it (99.4 % at 1 mm/s). The lumped
models compute the atan, as the source does, or the set-valued law as a switch (`vehicle.laws.switch`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.laws.law import Numbers, validate
from vehicle.parameters.quantity import quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class SmoothCoulomb:
    """F = Fd (2/pi) atan(eps v): the published law, that of the lumped models.

    Source: Bommer 2006, equation 2.4.
    """

    limit: Numbers = quantity("N", "Coulomb friction force Fd", at_least=0.0)
    steepness: Numbers = quantity("s/m", "smoothing parameter eps", above=0.0)

    def __post_init__(self) -> None:
        validate(self)

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Force [N] at a velocity [m/s]."""
        return np.asarray(self.limit * (2.0 / np.pi) * np.arctan(self.steepness * np.asarray(velocity)))

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Derivative d F / d v = (2/pi) Fd eps / (1 + (eps v)^2) [N s/m]."""
        scaled = self.steepness * np.asarray(velocity)
        return np.asarray(self.limit * (2.0 / np.pi) * self.steepness / (1.0 + scaled * scaled))


@dataclass(frozen=True, kw_only=True, slots=True)
class RegularisedCoulomb:
    """F = min(Fd, max(-Fd, c v)) with c = (2/pi) Fd eps, the slope of the smooth law at rest.

    This is what an implicit friction row with the impedance D = c h answers: the law of the complete car.
    """

    limit: Numbers = quantity("N", "Coulomb friction force Fd", at_least=0.0)
    steepness: Numbers = quantity("s/m", "smoothing parameter eps", above=0.0)

    def __post_init__(self) -> None:
        validate(self)

    @property
    def coefficient(self) -> npt.NDArray[np.float64]:
        """Slope at rest c = (2/pi) Fd eps [N s/m]."""
        return np.asarray((2.0 / np.pi) * self.limit * self.steepness)

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Force [N] at a velocity [m/s]."""
        limit = np.asarray(self.limit)
        return np.asarray(np.clip(self.coefficient * np.asarray(velocity), -limit, limit))

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Derivative d F / d v [N s/m]: c where the force is below its limit, zero elsewhere."""
        inside = self.coefficient * np.abs(velocity) < self.limit
        return np.where(inside, self.coefficient, 0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class SetValuedCoulomb:
    """F in [-Fd, Fd] at rest, F = Fd sign(v) in motion.

    Source: Bommer 2006, figure 2.8-a and equation 2.3.
    """

    limit: Numbers = quantity("N", "Coulomb friction force Fd", at_least=0.0)

    def __post_init__(self) -> None:
        validate(self)

    def bounds(self, velocity: Numbers) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Smallest and largest force [N] the law allows at a velocity [m/s]; equal in motion."""
        v = np.asarray(velocity)
        limit = np.asarray(self.limit)
        return np.where(v > 0.0, limit, -limit), np.where(v < 0.0, -limit, limit)

    def force_at_rest(self, applied: Numbers) -> npt.NDArray[np.float64]:
        """Friction force [N] that holds an applied force [N] at rest, as far as the limit allows."""
        limit = np.asarray(self.limit)
        return np.asarray(np.clip(np.asarray(applied), -limit, limit))
