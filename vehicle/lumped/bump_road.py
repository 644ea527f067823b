"""A half-sine bump met first by the front and later by the rear wheel."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.parameters.half_car_rider import BumpShape


@dataclass(frozen=True, kw_only=True, slots=True)
class BumpPassage:
    """z_i = h0 sin(omega (t - t_i)) while wheel i is on the bump, else 0."""

    height: float
    """h0 [m]."""
    omega: float
    """Angular frequency pi v / wb [rad/s]."""
    arrivals: tuple[float, ...]
    """Time t_i at which each wheel reaches the bump [s]."""

    @property
    def contact(self) -> float:
        """Time wb / v that one wheel spends on the bump [s]."""
        return math.pi / self.omega

    def heights(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Road height under each wheel [m], shape (wheels, *time.shape)."""
        return np.stack([self.height * np.sin(self.omega * since) * on for since, on in self._phases(time)])

    def rates(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Rate of the road height under each wheel [m/s], shape (wheels, *time.shape)."""
        return np.stack(
            [self.height * self.omega * np.cos(self.omega * since) * on for since, on in self._phases(time)]
        )

    def _phases(self, time: npt.ArrayLike) -> list[tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_]]]:
        instants = np.asarray(time, dtype=float)
        since = [instants - arrival for arrival in self.arrivals]
        return [(phase, (phase >= 0.0) & (phase < self.contact)) for phase in since]


def bump_passage(shape: BumpShape, speed: float, wheelbase: float, start: float = 0.0) -> BumpPassage:
    """Passage of a two-axled car over a bump at constant speed; the rear wheel follows (a1 + a2) / v later.

    Args:
        shape: height and length of the bump.
        speed: v [m/s].
        wheelbase: a1 + a2 [m].
        start: time t0 at which the front wheel reaches the bump [s].

    Returns:
        The passage, front wheel first.

    Raises:
        ConfigurationError: speed or wheelbase is not a positive finite number, or start is negative.

    Source: "Parametric study of rider's comfort ...", equation 20.
    """
    for name, value, unit in (("speed", speed, "m/s"), ("wheelbase", wheelbase, "m")):
        if not (math.isfinite(value) and value > 0.0):
            raise ConfigurationError(f"bump passage: {name}: found {value!r} {unit}, must be greater than 0.0")
    if not (math.isfinite(start) and start >= 0.0):
        raise ConfigurationError(f"bump passage: start: found {start!r} s, must be at least 0.0")
    omega = math.pi * speed / shape.length
    return BumpPassage(height=shape.height, omega=omega, arrivals=(start, start + wheelbase / speed))
