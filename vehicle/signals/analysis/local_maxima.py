"""Local maxima of samples with their prominence."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class LocalMaximum(NamedTuple):
    """Local maximum of samples; a flat top counts as one maximum at its middle."""

    top: int
    """index of the sample"""
    prominence: float
    """height above the higher foot [unit of the samples]"""
    foot: int
    """index of the higher foot, the left one of two equal ones"""


def local_maxima(values: NDArray[np.float64], prominence: float) -> list[LocalMaximum]:
    """Find the local maxima with a minimum prominence, in the order of the samples.

    A foot is the lowest sample between the maximum and the next higher sample, or the end, on one side. A maximum at an
    end of the samples does not count. The same maxima as `scipy.signal.find_peaks`, whose import takes a second of
    processor time.

    Args:
        values: samples, (n,).
        prominence: minimum prominence [unit of the samples].
    """
    steps = np.flatnonzero(np.diff(values))
    first, last = np.concatenate(([0], steps + 1)), np.concatenate((steps, [values.size - 1]))
    levels = values[first]
    tops = 1 + np.flatnonzero((levels[1:-1] > levels[:-2]) & (levels[1:-1] > levels[2:]))
    maxima = (_with_feet(values, int(index)) for index in (first[tops] + last[tops]) // 2)
    return [maximum for maximum in maxima if maximum.prominence >= prominence]


def _with_feet(values: NDArray[np.float64], index: int) -> LocalMaximum:
    """Return a maximum with its prominence; of equal lowest samples, a foot is the nearest."""
    higher = np.flatnonzero(values > values[index])
    after = int(np.searchsorted(higher, index))
    begin = int(higher[after - 1]) + 1 if after else 0
    end = int(higher[after]) if after < higher.size else values.size
    left = index - int(np.argmin(values[begin : index + 1][::-1]))
    right = index + int(np.argmin(values[index:end]))
    foot = max(left, right, key=lambda sample: float(values[sample]))
    return LocalMaximum(index, float(values[index] - values[foot]), foot)
