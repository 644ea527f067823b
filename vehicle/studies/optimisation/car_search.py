"""Search for optimal parameters of a car: check all arguments first, then run in a folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.studies.optimisation.front_checks import (
    mujoco_differences,
    named_cars,
    shares_as_good,
    validity_warnings,
    without_tolerances,
)
from vehicle.studies.optimisation.outcome import outcome
from vehicle.studies.optimisation.problem import Tolerance, parsed_criteria, parsed_tolerance
from vehicle.studies.optimisation.ride import ride_measure
from vehicle.studies.optimisation.search import pymoo
from vehicle.studies.optimisation.search_result import FoundCars
from vehicle.studies.optimisation.stored_search import stored_search
from vehicle.studies.optimisation.trials import NO_TOLERANCES, Spread, Trials, bands, on_executor, samples_for
from vehicle.studies.optimisation.variables import problem_of, require_bounds, toleranced
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.executors import process_pool
from vehicle.studies.sweeps.sweep_inputs import Source, common_start, file_of, inputs_of

Tolerances = Mapping[str, float | str] | Sequence[Tolerance]
"""Path to half of the band: in the unit of the parameter, or as "15%"."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SearchPlan:
    """Checked search, ready to run.

    Attributes:
        trials: evaluation of the cars.
        vehicle: parameters of the unmodified car.
        skip: start of the evaluation [s].
        seed: seed of the search.
    """

    trials: Trials
    vehicle: Vehicle
    skip: float
    seed: int

    def run(
        self,
        folder: Path,
        *,
        cars: int = 2000,
        population: int = 64,
        executor: Callable[[], Executor] | None = None,
        check: bool = False,
        progress: Callable[[float], None] = lambda fraction: None,
    ) -> FoundCars:
        """Run the search.

        Args:
            folder: existing folder in which every car is stored; an interrupted search in the folder is continued.
            cars: number of cars to try.
            population: cars of a generation.
            executor: function that returns the executor for the evaluation of cars; by default this process.
            check: run the named cars with MuJoCo too.
            progress: called with the finished fraction.

        Raises:
            ConfigurationError: the folder contains another search.
            SimulationError: no car satisfies the limits, or no car could be run.
        """
        trials = self.trials
        with ExitStack() as held:
            if executor is not None:
                trials = replace(trials, evaluate=on_executor(held.enter_context(executor()), trials.measure))
            base, generations = stored_search(
                trials, folder, cars=cars, population=population, seed=self.seed, progress=progress
            )
            outcome_of_search = outcome(trials.problem, base, generations)
            cars_by_name = named_cars(trials, outcome_of_search)
            nominal = without_tolerances(trials, outcome_of_search) if trials.spread.tolerances else None
            reached = shares_as_good(trials, outcome_of_search, self.seed) if trials.spread.quantile > 0.0 else None
            checked = mujoco_differences(trials, outcome_of_search) if check else None
        return FoundCars(
            outcome=outcome_of_search,
            trials=self.trials,
            vehicle=self.vehicle,
            cars=cars_by_name,
            skip=self.skip,
            seed=self.seed,
            nominal=nominal,
            reached=reached,
            checked=checked,
            notices=tuple(validity_warnings(trials, cars_by_name)),
        )


def plan_search(
    car: Car,
    vary: Mapping[str, Sequence[float]] | Sequence[Range],
    inputs: Source | Sequence[Source],
    minimise: Sequence[str] = (),
    *,
    maximise: Sequence[str] = (),
    limits: Sequence[str] = (),
    tolerances: Tolerances = (),
    samples: int | None = None,
    quantile: float | None = None,
    engine: str = "reduced",
    skip: float | None = None,
    seed: int = 1,
) -> SearchPlan:
    """Check the arguments of a search and return the search; arguments and errors as in `optimise`."""
    pymoo("core.problem")
    vehicle, file = car.vehicle, file_of(car)
    sources = inputs_of(car, inputs)
    names = [source.name for source in sources]
    if len(set(names)) < len(names):
        raise ConfigurationError(f"inputs {', '.join(names)}: equal names; rename a file, or use each input once")
    start = common_start(sources, skip)
    criteria = parsed_criteria(minimise, maximise, limits, names)
    measure = ride_measure(vehicle, tuple(criterion.number for criterion in criteria), start)
    criteria = tuple(replace(criterion, unit=measure.units[criterion.number]) for criterion in criteria)
    problem = problem_of(vehicle, _ranges(vary), criteria, names)
    require_bounds(file, car.overrides, problem)
    spread = NO_TOLERANCES
    if not tolerances and (samples is not None or quantile is not None):
        raise ConfigurationError("samples, quantile: only valid with tolerances; add tolerances")
    if tolerances:
        chosen, count = _quantile_and_samples(quantile, samples)
        if isinstance(tolerances, Mapping):
            tolerances = [parsed_tolerance(f"{path}={size}") for path, size in tolerances.items()]
        each = toleranced(vehicle, tolerances)
        spread = Spread(tolerances=each, bands=bands(len(each), count, seed), quantile=chosen)
    trials = Trials(
        problem=problem,
        inputs=sources,
        measure=measure,
        evaluate=evaluate,
        fixed=car.overrides,
        vehicle=file,
        engine=engine,
        spread=spread,
    )
    return SearchPlan(trials=trials, vehicle=vehicle, skip=start, seed=seed)


