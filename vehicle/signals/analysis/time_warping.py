"""Dynamic time warping of many pairs of curves at once: squared distances, steps (1, 0), (0, 1), (1, 1), in a window.

The cumulated distances are computed along the antidiagonals i + j = d, of which each needs the two before; pairs lie
side by side in the last axis.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

WINDOW = 0.1
"""Half width of the window over the length of the curves (ISO/TS 18571)."""
ROOM = 2**24
"""Memory of the steps that are kept at once [byte]."""


def warped_differences(curves: Sequence[Vector], truths: Sequence[Vector]) -> tuple[Vector, Vector]:
    """Return |C - T|_1 and |T|_1 of pairs of curves after warping.

    Args:
        curves: C, k times (n,); each pair may have a length of its own.
        truths: T, k times (n,).

    Returns:
        Sums over the path of warping, (k,) each.
    """
    away, size = np.zeros(len(curves)), np.zeros(len(curves))
    longest = max(curve.size for curve in curves)
    together = max(1, ROOM // (2 * longest * (_half_width(longest) + 1)))
    for first in range(0, len(curves), together):
        some = slice(first, first + together)
        away[some], size[some] = _together(curves[some], truths[some])
    return away, size


def _half_width(count: int) -> int:
    """Half width of the window of curves of this length: |i - j| stays below it."""
    return min(count, max(1, int(np.ceil(WINDOW * count))))


def _together(curves: Sequence[Vector], truths: Sequence[Vector]) -> tuple[Vector, Vector]:
    """`warped_differences` of pairs whose steps are kept together."""
    lengths = np.array([curve.size for curve in curves])
    count, pairs = int(lengths.max()), lengths.size
    widths = np.array([_half_width(int(length)) for length in lengths])
    width = int(widths.max())
    curve, truth = np.zeros((count, pairs)), np.zeros((count, pairs))
    for number, (one, other) in enumerate(zip(curves, truths, strict=True)):
        curve[: one.size, number], truth[: other.size, number] = one, other
    backwards = np.ascontiguousarray(truth[::-1])
    # Index of a cell in its diagonal: i - j + width; beyond the window of a pair its cost is infinite.
    offset = np.arange(-width, width + 1)
    closed = np.where(np.abs(offset)[:, None] >= widths, np.inf, 0.0)
    before, last = np.full((2 * width + 1, pairs), np.inf), np.full((2 * width + 1, pairs), np.inf)
    moves = np.zeros((2 * count - 1, width + 1, pairs), dtype=np.uint8)
    for diagonal in range(2 * count - 1):
        reach = min(width - 1, diagonal, 2 * count - 2 - diagonal)
        reach -= (reach - diagonal) % 2
        low, high = (diagonal - reach) // 2, (diagonal + reach) // 2 + 1
        cost = curve[low:high] - backwards[count - 1 - diagonal + low : count - 1 - diagonal + high]
        cost *= cost
        index = slice(width - reach, width + reach + 1, 2)
        cost += closed[index]
        left, right = last[index.start - 1 : index.stop - 1 : 2], last[index.start + 1 : index.stop + 1 : 2]
        best = np.minimum(left, right)
        if diagonal:
            kept = moves[diagonal, (width - reach) // 2 :][: high - low]
            np.less(right, left, out=kept, casting="unsafe")
            corner = before[index]
            kept[corner < best] = 2
            np.minimum(best, corner, out=best)
            cost += best
        before[index] = cost  # what else it holds is of the other diagonals and is not read again
        before, last = last, before
    return _sums_along(moves, width, curve, truth, lengths)


def _sums_along(
    moves: npt.NDArray[np.uint8], width: int, curve: Vector, truth: Vector, lengths: npt.NDArray[np.int64]
) -> tuple[Vector, Vector]:
    """|C - T|_1 and |T|_1 along the paths, from their ends to their beginnings."""
    pair = np.arange(lengths.size)
    row, column = lengths - 1, lengths - 1
    away, size = np.zeros(lengths.size), np.zeros(lengths.size)
    going = np.ones(lengths.size, dtype=bool)
    while going.any():
        there = truth[column, pair]
        away += np.where(going, np.abs(curve[row, pair] - there), 0.0)
        size += np.where(going, np.abs(there), 0.0)
        going &= (row > 0) | (column > 0)
        move = moves[row + column, (row - column + width) // 2, pair]
        row = np.where(going, row - (move != 1), row)
        column = np.where(going, column - (move != 0), column)
    return away, size
