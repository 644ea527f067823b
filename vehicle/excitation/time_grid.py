"""The samples of a plate signal: often enough; filled in or resampled on request."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.excitation.signal import MINIMUM_SAMPLES
from vehicle.records.clock import UNIFORM_TOLERANCE
from vehicle.records.table import Table, Vector

LOWEST_RATE = 125.0
"""Lowest sampling rate [Hz]: 2.5 samples for each period of 50 Hz, the upper end of the range of interest."""

FULL_RATE = 250.0
"""From this sampling rate on the whole range up to 100 Hz of the weighting filters is covered [Hz]."""

SAMPLES_PER_PERIOD = 2.5
"""Samples needed for each period of the highest frequency that is used [-]."""

LONGEST_GAP = 0.010
"""Longest gap [s] that is interpolated over: half a period of 50 Hz."""

LARGEST_GRID = 20_000_000
"""Most samples that resampling may make."""


def check_rate(path: Path, rate: float) -> tuple[str, ...]:
    """Refuse a sampling rate [Hz] below `LOWEST_RATE`; below `FULL_RATE` return a notice with the usable band."""
    if rate < LOWEST_RATE * (1.0 - 1e-9):  # a rate computed from rounded times
        hint = "; the time looks like ms" if LOWEST_RATE <= rate * 1000.0 <= 1e4 else ""
        raise DataError(
            f"{path}: sampling rate {rate:.6g} Hz; allowed from {LOWEST_RATE:g} Hz ({SAMPLES_PER_PERIOD:g} samples "
            "per period of "
            f"50 Hz){hint}; measure or export with a higher rate"
        )
    if rate < FULL_RATE * (1.0 - 1e-9):
        return (
            f"sampling rate {rate:.6g} Hz: usable up to {rate / SAMPLES_PER_PERIOD:.4g} Hz, from {FULL_RATE:g} Hz "
            "on up to 100 Hz",
        )
    return ()


def fill_missing(table: Table, time: Vector, column: int) -> tuple[Vector, list[str]]:
    """Interpolate missing displacements by a cubic spline through the values on both sides.

    Args:
        table: NaN where a value is missing.
        time: increasing times [s], shape (n,).
        column: index of the column.

    Returns:
        The column, shape (n,), and a notice with the count (none: nothing was missing).

    Raises:
        DataError: a gap too long, or at the beginning or end.
    """
    values, name = table.values[:, column], f"column {table.header.cells[column]!r}"
    valid = np.isfinite(values)
    if valid.all():
        return values, []
    first = int(np.flatnonzero(~valid)[0])
    if not (valid[0] and valid[-1]) or np.count_nonzero(valid) < MINIMUM_SAMPLES:
        raise DataError(
            f"{table.place(first)}:{column + 1}: {name} has missing values at its beginning or end, or hardly any "
            "others; interpolation needs values on both sides; remove those rows"
        )
    gaps = np.diff(time[valid])
    limit = longest_gap(float(np.median(np.diff(time))))
    worst = int(np.argmax(gaps))
    if gaps[worst] > limit * (1.0 + UNIFORM_TOLERANCE):
        begin = int(np.flatnonzero(valid)[worst]) + 1
        raise DataError(
            f"{table.place(begin)}:{column + 1}: {name} has no value for {gaps[worst]:.6g} s from this line on; "
            f"interpolation bridges at most {limit:.6g} s; use the part before or after it"
        )
    filled = values.copy()
    filled[~valid] = scipy.interpolate.CubicSpline(time[valid], values[valid])(time[~valid])
    count = int(np.count_nonzero(~valid))
    return filled, [f"{count} missing values of {name} interpolated by a cubic spline, the first in {table.row(first)}"]


def refine(table: Table, time: Vector, columns: Mapping[str, Vector], rate: float) -> tuple[int, dict[str, Vector]]:
    """Interpolate onto a uniform grid of `factor * rate`, the lowest multiple that is not below the recorded rate.

    Cubic spline (not-a-knot) through the recorded samples; the first half of resampling, `decimate` is the second.

    Args:
        table: for messages.
        time: increasing times [s], shape (n,).
        columns: wheel -> displacement [m], shape (n,).
        rate: wanted sampling rate [Hz].

    Returns:
        The factor and the columns on the fine grid, shape (m,).

    Raises:
        DataError: a gap too long to be interpolated, a rate out of range.
    """
    recorded = 1.0 / float(np.median(np.diff(time)))
    gap = int(np.argmax(np.diff(time))) + 1
    length = float(time[gap] - time[gap - 1])
    limit = longest_gap(1.0 / recorded)
    if length > limit * (1.0 + UNIFORM_TOLERANCE):
        raise DataError(
            f"{table.place(gap)}: gap of {length:.6g} s; resampling bridges at most {limit:.6g} s; use the part before "
            "or after it"
        )
    factor = max(1, int(np.ceil(recorded / rate * (1.0 - 1e-6))))
    samples = int(np.floor((time[-1] - time[0]) * rate * factor * (1.0 + 1e-12))) + 1
    if samples > LARGEST_GRID:
        raise DataError(
            f"{table.header.path}: resampling to {rate:g} Hz makes {samples} samples; allowed {LARGEST_GRID}; choose a "
            "lower rate"
        )
    fine = np.minimum(time[0] + np.arange(samples) / (rate * factor), time[-1])
    return factor, {wheel: scipy.interpolate.CubicSpline(time, values)(fine) for wheel, values in columns.items()}


def decimate(values: Vector, factor: int) -> Vector:
    """Keep each `factor`-th sample after an anti-alias filter: shape (m,) -> (ceil(m / factor),).

    Linear-phase FIR (Kaiser, 80 dB): flat up to 0.8 of the new Nyquist frequency, closed from it on; no delay. Beyond
    both ends the record is continued along the straight line between its ends.
    """
    if factor == 1:
        return values
    # Kaiser's formula: 80 dB over a transition of 0.2 / factor need (80 - 7.95) / (2.285 pi 0.2) = 50.2 factor taps.
    taps = scipy.signal.firwin(52 * factor + 1, 0.9 / factor, window=("kaiser", 7.857))
    kept: Vector = scipy.signal.resample_poly(values, 1, factor, window=taps, padtype="line")
    return kept


def longest_gap(timestep: float) -> float:
    """Longest distance of two valid samples that is interpolated over [s]: `LONGEST_GAP`, or one missing sample."""
    return max(LONGEST_GAP, 2.0 * timestep)
