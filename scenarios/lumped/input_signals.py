"""Input signals of a lumped model: road displacement and applied force as functions of time."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, DataError


class InputSignal(Protocol):
    """Signal over time: value and first derivative."""

    def at(self, time: float) -> tuple[float, float]:
        """Return value and first derivative at a time [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ZeroSignal:
    """Zero signal."""

    def at(self, time: float) -> tuple[float, float]:
        """Return zero value and zero rate."""
        return 0.0, 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Sine:
    """Sine signal: value = amplitude sin(2 pi frequency t + phase)."""

    amplitude: float
    frequency: float
    phase: float = 0.0

    def at(self, time: float) -> tuple[float, float]:
        """Return value and rate at a time [s]."""
        omega = 2.0 * math.pi * self.frequency
        angle = omega * time + self.phase
        return self.amplitude * math.sin(angle), self.amplitude * omega * math.cos(angle)


class Sampled:
    """Natural cubic spline through samples on a uniform grid that begins at t = 0; constant after the last sample.

    With straight lines the stiff solver would have to resolve a kink at each sample; with a spline its steps follow the
    solution.
    """

    def __init__(self, values: npt.ArrayLike, timestep: float) -> None:
        samples = np.asarray(values, dtype=float)
        if samples.ndim != 1 or samples.size < 2 or not np.isfinite(samples).all():
            raise DataError("sampled signal: must have at least two finite samples in one dimension")
        if not (math.isfinite(timestep) and timestep > 0.0):
            raise ConfigurationError(f"sampled signal: timestep {timestep!r} s must be finite and greater than 0.0")
        self.timestep = timestep
        self.values = samples
        spline = scipy.interpolate.CubicSpline(timestep * np.arange(samples.size), samples, bc_type="natural")
        # Plain floats: the solver evaluates single instants, for which an array access costs more than the polynomial.
        self._cubic: list[tuple[float, float, float, float]] = [tuple(c) for c in spline.c.T.tolist()]

    def at(self, time: float) -> tuple[float, float]:
        """Return value and rate at a time [s]."""
        index = int(time / self.timestep)
        if index >= len(self._cubic):
            return float(self.values[-1]), 0.0
        a, b, c, d = self._cubic[index]
        t = time - index * self.timestep
        return ((a * t + b) * t + c) * t + d, (3.0 * a * t + 2.0 * b) * t + c
