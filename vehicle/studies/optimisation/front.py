"""Pareto front: non-dominated rows, ends, knee point, thinning, hypervolume, and distance of two fronts."""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.studies.optimisation.search import pymoo

MARGIN = 0.1
"""Distance of the reference point from the worst values of the front, in extents of the front: with a margin the ends
contribute to the hypervolume."""


def front(costs: Vector) -> Indices:
    """Return the non-dominated rows: no other row is at most as large in all columns and smaller in at least one.

    Args:
        costs: objectives, less is better; (n, goals).

    Returns:
        Indices of the rows, sorted by the first column; equal rows appear once.
    """
    kept: list[int] = []
    for row in np.lexsort(costs.T[::-1]):
        # Rows come in ascending order, so a later row never dominates an earlier row.
        if not kept or not np.any(np.all(costs[kept] <= costs[row], axis=1)):
            kept.append(int(row))
    return np.array(kept, dtype=np.intp)


def scaled(costs: Vector, like: Vector) -> Vector:
    """Return costs scaled by the extents of the front `like`: 0 at its minimum, 1 at its maximum; (n, goals)."""
    best, worst = np.min(like, axis=0), np.max(like, axis=0)
    return np.asarray((costs - best) / np.where(worst > best, worst - best, 1.0))


def ends(costs: Vector) -> list[int]:
    """Return the minimal row of a front in each column; ties are resolved by the other columns."""
    order = range(costs.shape[1])
    return [int(np.lexsort([*(costs[:, j] for j in order if j != column), costs[:, column]])[0]) for column in order]


def knee(costs: Vector) -> int:
    """Return the row of the knee point: farthest below the plane through the ends of the front.

    With columns scaled to 0 and 1 the plane is sum f_j = 1, so the knee point has the minimum sum.

    Args:
        costs: criteria of the cars of the front, smaller is better; (cars, criteria).

    Source: Das, On characterizing the "knee" of the Pareto curve based on normal-boundary intersection, Structural
    Optimization 18 (1999).
    """
    return int(np.argmin(np.sum(scaled(costs, costs), axis=1)))


def thinned(costs: Vector, first: Sequence[int], maximum: int) -> Indices:
    """Return well-spread rows of a front: after the first rows repeatedly the row farthest from all selected rows.

    Args:
        costs: objectives of the front; (f, goals).
        first: rows that are always selected.
        maximum: maximum number of rows.

    Returns:
        Indices of the rows in ascending order; all rows if the front has at most `maximum` rows.

    Source: Gonzalez, Clustering to minimize the maximum intercluster distance, Theoretical Computer Science 38 (1985).
    """
    points = scaled(costs, costs)
    selected = list(dict.fromkeys(first))
    gaps = np.min([np.linalg.norm(points - points[row], axis=1) for row in selected], axis=0)
    while len(selected) < min(maximum, len(costs)):
        selected.append(int(np.argmax(gaps)))
        gaps = np.minimum(gaps, np.linalg.norm(points - points[selected[-1]], axis=1))
    return np.array(sorted(selected), dtype=np.intp)


def hypervolume(costs: Vector, like: Vector) -> float:
    """Return the volume dominated by a front, in extents of another front [-].

    The reference point is `MARGIN` extents above the largest values of the other front.

    Args:
        costs: criteria of the cars of the front, smaller is better; (cars, criteria).
        like: criteria of the front that defines the scales; (cars, criteria).

    Source: Zitzler and Thiele, Multiobjective optimization using evolutionary algorithms, PPSN V (1998).
    """
    reference = np.full(costs.shape[1], 1.0 + MARGIN)
    return float(pymoo("indicators.hv").HV(ref_point=reference)(scaled(costs, like)))


def distance(costs: Vector, other: Vector) -> float:
    """Return the mean distance from the rows of a front to the nearest row of another front, in extents of both [-]."""
    both = np.concatenate([costs, other])
    gaps = scaled(costs, both)[:, None] - scaled(other, both)
    return float(np.mean(np.min(np.linalg.norm(gaps, axis=2), axis=1)))
