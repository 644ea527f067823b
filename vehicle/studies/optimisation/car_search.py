"""Search for optimal parameters of a car: check all arguments first, then run in a folder."""

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.settings import with_settings
from vehicle.signals.excitation.road_drive import evaluated_from
from vehicle.studies.optimisation.front_checks import (
    mujoco_differences,
    named_cars,
    shares_as_good,
    validity_warnings,
    without_tolerances,
)
from vehicle.studies.optimisation.outcome import outcome
from vehicle.studies.optimisation.problem import parsed_criteria, parsed_tolerance
from vehicle.studies.optimisation.screening import screening
from vehicle.studies.optimisation.search import pymoo
from vehicle.studies.optimisation.search_result import FoundCars
from vehicle.studies.optimisation.search_settings import SearchSettings
from vehicle.studies.optimisation.stored_search import stored_search
from vehicle.studies.optimisation.trials import NO_TOLERANCES, Spread, Trials, bands, on_executor, samples_for
from vehicle.studies.optimisation.variables import problem_of, require_bounds, toleranced
from vehicle.studies.sweeps.case_evaluation import evaluate
from vehicle.studies.sweeps.estimate_measure import ESTIMATE, EstimateMeasure, estimate_measure
from vehicle.studies.sweeps.executors import StandingExecutor, process_pool
from vehicle.studies.sweeps.figure_inputs import require_on_inputs
from vehicle.studies.sweeps.function_measure import RunFunction, require_picklable
from vehicle.studies.sweeps.measure import Measure, chosen_measure, measure_of
from vehicle.studies.sweeps.study_size import state_size
from vehicle.studies.sweeps.sweep_inputs import Inputs, common_start, file_of, inputs_of, require_speed_of_roads

