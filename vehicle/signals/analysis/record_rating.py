"""Rating of long records after ISO/TS 18571 in windows.

The standard rates single events: curves of a few periods, shifted by a fifth and warped by a tenth of their length. In
a record of minutes these would be seconds, and any two records of equal level would agree. So a record is cut into
windows of one period of the lowest compared frequency, and each window is rated as a curve.
"""

from dataclasses import dataclass

import numpy as np

from vehicle.signals.analysis.curve_rating import Ratings, rate_curves
from vehicle.signals.analysis.samples import Vector

WINDOW = 1.0
"""Length of a window [s]: one period of 1 Hz, the lowest frequency of comparisons."""
LEAST, MOST = 100, 4000
"""Minimum and maximum length of a window [samples]; the running mean of the slope is shorter than a tenth of it."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RecordRating(Ratings):
    """Mean ratings over the windows of a record, weighted by the RMS of both records in the window.

    Attributes:
        window: length of the windows [s].
        windows: number of windows.
    """

    window: float
    windows: int


def rate_record(measured: Vector, simulated: Vector, step: float) -> RecordRating:
    """Rate a simulated record against a measured record in windows of equal length.

    About n step / `WINDOW` windows start at the first sample; the remaining samples at the end, fewer than the number
    of windows, are ignored. A window without motion in both records has no weight.

    Args:
        measured: measured record T, (n,), uniformly sampled.
        simulated: simulated record C, (n,), at the times of T.
        step: sampling interval [s].
    """
    target = int(np.clip(round(WINDOW / step), LEAST, MOST))
    windows = max(1, round(measured.size / target))
    length = measured.size // windows
    # (windows, samples)
    truth, curve = (values[: windows * length].reshape(windows, length) for values in (measured, simulated))
    ratings = rate_curves(truth, curve, step)
    level = np.sqrt(np.mean(truth**2 + curve**2, axis=1))
    weight = level if level.any() else np.ones(windows)

    def mean(name: str) -> float:
        """Return the weighted mean of a rating over the windows."""
        return float(np.average([getattr(rating, name) for rating in ratings], weights=weight))

    return RecordRating(
        corridor=mean("corridor"),
        phase=mean("phase"),
        magnitude=mean("magnitude"),
        slope=mean("slope"),
        window=length * step,
        windows=windows,
    )
