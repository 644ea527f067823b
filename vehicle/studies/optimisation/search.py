"""The search itself: NSGA-II of pymoo, generation by generation, each a batch of cars.

Source: Deb, Pratap, Agarwal, Meyarivan, A fast and elitist multiobjective genetic algorithm: NSGA-II, IEEE Transactions
on Evolutionary Computation 6 (2002); a car that keeps the limits is better than one that does not (its section VI).
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.errors import DataError, MissingPartError
from vehicle.studies.optimisation.problem import Problem, Vector

FAILED = 1e3
"""What a car that cannot be run counts as beyond a limit: more than any that can."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Tried:
    """Cars that were tried.

    Attributes:
        points: values of their parameters; (n, p).
        values: the number of each wish, NaN where a car could not be run; (n, wishes).
        reasons: why it could not; empty where it could.
    """

    points: Vector
    values: Vector
    reasons: tuple[str, ...]

    def kept(self, problem: Problem) -> Vector:
        """Which cars could be run and keep all limits; (n,)."""
        runs = np.array([not reason for reason in self.reasons])
        return np.asarray(runs & np.all(problem.excesses(self.values) <= 0.0, axis=1))


def joined(parts: Sequence[Tried]) -> Tried:
    """Cars of several generations, one after the other."""
    return Tried(
        points=np.concatenate([part.points for part in parts]),
        values=np.concatenate([part.values for part in parts]),
        reasons=tuple(reason for part in parts for reason in part.reasons),
    )


def search(
    problem: Problem,
    attempt: Callable[[Vector], Tried],
    *,
    population: int,
    generations: int,
    seed: int,
    known: Sequence[Tried] = (),
) -> list[Tried]:
    """Look for the cars that no other beats in all objectives.

    The first generation is a Latin hypercube with the car as it is. One seed is one search, to the last digit.

    Args:
        problem: what is wanted.
        attempt: tries cars, (n, p).
        population: cars of a generation.
        generations: how many.
        seed: of the search.
        known: generations that were tried before, with the same seed and population: not tried again.

    Returns:
        The generations.

    Raises:
        DataError: what is known is of another search.
        MissingPartError: pymoo is not installed.
    """
    size, limits = len(problem.ranges), len(problem.limits)
    box = pymoo("core.problem").Problem(
        n_var=size, n_obj=len(problem.goals), n_ieq_constr=limits + 1, xl=np.zeros(size), xu=np.ones(size)
    )
    algorithm = pymoo("algorithms.moo.nsga2").NSGA2(pop_size=population, sampling=_first(problem, population, seed))
    algorithm.setup(box, termination=("n_gen", generations), seed=seed, verbose=False)
    evaluator, static = pymoo("core.evaluator").Evaluator(), pymoo("problems.static").StaticProblem
    found: list[Tried] = []
    while algorithm.has_next():
        shares = algorithm.ask()
        if shares is None or not len(shares):
            break  # nothing is left that was not tried
        points = problem.point(shares.get("X"))
        if len(found) < len(known):
            if not np.array_equal(known[len(found)].points, points):
                raise DataError(f"generation {len(found) + 1} is of another search; start anew with --force")
            found.append(known[len(found)])
        else:
            found.append(attempt(points))
        failed = np.array([bool(reason) for reason in found[-1].reasons])
        values = np.where(failed[:, None], 0.0, found[-1].values)
        excess = np.column_stack([problem.excesses(values), np.where(failed, FAILED, 0.0)])
        evaluator.eval(static(box, F=problem.costs(values), G=excess), shares)
        algorithm.tell(infills=shares)
    return found


def _first(problem: Problem, population: int, seed: int) -> Vector:
    """Shares of the ranges of the first generation; (population, p)."""
    draw, size = np.random.default_rng(seed), (population, len(problem.ranges))
    strata = draw.permuted(np.tile(np.arange(population), (size[1], 1)), axis=1).T  # each range in as many slices
    shares = (strata + draw.random(size)) / population
    base = problem.share(np.array(problem.base))
    if np.all((base >= 0.0) & (base <= 1.0)):
        shares[0] = base
    return np.asarray(shares)


def pymoo(part: str) -> Any:
    """A module of pymoo.

    Raises:
        MissingPartError: it is not installed.
    """
    try:
        return importlib.import_module(f"pymoo.{part}")
    except ImportError:
        raise MissingPartError("optimise: needs pymoo, of the extra 'optimisation' (pip install pymoo)") from None
