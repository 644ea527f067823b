"""Settling time of a history after a single event."""

import numpy as np

from vehicle.signals.analysis.samples import Vector

SETTLED = 0.1
"""Share of the peak within which an acceleration counts as settled [-]."""


def settling_time(time: Vector, values: Vector, after: float) -> float | None:
    """Return the time after which |values| stays within `SETTLED` of its peak [s]; None if the last quarter exceeds it.

    Args:
        time: times [s], (n,).
        values: history, (n,).
        after: time from which it is counted [s].

    Returns:
        The time, 0 if the values are within the share from `after` on.
    """
    size = np.abs(values)
    outside = np.flatnonzero(size > SETTLED * size.max())
    last = float(time[outside[-1]]) if outside.size else after
    if last > time[-1] - 0.25 * (time[-1] - after):
        return None
    return max(0.0, last - after)
