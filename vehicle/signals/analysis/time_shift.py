"""Estimate time shift and clock drift between two records of the same motion, with subsample accuracy.

Model: x(t) = m + g y(t + a + b (t - tm)), x and y the records, a the shift at the middle tm, b the drift, g the gain.

1. Search. Both records are whitened; windows of x with 100 / B seconds (B: their bandwidth) are correlated with all of
   y; the straight line through most of the correlation peaks is the first estimate (Knapp and Carter 1976, IEEE Trans.
   ASSP 24(4); Fischler and Bolles 1981, Comm. ACM 24(6)).
2. Refinement. Gauss-Newton in windows: x - m - g y = g y' d for the remaining shift d, then a line through d by
   iteratively reweighted least squares (Tukey's biweight). Standard errors follow from the scatter about this line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from vehicle.arrays import Mask
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.shift_search import searched_line, spectral_shares

LARGEST_DRIFT = 1e-2
"""Maximum drift in the search [-]. Clocks of loggers stay within 1e-4, wrong rates (1000 for 1024 Hz) are 2.4e-2."""
GOOD = 0.97
"""Minimum correlation at which the initial line is refined without a search [-]."""
REPEATED = 0.98
"""Minimum share of the largest correlation at which another shift is equivalent, for a periodic record [-]."""
LEAST_WINDOWS, MOST_WINDOWS = 4, 60
"""Minimum and maximum number of windows of the refinement."""
PERIODS = 6.0
"""Minimum number of mean periods in a window of the refinement."""
WIDER, HIGHEST = 1.25, 0.4
"""Corner of the low-pass over the highest frequency of the motion [-]; maximum corner with a low-pass [1/sample]."""
LOST = 0.2
"""Minimum correlation of a refinement; below it the estimate is too far from the shift [-]."""
ROUNDS = 8
"""Maximum number of Gauss-Newton steps; four are sufficient from half a period away."""
CONVERGED = 1e-4
"""Change of the shift at both ends below which the refinement ends [samples]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeShift:
    """Time shift of a second record against a first, with drift, standard errors and correlation.

    Attributes:
        shift: delay of the second record at `middle` [s].
        drift: change of the delay per time [-]; 0 if not identifiable.
        shift_error, drift_error: standard errors [s], [-]; infinite if not identifiable.
        middle: middle of the common time on the clock of the first record [s].
        span: length of the common time [s].
        correlation: correlation coefficient without shift and drift [-]; negative if the second record is inverted.
        gain: least-squares factor of the second record to the first [-].
        period: further shift with equal agreement, for periodic records [s]; None otherwise.
    """

    shift: float
    drift: float
    shift_error: float
    drift_error: float
    middle: float
    span: float
    correlation: float
    gain: float
    period: float | None = None

    def at(self, time: float) -> float:
        """Return the delay of the second record at a time of the first [s]."""
        return self.shift + self.drift * (time - self.middle)

    def later(self, seconds: float) -> TimeShift:
        """Return the shift on a clock on which the first sample is later by a time [s]."""
        return replace(self, middle=self.middle + seconds)


def time_shift(
    first: Vector, second: Vector, step: float, start: float = 0.0, guess: TimeShift | None = None
) -> TimeShift | None:
    """Return the time shift and the clock drift between two records.

    Args:
        first: record x, (n,), whose first sample is at time 0.
        second: record y with the same sampling interval, (m,).
        step: sampling interval of both [s].
        start: time of the first sample of y [s].
        guess: initial shift, from another channel of the same records; zero by default.

    Returns:
        Estimated shift; None if a record is constant, or without a common time span.
    """
    if min(first.size, second.size) < 2 * LEAST_WINDOWS or not (np.ptp(first) > 0.0 and np.ptp(second) > 0.0):
        return None
    (clean, begin), (clean_second, second_begin) = _without_noise(first, second)
    curve, offset = _Curve(clean_second), start / step + second_begin - begin
    middle = 0.5 * (clean.size - 1)
    line = (0.0, 0.0) if guess is None else (guess.at((middle + begin) * step) / step, guess.drift)
    best = _refined(clean, curve, offset, line)
    if best is None or abs(best.correlation) < GOOD:
        searched = searched_line(clean, clean_second, offset, LARGEST_DRIFT)
        candidate = None if searched is None else _refined(clean, curve, offset, searched)
        if candidate is not None and (best is None or abs(candidate.correlation) > abs(best.correlation)):
            best = candidate
    if best is None:
        return None
    result = replace(best, period=_period(clean, curve, offset, best))
    return replace(
        result,
        shift=result.shift * step,
        shift_error=result.shift_error * step,
        middle=(result.middle + begin) * step,
        span=result.span * step,
        period=None if result.period is None else result.period * step,
    )


