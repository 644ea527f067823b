"""Rating of long records after ISO/TS 18571, window by window.

The standard rates single events: curves of a few periods, shifted by a fifth and warped by a tenth of their length. Of
a record of minutes these would be seconds, and any two records of one level would agree. So a record is cut into
windows of one period of the lowest frequency of a comparison, and each of them is rated as a curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.curve_rating import Ratings, rate_curves

Vector = npt.NDArray[np.float64]

WINDOW = 1.0
"""Length of a window [s]: a period of 1 Hz, the lowest frequency of comparisons and of the comfort of a body."""
LEAST, MOST = 100, 4000
"""Samples of a window at least, so that the running mean of the slope stays below a tenth of it, and at most."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RecordRating(Ratings):
    """Ratings of the windows of a record, means weighted by the RMS of both records in the window.

    Attributes:
        window: length of the windows [s].
        windows: their number.
    """

    window: float
    windows: int


def rate_record(measured: Vector, simulated: Vector, step: float) -> RecordRating:
    """Rate a record in windows of equal length.

    round(n step / `WINDOW`) windows of equal length from the first sample on; fewer samples than windows are left at
    the end. A window in which neither record moves has no weight, one in which a record moves that should not has.

    Args:
        measured: T, (n,), of a uniform rate.
        simulated: C, (n,), at the same times.
        step: sampling interval [s].
    """
    wanted = int(np.clip(round(WINDOW / step), LEAST, MOST))
    windows = max(1, round(measured.size / wanted))
    length = measured.size // windows
    truth, curve = (values[: windows * length].reshape(windows, length) for values in (measured, simulated))
    ratings = rate_curves(truth, curve, step)
    level = np.sqrt(np.mean(truth**2 + curve**2, axis=1))
    weight = level if level.any() else np.ones(windows)

    def mean(name: str) -> float:
        return float(np.average([getattr(rating, name) for rating in ratings], weights=weight))

    return RecordRating(
        corridor=mean("corridor"),
        phase=mean("phase"),
        magnitude=mean("magnitude"),
        slope=mean("slope"),
        window=length * step,
        windows=windows,
    )
