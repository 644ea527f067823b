"""Outcome of a search: Pareto front, named cars on the front, and growth of the hypervolume."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.errors import SimulationError
from vehicle.studies.optimisation.front import ends, front, hypervolume, knee, thinned
from vehicle.studies.optimisation.problem import Problem
from vehicle.studies.optimisation.search import TriedCars, joined

BASE, KNEE, BEST = "base", "knee", "best"

SHOWN = 100
"""Maximum number of cars of a front that are written and drawn: neighbours are about a hundredth of the front apart."""

PARTS = (0.25, 0.5, 0.75)
"""Shares of the cars after which the hypervolume is computed."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Outcome:
    """A finished search."""

    problem: Problem  # parameters, objectives and limits
    base: TriedCars  # unmodified car
    tried: TriedCars  # all other cars
    front_size: int  # number of non-dominated cars
    front: Indices  # rows of `tried` of at most `SHOWN` non-dominated cars, well spread, sorted by the first objective
    named: Mapping[str, int]  # name to row of `tried`: best car of each objective, knee point
    # share of the final hypervolume after each of `PARTS` of the cars; empty for a front of one car
    reached: Mapping[float, float]

    @property
    def costs(self) -> Vector:
        """Return the objectives of the front as costs, less is better; (f, goals)."""
        return self.problem.costs(self.tried.values[self.front])


def outcome(problem: Problem, base: TriedCars, generations: Sequence[TriedCars]) -> Outcome:
    """Evaluate a finished search: front, named cars and growth of the hypervolume.

    Args:
        problem: parameters, objectives and limits.
        generations: cars of each generation.
    """
    tried = joined(generations)
    kept = np.flatnonzero(tried.kept(problem))
    if not kept.size:
        raise SimulationError(_no_front_message(problem, tried))
    costs = problem.costs(tried.values)
    non_dominated = kept[front(costs[kept])]
    front_costs = costs[non_dominated]
    reached = {}
    if len(non_dominated) > 1:  # a front of one car has no extent
        final = hypervolume(front_costs, front_costs)
        for part in PARTS:
            early = costs[kept[kept < part * len(tried.reasons)]]
            reached[part] = hypervolume(early, front_costs) / final if early.size else 0.0
    names = [BEST] if len(problem.goals) == 1 else [f"{BEST} {goal.label}" for goal in problem.goals]
    rows = dict(zip(names, ends(front_costs), strict=True))
    if len(problem.goals) > 1:
        rows[KNEE] = knee(front_costs)
    return Outcome(
        problem=problem,
        base=base,
        tried=tried,
        front_size=len(non_dominated),
        front=non_dominated[thinned(front_costs, list(rows.values()), SHOWN)],
        named={name: int(non_dominated[row]) for name, row in rows.items()},
        reached=reached,
    )


def _no_front_message(problem: Problem, tried: TriedCars) -> str:
    """Return the message for a search without a car that satisfies the limits."""
    ran = np.array([not reason for reason in tried.reasons])
    if not ran.any():
        return f"all {ran.size} cars failed; the first: {tried.reasons[0]}"
    excess = problem.excesses(tried.values[ran])
    nearest = int(np.argmin(np.max(excess, axis=1)))
    first, values = len(problem.goals), tried.values[ran][nearest]
    broken = [
        f"{limit.expression} ({values[first + i]:.4g} {limit.unit})"
        for i, limit in enumerate(problem.limits)
        if excess[nearest, i] > 0.0
    ]
    return (
        f"none of {ran.size} cars satisfies all limits; the nearest one violates {', '.join(broken)}; widen the limits "
        "or the bounds"
    )
