"""Displacement and velocity of the driven plates at the ends of the steps, computed once per signal."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.recorded_acceleration import continued
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]


LARGEST_TABLE = 64_000_000
"""Maximum size of a cached table [byte]: two minutes of both plates at 8 kHz. Longer tables are computed in slices, so
that memory does not grow with the steps of a long record."""


class LongPlateSamples:
    """Rows of `plate_samples`, computed on access; same arguments."""

    def __init__(self, signal: Signal, step: float, steps: int, beyond: int) -> None:
        self.signal, self.step, self.steps, self.rows = signal, step, steps, steps + 1 + beyond

    def __getitem__(self, part: slice) -> Vector:
        """Return the rows of a slice, (z, z') of each driven plate."""
        index, signal = np.arange(*part.indices(self.rows)), self.signal
        inside, last = index <= self.steps, min(self.step * self.steps, signal.duration)
        at = np.clip(self.step * index[inside], 0.0, signal.duration)
        after = np.asarray(self.step * (index[~inside] - self.steps), dtype=np.float64)
        begin, end = float(at[0]) if at.size else last, last if after.size else float(at[-1])
        columns = []
        for wheel in signal.wheels:
            spline = signal.spline(wheel, begin, end)
            z, velocity, acceleration = (float(spline(last, order)) for order in range(3))
            columns.append(np.append(spline(at), continued(z, velocity, acceleration, after)))
            columns.append(np.append(spline(at, 1), velocity + acceleration * after))
        return np.stack(columns, axis=1)


def plate_samples(signal: Signal, step: float, steps: int, beyond: int) -> Vector | LongPlateSamples:
    """Return (z, z') of each driven plate [m, m/s] from the spline of the signal; (steps + 1 + beyond, 2 per plate).

    Args:
        signal: displacement of the plates.
        step: time step [s].
        steps: number of steps.
        beyond: number of further steps after the end, with the last acceleration.

    Returns:
        The table, or an object that computes its slices if the table would be larger than `LARGEST_TABLE`.
    """
    long = 16 * (steps + 1 + beyond) * len(signal.wheels) > LARGEST_TABLE
    return (LongPlateSamples if long else _table)(signal, step, steps, beyond)


# A sweep runs hundreds of cars over the same few signals.
@lru_cache(maxsize=4)
def _table(signal: Signal, step: float, steps: int, beyond: int) -> Vector:
    """Return all rows as a read-only table."""
    table = LongPlateSamples(signal, step, steps, beyond)[:]
    table.setflags(write=False)
    return table
