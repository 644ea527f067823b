"""The front of a search: the cars that no other beats, its ends, its knee, how large it is, how far from another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.studies.optimisation.problem import Vector
from vehicle.studies.optimisation.search import pymoo

Indices = npt.NDArray[np.intp]

MARGIN = 0.1
"""How far the reference point lies beyond the worst of the front, of its extent: so the ends count too."""


def front(costs: Vector) -> Indices:
    """Rows that no other row beats: none is at most as large in all columns and smaller in one.

    Args:
        costs: less is better; (n, goals).

    Returns:
        Their indices, by the first column; of equal rows one.
    """
    kept: list[int] = []
    for row in np.lexsort(costs.T[::-1]):
        # Rows come in ascending order, so that none is beaten by a later one.
        if not kept or not np.any(np.all(costs[kept] <= costs[row], axis=1)):
            kept.append(int(row))
    return np.array(kept, dtype=np.intp)


def scaled(costs: Vector, like: Vector) -> Vector:
    """Costs in the extents of a front: 0 at its best, 1 at its worst in each column; (n, goals)."""
    best, worst = np.min(like, axis=0), np.max(like, axis=0)
    return np.asarray((costs - best) / np.where(worst > best, worst - best, 1.0))


def ends(costs: Vector) -> list[int]:
    """Row of a front that is best in each column; of equal ones that which is better in the others."""
    order = range(costs.shape[1])
    return [int(np.lexsort([*(costs[:, j] for j in order if j != column), costs[:, column]])[0]) for column in order]


def knee(costs: Vector) -> int:
    """Row of a front that lies farthest below the plane through its ends, towards the best of all columns.

    With the columns scaled to 0 and 1 that plane is sum f_j = 1, so it is the row of the least sum.

    Source: Das, On characterizing the "knee" of the Pareto curve based on normal-boundary intersection, Structural
    Optimization 18 (1999).
    """
    return int(np.argmin(np.sum(scaled(costs, costs), axis=1)))


def thinned(costs: Vector, first: Sequence[int], most: int) -> Indices:
    """Rows of a front that stand far from each other: after the first ones always that farthest from all taken.

    Args:
        costs: the front; (f, goals).
        first: rows that are taken.
        most: number of rows.

    Returns:
        Their indices in the order of the front; all where there are no more than `most`.

    Source: Gonzalez, Clustering to minimize the maximum intercluster distance, Theoretical Computer Science 38 (1985).
    """
    places = scaled(costs, costs)
    taken = list(dict.fromkeys(first))
    gaps = np.min([np.linalg.norm(places - places[row], axis=1) for row in taken], axis=0)
    while len(taken) < min(most, len(costs)):
        taken.append(int(np.argmax(gaps)))
        gaps = np.minimum(gaps, np.linalg.norm(places - places[taken[-1]], axis=1))
    return np.array(sorted(taken), dtype=np.intp)


def hypervolume(costs: Vector, like: Vector) -> float:
    """Volume that is beaten by some row, up to `MARGIN` beyond the worst of a front, in units of its extents.

    Source: Zitzler and Thiele, Multiobjective optimization using evolutionary algorithms, PPSN V (1998).
    """
    reference = np.full(costs.shape[1], 1.0 + MARGIN)
    return float(pymoo("indicators.hv").HV(ref_point=reference)(scaled(costs, like)))


def distance(costs: Vector, other: Vector) -> float:
    """Mean distance from the rows of a front to the nearest of another one, in units of the extents of both."""
    both = np.concatenate([costs, other])
    gaps = scaled(costs, both)[:, None] - scaled(other, both)
    return float(np.mean(np.min(np.linalg.norm(gaps, axis=2), axis=1)))
