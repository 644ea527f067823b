"""What a search found: its front, the cars on it that have a name, and whether it still moved at the end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.errors import SimulationError
from vehicle.studies.optimisation.front import Indices, ends, front, hypervolume, knee, thinned
from vehicle.studies.optimisation.problem import Problem, Vector
from vehicle.studies.optimisation.search import Tried, joined

BASE, KNEE, BEST = "base", "knee", "best"

SHOWN = 100
"""Most cars of a front that are written and drawn: from one to the next about a hundredth of it."""

PARTS = (0.25, 0.5, 0.75)
"""Shares of the cars after which the hypervolume is looked at."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Outcome:
    """A finished search.

    Attributes:
        problem: what was wanted.
        base: the car as it is.
        tried: all others.
        whole: number of cars that no other beats.
        front: rows of `tried` of at most `SHOWN` of them, far from each other, by the first objective.
        named: name to row: best of each objective, knee.
        reached: share of their hypervolume that was reached after `PARTS` of the cars; empty for a front of one car.
    """

    problem: Problem
    base: Tried
    tried: Tried
    whole: int
    front: Indices
    named: Mapping[str, int]
    reached: Mapping[float, float]

    @property
    def costs(self) -> Vector:
        """Objectives of the front, less is better; (f, goals)."""
        return self.problem.costs(self.tried.values[self.front])


def outcome(problem: Problem, base: Tried, generations: Sequence[Tried]) -> Outcome:
    """What the cars of a search give.

    Raises:
        SimulationError: none of them keeps the limits, or none could be run.
    """
    tried = joined(generations)
    kept = np.flatnonzero(tried.kept(problem))
    if not kept.size:
        raise SimulationError(_none_kept(problem, tried))
    costs = problem.costs(tried.values)
    found = kept[front(costs[kept])]
    own = costs[found]
    reached = {}
    if len(found) > 1:  # a front of one car has no extent
        whole = hypervolume(own, own)
        for part in PARTS:
            early = costs[kept[kept < part * len(tried.reasons)]]
            reached[part] = hypervolume(early, own) / whole if early.size else 0.0
    names = [BEST] if len(problem.goals) == 1 else [f"{BEST} {goal.label}" for goal in problem.goals]
    rows = dict(zip(names, ends(own), strict=True))
    if len(problem.goals) > 1:
        rows[KNEE] = knee(own)
    return Outcome(
        problem=problem,
        base=base,
        tried=tried,
        whole=len(found),
        front=found[thinned(own, list(rows.values()), SHOWN)],
        named={name: int(found[row]) for name, row in rows.items()},
        reached=reached,
    )


def _none_kept(problem: Problem, tried: Tried) -> str:
    """Why there is no front."""
    ran = np.array([not reason for reason in tried.reasons])
    if not ran.any():
        return f"none of {ran.size} cars could be run; the first: {tried.reasons[0]}"
    excess = problem.excesses(tried.values[ran])
    nearest = int(np.argmin(np.max(excess, axis=1)))
    first, values = len(problem.goals), tried.values[ran][nearest]
    broken = [
        f"{limit.words} is {values[first + i]:.4g} {limit.unit}"
        for i, limit in enumerate(problem.limits)
        if excess[nearest, i] > 0.0
    ]
    return (
        f"none of {ran.size} cars keeps all limits; the nearest one misses {', '.join(broken)}; widen the limits or "
        "the bounds"
    )