class _Curve:
    """Interpolation of a record by a spline of fifth order."""

    def __init__(self, values: Vector) -> None:
        self.last = values.size - 1
        self._coefficients = scipy.ndimage.spline_filter1d(values, 5, mode="mirror")

    def at(self, position: Vector) -> Vector:
        """Return the values at positions from 0 to `last` [samples]."""
        values = scipy.ndimage.map_coordinates(
            self._coefficients, position[None], order=5, mode="mirror", prefilter=False
        )
        return np.asarray(values)


def _without_noise(first: Vector, second: Vector) -> tuple[tuple[Vector, int], tuple[Vector, int]]:
    """Return both records without frequencies above their motion, each with the index of its first sample.

    Noise in the slope of y would bias the shift towards the start of the refinement. A zero-phase low-pass on both
    records does not change the shift.
    """
    frequency, share, _ = spectral_shares(first, second)
    # Highest frequency at which a quarter of the largest share is signal.
    corner = WIDER * float(frequency[np.flatnonzero(share >= 0.25 * share.max())[-1]])
    # One period at the corner is cut off at both ends, where the filter has started.
    cut = int(np.ceil(1.0 / max(corner, 1e-9)))
    if not 0.0 < corner < HIGHEST or 4 * cut > min(first.size, second.size):
        return (first, 0), (second, 0)
    sections = scipy.signal.butter(4, 2.0 * corner, output="sos")
    clean, clean_second = (scipy.signal.sosfiltfilt(sections, values)[cut:-cut] for values in (first, second))
    return (clean, cut), (clean_second, cut)


def _mapped(count: int, last: int, offset: float, line: TimeShift) -> tuple[slice, Vector]:
    """Return the samples of the first record with a counterpart, and its position in the second record [samples]."""
    index = np.arange(count)
    position = index + (line.shift + line.drift * (index - line.middle)) - offset
    # Positions rise with the index, because drift is below 1.
    low, high = np.searchsorted(position, (-1e-9, last + 1e-9))
    return slice(int(low), int(high)), np.clip(position[low:high], 0.0, last)


def _refined(first: Vector, curve: _Curve, offset: float, line: tuple[float, float]) -> TimeShift | None:
    """Refine a line (shift at the middle of the first record, drift) by Gauss-Newton; units are samples."""
    current = TimeShift(
        shift=line[0], drift=line[1], shift_error=np.inf, drift_error=np.inf, middle=0.5 * (first.size - 1),
        span=0.0, correlation=0.0, gain=0.0,
    )  # fmt: skip
    best: TimeShift | None = None
    for _ in range(ROUNDS):
        inside, position = _mapped(first.size, curve.last, offset, current)
        if position.size < 2 * LEAST_WINDOWS:
            return best
        middle = 0.5 * (inside.start + inside.stop - 1)
        current = replace(current, shift=current.at(middle), middle=middle, span=float(position.size - 1))
        x, y = first[inside], curve.at(position)
        x, y = x - x.mean(), y - y.mean()
        power = float(y @ y), float(x @ x)
        if min(power) <= 0.0:
            return best
        # Least squares of x - g y.
        gain = float(x @ y) / power[0]
        current = replace(current, gain=gain, correlation=float(x @ y) / np.sqrt(power[0] * power[1]))
        change = _change(x, y, np.gradient(y), gain)
        if abs(current.correlation) < LOST and best is not None:
            break
        if best is None or abs(current.correlation) >= abs(best.correlation):
            best = replace(current, shift_error=change[2], drift_error=change[3])
        if abs(change[0]) + 0.5 * position.size * abs(change[1]) < CONVERGED:
            break
        drift = float(np.clip(current.drift + change[1], -LARGEST_DRIFT, LARGEST_DRIFT))
        current = replace(current, shift=current.shift + change[0], drift=drift)
    return best


def _change(x: Vector, y: Vector, slope: Vector, gain: float) -> tuple[float, float, float, float]:
    """Return the change of shift and drift and their standard errors, from a line through the shifts of windows."""
    if gain == 0.0:
        return 0.0, 0.0, np.inf, np.inf
    slope_power = float(slope @ slope)
    # Rice's mean frequency in periods per sample; the bandwidth has about this size.
    rate = np.sqrt(slope_power / float(y @ y)) / (2.0 * np.pi)
    windows = int(np.clip(x.size * rate / PERIODS, LEAST_WINDOWS, MOST_WINDOWS))
    edges = (np.arange(windows) * x.size) // windows
    size = np.diff([*edges, x.size])

    def sums(values: Vector) -> Vector:
        """Return the sums over the windows."""
        return np.asarray(np.add.reduceat(values, edges))

    def inner(a: Vector, b: Vector) -> Vector:
        """Return the inner products over the windows, without means."""
        return sums(a * b) - sums(a) * sums(b) / size

    # x - g y = e y + g y' d in each window, with a gain error e: normal equations of two unknowns, solved by Cramer's
    # rule.
    residual = x - gain * y
    yy, dd, yd = inner(y, y), inner(slope, slope), inner(y, slope)
    determinant = yy * dd - yd**2
    usable = determinant > 1e-12 * max(float(np.max(yy)) * float(np.max(dd)), 1e-300)
    shift = np.zeros(windows)
    shift[usable] = ((yy * inner(slope, residual) - yd * inner(y, residual))[usable] / determinant[usable]) / gain
    # Variance of d: residual power over the power of the slope; the mean keeps a quiet window from an infinite weight.
    residual_power = np.maximum(inner(residual, residual) - shift * gain * inner(slope, residual), 0.0) / size
    weight = np.where(usable, dd / (residual_power + residual_power.mean() + 1e-300), 0.0)
    if not weight.any():
        return 0.0, 0.0, np.inf, np.inf
    return _line(edges + 0.5 * (size - 1) - 0.5 * (x.size - 1), shift, weight / weight.max())


