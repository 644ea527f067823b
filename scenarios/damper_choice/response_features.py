"""Features of magnitudes of frequency responses: spread, crossing, local maxima."""

import numpy as np

from vehicle.arrays import Vector


def spread_of(curves: Vector) -> Vector:
    """Return the largest difference of curves, (n, m), at each line, (m,)."""
    return np.asarray(curves.max(axis=0) - curves.min(axis=0))


def crossing(lines: Vector, softest: Vector, firmest: Vector) -> float:
    """Return the highest line up to 12 Hz at which the firmest damper moves the wheel more than the softest [Hz].

    Both are magnitudes, (m,), at lines [Hz], (m,).
    """
    return float(lines[np.flatnonzero((firmest > softest) & (lines < 12.0))[-1]])


def last_peak(lines: Vector, curve: Vector) -> float:
    """Return the frequency of the last local maximum [Hz]; arguments as for `local_peaks`."""
    return local_peaks(lines, curve)[-1]


def local_peaks(lines: Vector, curve: Vector) -> list[float]:
    """Return the frequencies of all local maxima of a magnitude, (m,), at lines, (m,) [Hz]."""
    inner = curve[1:-1]
    return [float(lines[i + 1]) for i in np.flatnonzero((inner > curve[:-2]) & (inner > curve[2:]))]
