"""Objective rating of a simulated time history against a measured one: corridor, phase, magnitude, slope.

Source: ISO/TS 18571:2024, Road vehicles - Objective rating metric for non-ambiguous signals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

Vector = npt.NDArray[np.float64]

CORRIDOR, PHASE, MAGNITUDE, SLOPE = 0.4, 0.2, 0.2, 0.2
"""Weights of the four ratings in the whole."""
INNER, OUTER = 0.05, 0.5
"""Half widths of the corridors over the largest absolute value of the measured curve."""
LARGEST_SHIFT = 0.2
"""Share of the record by which the curves may be shifted."""
WARPING_WINDOW = 0.1
"""Half width of the window of the dynamic time warping over the length of the shifted curves."""
MAGNITUDE_LIMIT, SLOPE_LIMIT = 0.5, 2.0
"""Relative errors from which on the magnitude and the slope are rated 0."""
SMOOTHED = 9
"""Samples of the running mean of the slope."""
GRADES = ((0.94, "excellent"), (0.8, "good"), (0.58, "fair"))
"""Ratings above which a word holds; poor below."""
LONGEST = 6000
"""Samples beyond which the warping would take most of a second: longer records are to be brought to fewer."""
_TIE = 1e-12
"""Correlations closer than this are equal: the smaller shift is taken."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CurveRating:
    """The ratings, 0 to 1 each.

    Attributes:
        corridor, phase, magnitude, slope: of the four aspects [-].
        shift: samples by which the simulated curve lags behind the measured one.
    """

    corridor: float
    phase: float
    magnitude: float
    slope: float
    shift: int

    @property
    def overall(self) -> float:
        """0.4 corridor + 0.2 (phase + magnitude + slope) [-]."""
        return CORRIDOR * self.corridor + PHASE * self.phase + MAGNITUDE * self.magnitude + SLOPE * self.slope

    @property
    def grade(self) -> str:
        """The word of the standard for the whole."""
        return next((word for limit, word in GRADES if self.overall > limit), "poor")


def rate_curve(measured: npt.ArrayLike, simulated: npt.ArrayLike, step: float = 1.0) -> CurveRating:
    """Rate a curve.

    Corridor: mean of 1 within the inner corridor, 0 outside the outer one, ((outer - d) / (outer - inner))^2 between.
    Phase: 1 - n / (0.2 N), n the shift with the largest correlation. Magnitude, of the shifted curves after dynamic
    time warping: 1 - (|C - T|_1 / |T|_1) / 0.5. Slope, of the shifted curves' smoothed slopes:
    1 - (|C' - T'|_1 / |T'|_1) / 2. None is below 0.

    Args:
        measured: T, (n,), of a uniform rate.
        simulated: C, (n,), at the same times.
        step: sampling interval; it changes nothing but the scale of the slopes, which cancels.
    """
    truth, curve = np.asarray(measured, dtype=float), np.asarray(simulated, dtype=float)
    largest = float(np.max(np.abs(truth)))
    distance = np.abs(curve - truth)
    if largest > 0.0:
        inner, outer = INNER * largest, OUTER * largest
        share = np.where(distance > outer, 0.0, ((outer - distance) / (outer - inner)) ** 2)
        corridor = float(np.mean(np.where(distance < inner, 1.0, share)))
    else:
        corridor = float(np.mean(distance == 0.0))
    shift = best_shift(truth, curve)
    first, second = (truth[: truth.size - shift], curve[shift:]) if shift >= 0 else (truth[-shift:], curve[:shift])
    path = _warping(second, first)
    return CurveRating(
        corridor=corridor,
        phase=max(0.0, 1.0 - abs(shift) / (LARGEST_SHIFT * truth.size)),
        magnitude=_share(second[path[0]], first[path[1]], MAGNITUDE_LIMIT),
        slope=_share(_slope(second, step), _slope(first, step), SLOPE_LIMIT),
        shift=shift,
    )


def _share(curve: Vector, truth: Vector, limit: float) -> float:
    """1 - (|C - T|_1 / |T|_1) / limit, not below 0."""
    away, size = float(np.sum(np.abs(curve - truth))), float(np.sum(np.abs(truth)))
    if size == 0.0:
        return float(away == 0.0)
    return max(0.0, 1.0 - away / size / limit)


def best_shift(truth: Vector, curve: Vector) -> int:
    """Samples by which a curve lags behind another for the largest correlation coefficient of what overlaps.

    Args:
        truth: (n,).
        curve: (n,).

    Returns:
        Of at most a fifth of n; the smallest of equal ones, positive where the curve is late.
    """
    count = truth.size
    most = int(LARGEST_SHIFT * count + 1e-9)
    first, second = truth - truth.mean(), curve - curve.mean()
    # Sums over the overlap for every shift k: truth[: n - k] with curve[k:], and with negative k the other way.
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
    best, found = correlation[most], 0
    for distance in range(1, most + 1):
        for shift in (distance, -distance):
            if correlation[most + shift] > best + _TIE:
                best, found = correlation[most + shift], shift
    return found


def _slope(values: Vector, step: float) -> Vector:
    """Slopes under a running mean, shorter towards the ends."""
    slope = np.gradient(values, step)
    half = SMOOTHED // 2
    total = np.concatenate([[0.0], np.cumsum(slope)])
    place = np.arange(values.size)
    reach = np.minimum(half, np.minimum(place, place[::-1]))
    return np.asarray((total[place + reach + 1] - total[place - reach]) / (2 * reach + 1))


def _warping(curve: Vector, truth: Vector) -> npt.NDArray[np.int64]:
    """Path of dynamic time warping: squared distances, steps (1, 0), (0, 1), (1, 1), within the window; (2, length).

    The cumulated distances are computed along the antidiagonals i + j = d, of which each needs the two before.
    """
    count = curve.size
    window = min(count, max(1, int(np.ceil(WARPING_WINDOW * count))))
    width = 2 * window + 1  # index of a cell in its diagonal: i - j + window; |i - j| < window is allowed
    before, last = np.full(width, np.inf), np.full(width, np.inf)
    moves = np.zeros((2 * count - 1, window + 1), dtype=np.uint8)
    for diagonal in range(2 * count - 1):
        reach = min(window - 1, diagonal, 2 * count - 2 - diagonal)
        reach -= (reach - diagonal) % 2
        offsets = np.arange(-reach, reach + 1, 2)
        i, index = (diagonal + offsets) // 2, slice(window - reach, window + reach + 1, 2)
        cost = (curve[i] - truth[diagonal - i]) ** 2
        left, right = slice(index.start - 1, index.stop - 1, 2), slice(index.start + 1, index.stop + 1, 2)
        best = np.minimum(last[left], last[right])
        taken = (last[right] < last[left]).astype(np.uint8)
        taken[before[index] < best] = 2
        best = np.minimum(best, before[index]) if diagonal else np.zeros(1)
        moves[diagonal, (offsets[0] + window) // 2 :][: i.size] = taken
        before[:] = np.inf
        before[index] = cost + best
        before, last = last, before
    row = column = count - 1
    path = [(row, column)]
    while row or column:
        move = int(moves[row + column, (row - column + window) // 2])
        row, column = row - (move != 1), column - (move != 0)
        path.append((row, column))
    return np.array(path[::-1], dtype=np.int64).T
