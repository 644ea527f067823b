"""Objective rating of a simulated time history against a measured one: corridor, phase, magnitude, slope.

Source: ISO/TS 18571:2024, Road vehicles - Objective rating metric for non-ambiguous signals.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.time_shift import coefficients
from vehicle.signals.analysis.time_warping import warped_differences

CORRIDOR, PHASE, MAGNITUDE, SLOPE = 0.4, 0.2, 0.2, 0.2
"""Weights of the four ratings in the overall rating."""
INNER, OUTER = 0.05, 0.5
"""Half widths of the inner and outer corridor over the maximum absolute value of the measured curve."""
LARGEST_SHIFT = 0.2
"""Maximum shift of the curves over the length of the record."""
MAGNITUDE_LIMIT, SLOPE_LIMIT = 0.5, 2.0
"""Relative errors of magnitude and slope at and above which the rating is 0."""
SMOOTHED = 9
"""Length of the running mean of the slope [samples]."""
GRADES = ((0.94, "excellent"), (0.8, "good"), (0.58, "fair"))
"""Grades of the standard, each with the rating that must be exceeded; "poor" below all of them."""
_TIE = 1e-12
"""Tolerance for equal correlations; the smaller shift is then used."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ratings:
    """Ratings of the four aspects and their weighted sum, 0 to 1 each.

    Attributes:
        corridor, phase, magnitude, slope: ratings [-].
    """

    corridor: float
    phase: float
    magnitude: float
    slope: float

    @property
    def overall(self) -> float:
        """Overall rating, 0.4 corridor + 0.2 (phase + magnitude + slope) [-]."""
        return CORRIDOR * self.corridor + PHASE * self.phase + MAGNITUDE * self.magnitude + SLOPE * self.slope

    @property
    def grade(self) -> str:
        """Grade of the overall rating in the standard, "excellent" to "poor"."""
        return next((grade for limit, grade in GRADES if self.overall > limit), "poor")


@dataclass(frozen=True, kw_only=True, slots=True)
class CurveRating(Ratings):
    """Ratings of a simulated curve.

    Attributes:
        shift: lag of the simulated curve against the measured curve [samples].
    """

    shift: int


def rate_curves(
    measured: Sequence[Vector] | Vector, simulated: Sequence[Vector] | Vector, step: float = 1.0
) -> list[CurveRating]:
    """Rate simulated curves against measured ones, each pair by itself.

    Corridor: mean of 1 within the inner corridor, 0 outside the outer one, ((outer - d) / (outer - inner))^2 between.
    Phase: 1 - n / (0.2 N), n the shift with the largest correlation. Magnitude, of the shifted curves after dynamic
    time warping: 1 - (|C - T|_1 / |T|_1) / 0.5. Slope, of the shifted curves' smoothed slopes:
    1 - (|C' - T'|_1 / |T'|_1) / 2. Negative ratings are set to 0.

    Args:
        measured: k measured curves T, (n,) each, uniformly sampled.
        simulated: k simulated curves C, (n,) each, at the times of T.
        step: sampling interval; it scales both slopes and cancels in the rating.
    """
    pairs = list(zip(measured, simulated, strict=True))
    shifts = [best_shift(truth, curve) for truth, curve in pairs]
    shifted = [
        (truth[: truth.size - shift], curve[shift:]) if shift >= 0 else (truth[-shift:], curve[:shift])
        for (truth, curve), shift in zip(pairs, shifts, strict=True)
    ]
    difference, size = warped_differences([curve for _, curve in shifted], [truth for truth, _ in shifted])
    return [
        CurveRating(
            corridor=_corridor(truth, curve),
            phase=max(0.0, 1.0 - abs(shift) / (LARGEST_SHIFT * truth.size)),
            magnitude=_share(float(difference[number]), float(size[number]), MAGNITUDE_LIMIT),
            slope=_slope_rating(*shifted[number], step),
            shift=shift,
        )
        for number, ((truth, curve), shift) in enumerate(zip(pairs, shifts, strict=True))
    ]


def _corridor(truth: Vector, curve: Vector) -> float:
    """Return the mean corridor rating over all samples."""
    largest = float(np.max(np.abs(truth)))
    distance = np.abs(curve - truth)
    if largest == 0.0:
        return float(np.mean(distance == 0.0))
    inner, outer = INNER * largest, OUTER * largest
    # Between both corridors the rating falls as a parabola from 1 to 0.
    share = np.where(distance > outer, 0.0, ((outer - distance) / (outer - inner)) ** 2)
    return float(np.mean(np.where(distance < inner, 1.0, share)))


def _share(difference: float, size: float, limit: float) -> float:
    """Return 1 - (|C - T|_1 / |T|_1) / limit, at least 0."""
    if size == 0.0:
        return float(difference == 0.0)
    return max(0.0, 1.0 - difference / size / limit)


def _slope_rating(truth: Vector, curve: Vector, step: float) -> float:
    """Rate the slopes of two shifted curves."""
    first, second = _slope(truth, step), _slope(curve, step)
    return _share(float(np.sum(np.abs(second - first))), float(np.sum(np.abs(first))), SLOPE_LIMIT)


def best_shift(truth: Vector, curve: Vector) -> int:
    """Return the lag [samples] of a curve with the largest correlation coefficient over the overlap.

    Args:
        truth: measured curve, (n,).
        curve: simulated curve, (n,).

    Returns:
        Lag, at most n / 5, positive if the simulated curve is late; for equal coefficients the smallest lag.
    """
    count = truth.size
    limit = int(LARGEST_SHIFT * count + 1e-9)
    correlation = coefficients(truth, curve, limit)
    best, lag = correlation[limit], 0
    # From small to large lags, so that a tie keeps the smaller lag.
    for distance in range(1, limit + 1):
        for shift in (distance, -distance):
            if correlation[limit + shift] > best + _TIE:
                best, lag = correlation[limit + shift], shift
    return lag


def _slope(values: Vector, step: float) -> Vector:
    """Return the slopes smoothed by a running mean, which is shorter towards the ends."""
    slope = np.gradient(values, step)
    half = SMOOTHED // 2
    # A difference of cumulated sums is the sum over a window; the window stays symmetric up to the ends.
    total = np.concatenate([[0.0], np.cumsum(slope)])
    index = np.arange(values.size)
    half_width = np.minimum(half, np.minimum(index, index[::-1]))
    return np.asarray((total[index + half_width + 1] - total[index - half_width]) / (2 * half_width + 1))
