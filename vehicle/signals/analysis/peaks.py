"""Resonance peaks of an FRF magnitude."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.tops import prominent_tops

PROMINENCE_DB = 1.0
"""Minimum prominence of a peak above the higher of its two feet: 1 dB, a factor 1.12."""

STANDARD_ERRORS = 3.5
"""Minimum prominence in standard errors of the difference of top and foot. Both are extremes: the range of a hundred
independent estimates is 5 standard errors of an estimate on average, which is 3.5 of a difference."""

LEAST_COHERENCE = 0.3
"""Minimum coherence at a resonance: below it, more than two thirds of the power have another cause."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Peak:
    """Local maximum of an FRF magnitude."""

    frequency_hz: float
    """frequency of the maximum, between the lines [Hz]"""
    magnitude: float
    """interpolated maximum [unit of the FRF]"""
    coherence: float | None
    """coherence of the nearest line [-]; None if unknown"""
    prominence_db: float
    """height above the higher foot [dB]"""
    random_error: float | None = None
    """standard error of the nearest line [unit of the FRF]; None if unknown"""


def _vertex(x: Vector, y: Vector) -> tuple[float, float]:
    """Return position and height of the parabola through three points around a maximum, not necessarily equidistant."""
    # Divided differences of Newton: y = y0 + left (x - x0) + curvature (x - x0)(x - x1).
    left = (y[1] - y[0]) / (x[1] - x[0])
    right = (y[2] - y[1]) / (x[2] - x[1])
    curvature = (right - left) / (x[2] - x[0])
    if curvature >= 0.0:  # flat top of equal values: use the middle point
        return float(x[1]), float(y[1])
    position = 0.5 * (x[0] + x[1]) - 0.5 * left / curvature
    height = y[0] + left * (position - x[0]) + curvature * (position - x[0]) * (position - x[1])
    return float(position), float(height)


def resonance_peaks(
    frequency: ArrayLike,
    magnitude: ArrayLike,
    coherence: ArrayLike | None = None,
    random_error: ArrayLike | None = None,
    *,
    prominence_db: float = PROMINENCE_DB,
) -> tuple[Peak, ...]:
    """Find the resonance peaks of an FRF magnitude, sorted by frequency.

    A peak is a line above both neighbours whose prominence reaches the limit in dB and `STANDARD_ERRORS`, and whose
    coherence reaches `LEAST_COHERENCE`; its frequency and height come from the parabola through log(magnitude) at the
    line and its two neighbours. Lines with a NaN magnitude separate the searched ranges. A maximum at the edge of a
    range is no peak.

    Args:
        frequency: increasing lines [Hz], shape (m,).
        magnitude: |H| > 0 [unit of the FRF], shape (m,), NaN where undefined.
        coherence: coherence of the lines [-], shape (m,).
        random_error: standard error of the magnitude [unit of the FRF], shape (m,); 0 by default.
        prominence_db: minimum prominence [dB].
    """
    lines = np.asarray(frequency, dtype=np.float64)
    values = np.asarray(magnitude, dtype=np.float64)
    quality = None if coherence is None else np.asarray(coherence, dtype=np.float64)
    error = None if random_error is None else np.asarray(random_error, dtype=np.float64)
    others = [array.shape for array in (quality, error) if array is not None]
    if lines.ndim != 1 or any(shape != lines.shape for shape in (values.shape, *others)):
        raise DataError(
            f"peaks: found shapes {lines.shape} for frequency, {values.shape} for magnitude and "
            f"{others} for coherence and random error; all must be (m,)"
        )
    if not np.isfinite(lines).all() or np.any(np.diff(lines) <= 0.0):
        raise DataError("peaks: frequency must be finite and increase from line to line")
    defined = ~np.isnan(values)
    if np.any(values[defined] <= 0.0) or np.any(np.isinf(values)):
        raise DataError("peaks: a magnitude must be above 0 and finite (or NaN where undefined)")
    if not (np.isfinite(prominence_db) and prominence_db > 0.0):
        raise ConfigurationError(f"prominence: found {prominence_db!r} dB, must be a finite number above 0 dB")

    peaks: list[Peak] = []
    # Ranges of defined and of undefined lines alternate.
    for span in np.split(np.arange(lines.size), np.flatnonzero(np.diff(defined.astype(np.int8))) + 1):
        if span.size < 3 or not defined[span[0]]:
            continue
        decibel = 20.0 * np.log10(values[span])
        height, ripple = values[span], np.zeros(span.size) if error is None else error[span]
        for top, rise, bases in prominent_tops(decibel, prominence_db):
            foot = max(bases, key=lambda base: float(decibel[base]))
            noisy = quality is not None and quality[span[top]] < LEAST_COHERENCE
            if noisy or height[top] - height[foot] < STANDARD_ERRORS * np.hypot(ripple[top], ripple[foot]):
                continue
            around = slice(top - 1, top + 2)
            position, level = _vertex(lines[span][around], decibel[around])
            peaks.append(
                Peak(
                    frequency_hz=position,
                    magnitude=float(10.0 ** (level / 20.0)),
                    coherence=None if quality is None else float(quality[span[top]]),
                    prominence_db=float(rise),
                    random_error=None if error is None else float(error[span[top]]),
                )
            )
    return tuple(peaks)


def resonances(response: FrequencyResponse, row: int) -> tuple[Peak, ...]:
    """Find the resonance peaks of a row of an FRF with its coherence and random error."""
    return resonance_peaks(
        response.frequency, np.abs(response.response[row]), response.coherence[row], response.random_error[row]
    )


def phase_resonance(frequency: Vector, response: Complex) -> float:
    """Return the resonance frequency: the phase crossing of 90 deg nearest to the largest line, at any damping.

    Args:
        frequency: lines of the band [Hz], (m,).
        response: acceleration over displacement, (m,); its phase falls from 180 to 0 deg through a resonance.

    Returns:
        Interpolated frequency [Hz]; NaN if the phase does not cross 90 deg.
    """
    # Through 90 deg from above, the real part changes from negative to positive while the imaginary part is positive.
    real, positive_imaginary = response.real, response.imag > 0.0
    crossing = np.flatnonzero((real[:-1] < 0.0) & (real[1:] >= 0.0) & positive_imaginary[:-1] & positive_imaginary[1:])
    if not crossing.size:
        return float("nan")
    # Zero of the real part by the straight line between both lines.
    crossings = frequency[crossing] - real[crossing] * (frequency[crossing + 1] - frequency[crossing]) / (
        real[crossing + 1] - real[crossing]
    )
    return float(crossings[np.argmin(np.abs(crossings - frequency[np.nanargmax(np.abs(response))]))])
