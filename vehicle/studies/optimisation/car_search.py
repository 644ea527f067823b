"""A search for better parameters of a car: checked before anything is computed, then run in a folder."""

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
from vehicle.studies.optimisation.front_checks import chosen_cars, compared, left_validity, new_cars, without_tolerances
from vehicle.studies.optimisation.outcome import outcome
from vehicle.studies.optimisation.problem import Tolerance, parsed_tolerance, parsed_wishes
from vehicle.studies.optimisation.ride import ride_measure
from vehicle.studies.optimisation.search import pymoo
from vehicle.studies.optimisation.search_result import FoundCars
from vehicle.studies.optimisation.stored_search import kept_search
from vehicle.studies.optimisation.trials import ALONE, Spread, Trials, bands, on_executor, samples_for
from vehicle.studies.optimisation.variables import problem_of, require_bounds, toleranced
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.executors import process_pool
from vehicle.studies.sweeps.sweep_inputs import Source, common_start, file_of, inputs_of

Tolerances = Mapping[str, float | str] | Sequence[Tolerance]
"""Path to half of the band: in the unit of the parameter, or as "15%"."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SearchPlan:
    """A search that can be run.

    Attributes:
        trials: how cars are tried.
        vehicle: parameters of the car as it is.
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
            folder: existing folder in which every car is stored; a search in it is continued.
            cars: number of cars to try.
            population: cars of a generation.
            executor: makes what evaluates cars; this process by default.
            check: run the named cars with MuJoCo too.
            progress: called with the finished fraction.

        Raises:
            ConfigurationError: the folder holds another search.
            SimulationError: no car keeps the limits, or none could be run.
        """
        trials = self.trials
        with ExitStack() as held:
            if executor is not None:
                trials = replace(trials, evaluate=on_executor(held.enter_context(executor()), trials.measure))
            base, generations = kept_search(
                trials, folder, cars=cars, population=population, seed=self.seed, progress=progress
            )
            found = outcome(trials.problem, base, generations)
            named = chosen_cars(trials, found)
            nominal = without_tolerances(trials, found) if trials.spread.tolerances else None
            reached = new_cars(trials, found, self.seed) if trials.spread.quantile > 0.0 else None
            checked = compared(trials, found) if check else None
        return FoundCars(
            outcome=found,
            trials=self.trials,
            vehicle=self.vehicle,
            cars=named,
            skip=self.skip,
            seed=self.seed,
            nominal=nominal,
            reached=reached,
            checked=checked,
            notices=tuple(left_validity(trials, named)),
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
    """Check a search; arguments and errors of `optimise_car`."""
    pymoo("core.problem")
    vehicle, file = car.vehicle, file_of(car)
    sources = inputs_of(car, inputs)
    names = [source.name for source in sources]
    if len(set(names)) < len(names):
        raise ConfigurationError(f"inputs {', '.join(names)}: two have one name; rename a file, or give each once")
    start = common_start(sources, skip)
    wishes = parsed_wishes(minimise, maximise, limits, names)
    measure = ride_measure(vehicle, tuple(wish.number for wish in wishes), start)
    wishes = tuple(replace(wish, unit=measure.units[wish.number]) for wish in wishes)
    problem = problem_of(vehicle, _ranges(vary), wishes, names)
    require_bounds(file, car.overrides, problem)
    spread = ALONE
    if not tolerances and (samples is not None or quantile is not None):
        raise ConfigurationError("samples, quantile: belong to tolerances, and there are none")
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


def optimise_car(
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
        minimise, maximise: objectives, as "comfort", "tyre_load", "travel", "slip_share"; with several inputs
            "comfort@NAME", "comfort@mean" or "comfort@worst".
        limits: constraints, as "travel<=0.06", in the unit of the value.
        tolerances: path to half of the band within which made cars differ: in its unit, or as "15%".
        samples: made cars for each car tried; 8 by default.
        quantile: quantile of their values that counts, 0.5 to 1; the mean by default.
        cars: number of cars to try, at least 8.
        population: cars of a generation, at least 8.
        seed: one seed is one search, from 0 on.
        engine: as in `Car.run`.
        skip: start of the evaluation [s]; 2 by default, on a road see `Car.run`.
        jobs: number of processes; the result does not depend on it.
        folder: existing folder in which every car is stored, and found again by the next call; None stores none.
        check: run the named cars with MuJoCo too.
        progress: called with the finished fraction.

    Returns:
        The Pareto front and its named cars; `print` shows them, `write` writes all files.

    Raises:
        ConfigurationError: a path, bound, objective or limit that the car does not have, or a number out of range.
        DataError: an input cannot be read.
        MissingPartError: pymoo is not installed.
        SimulationError: no car keeps the limits, or none could be run.
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
"""Minimum number of cars, cars of a generation, and seed."""


def require_counts(**counts: int) -> None:
    """Check the size and the seed of a search, by the names of `LEAST_COUNTS`.

    Raises:
        ConfigurationError: one is below its minimum.
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
    """Return the quantile, NaN for the mean, and the number of made cars for each car tried.

    Raises:
        ConfigurationError: out of range, or too few cars for the quantile.
    """
    chosen = math.nan if quantile is None else quantile
    if quantile is not None and not 0.5 <= chosen <= 1.0:
        raise ConfigurationError(f"--quantile {chosen:g}: allowed are 0.5 to below 1, and 1 for the worst car")
    needed = samples_for(chosen) if chosen < 1.0 else 2
    if samples is None:
        return chosen, max(8, needed)
    if samples < needed:
        raise ConfigurationError(
            f"--quantile {chosen:g}: needs at least {needed} cars, found --samples {samples}; give "
            f"--samples {needed}, a lower quantile, or --quantile 1 for the worst of {samples} cars"
        )
    return chosen, samples
