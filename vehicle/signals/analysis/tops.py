"""Local maxima with their prominence (as `scipy.signal.find_peaks`; its import takes half a second)."""

import numpy as np

from vehicle.signals.analysis.samples import Vector


def prominent_tops(values: Vector, prominence: float) -> list[tuple[int, float, tuple[int, int]]]:
    """Return the local maxima of a record whose prominence reaches a limit.

    A sample or plateau is a maximum if both neighbours are lower; the ends of the record are none.

    Args:
        values: the record; (n,).
        prominence: minimum prominence, in the unit of the record.

    Returns:
        Sample of each maximum, the middle of a plateau rounded down; its prominence, the height over the higher one of
        both bases; and its bases, the lowest samples to the left and to the right up to the next higher sample.
    """
    # Runs of equal samples, so that a plateau is one level.
    firsts = np.flatnonzero(np.concatenate([[True], values[1:] != values[:-1]]))
    levels, lasts = values[firsts], np.append(firsts[1:], values.size) - 1
    inner = 1 + np.flatnonzero((levels[1:-1] > levels[:-2]) & (levels[1:-1] > levels[2:]))
    tops = []
    for index in ((firsts[inner] + lasts[inner]) // 2).tolist():
        higher = np.flatnonzero(values > values[index])
        split = int(np.searchsorted(higher, index))
        begin = int(higher[split - 1]) + 1 if split else 0
        end = int(higher[split]) if split < higher.size else values.size
        # The base is the lowest sample, of equal ones the nearest.
        left = index - int(np.argmin(values[begin : index + 1][::-1]))
        right = index + int(np.argmin(values[index:end]))
        rise = float(values[index] - max(values[left], values[right]))
        if rise >= prominence:
            tops.append((index, rise, (left, right)))
    return tops
