"""A record at other times: jittered clocks made uniform, rates lowered without aliasing."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.signals.records.clock import UNIFORM_TOLERANCE, longest_gap
from vehicle.signals.records.table import Vector

KEPT = 0.4
"""Corner of the low-pass before a record is brought to a lower rate, as a share of that rate."""

DEGREE = 7
"""Degree of the spline through the samples. A sine of frequency f keeps sinc^8(f T) / sum over k of sinc^8(f T - k) of
its amplitude at the sampling interval T: 99.98 % at 0.25 / T, 99.9 % at 0.3 / T and 96 % at 0.4 / T. A cubic spline
keeps 98.8, 95.7 and 83 %."""

LARGEST_GRID = 20_000_000
"""Maximum number of samples that resampling may make."""


def resampled(
    time: Vector, columns: Mapping[str, Vector], rate: float, place: Callable[[int], str], uniform: bool
) -> tuple[dict[str, Vector], str]:
    """Bring columns to uniform times `time[0] + k / rate`: first the clock, then the anti-alias filter.

    The samples x_j stand at their true times t_j = j T + e_j, with jitter e_j. A spline of degree `DEGREE` through
    (t_j, x_j) is evaluated at the uniform times t_0 + k / (m rate), m the smallest integer with m rate >= 1 / T. These
    samples are uniform, so that a linear-phase filter may act on them. To a lower rate, `decimate` closes from half the
    new rate on and returns every m-th sample. To a higher rate, the images of the record above half its own rate are
    taken away by the same filter at its own rate.

    Args:
        time: increasing times [s], shape (n,).
        columns: name -> samples, shape (n,).
        rate: wanted sampling rate [Hz].
        place: name of a sample by its index, for messages.
        uniform: True if the times are uniform within `UNIFORM_TOLERANCE`, for the notice.

    Returns:
        The columns at the new times, shape (m,), and a notice with the deviation of the clock.

    Raises:
        DataError: a gap longer than `longest_gap`, or more samples than `LARGEST_GRID`.
    """
    steps = np.diff(time)
    median = float(np.median(steps))
    limit = longest_gap(median)
    gap = int(np.argmax(steps))
    if steps[gap] > limit * (1.0 + UNIFORM_TOLERANCE):
        raise DataError(
            f"{place(gap + 1)}: gap of {steps[gap]:.6g} s behind {time[gap]:.9g} s; --resample bridges at most "
            f"{limit:.6g} s; use the part before it (--to {time[gap]:.9g}) or after it (--from {time[gap + 1]:.9g})"
        )
    factor = max(1, int(np.ceil((1.0 - UNIFORM_TOLERANCE) / (median * rate))))
    samples = int(np.floor((time[-1] - time[0]) * rate * factor * (1.0 + 1e-12))) + 1
    if samples > LARGEST_GRID:
        raise DataError(
            f"{place(0)}: --resample {rate:g} Hz makes {samples} samples; allowed {LARGEST_GRID}; set a lower rate"
        )
    fine = np.minimum(time[0] + np.arange(samples) / (rate * factor), time[-1])
    found = {}
    for name, values in columns.items():
        even = scipy.interpolate.make_interp_spline(time - time[0], values, k=DEGREE)(fine - time[0])
        found[name] = decimate(even, factor) if factor > 1 else _without_images(even, median * rate)
    return found, _notice(steps, median, rate, factor, uniform)


def _without_images(values: Vector, ratio: float) -> Vector:
    """Return samples, shape (m,), without what lies above half a lower rate.

    Args:
        values: uniform samples, shape (m,).
        ratio: their rate over the lower one; unchanged samples where it is 1 within `UNIFORM_TOLERANCE`.
    """
    if ratio <= 1.0 + UNIFORM_TOLERANCE:
        return values
    taps = _taps(ratio)
    line = values[0] + (values[-1] - values[0]) * np.linspace(0.0, 1.0, values.size)
    filtered = scipy.signal.oaconvolve(values - line, taps)[taps.size // 2 :][: values.size]
    return np.asarray(line + filtered)


def _taps(ratio: float) -> Vector:
    """Return a low-pass of odd length: flat to 0.8 of the Nyquist frequency of a rate that is `ratio` times lower.

    Kaiser's formula: 80 dB over a transition of 0.2 / ratio need (80 - 7.95) / (2.285 pi 0.2) = 50.2 ratio taps.
    """
    taps: Vector = scipy.signal.firwin(2 * round(26 * ratio) + 1, 0.9 / ratio, window=("kaiser", 7.857))
    return taps


def _notice(steps: Vector, median: float, rate: float, factor: int, uniform: bool) -> str:
    """Return a sentence on a resampled record: its clock, its gaps, the filter."""
    words = "uniform times"
    if not uniform:
        missing = int(np.count_nonzero(steps > 1.5 * median))
        jitter = np.abs(steps[steps <= 1.5 * median] / median - 1.0)
        words = f"jittered times (steps up to {100.0 * float(jitter.max()):.2g} % off the median)"
        if missing:
            plural = "s" if missing > 1 else ""
            words = f"{words} with {missing} gap{plural} of up to {1e3 * float(steps.max()):.3g} ms"
    how = f" and a linear-phase anti-alias filter from {KEPT * rate:g} Hz on" if factor > 1 else ""
    return (
        f"resampled from {words} at {1.0 / median:.6g} Hz to {rate:g} Hz by a spline of degree {DEGREE} through the "
        f"samples at their own times{how}; amplitudes hold within 0.1 % up to {0.3 / median:.3g} Hz, 4 % up to "
        f"{KEPT / median:.3g} Hz"
    )


def decimate(values: Vector, factor: int) -> Vector:
    """Return each `factor`-th sample after an anti-alias filter: shape (m,) -> (ceil(m / factor),).

    Linear-phase FIR (Kaiser, 80 dB): flat up to 0.8 of the new Nyquist frequency, closed from it on; no delay. Beyond
    both ends the record is continued along the straight line between its ends.

    Args:
        values: uniform samples, shape (m,).
        factor: ratio of the rates, at least 1.
    """
    if factor == 1:
        return values
    kept: Vector = scipy.signal.resample_poly(values, 1, factor, window=_taps(factor), padtype="line")
    return kept


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
