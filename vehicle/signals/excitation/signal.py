"""The displacement of the plates over time: what every source of excitation delivers and every simulation reads."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from vehicle.errors import DataError
from vehicle.names import CORNERS, in_order, is_wheel

STEP_TOLERANCE = 1e-6
"""Largest deviation of one time step from the mean step, as a share of it: rounding, since readers rebuild the grid."""

MINIMUM_SAMPLES = 32
"""Fewer samples than this are no signal: the filter of the plausibility check needs its padding on both sides."""

MARGIN = 64
"""Samples on each side of the times for which a spline is made: what a sample does to it shrinks by 2 - sqrt(3) = 0.27
from each to the next, so to 1e-36 over them."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlateMotion:
    """Motion of plates at chosen times; a wheel without excitation stands on a plate at rest (zeros)."""

    time: NDArray[np.float64]
    """Simulation times [s], shape (m,)."""
    displacement: Mapping[str, NDArray[np.float64]]
    """Upward displacement of each plate [m], wheel -> shape (m,)."""
    velocity: Mapping[str, NDArray[np.float64]]
    """First time derivative of the displacement [m/s], wheel -> shape (m,)."""
    acceleration: Mapping[str, NDArray[np.float64]]
    """Second time derivative of the displacement [m/s2], wheel -> shape (m,)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signal:
    """Upward plate displacements z(t) on a uniform time grid that begins at t = 0.

    Args:
        time: sample times [s], shape (n,), first value 0, uniform.
        displacement: wheel, as 'fr' -> plate displacement [m], shape (n,), positive upwards.
        notices: one sentence for everything that was done to the data or noticed about them.
        source: name of the file or text of the generator.
        sha256: hexadecimal digest of the file, None for a generated signal.
        highest: highest frequency that the signal holds [Hz] where that is below 50 Hz; else None.

    Raises:
        DataError: shapes differ, a value is not finite, the grid is not uniform, a wheel is unknown.
    """

    time: NDArray[np.float64]
    displacement: Mapping[str, NDArray[np.float64]]
    notices: tuple[str, ...] = ()
    source: str = "array"
    sha256: str | None = None
    highest: float | None = None

    def __post_init__(self) -> None:
        time = _read_only(self.time)
        displacement = {wheel: _read_only(values) for wheel, values in self.displacement.items()}
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "displacement", displacement)
        self._check_time()
        if not displacement:
            raise DataError(f"{self.source}: the signal drives no wheel; give a displacement for one of {_wheels()}")
        for wheel, values in displacement.items():
            if not is_wheel(wheel):
                raise DataError(f"{self.source}: unknown wheel {wheel!r}; allowed are {_wheels()}")
            if values.shape != time.shape:
                raise DataError(
                    f"{self.source}: displacement of {wheel} has shape {values.shape}, time has {time.shape}; "
                    "all columns must have the same length"
                )
            if not np.isfinite(values).all():
                bad = int(np.flatnonzero(~np.isfinite(values))[0])
                raise DataError(
                    f"{self.source}: displacement of {wheel} is {values[bad]} at sample {bad}; allowed: finite"
                )

    def _check_time(self) -> None:
        time = self.time
        if time.ndim != 1 or time.size < MINIMUM_SAMPLES:
            raise DataError(
                f"{self.source}: time has shape {time.shape}; needed is one axis with at least {MINIMUM_SAMPLES} "
                "samples"
            )
        if not np.isfinite(time).all() or time[0] != 0.0 or time[-1] <= 0.0:
            raise DataError(f"{self.source}: time must be finite, begin at 0 s and increase; it begins at {time[0]} s")
        deviation = float(np.max(np.abs(np.diff(time) / self.timestep - 1.0)))
        if deviation > STEP_TOLERANCE:
            raise DataError(
                f"{self.source}: a time step deviates by {deviation:.3g} of the mean step {self.timestep:.6g} s; "
                f"allowed {STEP_TOLERANCE:g}; resample the signal to a uniform grid first"
            )

    @property
    def wheels(self) -> tuple[str, ...]:
        """Wheels whose plates move, in the order of files."""
        return in_order(self.displacement)

    @property
    def timestep(self) -> float:
        """Distance of two samples [s]."""
        return float(self.time[-1]) / (self.time.size - 1)

    @property
    def duration(self) -> float:
        """Time from the first to the last sample [s]."""
        return float(self.time[-1])

    @property
    def name(self) -> str:
        """Name as the input of a case."""
        return self.source

    def signal(self) -> Signal:
        """The signal itself, as the input of a case."""
        return self

    def identity(self) -> dict[str, object]:
        """Digest of all that tells it from other signals."""
        content = hashlib.sha256(self.time.tobytes())
        for wheel, values in self.displacement.items():
            content.update(wheel.encode() + values.tobytes())
        return {"sha256": content.hexdigest()}

    def band(self, band: tuple[float, float]) -> tuple[float, float]:
        """Return the part of a band [Hz] that the signal holds."""
        return band if self.highest is None else (band[0], min(band[1], self.highest))

    def rms(self, wheel: str) -> float:
        """Root mean square of the displacement about its mean [m]; 0 for a plate at rest."""
        if wheel not in self.displacement:
            return 0.0
        return float(np.std(self.displacement[wheel]))

    def spline(self, wheel: str, first: float, last: float) -> scipy.interpolate.CubicSpline:
        """That of `plate_motion` for the times from first to last [s], through the samples around them."""
        begin, end = (int(time / self.timestep) for time in (first, last))
        near = slice(max(begin - MARGIN, 0), end + 2 + MARGIN)
        return scipy.interpolate.CubicSpline(self.time[near], self.displacement[wheel][near], bc_type="not-a-knot")

    def plate_motion(self, times: ArrayLike, wheels: Iterable[str] | None = None) -> PlateMotion:
        """Displacement, velocity and acceleration of the plates at arbitrary times within the record.

        A cubic spline through the samples: z is twice continuously differentiable, and velocity and acceleration are
        its exact derivatives, so that the three agree at every step of the simulation. Both ends are not-a-knot (the
        first two and the last two pieces are one cubic). A natural end would force zero acceleration and a clamped
        one a given velocity on data that have neither; not-a-knot claims nothing and keeps the fourth order up to the
        ends. At 1 kHz a sine of 50 Hz keeps its velocity within 0.03 % and its acceleration within 1 %.

        Args:
            times: simulation times [s], shape (m,), within 0 and `duration`.
            wheels: whose plates; by default those that the signal drives.

        Returns:
            The motion of the plates; zeros for a wheel that the signal does not drive.

        Raises:
            DataError: a time lies outside the record (no extrapolation of a spline).

        Source: de Boor, A Practical Guide to Splines, chapter IV.
        """
        at = np.atleast_1d(np.asarray(times, dtype=np.float64))
        rounding = STEP_TOLERANCE * self.timestep  # a sum of many steps ends a few ulp beyond the record
        inside = (at >= -rounding) & (at <= self.duration + rounding)
        if not inside.all():
            raise DataError(
                f"{self.source}: plate motion asked for t = {at[~inside][0]:.9g} s; the record covers 0 to "
                f"{self.duration:.9g} s; shorten the simulation or give a longer signal"
            )
        at = np.clip(at, 0.0, self.duration)
        motion: list[dict[str, NDArray[np.float64]]] = [{}, {}, {}]
        for wheel in self.wheels if wheels is None else wheels:
            driven = wheel in self.displacement and at.size
            spline = self.spline(wheel, float(at.min()), float(at.max())) if driven else None
            for order, values in enumerate(motion):
                values[wheel] = np.zeros_like(at) if spline is None else spline(at, order)
        return PlateMotion(time=at, displacement=motion[0], velocity=motion[1], acceleration=motion[2])


@lru_cache(maxsize=2)
def uniform_time(*, samples: int, timestep: float) -> NDArray[np.float64]:
    """Sample times i * timestep, i = 0 ... samples - 1 [s]; one product each, so that rounding does not add up.

    A signal and the run on it share them, so they cannot be written to.
    """
    time: NDArray[np.float64] = np.arange(samples, dtype=np.float64)
    time *= timestep
    time.setflags(write=False)
    return time


def _read_only(values: ArrayLike) -> NDArray[np.float64]:
    array = np.asarray(values, dtype=np.float64)
    if array.flags.writeable or not array.flags.owndata:
        array = np.array(array)
        array.setflags(write=False)
    return array


def _wheels() -> str:
    return ", ".join(CORNERS.values())
