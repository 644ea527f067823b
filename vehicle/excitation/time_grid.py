"""The time stamps of a record: increasing, uniform, often enough; or resampled on request."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar
from scipy.signal import firwin, resample_poly

from vehicle.errors import DataError

PAUSE = 0.5
"""A step of the time, or a stretch without motion, from this length on is a pause of the record [s]."""

UNIFORM_TOLERANCE = 1e-3
"""Largest |dt - median dt| / median dt of a uniform record [-]."""

LOWEST_RATE = 125.0
"""Lowest sampling rate [Hz]: 2.5 samples for each period of 50 Hz, the upper end of the range of interest."""

FULL_RATE = 250.0
"""From this sampling rate on the whole range up to 100 Hz of the weighting filters is covered [Hz]."""

SAMPLES_PER_PERIOD = 2.5
"""Samples needed for each period of the highest frequency that is used [-]."""

LARGEST_QUANTUM = 0.25
"""Largest last digit of rounded time stamps that still tells a clock, as a share of its step [-]."""

LONGEST_GAP = 0.010
"""Longest gap [s] that is interpolated over: half a period of 50 Hz."""

LARGEST_GRID = 20_000_000
"""Most samples that resampling may make."""


def check_increasing(path: Path, time: NDArray[np.float64], line_numbers: NDArray[np.int64]) -> None:
    """Refuse repeated or decreasing time [s], shape (n,), naming the first offending line."""
    steps = np.diff(time)
    if (steps > 0.0).all():
        return
    row = int(np.flatnonzero(steps <= 0.0)[0]) + 1
    what = "repeats" if steps[row - 1] == 0.0 else "goes back behind"
    raise DataError(
        f"{path}:{line_numbers[row]}: time {time[row]:.9g} s {what} the time {time[row - 1]:.9g} s of line "
        f"{line_numbers[row - 1]}; "
        "time must increase from row to row; were two logs put behind each other?"
    )


def check_uniform(path: Path, time: NDArray[np.float64], line_numbers: NDArray[np.int64]) -> None:
    """Refuse steps that deviate from the median step by more than `UNIFORM_TOLERANCE`, naming the worst line."""
    worst, row = _worst_step(time)
    if worst > UNIFORM_TOLERANCE:
        step = time[row] - time[row - 1]
        if step >= PAUSE:
            raise DataError(
                f"{path}:{line_numbers[row]}: the record pauses for {step:.6g} s, from {time[row - 1]:.9g} to "
                f"{time[row]:.9g} s; nothing is filled in; use the part before or after it"
            )
        raise DataError(
            f"{path}:{line_numbers[row]}: time is not uniform: the step of {time[row] - time[row - 1]:.9g} s "
            f"deviates by {worst:.3g} of "
            f"the median step {float(np.median(np.diff(time))):.9g} s; allowed {UNIFORM_TOLERANCE:g}; write the "
            "time with more digits, "
            "or resample it (--resample HZ)"
        )


def clock_of_rounded(time: NDArray[np.float64]) -> tuple[float, int] | None:
    """The clock behind time stamps that were rounded, or cut, to a fixed number of decimals.

    t_k = t_0 + k / f + e_k with e_k within one unit q of the last decimal, for all k: 2048 Hz written with six decimals
    has steps of 488 and 489 us. A whole number f that fits is taken, else the clock with the least spread.

    Args:
        time: increasing times [s], shape (n,).

    Returns:
        Rate f [Hz] and number of decimals; None where no clock fits, or q is more than `LARGEST_QUANTUM` steps.
    """
    count = np.arange(time.size)
    step = float(time[-1] - time[0]) / (time.size - 1)
    for decimals in range(2, 10):
        digits = (time - time[0]) * 10.0**decimals
        if np.max(np.abs(digits - np.rint(digits))) < 0.01:  # what binary numbers leave of decimal ones
            break
    else:
        return None
    quantum = 10.0**-decimals
    if quantum > LARGEST_QUANTUM * step:
        return None
    # The spread about a clock is convex in its step; the step that is sought lies within q / T of the mean one.
    reach = quantum / (time.size - 1)
    best = minimize_scalar(
        lambda one: np.ptp(time - count * one), bounds=(step - reach, step + reach), options={"xatol": 1e-6 * reach}
    )
    for rate in (float(round(1.0 / step)), 1.0 / float(best.x)):
        if rate > 0.0 and np.ptp(time - count / rate) <= (1.0 + 1e-3) * quantum:
            return rate, decimals
    return None


def is_uniform(time: NDArray[np.float64]) -> bool:
    """Tell whether `check_uniform` accepts the time stamps."""
    return _worst_step(time)[0] <= UNIFORM_TOLERANCE


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


def refine(
    path: Path,
    time: NDArray[np.float64],
    columns: Mapping[str, NDArray[np.float64]],
    line_numbers: NDArray[np.int64],
    rate: float,
) -> tuple[int, dict[str, NDArray[np.float64]]]:
    """Interpolate onto a uniform grid of `factor * rate`, the lowest multiple that is not below the recorded rate.

    Cubic spline (not-a-knot) through the recorded samples; the first half of resampling, `decimate` is the second.

    Args:
        path: file, for messages.
        time: increasing times [s], shape (n,).
        columns: wheel -> displacement [m], shape (n,).
        line_numbers: line of the file of each row, shape (n,).
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
            f"{path}:{line_numbers[gap]}: gap of {length:.6g} s; resampling bridges at most "
            f"{limit:.6g} s; "
            "use the part before or after it"
        )
    factor = max(1, int(np.ceil(recorded / rate * (1.0 - 1e-6))))
    samples = int(np.floor((time[-1] - time[0]) * rate * factor * (1.0 + 1e-12))) + 1
    if samples > LARGEST_GRID:
        raise DataError(
            f"{path}: resampling to {rate:g} Hz makes {samples} samples; allowed {LARGEST_GRID}; choose a lower rate"
        )
    fine = np.minimum(time[0] + np.arange(samples) / (rate * factor), time[-1])
    return factor, {wheel: CubicSpline(time, values)(fine) for wheel, values in columns.items()}


def decimate(values: NDArray[np.float64], factor: int) -> NDArray[np.float64]:
    """Keep each `factor`-th sample after an anti-alias filter: shape (m,) -> (ceil(m / factor),).

    Linear-phase FIR (Kaiser, 80 dB): flat up to 0.8 of the new Nyquist frequency, closed from it on; no delay. Beyond
    both ends the record is continued along the straight line between its ends.
    """
    if factor == 1:
        return values
    # Kaiser's formula: 80 dB over a transition of 0.2 / factor need (80 - 7.95) / (2.285 pi 0.2) = 50.2 factor taps.
    taps = firwin(52 * factor + 1, 0.9 / factor, window=("kaiser", 7.857))
    kept: NDArray[np.float64] = resample_poly(values, 1, factor, window=taps, padtype="line")
    return kept


def longest_gap(timestep: float) -> float:
    """Longest distance of two valid samples that is interpolated over [s]: `LONGEST_GAP`, or one missing sample."""
    return max(LONGEST_GAP, 2.0 * timestep)


def _worst_step(time: NDArray[np.float64]) -> tuple[float, int]:
    steps = np.diff(time)
    median = float(np.median(steps))
    deviation = np.abs(steps - median) / median
    row = int(np.argmax(deviation))
    return float(deviation[row]), row + 1
