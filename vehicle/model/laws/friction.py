"""Friction of a sliding pair: a law defines the limit L(v), and two forms the force near zero velocity.

    smooth    F = L(v) (2/pi) atan(eps v)               the published form, used by the lumped models
    clamped   F = min(L, max(-L, c v)), c = (2/pi) L eps   the same slope at rest, linear up to the limit

The complete car uses the clamped form in both engines: an implicit friction row with the impedance D = c h solves it.
At eps = 1e5 s/m it reaches the limit at pi/(2 eps) = 16 um/s, where the atan reaches 64 % (99.4 % at 1 mm/s).

A law is a module of this package with the name in `Damper.friction_law`, and a class of that name: its parameters and
the static functions `limit_at` and `fall_at` of a velocity and of parameters by name, for arrays and scalars.

Source: Bommer 2006, equations 2.4 and 3.2.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class Friction(ABC):
    """Smooth form of a friction law; parameters are scalars, or arrays that broadcast together."""

    friction_limit: Numbers = quantity("N", "friction limit Fd in sliding", at_least=0.0)
    smoothing: Numbers = quantity("s/m", "smoothing eps", above=0.0)

    def __post_init__(self) -> None:
        validate(self)

    @staticmethod
    @abstractmethod
    def limit_at(velocity: Any, numbers: Any) -> Any:
        """Return the friction limit L [N] at a velocity [m/s]."""

    @staticmethod
    @abstractmethod
    def fall_at(velocity: Any, numbers: Any) -> Any:
        """Return v dL/dv [N] at a velocity [m/s]."""

    def __getitem__(self, name: str) -> Numbers:
        """Return a parameter of the law by its name, for functions that also accept records."""
        value: Numbers = getattr(self, name)
        return value

    def limit(self, velocity: Numbers) -> Vector:
        """Return the friction limit L [N] at a velocity [m/s]."""
        return np.asarray(self.limit_at(velocity, self), dtype=float)

    def force(self, velocity: Numbers) -> Vector:
        """Return the force [N] at a velocity [m/s]."""
        return np.asarray(self.limit(velocity) * (2.0 / np.pi) * np.arctan(self.smoothing * np.asarray(velocity)))

    def slope(self, velocity: Numbers) -> Vector:
        """Return dF/dv [N s/m]."""
        v = np.asarray(velocity, dtype=float)
        scaled = self.smoothing * v
        fall, rising = self.fall_at(v, self), self.limit(v) * self.smoothing / (1.0 + scaled * scaled)
        if np.any(fall):
            # dL/dv is fall / v, written so that v = 0 divides nothing: atan(eps v)/v tends to eps there.
            moving = v != 0.0
            rising = rising + fall * np.where(moving, np.arctan(scaled) / np.where(moving, v, 1.0), self.smoothing)
        return np.asarray((2.0 / np.pi) * rising)


@dataclass(frozen=True, kw_only=True, slots=True)
class Clamped:
    """Clamped form of a friction law."""

    law: Friction

    def force(self, velocity: Numbers) -> Vector:
        """Return the force [N] at a velocity [m/s]."""
        limit = self.law.limit(velocity)
        return np.asarray(np.clip(slope_at_rest(limit, self.law.smoothing) * np.asarray(velocity), -limit, limit))

    def slope(self, velocity: Numbers) -> Vector:
        """Return dF/dv [N s/m]: of c v if the force is below the limit, otherwise of the limit."""
        v, limit = np.asarray(velocity, dtype=float), self.law.limit(velocity)
        fall, steep = self.law.fall_at(v, self.law), slope_at_rest(1.0, self.law.smoothing)
        inside = steep * np.abs(v) < 1.0
        return np.asarray(np.where(inside, steep * (limit + fall), fall / np.where(inside, 1.0, np.abs(v))))


def slope_at_rest(limit: Any, smoothing: Any) -> Any:
    """Return c = (2/pi) L eps [N s/m]."""
    return (2.0 / np.pi) * limit * smoothing
