"""Evaluation of cars of a search on all inputs and over the production tolerances."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.studies.optimisation.problem import Problem, Tolerance
from vehicle.studies.sweeps.case import Case, Input
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.dispatcher import Dispatcher
from vehicle.studies.sweeps.executors import StandingExecutor
from vehicle.studies.sweeps.measure import Measure

Evaluate = Callable[[Sequence[Case], Measure], Sequence[Result]]
"""Function that evaluates cases, see `vehicle.studies.sweeps.case_evaluation.evaluate`."""


def on_executor(executor: Executor | StandingExecutor, measure: Measure) -> Evaluate:
    """Return an evaluation function that uses the workers of an executor, which stays open between generations.

    Args:
        executor: executor; a `StandingExecutor` is replaced after the death of a worker.
        measure: measure of all cases.
    """
    dispatcher = Dispatcher(executor, measure)

    def evaluate(cases: Sequence[Case], _: Measure) -> list[Result]:
        results: dict[int, Result] = {}
        dispatcher.work(cases, lambda numbers, block: results.update(zip(numbers, block.results(), strict=True)))
        return [results[number] for number in range(len(cases))]

    return evaluate


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spread:
    """Production tolerances, and the sample of k cars within the tolerances that is run for each car tried."""

    # tolerances, each with full path to value of the unmodified car
    tolerances: tuple[tuple[Tolerance, Mapping[str, float]], ...]
    bands: Vector  # positions of the cars in each band, -1 to 1; (k, tolerances)
    quantile: float = math.nan  # quantile of the k values, counted from the good end; 1 for the worst, NaN for the mean

    def cars(self, changes: Mapping[str, float]) -> list[dict[str, float]]:
        """Return path to value of each of the k cars within the tolerances of a car."""
        sample = []
        for positions in self.bands:
            car = dict(changes)
            for (tolerance, values), position in zip(self.tolerances, positions, strict=True):
                car |= {
                    path: tolerance.value_at(changes.get(path, old), float(position)) for path, old in values.items()
                }
            sample.append(car)
        return sample

    def statistic_of(self, costs: Vector) -> Vector:
        """Return the statistic (quantile or mean) of the k costs of each car; (n,) of (n, k)."""
        if math.isnan(self.quantile):
            return np.asarray(np.mean(costs, axis=1))
        # Position p k + 1/2 (Hazen): with one car in each k-th part of a band, the r-th car has the expected share
        # (r - 1/2) / k below it. The default of NumPy, 1 + p (k - 1), has less: 0.85 for p = 0.9 of 8.
        return np.asarray(np.quantile(costs, self.quantile, axis=1, method="hazen"))

    @property
    def statistic(self) -> str:
        """Return the name of the statistic, for example "quantile 0.9 of 16 cars"."""
        count = len(self.bands)
        if math.isnan(self.quantile):
            return f"mean of {count} cars"
        return f"worst of {count} cars" if self.quantile == 1.0 else f"quantile {self.quantile:g} of {count} cars"


NO_TOLERANCES = Spread(tolerances=(), bands=np.zeros((1, 0)))
"""Sample without tolerances: the car itself."""


def samples_for(quantile: float) -> int:
    """Return the minimum number of cars for a quantile: the smallest power of two from 1 / (1 - quantile).

    One car of this number is expected above the quantile. With fewer cars the quantile would be interpolated or
    extrapolated at the last cars, where the share of cars above it depends on the number of tolerances.

    Args:
        quantile: quantile from 0.5 to below 1.
    """
    return int(2 ** math.ceil(math.log2(1.0 / (1.0 - quantile)) - 1e-9))


def bands(tolerances: int, samples: int, seed: int) -> Vector:
    """Return positions in the bands of t tolerances, -1 to 1: a scrambled Sobol sequence; (samples, t).

    Args:
        tolerances: number t of tolerances.
        samples: number of cars, a power of two.
        seed: seed of the scrambling.
    """
    if samples < 2 or samples & (samples - 1):
        raise ConfigurationError(
            f"--samples {samples}: must be a power of two, at least 2 (a Sobol sequence of this length is balanced)"
        )
    return np.asarray(2.0 * scipy.stats.qmc.Sobol(tolerances, scramble=True, rng=seed).random(samples) - 1.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trials:
    """Evaluation of cars: runs on all inputs within the tolerances, reduced to the criteria of the problem."""

    problem: Problem  # parameters, objectives and limits
    inputs: Sequence[Input]  # inputs of each car
    measure: Measure  # measure with the quantities of all criteria
    evaluate: Evaluate  # function that evaluates cases
    fixed: Sequence[str] = ()  # overrides of every car
    vehicle: Path | None = None  # vehicle file
    engine: str = "reduced"  # simulation engine, see `Car.run`
    spread: Spread = field(default=NO_TOLERANCES)  # sample of cars within the tolerances

    def cases(self, points: Vector) -> list[Case]:
        """Return the runs of points (n, p); the inputs vary fastest, then the cars within the tolerances."""
        cars = [car for point in points for car in self.spread.cars(self.problem.changes(point.tolist()))]
        make = partial(table_cases, inputs=self.inputs, engine=self.engine, vehicle=self.vehicle, fixed=self.fixed)
        return [case for car in cars for case in make([*car], [[*car.values()]])]

    def per_sample(self, points: Vector) -> tuple[Vector, list[str]]:
        """Run the k cars within the tolerances of each point.

        Args:
            points: parameter values, NaN for the value of the unmodified car; (n, p).

        Returns:
            Values of the criteria, NaN where undefined, (n, k, criteria); for each point the error message of a car
            that could not be run, or "".
        """
        results = list(self.evaluate(self.cases(points), self.measure))
        per_car = len(self.spread.bands) * len(self.inputs)
        reasons = [
            next((result.reason for result in results[first : first + per_car] if result.reason), "")
            for first in range(0, len(results), per_car)
        ]
        sample_values = np.empty((len(points), len(self.spread.bands), len(self.problem.criteria)))
        for column, criterion in enumerate(self.problem.criteria):
            numbers = [result.values.get(criterion.number, math.nan) for result in results]
            values = np.array(numbers).reshape(len(points), len(self.spread.bands), len(self.inputs))
            sample_values[:, :, column] = criterion.of(values, self.problem.inputs)
        return sample_values, reasons

    def __call__(self, points: Vector) -> tuple[Vector, list[str]]:
        """Evaluate cars.

        Args:
            points: parameter values, see `per_sample`.

        Returns:
            Value of each criterion, (n, criteria), NaN for a car that could not be run; its error message, or "".
        """
        samples, reasons = self.per_sample(points)
        values = np.empty((len(points), len(self.problem.criteria)))
        for column, criterion in enumerate(self.problem.criteria):
            values[:, column] = criterion.sense * self.spread.statistic_of(criterion.sense * samples[:, :, column])
            for car in np.flatnonzero(~np.isfinite(values[:, column])):
                reasons[car] = reasons[car] or f"{criterion.label}: undefined in this run"
        values[[bool(reason) for reason in reasons]] = math.nan
        return values, reasons
