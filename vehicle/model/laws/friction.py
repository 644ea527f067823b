"""Friction of a sliding pair: a law gives the limit L(v), and there are two ways through zero.

    smooth    F = L(v) (2/pi) atan(eps v)               the published form, that of the lumped models
    clamped   F = min(L, max(-L, c v)), c = (2/pi) L eps   its slope at rest, straight up to the limit

The complete car computes the clamped line, in both engines: an implicit friction row with the impedance D = c h answers
it. At eps = 1e5 s/m it reaches the limit at pi/(2 eps) = 16 um/s, where the atan has 64 % of it (99.4 % at 1 mm/s).

A law is a file of this room under its word of `Damper.friction_law`, with a class of that name: its numbers and the
static functions `limit_at` and `fall_at`, which take a velocity, numbers by their names, and arrays as well as scalars.

Source: Bommer 2006, equations 2.4 and 3.2.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.compiler import jitable
from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import quantity, validate

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class Friction(ABC):
    """The smooth form of a law; its numbers are scalars, or arrays that broadcast together."""

    friction_limit: Numbers = quantity("N", "friction limit Fd in sliding", at_least=0.0)
    smoothing: Numbers = quantity("s/m", "smoothing eps", above=0.0)

    def __post_init__(self) -> None:
        validate(self)

    @staticmethod
    @abstractmethod
    def limit_at(velocity: Any, numbers: Any) -> Any:
        """Friction limit L [N] at a velocity [m/s]."""

    @staticmethod
    @abstractmethod
    def fall_at(velocity: Any, numbers: Any) -> Any:
        """v dL/dv [N] at a velocity [m/s]."""

    def __getitem__(self, name: str) -> Numbers:
        """A number of the law by its name, as of a record."""
        found: Numbers = getattr(self, name)
        return found

    def limit(self, velocity: Numbers) -> Array:
        """Friction limit L [N] at a velocity [m/s]."""
        return np.asarray(self.limit_at(velocity, self), dtype=float)

    def force(self, velocity: Numbers) -> Array:
        """Force [N] at a velocity [m/s]."""
        return np.asarray(self.limit(velocity) * (2.0 / np.pi) * np.arctan(self.smoothing * np.asarray(velocity)))

    def slope(self, velocity: Numbers) -> Array:
        """Derivative d F / d v [N s/m]."""
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
    """The clamped form of a law."""

    law: Friction

    def force(self, velocity: Numbers) -> Array:
        """Force [N] at a velocity [m/s]."""
        limit = self.law.limit(velocity)
        return np.asarray(np.clip(slope_at_rest(limit, self.law.smoothing) * np.asarray(velocity), -limit, limit))

    def slope(self, velocity: Numbers) -> Array:
        """Derivative d F / d v [N s/m]: that of c v where the force is below its limit, of the limit elsewhere."""
        v, limit = np.asarray(velocity, dtype=float), self.law.limit(velocity)
        fall, steep = self.law.fall_at(v, self.law), slope_at_rest(1.0, self.law.smoothing)
        inside = steep * np.abs(v) < 1.0
        return np.asarray(np.where(inside, steep * (limit + fall), fall / np.where(inside, 1.0, np.abs(v))))


@jitable
def clamp(force: float, limit: float) -> float:
    """min(L, max(-L, F)), the scalar form."""
    return min(max(force, -limit), limit)


@jitable
def slope_at_rest(limit: Any, smoothing: Any) -> Any:
    """c = (2/pi) L eps [N s/m]."""
    return (2.0 / np.pi) * limit * smoothing
