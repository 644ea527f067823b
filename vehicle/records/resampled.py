"""A record at other times."""

from __future__ import annotations

import numpy as np
import scipy

from vehicle.records.table import Vector

KEPT = 0.4
"""Corner of the low-pass before a record is brought to a lower rate, as a share of that rate."""


def at_times(time: Vector, values: Vector, grid: Vector, step: float) -> Vector:
    """A record at other times within its own, low-passed without phase shift where they are fewer.

    Args:
        time: uniform times of the samples [s], (n,).
        values: (n,).
        grid: uniform times [s], (m,).
        step: of the grid [s].

    Returns:
        (m,); the samples themselves where both have the same times.
    """
    own = float(time[-1] - time[0]) / (time.size - 1)
    first = (grid[0] - time[0]) / own
    if abs(own / step - 1.0) < 1e-9 and abs(first - round(first)) < 1e-6:
        return values[round(first) : round(first) + grid.size]
    if step > 1.05 * own:
        sections = scipy.signal.butter(8, 2.0 * own * KEPT / step, output="sos")
        values = scipy.signal.sosfiltfilt(sections, values)
    return np.asarray(scipy.interpolate.CubicSpline(time, values)(grid))