Objectives = Sequence[str] | Mapping[str, RunFunction | str]
"""Objectives of a search: names of figures, or numbers by name, each a function of a run or the name of a figure."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SearchPlan:
    """Checked search, ready to run."""

    trials: Trials  # evaluation of the cars
    vehicle: Vehicle  # parameters of the unmodified car
    skip: float  # start of the evaluation [s]
    settings: SearchSettings  # settings of the search

    def run(self, folder: Path, **changed: Any) -> FoundCars:
        """Run the search.

        Args:
            folder: existing folder in which every car is stored; an interrupted search in the folder is continued.
            changed: settings that replace settings of the plan.

        Raises:
            ConfigurationError: the folder contains another search.
            SimulationError: no car satisfies the limits, or no car could be run.
        """
        trials, settings = self.trials, replace(self.settings, **changed)
        unmodified = trials.cases(np.full((1, len(trials.problem.ranges)), math.nan))
        state_size(
            unmodified[: len(trials.inputs)],
            settings.population * len(unmodified),
            trials.measure,
            replace(settings, folder=folder),
            cars=settings.cars,
            numbers=len(trials.problem.ranges) + len(trials.problem.criteria),
        )
        jobs = settings.jobs or 1
        if settings.executor is None and jobs > 1:
            require_picklable(trials.measure)
        with ExitStack() as held:
            executor: Executor | StandingExecutor | None = None
            if settings.executor is not None or jobs > 1:
                make = settings.executor or partial(process_pool, jobs)
                executor = make if isinstance(make, Executor) else held.enter_context(StandingExecutor(make))
                trials = replace(trials, evaluate=on_executor(executor, trials.measure))
            base, generations = stored_search(trials, folder, settings)
            outcome_of_search, screened = outcome(trials.problem, base, generations), None
            if settings.screen is not None:
                assert isinstance(trials.measure, EstimateMeasure)
                trials = replace(trials, engine=settings.engine, measure=trials.measure.each)
                if executor is not None:
                    trials = replace(trials, evaluate=on_executor(executor, trials.measure))
                screened = screening(trials, outcome_of_search, settings.screen)
                outcome_of_search = screened.outcome
            cars_by_name = named_cars(trials, outcome_of_search)
            nominal = without_tolerances(trials, outcome_of_search) if trials.spread.tolerances else None
            quantile = trials.spread.quantile > 0.0
            reached = shares_as_good(trials, outcome_of_search, settings.seed) if quantile else None
            checked = mujoco_differences(trials, outcome_of_search) if settings.check else None
        return FoundCars(
            outcome=outcome_of_search,
            trials=replace(trials, evaluate=self.trials.evaluate),
            vehicle=self.vehicle,
            cars=cars_by_name,
            skip=self.skip,
            seed=settings.seed,
            nominal=nominal,
            reached=reached,
            checked=checked,
            screened=screened,
            notices=tuple(validity_warnings(trials, cars_by_name)),
        )


def plan_search(
    car: Car,
    vary: Mapping[str, Sequence[float]] | Sequence[Range],
    inputs: Inputs,
    minimise: Objectives,
    settings: SearchSettings,
) -> SearchPlan:
    """Check the arguments of a search and return the search; arguments and errors as in `optimise`."""
    pymoo("core.problem")
    vehicle, file = car.vehicle, file_of(car)
    sources = inputs_of(car, inputs, settings.skip)
    names = [source.name for source in sources]
    if len(set(names)) < len(names):
        raise ConfigurationError(f"inputs {', '.join(names)}: equal names; rename a file, or use each input once")
    start = common_start(sources, settings.skip)
    sources = [evaluated_from(source, start) for source in sources]
    functions = dict(minimise) if isinstance(minimise, Mapping) else {}
    criteria = parsed_criteria(list(minimise), settings.maximise, settings.limits, names)
    figures = {
        criterion.number: chosen_figure(criterion.number, vehicle, criterion.option)
        for criterion in criteria
        if criterion.number not in functions
    }
    measure: Measure = measure_of(vehicle, figures, start, errors=False)
    if functions:
        measure = chosen_measure(functions | {name: name for name in figures}, vehicle, start)
    criteria = tuple(replace(criterion, unit=measure.units[criterion.number]) for criterion in criteria)
    problem = problem_of(vehicle, _ranges(vary), criteria, names)
    # Both ends of a range: a search over the speed of a road gives it twice.
    require_speed_of_roads(
        sources, [[f"{each.path}={end!r}" for end in (each.low, each.high)] for each in _ranges(vary)]
    )
    ends = [[f"{each.path}={getattr(each, end)!r}" for each in _ranges(vary)] for end in ("low", "high")]
    require_on_inputs(measure, car, ends, sources)
    require_bounds(file, car.overrides, problem)
    spread = NO_TOLERANCES
    tolerances = settings.tolerances
    if not tolerances and (settings.samples is not None or settings.quantile is not None):
        raise ConfigurationError("samples, quantile: only valid with tolerances; add tolerances")
    if tolerances:
        chosen, count = _quantile_and_samples(settings.quantile, settings.samples)
        if isinstance(tolerances, Mapping):
            tolerances = [parsed_tolerance(f"{path}={size}") for path, size in tolerances.items()]
        each = toleranced(vehicle, tolerances)
        spread = Spread(tolerances=each, bands=bands(len(each), count, settings.seed), quantile=chosen)
    if settings.screen is not None:
        measure = estimate_measure(measure, vehicle, sources, alike=settings.cars)
    trials = Trials(
        problem=problem,
        inputs=sources,
        measure=measure,
        evaluate=evaluate,
        fixed=car.overrides,
        vehicle=file,
        engine=settings.engine if settings.screen is None else ESTIMATE,
        spread=spread,
    )
    return SearchPlan(trials=trials, vehicle=vehicle, skip=start, settings=settings)


@with_settings(SearchSettings)
def optimise(
    car: Car,
    vary: Mapping[str, Sequence[float]] | Sequence[Range],
    inputs: Inputs,
    minimise: Objectives,
    settings: SearchSettings,
) -> FoundCars:
    """Search for the parameters of a car with the best compromise of comfort, tyre load and travel (NSGA-II).

    Args:
        car: loaded by `Car.load`.
        vary: path to (lower, upper) bound in the unit of the parameter, e.g. {"front.damper.viscous": (800, 4000)};
            "*.damper.viscous" sets all dampers alike.
        inputs: files, names of shipped files, roads, signals; one or several.
        minimise: objectives: figures, for example "weighted", "tyre_load" or "travel", with several inputs
            "weighted@NAME", "weighted@mean" or "weighted@worst"; or {"my number": function of a run, "travel":
            "travel"}.

    Returns:
        The Pareto front and its named cars; `print` shows them, `write` writes all files.

    Raises:
        ConfigurationError: the car lacks a path, objective or limit, or a value is out of range.
        DataError: an input cannot be read.
        MissingPartError: pymoo is not installed.
        SimulationError: no car satisfies the limits, or no car could be run.
    """
    plan = plan_search(car, vary, inputs, minimise, settings)
    with TemporaryDirectory() as work:
        return plan.run(settings.folder or Path(work))


def _ranges(vary: Mapping[str, Sequence[float]] | Sequence[Range]) -> Sequence[Range]:
    """Return the parameters of a search with their bounds."""
    if not isinstance(vary, Mapping):
        return vary
    wrong = next((path for path, bounds in vary.items() if len(bounds) != 2), None)
    if wrong is not None:
        raise ConfigurationError(f"vary {wrong}: must be (lower, upper), not {vary[wrong]}")
    return [Range(path=path, low=low, high=high) for path, (low, high) in vary.items()]


def _quantile_and_samples(quantile: float | None, samples: int | None) -> tuple[float, int]:
    """Return the quantile, NaN for the mean, and the number of cars within the tolerances for each car tried."""
    chosen = math.nan if quantile is None else quantile
    needed = samples_for(chosen) if chosen < 1.0 else 2
    if samples is None:
        return chosen, max(8, needed)
    if samples < needed:
        raise ConfigurationError(
            f"--quantile {chosen:g}: needs at least {needed} cars, found --samples {samples}; set --samples {needed}, "
            f"a lower quantile, or --quantile 1 for the worst of {samples} cars"
        )
    return chosen, samples
