"""Objective rating of a simulated time history against a measured one: corridor, phase, magnitude, slope.

Source: ISO/TS 18571:2024, Road vehicles - Objective rating metric for non-ambiguous signals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.time_shift import coefficients
from vehicle.signals.analysis.time_warping import warped_differences

Vector = npt.NDArray[np.float64]

CORRIDOR, PHASE, MAGNITUDE, SLOPE = 0.4, 0.2, 0.2, 0.2
"""Weights of the four ratings in the whole."""
INNER, OUTER = 0.05, 0.5
"""Half widths of the corridors over the largest absolute value of the measured curve."""
LARGEST_SHIFT = 0.2
"""Share of the record by which the curves may be shifted."""
MAGNITUDE_LIMIT, SLOPE_LIMIT = 0.5, 2.0
"""Relative errors from which on the magnitude and the slope are rated 0."""
SMOOTHED = 9
"""Samples of the running mean of the slope."""
GRADES = ((0.94, "excellent"), (0.8, "good"), (0.58, "fair"))
"""Ratings above which a word holds; poor below."""
_TIE = 1e-12
"""Correlations closer than this are equal: the smaller shift is taken."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ratings:
    """The ratings, 0 to 1 each.

    Attributes:
        corridor, phase, magnitude, slope: of the four aspects [-].
    """

    corridor: float
    phase: float
    magnitude: float
    slope: float

    @property
    def overall(self) -> float:
        """0.4 corridor + 0.2 (phase + magnitude + slope) [-]."""
        return CORRIDOR * self.corridor + PHASE * self.phase + MAGNITUDE * self.magnitude + SLOPE * self.slope

    @property
    def grade(self) -> str:
        """The word of the standard for the whole."""
        return next((word for limit, word in GRADES if self.overall > limit), "poor")


@dataclass(frozen=True, kw_only=True, slots=True)
class CurveRating(Ratings):
    """Ratings of a curve.

    Attributes:
        shift: samples by which the simulated curve lags behind the measured one.
    """

    shift: int


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
    return rate_curves([truth], [curve], step)[0]


def rate_curves(
    measured: Sequence[Vector] | Vector, simulated: Sequence[Vector] | Vector, step: float = 1.0
) -> list[CurveRating]:
    """Rate several curves together; the ratings of each are those of `rate_curve`.

    Args:
        measured: T, k times (n,).
        simulated: C, k times (n,).
        step: sampling interval.
    """
    pairs = list(zip(measured, simulated, strict=True))
    shifts = [best_shift(truth, curve) for truth, curve in pairs]
    shifted = [
        (truth[: truth.size - shift], curve[shift:]) if shift >= 0 else (truth[-shift:], curve[:shift])
        for (truth, curve), shift in zip(pairs, shifts, strict=True)
    ]
    away, size = warped_differences([curve for _, curve in shifted], [truth for truth, _ in shifted])
    return [
        CurveRating(
            corridor=_corridor(truth, curve),
            phase=max(0.0, 1.0 - abs(shift) / (LARGEST_SHIFT * truth.size)),
            magnitude=_share(float(away[number]), float(size[number]), MAGNITUDE_LIMIT),
            slope=_slope_rating(*shifted[number], step),
            shift=shift,
        )
        for number, ((truth, curve), shift) in enumerate(zip(pairs, shifts, strict=True))
    ]


def _corridor(truth: Vector, curve: Vector) -> float:
    """Mean of the rating of each sample."""
    largest = float(np.max(np.abs(truth)))
    distance = np.abs(curve - truth)
    if largest == 0.0:
        return float(np.mean(distance == 0.0))
    inner, outer = INNER * largest, OUTER * largest
    share = np.where(distance > outer, 0.0, ((outer - distance) / (outer - inner)) ** 2)
    return float(np.mean(np.where(distance < inner, 1.0, share)))


def _share(away: float, size: float, limit: float) -> float:
    """1 - (|C - T|_1 / |T|_1) / limit, not below 0."""
    if size == 0.0:
        return float(away == 0.0)
    return max(0.0, 1.0 - away / size / limit)


def _slope_rating(truth: Vector, curve: Vector, step: float) -> float:
    first, second = _slope(truth, step), _slope(curve, step)
    return _share(float(np.sum(np.abs(second - first))), float(np.sum(np.abs(first))), SLOPE_LIMIT)


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
    correlation = coefficients(truth, curve, most)
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