def optimise(
    car: Car,
    vary: Mapping[str, Sequence[float]] | Sequence[Range],
    inputs: Source | Sequence[Source],
    minimise: Sequence[str],
    *,
    maximise: Sequence[str] = (),
    limits: Sequence[str] = (),
    tolerances: Tolerances = (),
    samples: int | None = None,
    quantile: float | None = None,
    cars: int = 2000,
    population: int = 64,
    seed: int = 1,
    engine: str = "reduced",
    skip: float | None = None,
    jobs: int = 1,
    folder: Path | None = None,
    check: bool = False,
    progress: Callable[[float], None] = lambda fraction: None,
) -> FoundCars:
    """Search for the parameters of a car with the best compromise of comfort, tyre load and travel (NSGA-II).

    Args:
        car: loaded by `Car.load`.
        vary: path to (lower, upper) bound in the unit of the parameter, as {"front.damper.viscous": (800, 4000)};
            "*.damper.viscous" sets all dampers alike.
        inputs: files or names of shipped ones, roads, signals; one or several.
        minimise, maximise: objectives, as "unweighted", "weighted", "tyre_load", "travel"; with several inputs
            "weighted@NAME", "weighted@mean" or "weighted@worst".
        limits: constraints, as "travel<=0.06", in the unit of the value.
        tolerances: path to half width of the production tolerance: in the unit of the parameter, or as "15%".
        samples: number of cars within the tolerances for each car tried; 8 by default.
        quantile: quantile of their values that is optimised, 0.5 to 1; the mean by default.
        cars: number of cars to try, at least 8.
        population: cars of a generation, at least 8.
        seed: seed of the search, at least 0; equal seeds give equal searches.
        engine: as in `Car.run`.
        skip: start of the evaluation [s]; by default as in `Car.run`.
        jobs: number of processes; the result does not depend on it.
        folder: existing folder in which every car is stored, for the next call to continue; None stores no cars.
        check: run the named cars with MuJoCo too.
        progress: called with the finished fraction.

    Returns:
        The Pareto front and its named cars; `print` shows them, `write` writes all files.

    Raises:
        ConfigurationError: the car lacks a path, objective or limit, or a value is out of range.
        DataError: an input cannot be read.
        MissingPartError: pymoo is not installed.
        SimulationError: no car satisfies the limits, or no car could be run.
    """
    require_counts(cars=cars, population=population, search_seed=seed)
    plan = plan_search(
        car,
        vary,
        inputs,
        minimise,
        maximise=maximise,
        limits=limits,
        tolerances=tolerances,
        samples=samples,
        quantile=quantile,
        engine=engine,
        skip=skip,
        seed=seed,
    )
    with TemporaryDirectory() as work:
        return plan.run(
            Path(work) if folder is None else folder,
            cars=cars,
            population=population,
            executor=(lambda: process_pool(jobs)) if jobs > 1 else None,
            check=check,
            progress=progress,
        )


LEAST_COUNTS = {"cars": 8, "population": 8, "search_seed": 0}
"""Minimum number of cars, number of cars of a generation, and seed."""


def require_counts(**counts: int) -> None:
    """Check the size and the seed of a search, by the names of `LEAST_COUNTS`.

    Raises:
        ConfigurationError: a value is below its minimum.
    """
    for name, number in counts.items():
        if number < LEAST_COUNTS[name]:
            raise ConfigurationError(f"--{name.replace('_', '-')} {number}: must be at least {LEAST_COUNTS[name]}")


def _ranges(vary: Mapping[str, Sequence[float]] | Sequence[Range]) -> Sequence[Range]:
    """Return the parameters of a search with their bounds."""
    if not isinstance(vary, Mapping):
        return vary
    wrong = next((path for path, bounds in vary.items() if len(bounds) != 2), None)
    if wrong is not None:
        raise ConfigurationError(f"vary {wrong}: found {vary[wrong]}, must be (lower, upper)")
    return [Range(path=path, low=low, high=high) for path, (low, high) in vary.items()]


def _quantile_and_samples(quantile: float | None, samples: int | None) -> tuple[float, int]:
    """Return the quantile, NaN for the mean, and the number of cars within the tolerances for each car tried.

    Raises:
        ConfigurationError: the quantile is out of range, or there are too few cars for the quantile.
    """
    chosen = math.nan if quantile is None else quantile
    if quantile is not None and not 0.5 <= chosen <= 1.0:
        raise ConfigurationError(f"--quantile {chosen:g}: must be 0.5 to below 1, or 1 for the worst car")
    needed = samples_for(chosen) if chosen < 1.0 else 2
    if samples is None:
        return chosen, max(8, needed)
    if samples < needed:
        raise ConfigurationError(
            f"--quantile {chosen:g}: needs at least {needed} cars, found --samples {samples}; set "
            f"--samples {needed}, a lower quantile, or --quantile 1 for the worst of {samples} cars"
        )
    return chosen, samples
