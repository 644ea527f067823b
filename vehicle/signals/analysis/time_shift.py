"""Time shift and clock drift between two records of one motion, with a fraction of a sample.

Model: x(t) = m + g y(t + a + b (t - tm)), x and y the records, a the shift at the middle tm, b the drift, g the gain.

1. Search. Both records are whitened; windows of x with 100 / B seconds (B: their bandwidth) are correlated with all of
   y; the straight line through most of the correlation peaks is the first estimate (Knapp and Carter 1976, IEEE Trans.
   ASSP 24(4); Fischler and Bolles 1981, Comm. ACM 24(6)).
2. Refinement. Gauss-Newton in windows: x - m - g y = g y' d for the rest d of the shift, then a line through d by
   iteratively reweighted least squares (Tukey's biweight). Standard errors come from the scatter about that line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.signals.analysis.shift_search import searched_line, spectral_shares

Vector = npt.NDArray[np.float64]

LARGEST_DRIFT = 1e-2
"""Largest drift that is searched [-]. Clocks of loggers stay within 1e-4, wrong rates (1000 for 1024 Hz) are 2.4e-2."""
GOOD = 0.97
"""Correlation from which on the line that was given is refined without a search [-]."""
REPEATED = 0.98
"""Share of the largest correlation from which on another shift is as good: the record repeats itself [-]."""
LEAST_WINDOWS, MOST_WINDOWS = 4, 60
"""Of the refinement."""
PERIODS = 6.0
"""Mean periods of a window of the refinement, at least."""
WIDER, HIGHEST = 1.25, 0.4
"""Corner of the low-pass over the highest frequency of the motion; above `HIGHEST` there is none [1/sample]."""
LOST = 0.2
"""Correlation below which a refinement ends: it is too far from the shift [-]."""
ROUNDS = 8
"""Gauss-Newton steps at most; from half a period away four suffice."""
CONVERGED = 1e-4
"""Change of the shift at both ends below which the refinement ends [samples]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeShift:
    """Shift of the second record against the first.

    Attributes:
        shift: time by which the second record is late at `middle` [s].
        drift: change of that time per time [-]; 0 where the record does not tell.
        shift_error, drift_error: standard errors [s], [-]; infinite where the record does not tell.
        middle: middle of the common time on the clock of the first record [s].
        span: length of the common time [s].
        correlation: coefficient with shift and drift removed [-]; negative where the second record is inverted.
        gain: of the second record, least squares, that gives the first [-].
        period: shift after which the records agree as well again [s]; None where there is none.
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
        """Return the time by which the second record is late at a time of the first [s]."""
        return self.shift + self.drift * (time - self.middle)

    def later(self, seconds: float) -> TimeShift:
        """Return the same shift on a clock on which the first sample is so much later [s]."""
        return replace(self, middle=self.middle + seconds)


def time_shift(
    first: Vector, second: Vector, step: float, start: float = 0.0, guess: TimeShift | None = None
) -> TimeShift | None:
    """Return the time shift and the clock drift between two records.

    Args:
        first: record x, (n,), whose first sample is at time 0.
        second: record y of the same step, (m,).
        step: sampling interval of both [s].
        start: time of the first sample of y [s].
        guess: of another channel of the same records; no shift by default.

    Returns:
        The shift; None where a record does not move, or nothing is common to both.
    """
    if min(first.size, second.size) < 2 * LEAST_WINDOWS or not (np.ptp(first) > 0.0 and np.ptp(second) > 0.0):
        return None
    (clean, begin), (against, against_begin) = _without_noise(first, second)
    curve, offset = _Curve(against), start / step + against_begin - begin
    middle = 0.5 * (clean.size - 1)
    line = (0.0, 0.0) if guess is None else (guess.at((middle + begin) * step) / step, guess.drift)
    best = _refined(clean, curve, offset, line)
    if best is None or abs(best.correlation) < GOOD:
        searched = searched_line(clean, against, offset, LARGEST_DRIFT)
        other = None if searched is None else _refined(clean, curve, offset, searched)
        if other is not None and (best is None or abs(other.correlation) > abs(best.correlation)):
            best = other
    if best is None:
        return None
    found = replace(best, period=_period(clean, curve, offset, best))
    return replace(
        found,
        shift=found.shift * step,
        shift_error=found.shift_error * step,
        middle=(found.middle + begin) * step,
        span=found.span * step,
        period=None if found.period is None else found.period * step,
    )


class _Curve:
    """Record between its samples: spline of fifth order through them."""

    def __init__(self, values: Vector) -> None:
        self.last = values.size - 1
        self._coefficients = scipy.ndimage.spline_filter1d(values, 5, mode="mirror")

    def at(self, place: Vector) -> Vector:
        """Return the values at places within 0 to `last` [samples]."""
        found = scipy.ndimage.map_coordinates(self._coefficients, place[None], order=5, mode="mirror", prefilter=False)
        return np.asarray(found)


def _without_noise(first: Vector, second: Vector) -> tuple[tuple[Vector, int], tuple[Vector, int]]:
    """Both records without the frequencies above their motion, and the index of their first sample.

    Noise of y in its slope would pull the shift to where the refinement began; a low-pass without phase on both moves
    nothing.
    """
    frequency, share, _ = spectral_shares(first, second)
    corner = WIDER * float(frequency[np.flatnonzero(share >= 0.25 * share.max())[-1]])
    cut = int(np.ceil(1.0 / max(corner, 1e-9)))
    if not 0.0 < corner < HIGHEST or 4 * cut > min(first.size, second.size):
        return (first, 0), (second, 0)
    sections = scipy.signal.butter(4, 2.0 * corner, output="sos")
    one, other = (scipy.signal.sosfiltfilt(sections, values)[cut:-cut] for values in (first, second))
    return (one, cut), (other, cut)


def _mapped(count: int, last: int, offset: float, line: TimeShift) -> tuple[slice, Vector]:
    """Samples of the first record whose counterpart exists, and where it is in the second [samples]."""
    index = np.arange(count)
    place = index + (line.shift + line.drift * (index - line.middle)) - offset
    low, high = np.searchsorted(place, (-1e-9, last + 1e-9))
    return slice(int(low), int(high)), np.clip(place[low:high], 0.0, last)


def _refined(first: Vector, curve: _Curve, offset: float, line: tuple[float, float]) -> TimeShift | None:
    """Refine a line (shift at the middle of the first record, drift); everything in samples."""
    known = TimeShift(
        shift=line[0], drift=line[1], shift_error=np.inf, drift_error=np.inf, middle=0.5 * (first.size - 1),
        span=0.0, correlation=0.0, gain=0.0,
    )  # fmt: skip
    best: TimeShift | None = None
    for _ in range(ROUNDS):
        inside, place = _mapped(first.size, curve.last, offset, known)
        if place.size < 2 * LEAST_WINDOWS:
            return best
        middle = 0.5 * (inside.start + inside.stop - 1)
        known = replace(known, shift=known.at(middle), middle=middle, span=float(place.size - 1))
        x, y = first[inside], curve.at(place)
        x, y = x - x.mean(), y - y.mean()
        power = float(y @ y), float(x @ x)
        if min(power) <= 0.0:
            return best
        gain = float(x @ y) / power[0]
        known = replace(known, gain=gain, correlation=float(x @ y) / np.sqrt(power[0] * power[1]))
        change = _change(x, y, np.gradient(y), gain)
        if abs(known.correlation) < LOST and best is not None:
            break
        if best is None or abs(known.correlation) >= abs(best.correlation):
            best = replace(known, shift_error=change[2], drift_error=change[3])
        if abs(change[0]) + 0.5 * place.size * abs(change[1]) < CONVERGED:
            break
        drift = float(np.clip(known.drift + change[1], -LARGEST_DRIFT, LARGEST_DRIFT))
        known = replace(known, shift=known.shift + change[0], drift=drift)
    return best


def _change(x: Vector, y: Vector, slope: Vector, gain: float) -> tuple[float, float, float, float]:
    """Change of shift and drift and their standard errors, from a line through the shifts of windows."""
    if gain == 0.0:
        return 0.0, 0.0, np.inf, np.inf
    moved = float(slope @ slope)
    # Rice's mean frequency in periods a sample; the bandwidth is of the same size.
    rate = np.sqrt(moved / float(y @ y)) / (2.0 * np.pi)
    windows = int(np.clip(x.size * rate / PERIODS, LEAST_WINDOWS, MOST_WINDOWS))
    edges = (np.arange(windows) * x.size) // windows
    size = np.diff([*edges, x.size])

    def sums(values: Vector) -> Vector:
        return np.asarray(np.add.reduceat(values, edges))

    def inner(one: Vector, other: Vector) -> Vector:
        return sums(one * other) - sums(one) * sums(other) / size

    rest = x - gain * y
    yy, dd, yd = inner(y, y), inner(slope, slope), inner(y, slope)
    known = yy * dd - yd**2
    usable = known > 1e-12 * max(float(np.max(yy)) * float(np.max(dd)), 1e-300)
    shift = np.zeros(windows)
    shift[usable] = ((yy * inner(slope, rest) - yd * inner(y, rest))[usable] / known[usable]) / gain
    left = np.maximum(inner(rest, rest) - shift * gain * inner(slope, rest), 0.0) / size
    weight = np.where(usable, dd / (left + left.mean() + 1e-300), 0.0)
    if not weight.any():
        return 0.0, 0.0, np.inf, np.inf
    return _line(edges + 0.5 * (size - 1) - 0.5 * (x.size - 1), shift, weight / weight.max())


def _line(place: Vector, value: Vector, weight: Vector) -> tuple[float, float, float, float]:
    """Robust straight line: value at 0, slope, and their standard errors."""
    told = float(weight.sum() ** 2 / (weight @ weight))  # effective number of windows
    if told < 3.0:  # one or two windows hold all that moves
        mean = float(np.average(value, weights=weight))
        return mean, 0.0, np.inf, np.inf
    trust, matrix = weight, np.vander(place, 2, increasing=True)
    for _ in range(10):
        normal = (matrix * trust[:, None]).T @ matrix
        found = np.linalg.solve(normal, matrix.T @ (trust * value))
        away = np.sqrt(weight) * np.abs(value - matrix @ found)
        scale = 1.4826 * float(np.median(away[weight > 0.0]))
        if scale == 0.0:
            break
        trust = weight * np.maximum(1.0 - (away / (4.685 * scale)) ** 2, 0.0) ** 2
        if np.count_nonzero(trust) < LEAST_WINDOWS:
            trust = weight
            break
    used = trust > 0.0
    degrees = max(float(trust.sum() ** 2 / (trust @ trust)) - 2.0, 1.0)
    spread = float(trust[used] @ (value - matrix @ found)[used] ** 2) / float(trust.sum())
    cover = np.linalg.inv(normal) * spread * float(trust.sum()) / degrees
    return float(found[0]), float(found[1]), float(np.sqrt(cover[0, 0])), float(np.sqrt(cover[1, 1]))


def _period(first: Vector, curve: _Curve, offset: float, line: TimeShift) -> float | None:
    """Smallest further shift at which the records agree as well [samples]; None where there is none."""
    inside, place = _mapped(first.size, curve.last, offset, line)
    x, y = first[inside], np.sign(line.correlation) * curve.at(place)
    most = x.size // 2
    correlation = coefficients(x, y, most)
    side = np.maximum(correlation[most:], correlation[most::-1])
    below = np.flatnonzero(side < 0.9 * side[0])
    if not below.size:
        return None
    high = np.flatnonzero(side[below[0] :] >= REPEATED * side[0])
    if not high.size:
        return None
    begin = int(below[0] + high[0])
    end = begin + int(np.argmax(side[begin:] < 0.9 * side[0])) if (side[begin:] < 0.9 * side[0]).any() else side.size
    return float(begin + np.argmax(side[begin:end]))


def coefficients(first: Vector, second: Vector, most: int) -> Vector:
    """Return the correlation coefficients of what overlaps when the second record is late by -most to most samples.

    Args:
        first, second: (n,).
        most: largest shift [samples], below n.

    Returns:
        (2 most + 1,); -1 where an overlap does not move.
    """
    count = first.size
    first, second = first - first.mean(), second - second.mean()
    # Sums over the overlap for every shift k: first[: n - k] with second[k:], and with negative k the other way.
    cross = scipy.signal.correlate(second, first, method="fft")[count - 1 - most : count + most]
    shifts = np.arange(-most, most + 1)
    length = count - np.abs(shifts)
    late = shifts >= 0

    def sums(values: Vector, from_start: npt.NDArray[np.bool_]) -> Vector:
        total = np.concatenate([[0.0], np.cumsum(values)])
        return np.asarray(np.where(from_start, total[length], total[-1] - total[count - length]))

    top, bottom = sums(first, late), sums(second, ~late)
    spread = (sums(first**2, late) - top**2 / length) * (sums(second**2, ~late) - bottom**2 / length)
    correlation = np.full(shifts.size, -np.inf)
    fine = (spread > 0.0) & (length > 1)
    correlation[fine] = (cross - top * bottom / length)[fine] / np.sqrt(spread[fine])
    return correlation
