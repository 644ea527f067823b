"""Dynamic time warping of pairs of curves in a batch: squared distances, steps (1, 0), (0, 1), (1, 1), in a window.

The cumulated distances are computed along the antidiagonals i + j = d; each needs the two previous antidiagonals. The
last axis of the arrays is the pair.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.samples import Vector

WINDOW = 0.1
"""Half width of the window over the length of the curves (ISO/TS 18571)."""
MEMORY = 2**24
"""Maximum memory of the stored steps of a batch [byte]."""


def warped_differences(curves: Sequence[Vector], truths: Sequence[Vector]) -> tuple[Vector, Vector]:
    """Return |C - T|_1 and |T|_1 of pairs of curves after warping.

    Args:
        curves: k simulated curves C, (n,) each; pairs may differ in length.
        truths: k measured curves T, (n,) each.

    Returns:
        Sums |C - T|_1 and |T|_1 over the warping path, (k,) each.
    """
    difference, size = np.zeros(len(curves)), np.zeros(len(curves))
    longest = max(curve.size for curve in curves)
    batch_size = max(1, MEMORY // (2 * longest * (_half_width(longest) + 1)))
    for first in range(0, len(curves), batch_size):
        batch = slice(first, first + batch_size)
        difference[batch], size[batch] = _batch_differences(curves[batch], truths[batch])
    return difference, size


def _half_width(count: int) -> int:
    """Return the half width of the window for curves of a length; |i - j| is below it."""
    return min(count, max(1, int(np.ceil(WINDOW * count))))


def _batch_differences(curves: Sequence[Vector], truths: Sequence[Vector]) -> tuple[Vector, Vector]:
    """Return `warped_differences` of a batch of pairs."""
    lengths = np.array([curve.size for curve in curves])
    count, pairs = int(lengths.max()), lengths.size
    widths = np.array([_half_width(int(length)) for length in lengths])
    width = int(widths.max())
    curve, truth = np.zeros((count, pairs)), np.zeros((count, pairs))
    for number, (simulated, measured) in enumerate(zip(curves, truths, strict=True)):
        curve[: simulated.size, number], truth[: measured.size, number] = simulated, measured
    backwards = np.ascontiguousarray(truth[::-1])
    # Index of a cell in its diagonal: i - j + width; the cost outside the window of a pair is infinite.
    offset = np.arange(-width, width + 1)
    closed = np.where(np.abs(offset)[:, None] >= widths, np.inf, 0.0)
    before, last = np.full((2 * width + 1, pairs), np.inf), np.full((2 * width + 1, pairs), np.inf)
    # (diagonals, cells of a diagonal, pairs)
    moves = np.zeros((2 * count - 1, width + 1, pairs), dtype=np.uint8)
    for diagonal in range(2 * count - 1):
        # Cells of a diagonal have i - j of equal parity with i + j, from -extent to extent in steps of two.
        extent = min(width - 1, diagonal, 2 * count - 2 - diagonal)
        extent -= (extent - diagonal) % 2
        low, high = (diagonal - extent) // 2, (diagonal + extent) // 2 + 1
        # Along a diagonal j falls as i rises: the reversed truth makes both slices ascend.
        cost = curve[low:high] - backwards[count - 1 - diagonal + low : count - 1 - diagonal + high]
        cost *= cost
        index = slice(width - extent, width + extent + 1, 2)
        cost += closed[index]
        # On the last diagonal, `left` is (i - 1, j) and `right` is (i, j - 1); (i - 1, j - 1) is on the diagonal
        # before.
        left, right = last[index.start - 1 : index.stop - 1 : 2], last[index.start + 1 : index.stop + 1 : 2]
        best = np.minimum(left, right)
        if diagonal:
            move = moves[diagonal, (width - extent) // 2 :][: high - low]
            np.less(right, left, out=move, casting="unsafe")
            corner = before[index]
            move[corner < best] = 2
            np.minimum(best, corner, out=best)
            cost += best
        before[index] = cost  # the other cells belong to older diagonals and are not read again
        before, last = last, before
    return _sums_along(moves, width, curve, truth, lengths)


def _sums_along(
    moves: npt.NDArray[np.uint8], width: int, curve: Vector, truth: Vector, lengths: npt.NDArray[np.int64]
) -> tuple[Vector, Vector]:
    """Return |C - T|_1 and |T|_1 along the paths, traced from their ends to their beginnings."""
    pair = np.arange(lengths.size)
    row, column = lengths - 1, lengths - 1
    difference, size = np.zeros(lengths.size), np.zeros(lengths.size)
    active = np.ones(lengths.size, dtype=bool)
    while active.any():
        values = truth[column, pair]
        difference += np.where(active, np.abs(curve[row, pair] - values), 0.0)
        size += np.where(active, np.abs(values), 0.0)
        active &= (row > 0) | (column > 0)
        move = moves[row + column, (row - column + width) // 2, pair]
        # Moves: 0 from i - 1, 1 from j - 1, 2 from both.
        row = np.where(active, row - (move != 1), row)
        column = np.where(active, column - (move != 0), column)
    return difference, size
