"""Features of magnitudes of frequency responses: spread, crossing, local maxima."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def spread_of(curves: Array) -> Array:
    """Return the largest difference of curves, (n, m), at each line, (m,)."""
    return np.asarray(curves.max(axis=0) - curves.min(axis=0))


def crossing(lines: Array, softest: Array, firmest: Array) -> float:
    """Return the highest line up to 12 Hz at which the firmest damper moves the wheel more than the softest [Hz].

    Both are magnitudes, (m,), at lines [Hz], (m,).
    """
    return float(lines[np.flatnonzero((firmest > softest) & (lines < 12.0))[-1]])


def last_peak(lines: Array, curve: Array) -> float:
    """Return the frequency of the last local maximum [Hz]; arguments as for `local_peaks`."""
    return local_peaks(lines, curve)[-1]


def local_peaks(lines: Array, curve: Array) -> list[float]:
    """Return the frequencies of all local maxima of a magnitude, (m,), at lines, (m,) [Hz]."""
    inner = curve[1:-1]
    return [float(lines[i + 1]) for i in np.flatnonzero((inner > curve[:-2]) & (inner > curve[2:]))]
