"""Cars that are tried: their runs on all inputs, over the tolerances of a made car."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.studies.optimisation.problem import Problem, Tolerance, Vector
from vehicle.studies.sweeps.case import Case, Input, table_cases
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.dispatcher import Dispatcher
from vehicle.studies.sweeps.measure import Measure

Evaluate = Callable[[Sequence[Case], Measure], Sequence[Result]]
"""As of `vehicle.studies.sweeps.case_evaluation.evaluate`."""


def on_executor(executor: Executor, measure: Measure) -> Evaluate:
    """Evaluation by the workers of an executor, which stays open from one generation to the next.

    Args:
        executor: as of `vehicle.studies.sweeps.executors`.
        measure: of all cases.
    """
    dispatcher = Dispatcher(executor, measure)

    def evaluate(cases: Sequence[Case], _: Measure) -> list[Result]:
        found: dict[str, Result] = {}
        todo = {str(number): case for number, case in enumerate(cases)}
        dispatcher.work(todo, lambda keys, results: found.update(zip(keys, results, strict=True)))
        return [found[key] for key in todo]

    return evaluate


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Spread:
    """Tolerances, and where in their bands the cars stand that are run in place of each.

    Attributes:
        tolerances: with the whole paths of each and their values in the car as it is.
        bands: places of the cars in each band, -1 to 1; (k, tolerances).
        quantile: of the k numbers, counted from the good end, that is taken; 1 for the worst, NaN for their mean.
    """

    tolerances: tuple[tuple[Tolerance, Mapping[str, float]], ...]
    bands: Vector
    quantile: float = math.nan

    def cars(self, changes: Mapping[str, float]) -> list[dict[str, float]]:
        """Path to value of the k cars around one."""
        found = []
        for places in self.bands:
            car = dict(changes)
            for (tolerance, values), place in zip(self.tolerances, places, strict=True):
                car |= {path: tolerance.around(changes.get(path, old), float(place)) for path, old in values.items()}
            found.append(car)
        return found

    def worth(self, costs: Vector) -> Vector:
        """What the k numbers of each car, less is better, count as; (n,) of (n, k)."""
        if math.isnan(self.quantile):
            return np.asarray(np.mean(costs, axis=1))
        # Position p k + 1/2 (Hazen): with one car in each k-th part of a band, the r-th car has the expected share
        # (r - 1/2) / k below it. numpy's default, 1 + p (k - 1), has less: 0.85 for p = 0.9 of 8.
        return np.asarray(np.quantile(costs, self.quantile, axis=1, method="hazen"))

    @property
    def words(self) -> str:
        """Name of the statistic: "quantile 0.9 of 16 cars"."""
        count = len(self.bands)
        if math.isnan(self.quantile):
            return f"mean of {count} cars"
        return f"worst of {count} cars" if self.quantile == 1.0 else f"quantile {self.quantile:g} of {count} cars"


ALONE = Spread(tolerances=(), bands=np.zeros((1, 0)))
"""No tolerances: each car stands for itself."""


def samples_for(quantile: float) -> int:
    """Return the number of cars that a quantile needs: the power of two from 1 / (1 - quantile) on.

    One car of so many is expected beyond the quantile. With fewer it would be read between or behind the last cars,
    where the share of cars beyond depends on the number of tolerances.

    Args:
        quantile: from 0.5 to below 1.
    """
    return int(2 ** math.ceil(math.log2(1.0 / (1.0 - quantile)) - 1e-9))


def bands(tolerances: int, samples: int, seed: int) -> Vector:
    """Places in the bands of tolerances, -1 to 1: a scrambled Sobol sequence, the same for all cars; (samples, t).

    Args:
        tolerances: their number t.
        samples: number of cars, a power of two.
        seed: of the scrambling.

    Raises:
        ConfigurationError: the number of samples is no power of two.
    """
    if samples < 2 or samples & (samples - 1):
        raise ConfigurationError(
            f"--samples {samples}: must be a power of two, from 2 on (Sobol's sequence is balanced there)"
        )
    return np.asarray(2.0 * scipy.stats.qmc.Sobol(tolerances, scramble=True, rng=seed).random(samples) - 1.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trials:
    """How cars are tried.

    Attributes:
        problem: what is wanted.
        inputs: what drives each car.
        measure: has the numbers of all wishes.
        evaluate: carries out runs.
        fixed: overrides of every car.
        vehicle: vehicle file.
        engine: as of `Car.run`.
        spread: of the cars that are made.
    """

    problem: Problem
    inputs: Sequence[Input]
    measure: Measure
    evaluate: Evaluate
    fixed: Sequence[str] = ()
    vehicle: Path | None = None
    engine: str = "reduced"
    spread: Spread = field(default=ALONE)

    def cases(self, points: Vector) -> list[Case]:
        """Runs of points, the inputs varying fastest, then the cars of the spread."""
        cars = [car for point in points for car in self.spread.cars(self.problem.changes(point.tolist()))]
        make = partial(table_cases, inputs=self.inputs, engine=self.engine, vehicle=self.vehicle, fixed=self.fixed)
        return [case for car in cars for case in make([*car], [[*car.values()]])]

    def each(self, points: Vector) -> tuple[Vector, list[str]]:
        """Run the cars around each point.

        Args:
            points: values of the parameters, NaN for that of the car as it is; (n, p).

        Returns:
            The number of each wish of each car of the spread, NaN where it does not exist, (n, k, wishes); why a car
            around the point could not be run, or "".
        """
        results = list(self.evaluate(self.cases(points), self.measure))
        per_car = len(self.spread.bands) * len(self.inputs)
        reasons = [
            next((one.reason for one in results[first : first + per_car] if one.reason), "")
            for first in range(0, len(results), per_car)
        ]
        found = np.empty((len(points), len(self.spread.bands), len(self.problem.wishes)))
        for column, wish in enumerate(self.problem.wishes):
            each = [result.values.get(wish.number, math.nan) for result in results]
            values = np.array(each).reshape(len(points), len(self.spread.bands), len(self.inputs))
            found[:, :, column] = wish.of(values, self.problem.inputs)
        return found, reasons

    def __call__(self, points: Vector) -> tuple[Vector, list[str]]:
        """Try cars.

        Args:
            points: as in `each`.

        Returns:
            The number of each wish, (n, wishes), NaN for a car that could not be run; why it could not, or "".
        """
        each, reasons = self.each(points)
        found = np.empty((len(points), len(self.problem.wishes)))
        for column, wish in enumerate(self.problem.wishes):
            found[:, column] = wish.sense * self.spread.worth(wish.sense * each[:, :, column])
            for car in np.flatnonzero(~np.isfinite(found[:, column])):
                reasons[car] = reasons[car] or f"{wish.label}: does not exist in this run"
        found[[bool(reason) for reason in reasons]] = math.nan
        return found, reasons