def _line(position: Vector, value: Vector, weight: Vector) -> tuple[float, float, float, float]:
    """Fit a robust straight line; return its value at 0, its slope, and their standard errors."""
    effective_windows = float(weight.sum() ** 2 / (weight @ weight))  # effective number of windows
    if effective_windows < 3.0:  # motion only in one or two windows
        mean = float(np.average(value, weights=weight))
        return mean, 0.0, np.inf, np.inf
    trust, matrix = weight, np.vander(position, 2, increasing=True)
    for _ in range(10):
        normal = (matrix * trust[:, None]).T @ matrix
        solution = np.linalg.solve(normal, matrix.T @ (trust * value))
        deviation = np.sqrt(weight) * np.abs(value - matrix @ solution)
        # Standard deviation of normal noise from the median of its magnitudes.
        scale = 1.4826 * float(np.median(deviation[weight > 0.0]))
        if scale == 0.0:
            break
        # Tukey's biweight: 95 % efficient for normal noise.
        trust = weight * np.maximum(1.0 - (deviation / (4.685 * scale)) ** 2, 0.0) ** 2
        if np.count_nonzero(trust) < LEAST_WINDOWS:
            trust = weight
            break
    used = trust > 0.0
    # Effective number of windows less two unknowns.
    degrees = max(float(trust.sum() ** 2 / (trust @ trust)) - 2.0, 1.0)
    spread = float(trust[used] @ (value - matrix @ solution)[used] ** 2) / float(trust.sum())
    cover = np.linalg.inv(normal) * spread * float(trust.sum()) / degrees
    return float(solution[0]), float(solution[1]), float(np.sqrt(cover[0, 0])), float(np.sqrt(cover[1, 1]))


def _period(first: Vector, curve: _Curve, offset: float, line: TimeShift) -> float | None:
    """Return the smallest further shift with equal agreement of the records [samples]; None without such a shift."""
    inside, position = _mapped(first.size, curve.last, offset, line)
    x, y = first[inside], np.sign(line.correlation) * curve.at(position)
    limit = x.size // 2
    correlation = coefficients(x, y, limit)
    # Agreement at a distance on either side of the shift: first below 90 %, then up again to a further maximum.
    side = np.maximum(correlation[limit:], correlation[limit::-1])
    below = np.flatnonzero(side < 0.9 * side[0])
    if not below.size:
        return None
    high = np.flatnonzero(side[below[0] :] >= REPEATED * side[0])
    if not high.size:
        return None
    begin = int(below[0] + high[0])
    end = begin + int(np.argmax(side[begin:] < 0.9 * side[0])) if (side[begin:] < 0.9 * side[0]).any() else side.size
    return float(begin + np.argmax(side[begin:end]))


def coefficients(first: Vector, second: Vector, limit: int) -> Vector:
    """Return the correlation coefficients of the overlap for delays of the second record of -limit to limit samples.

    Args:
        first, second: records, (n,).
        limit: largest shift [samples], below n.

    Returns:
        Coefficients, (2 limit + 1,); -infinity where an overlap is constant.
    """
    count = first.size
    first, second = first - first.mean(), second - second.mean()
    # Sums over the overlap for every shift k: first[: n - k] with second[k:], or first[-k:] with second[: n + k].
    cross = scipy.signal.correlate(second, first, method="fft")[count - 1 - limit : count + limit]
    shifts = np.arange(-limit, limit + 1)
    length = count - np.abs(shifts)
    late = shifts >= 0

    def sums(values: Vector, from_start: Mask) -> Vector:
        """Return the sums over the overlap for every shift."""
        total = np.concatenate([[0.0], np.cumsum(values)])
        return np.asarray(np.where(from_start, total[length], total[-1] - total[count - length]))

    # cov = sum x y - sum x sum y/n over the overlap, over the root of both variances.
    top, bottom = sums(first, late), sums(second, ~late)
    spread = (sums(first**2, late) - top**2 / length) * (sums(second**2, ~late) - bottom**2 / length)
    correlation = np.full(shifts.size, -np.inf)
    defined = (spread > 0.0) & (length > 1)
    correlation[defined] = (cross - top * bottom / length)[defined] / np.sqrt(spread[defined])
    return correlation
