"""Check the sampling rate of plate signals, and fill missing samples on request."""

from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.excitation.signal import MINIMUM_SAMPLES
from vehicle.signals.formats.clock import UNIFORM_TOLERANCE, longest_gap
from vehicle.signals.formats.table import USABLE, Table

LOWEST_RATE = 10.0
"""Minimum sampling rate [Hz]: usable up to 4 Hz, bounce and pitch of a body."""

SMOOTH_RATE, FINE_RATE = 125.0, 1000.0
"""A plate sampled below the first rate [Hz] is resampled to the second: the cubic spline between its samples would add
images of its upper band, 16 % of a sine at 0.4 of the rate."""

FULL_RATE = 250.0
"""Minimum sampling rate for the whole range of the weighting filters, up to 100 Hz [Hz]."""


def check_rate(path: Path, rate: float) -> tuple[str, ...]:
    """Reject a sampling rate [Hz] below `LOWEST_RATE`; return a notice on the usable band below `FULL_RATE`."""
    if rate < LOWEST_RATE * (1.0 - 1e-9):  # tolerance for a rate from rounded times
        hint = "; are the times in ms?" if FULL_RATE <= rate * 1000.0 <= 5e3 else ""
        raise DataError(
            f"{path}: sampling rate {rate:.4g} Hz, must be at least {LOWEST_RATE:g} Hz (usable up to "
            f"{USABLE * LOWEST_RATE:g} Hz){hint}; measure or export with a higher rate"
        )
    if rate >= FULL_RATE * (1.0 - UNIFORM_TOLERANCE):
        return ()
    ends = "; FRFs and comfort end there" if rate < SMOOTH_RATE * (1.0 - UNIFORM_TOLERANCE) else ""
    return (
        f"sampling rate {rate:.4g} Hz: results are valid up to {USABLE * rate:.3g} Hz (100 Hz from {FULL_RATE:g} Hz "
        f"on){ends}",
    )


def fill_missing(table: Table, time: Vector, column: int) -> tuple[Vector, list[str]]:
    """Interpolate missing displacements by a cubic spline through the values on both sides.

    Returns:
        Column, shape (n,), and a notice with the number of interpolated values, if any.
    """
    values, name = table.values[:, column], f"column {table.header.cells[column]!r}"
    valid = np.isfinite(values)
    if valid.all():
        return values, []
    first = int(np.flatnonzero(~valid)[0])
    if not (valid[0] and valid[-1]) or np.count_nonzero(valid) < MINIMUM_SAMPLES:
        raise DataError(
            f"{table.place(first)}:{column + 1}: {name} has too few values, or none at its beginning or end; "
            "interpolation needs values on both sides; remove these rows"
        )
    gaps = np.diff(time[valid])
    limit = longest_gap(float(np.median(np.diff(time))))
    largest = int(np.argmax(gaps))
    if gaps[largest] > limit * (1.0 + UNIFORM_TOLERANCE):
        begin = int(np.flatnonzero(valid)[largest]) + 1
        raise DataError(
            f"{table.place(begin)}:{column + 1}: {name} has no value for {gaps[largest]:.3g} s from this line on, but "
            f"interpolation fills at most {limit:.3g} s; use the part before or after it"
        )
    filled = values.copy()
    filled[~valid] = scipy.interpolate.CubicSpline(time[valid], values[valid])(time[~valid])
    count = int(np.count_nonzero(~valid))
    return filled, [f"{count} missing values of {name} interpolated by a cubic spline, the first in {table.row(first)}"]
