"""Degressive damper: steep at low velocities, flatter above the velocity at which its valve opens."""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class Degressive:
    """F = Ddeg v below Vdeg; F = D v + sign(v) (Ddeg - D) Vdeg above: continuous at Vdeg.

    Source: Bommer 2006, equation C.1 (the branch for large velocities is damaged in the scan; continuity gives it).
    """

    low_damping: Numbers = quantity("N s/m", "damping constant Ddeg below the knee", at_least=0.0)
    high_damping: Numbers = quantity("N s/m", "damping constant D above the knee", at_least=0.0)
    knee_velocity: Numbers = quantity("m/s", "velocity Vdeg of the knee", at_least=0.0)

    def __post_init__(self) -> None:
        validate(self)

    def force(self, velocity: Numbers) -> Vector:
        """Return the force [N] at a velocity [m/s]."""
        v = np.asarray(velocity)
        inner = np.clip(v, -np.asarray(self.knee_velocity), self.knee_velocity)
        return np.asarray(self.high_damping * v + (self.low_damping - self.high_damping) * inner)

    def slope(self, velocity: Numbers) -> Vector:
        """Return dF/dv [N s/m]: Ddeg below the knee, D at and above the knee."""
        return np.where(np.abs(velocity) < self.knee_velocity, self.low_damping, self.high_damping)
