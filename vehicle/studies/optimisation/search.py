"""Multi-objective search by NSGA-II of pymoo; each generation is a batch of cars.

Source: Deb, Pratap, Agarwal, Meyarivan, A fast and elitist multiobjective genetic algorithm: NSGA-II, IEEE Transactions
on Evolutionary Computation 6 (2002); a feasible car is better than an infeasible car (section VI).
"""

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError, MissingPartError
from vehicle.studies.optimisation.problem import Problem

FAILED = 1e3
"""Constraint violation assigned to a car that cannot be run: more than for any other car."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TriedCars:
    """Cars tried in a search, with their values."""

    points: Vector  # values of the parameters; (n, p)
    values: Vector  # value of each criterion, NaN for a car that could not be run; (n, criteria)
    reasons: tuple[str, ...]  # error message for a car that could not be run, else ""; (n,)

    def kept(self, problem: Problem) -> Vector:
        """Return a mask of the cars that could be run and satisfy all limits; (n,)."""
        runs = np.array([not reason for reason in self.reasons])
        return np.asarray(runs & np.all(problem.excesses(self.values) <= 0.0, axis=1))


def joined(parts: Sequence[TriedCars]) -> TriedCars:
    """Concatenate the cars of several generations."""
    return TriedCars(
        points=np.concatenate([part.points for part in parts]),
        values=np.concatenate([part.values for part in parts]),
        reasons=tuple(reason for part in parts for reason in part.reasons),
    )


def search(
    problem: Problem,
    attempt: Callable[[Vector], TriedCars],
    *,
    population: int,
    generations: int,
    seed: int,
    stored: Sequence[TriedCars] = (),
) -> list[TriedCars]:
    """Search for the Pareto front of a problem.

    The first generation is a Latin hypercube that includes the unmodified car. Equal seeds give bitwise equal searches.

    Args:
        problem: parameters, objectives and limits.
        attempt: function that evaluates cars at points (n, p).
        population: number of cars of a generation.
        generations: number of generations.
        seed: seed of the search.
        stored: generations of an earlier search with equal seed and population, which are not evaluated again.

    Returns:
        Cars of each generation.

    Raises:
        DataError: the stored generations belong to another search.
        MissingPartError: pymoo is not installed.
    """
    size, limits = len(problem.ranges), len(problem.limits)
    box = pymoo("core.problem").Problem(
        n_var=size, n_obj=len(problem.goals), n_ieq_constr=limits + 1, xl=np.zeros(size), xu=np.ones(size)
    )
    algorithm = pymoo("algorithms.moo.nsga2").NSGA2(pop_size=population, sampling=_first(problem, population, seed))
    algorithm.setup(box, termination=("n_gen", generations), seed=seed, verbose=False)
    evaluator, static = pymoo("core.evaluator").Evaluator(), pymoo("problems.static").StaticProblem
    results: list[TriedCars] = []
    while algorithm.has_next():
        shares = algorithm.ask()
        if shares is None or not len(shares):
            break  # all points of the grid were tried
        points = problem.point(shares.get("X"))
        if len(results) < len(stored):
            if not np.array_equal(stored[len(results)].points, points):
                raise DataError(f"generation {len(results) + 1} belongs to another search; start again with --force")
            results.append(stored[len(results)])
        else:
            results.append(attempt(points))
        failed = np.array([bool(reason) for reason in results[-1].reasons])
        values = np.where(failed[:, None], 0.0, results[-1].values)
        excess = np.column_stack([problem.excesses(values), np.where(failed, FAILED, 0.0)])
        evaluator.eval(static(box, F=problem.costs(values), G=excess), shares)
        algorithm.tell(infills=shares)
    return results


def _first(problem: Problem, population: int, seed: int) -> Vector:
    """Return the first generation as shares of the ranges; (population, p)."""
    draw, size = np.random.default_rng(seed), (population, len(problem.ranges))
    strata = draw.permuted(np.tile(np.arange(population), (size[1], 1)), axis=1).T  # Latin hypercube
    shares = (strata + draw.random(size)) / population
    base = problem.share(np.array(problem.base))
    if np.all((base >= 0.0) & (base <= 1.0)):
        shares[0] = base
    return np.asarray(shares)


def pymoo(part: str) -> Any:
    """Import a module of pymoo."""
    try:
        return importlib.import_module(f"pymoo.{part}")
    except ImportError:
        raise MissingPartError("optimise: needs pymoo of the extra 'optimisation' (pip install pymoo)") from None
