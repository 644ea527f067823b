"""Resample records: make jittered times uniform, change the rate without aliasing."""

from collections.abc import Callable, Mapping

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.signals.formats.clock import UNIFORM_TOLERANCE, longest_gap

KEPT = 0.4
"""Corner frequency of the low-pass before downsampling, over the lower rate [-]."""

DEGREE = 7
"""Degree of the spline through the samples. It retains sinc^8(f T) / sum over k of sinc^8(f T - k) of the amplitude of
a sine of frequency f at the sampling interval T: 99.98 % at 0.25 / T, 99.9 % at 0.3 / T and 96 % at 0.4 / T. A cubic
spline retains 98.8, 95.7 and 83 %."""

LARGEST_GRID = 20_000_000
"""Maximum number of samples after resampling."""


def resampled(
    time: Vector,
    columns: Mapping[str, Vector],
    rate: float,
    sample_name: Callable[[int], str],
    uniform: bool,
    span: tuple[float, float] | None = None,
) -> tuple[dict[str, Vector], str]:
    """Resample columns to uniform times `t_0 + k / rate`: first spline interpolation, then anti-alias filter.

    The samples x_j have the true times t_j = j T + e_j, with jitter e_j. A spline of degree `DEGREE` through
    (t_j, x_j) is evaluated at the uniform times t_0 + k / (m rate), m the smallest integer with m rate >= 1 / T. These
    samples are uniform, as required by a linear-phase filter. For a lower rate, `decimate` removes frequencies above
    half the new rate and returns every m-th sample. For a higher rate, the same filter at the original rate removes
    the images above half the original rate.

    Args:
        time: increasing times [s], shape (n,).
        columns: name -> samples, shape (n,).
        rate: new sampling rate [Hz].
        sample_name: function from the index of a sample to its name, for messages.
        uniform: True if the times are uniform within `UNIFORM_TOLERANCE`, for the notice.
        span: first new time t_0 and last time within `time` [s]; all of it by default.

    Returns:
        Columns at the new times, shape (m,), and a notice with the deviation of the original times.

    Raises:
        DataError: a gap longer than `longest_gap`, or more samples than `LARGEST_GRID`.
    """
    if time.size <= DEGREE:
        raise DataError(
            f"{sample_name(0)}: has {time.size} samples, but --resample needs at least {DEGREE + 1}; use a longer "
            "record"
        )
    steps = np.diff(time)
    median = float(np.median(steps))
    limit = longest_gap(median)
    gap = int(np.argmax(steps))
    if steps[gap] > limit * (1.0 + UNIFORM_TOLERANCE):
        raise DataError(
            f"{sample_name(gap + 1)}: gap of {steps[gap]:.3g} s, --resample fills at most {limit:.3g} s; use the part "
            f"before it (--to {time[gap]:.9g}) or after it (--from {time[gap + 1]:.9g})"
        )
    factor = max(1, int(np.ceil((1.0 - UNIFORM_TOLERANCE) / (median * rate))))
    first, last = (time[0], time[-1]) if span is None else span
    samples = int(np.floor((last - first) * rate * factor * (1.0 + 1e-12))) + 1
    if samples > LARGEST_GRID:
        raise DataError(
            f"{sample_name(0)}: --resample {rate:g} Hz gives {samples} samples, but at most {LARGEST_GRID} are "
            "allowed; choose a lower rate"
        )
    fine = np.minimum(first + np.arange(samples) / (rate * factor), last)
    result = {}
    for name, values in columns.items():
        even = scipy.interpolate.make_interp_spline(time - time[0], values, k=DEGREE)(fine - time[0])
        result[name] = decimate(even, factor) if factor > 1 else _without_images(even, median * rate)
    return result, _notice(steps, median, rate, factor, uniform)


def _without_images(values: Vector, ratio: float) -> Vector:
    """Remove frequencies above half of a lower rate from samples, shape (m,)."""
    if ratio <= 1.0 + UNIFORM_TOLERANCE:
        return values
    taps = _taps(ratio)
    line = values[0] + (values[-1] - values[0]) * np.linspace(0.0, 1.0, values.size)
    filtered = scipy.signal.oaconvolve(values - line, taps)[taps.size // 2 :][: values.size]
    return np.asarray(line + filtered)


def _taps(ratio: float) -> Vector:
    """Return the taps of a low-pass of odd length, flat to 0.8 of the Nyquist frequency of a `ratio` times lower rate.

    Kaiser's formula: 80 dB over a transition of 0.2 / ratio need (80 - 7.95) / (2.285 pi 0.2) = 50.2 ratio taps.
    """
    taps: Vector = scipy.signal.firwin(2 * round(26 * ratio) + 1, 0.9 / ratio, window=("kaiser", 7.857))
    return taps


def _notice(steps: Vector, median: float, rate: float, factor: int, uniform: bool) -> str:
    """Describe the resampling of a record: original times, gaps, filter, accuracy."""
    clock, longest = "uniform times", median
    if not uniform:
        longest = float(steps.max())  # the widest step limits the frequencies of the spline
        missing = int(np.count_nonzero(steps > 1.5 * median))
        jitter = np.abs(steps[steps <= 1.5 * median] / median - 1.0)
        clock = f"irregular times (steps deviate from the median by up to {number(100.0 * float(jitter.max()), 2)} %)"
        if missing:
            plural = "s" if missing > 1 else ""
            clock = f"{clock} with {missing} gap{plural} of up to {1e3 * float(steps.max()):.3g} ms"
    filtering = f" and an anti-alias filter from {KEPT * rate:g} Hz on" if factor > 1 else ""
    return (
        f"resampled from {clock} at {1.0 / median:.4g} Hz to {rate:g} Hz by a spline of degree {DEGREE}{filtering}; "
        f"amplitudes are right within 0.1 % up to {0.3 / longest:.3g} Hz and 4 % up to {KEPT / longest:.3g} Hz"
    )


def decimate(values: Vector, factor: int) -> Vector:
    """Return every `factor`-th sample after an anti-alias filter: shape (m,) -> (ceil(m / factor),).

    Linear-phase FIR (Kaiser, 80 dB): flat up to 0.8 of the new Nyquist frequency, 80 dB from it on; no delay. Beyond
    both ends the record is extrapolated along the straight line between its ends.

    Args:
        values: uniform samples, shape (m,).
        factor: old rate over new rate, at least 1.
    """
    if factor == 1:
        return values
    decimated: Vector = scipy.signal.resample_poly(values, 1, factor, window=_taps(factor), padtype="line")
    return decimated


def at_times(time: Vector, values: Vector, grid: Vector, step: float) -> Vector:
    """Interpolate a record to a uniform grid within its times; downsampling includes a zero-phase low-pass.

    Args:
        time: uniform times of the samples [s], (n,).
        values: samples, (n,).
        grid: uniform new times [s], (m,).
        step: step of the grid [s].

    Returns:
        Samples at the new times, (m,); unchanged samples if the times coincide.
    """
    interval = float(time[-1] - time[0]) / (time.size - 1)
    first = (grid[0] - time[0]) / interval
    if abs(interval / step - 1.0) < 1e-9 and abs(first - round(first)) < 1e-6:
        return values[round(first) : round(first) + grid.size]
    if step > 1.05 * interval:
        sections = scipy.signal.butter(8, 2.0 * interval * KEPT / step, output="sos")
        values = scipy.signal.sosfiltfilt(sections, values)
    return np.asarray(scipy.interpolate.CubicSpline(time, values)(grid))
