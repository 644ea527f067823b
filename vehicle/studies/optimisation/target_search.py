"""Smallest change of a car's parameters that meets all targets, or the targets that exclude each other."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import aligned, finite, number
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_of as parameter_value
from vehicle.model.parameters.ranges import LENGTH_OF_ONE, Range, is_coordinate
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.runs.targets.target import Target
from vehicle.runs.targets.verdict import CONFIDENCE, UNDECIDED, state_of
from vehicle.signals.analysis.ride_comfort import ERROR
from vehicle.studies.optimisation.smallest_change import SAMPLE, SAMPLE_SHARE, SmallestChange, smallest_change
from vehicle.studies.optimisation.target_measure import measures_of
from vehicle.studies.sweeps.executors import StandingExecutor, ThisProcess, process_pool
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep_settings import SweepSettings

MOST_PARAMETERS = 8
"""Maximum number of varied parameters: the quadratic surfaces need a sample of about their square."""

ERROR_WORDS = "+-: two standard errors over random roads of this class and length; within +-: another road may differ"
"""Line below figures with errors."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TargetSearch:
    """Result of a search for the smallest change."""

    car: Car  # changed car; of an infeasible problem the nearest one
    ranges: tuple[Range, ...]  # varied parameters with bounds and present values
    values: tuple[float, ...]  # their values in the changed car
    figures: Mapping[str, Target]  # figures by name
    before: tuple[float, ...]  # before, after: values of the figures of the unchanged and of the changed car
    after: tuple[float, ...]
    before_error: tuple[float, ...]  # before_error, after_error: their standard errors on random roads; NaN without one
    after_error: tuple[float, ...]
    change: SmallestChange  # result of the search
    inputs: tuple[str, ...]  # names of the inputs

    def __str__(self) -> str:
        """Return the printed tables and the result in words."""
        return "\n".join(self.lines())

    @property
    def sentence(self) -> str:
        """Return the result in words."""
        named = [figure.words or name.replace("_", " ") for name, figure in self.figures.items()]
        bound = [self.ranges[index].path for index in self.change.at_bounds]
        targets = {1: "the target", 2: "both targets"}.get(len(named), f"all {len(named)} targets")
        if self.change.feasible and self.change.cost == 0.0:
            return f"{self.car.vehicle.name} already meets {targets}."
        if self.change.feasible:
            changes = [
                f"{each.path} {_change(each, value, '+.3g')}"
                for each, value in zip(self.ranges, self.values, strict=True)
                if abs(each.coordinate(value)) > 5e-4
            ]
            binding = [named[index] for index in self.change.active]
            text = f"The smallest change that meets {targets}: {', '.join(changes)}."
            if not binding:
                return text
            limits, them = ("limit that binds is", "it") if len(binding) == 1 else ("limits that bind are", "them")
            return (
                f"{text} The {limits} {' and '.join(binding)}: the car just meets {them} and may miss {them} on "
                "another road; check with report --targets, or search with a stricter limit."
            )
        worst, *others = sorted(self.change.active, key=lambda index: -self.change.excess[index])
        text = (
            f"No car within the bounds meets {targets}; the best one misses {named[worst]} by "
            f"{100.0 * self.change.excess[worst]:.3g} %"
        )
        if others:
            text += f" and is at the limit of {' and '.join(named[index] for index in others)}"
        return text + (f"; the search stops at the bound of {' and '.join(bound)}." if bound else ".")

    def rows(self) -> list[tuple[str, str, str, str, str, str]]:
        """Return name, input, limit with unit, both values with two standard errors, and the state as texts."""

        def text(value: float, error: float) -> str:
            if not math.isfinite(value):
                return "not settled"
            return number(value) + (f" +- {number(CONFIDENCE * error, 2)}" if error > 0.0 else "")

        def state(figure: Target, value: float, error: float) -> str:
            certain = state_of(figure, value, error if error > 0.0 else None) != UNDECIDED
            return state_of(figure, value, None) + ("" if certain else " within +-")

        both = [zip(*pair, strict=True) for pair in ((self.before, self.before_error), (self.after, self.after_error))]
        return [
            (
                figure.words or name.replace("_", " "),
                figure.where,
                f"{'<=' if figure.sense > 0 else '>='} {number(figure.limit)} {figure.unit}",
                text(*before),
                text(*after),
                state(figure, *after),
            )
            for (name, figure), before, after in zip(self.figures.items(), *both, strict=True)
        ]

    def lines(self) -> list[str]:
        """Return the printed tables of parameters and figures, and the result in words."""
        parameters = [("parameter", "before", "after", "change", "within")]
        parameters += [
            (
                each.path,
                number(each.start, 4),
                number(value, 4),
                _change(each, value, "+.2f"),
                f"{number(each.low, 4)} to {number(each.high, 4)}",
            )
            for each, value in zip(self.ranges, self.values, strict=True)
        ]
        figures = [("target", "input", "limit", "before", "after", "now"), *self.rows()]
        errors = [ERROR_WORDS] if any(error > 0.0 for error in self.after_error) else []
        return [*aligned(parameters), *aligned(figures), *errors, self.sentence]

    def summary(self) -> dict[str, Any]:
        """Return the result for `summary.json`."""
        keys = ("before", "after", "before_error", "after_error")
        return {
            "feasible": self.change.feasible,
            "sentence": self.sentence,
            "cars": self.change.runs,
            "inputs": list(self.inputs),
            "parameters": {
                each.path: {"before": each.start, "after": value, "low": each.low, "high": each.high}
                for each, value in zip(self.ranges, self.values, strict=True)
            },
            "figures": {
                name: {"limit": figure.limit, "unit": figure.unit, **dict(zip(keys, map(finite, values), strict=True))}
                for (name, figure), *values in zip(
                    self.figures.items(), *(getattr(self, key) for key in keys), strict=True
                )
            },
        }


def meet_targets(
    car: Car,
    figures: Mapping[str, Target],
    ranges: Sequence[Range],
    *,
    duration: float | None = None,
    costs: Mapping[str, float] | None = None,
    jobs: int = 1,
    progress: Callable[[float], None] | None = None,
) -> TargetSearch:
    """Search for the smallest change of parameters with which a car meets all targets, with the reduced engine.

    The size of a change is the root of the sum of (c ln(value / present value))^2 over the parameters; for a coordinate
    the logarithm is (value - present value) / `LENGTH_OF_ONE`.

    Args:
        car: car loaded by `Car.load`.
        figures: figures with their limits and inputs, see `vehicle.runs.targets.verdict.read_targets`.
        ranges: parameters with their bounds, which contain the present values.
        duration: length of a road class [s]; by default the length of a run.
        costs: path to cost c of a parameter; 1 by default.
        jobs: number of processes.
        progress: called with the finished fraction.

    Raises:
        ConfigurationError: a figure without an input or with an unknown channel, a parameter that is neither positive
            nor a coordinate, or bounds without the present value.
        SimulationError: the unchanged car cannot be run.
    """
    started = tuple(_with_start(car.vehicle, each) for each in ranges)
    if not 1 <= len(started) <= MOST_PARAMETERS:
        raise ConfigurationError(f"--vary: found {len(started)} parameters, must be 1 to {MOST_PARAMETERS}")
    measures = dict(measures_of(car, figures, duration))
    names = list(figures)
    scale = np.array([figure.weight / (abs(figure.limit) or 1.0) for figure in figures.values()])
    limits, senses = (np.array([getattr(each, key) for each in figures.values()]) for key in ("limit", "sense"))

    def values(positions: Vector, executor: StandingExecutor) -> Vector:
        changes = [_texts(started, position) for position in positions]
        # An exact figure, for example a natural frequency, has no standard error.
        columns = {f"{name}{ERROR}": np.full(len(changes), np.nan) for name in names}
        for index, (source, measure) in enumerate(measures.items()):
            settings = SweepSettings(engine="reduced", measure=measure, skip=measure.skip, executor=executor, jobs=jobs)
            plan = plan_sweep(car, changes, source, settings)

            def report(part: float, done: float = index / len(measures)) -> None:
                # The cars of the sample take long; the cars of a step are few.
                if progress is not None and len(changes) >= SAMPLE:
                    progress(SAMPLE_SHARE * (done + part / len(measures)))

            table = plan.run(progress=report)
            # With one change the sweep runs the unchanged car first.
            columns |= {name: table.column(name)[-len(changes) :] for name in measure.units}
        return np.stack([columns[f"{name}{suffix}"] for suffix in ("", ERROR) for name in names], axis=1)

    low, high = (np.array([each.coordinate(getattr(each, key)) for each in started]) for key in ("low", "high"))
    # The processes of all batches of cars: each imports the program and builds the reference car once.
    with StandingExecutor(partial(process_pool, jobs) if jobs > 1 else ThisProcess) as executor:
        change = smallest_change(
            lambda positions: scale * senses * (values(positions, executor)[:, : len(names)] - limits),
            low,
            high,
            np.array([(costs or {}).get(each.path, 1.0) for each in started]),
            progress=progress,
        )
        ends = values(np.stack([np.zeros(len(started)), change.position]), executor).reshape(2, 2, -1).tolist()
    (before, before_error), (after, after_error) = (tuple(map(tuple, end)) for end in ends)
    changed = {each.path: each.value(float(u)) for each, u in zip(started, change.position, strict=True)}
    return TargetSearch(
        car=car.with_(changed),
        ranges=started,
        values=tuple(changed.values()),
        figures=figures,
        before=before,
        after=after,
        before_error=before_error,
        after_error=after_error,
        change=replace(change, excess=change.excess / np.array([figure.weight for figure in figures.values()])),
        inputs=tuple(str(source) for source in measures),
    )


def outlook(ranges: int, figures: Mapping[str, Target], duration: float) -> str:
    """Return text on the cars of a search before it begins; it has no time limit.

    Args:
        ranges: number of varied parameters.
        figures: figures with their inputs.
        duration: length of a road class [s].
    """
    inputs = {(each.road or each.obstacle or each.signal, each.speed) for each in figures.values()}
    text = f"{SAMPLE} cars, then steps of {ranges + 1} cars from up to 3 starts, on {len(inputs)} input"
    text += "" if len(inputs) == 1 else "s"
    if not any(len(each.road) == 1 for each in figures.values()):
        return text
    shorter = "a quarter of the --duration takes a quarter of the time and doubles the errors"
    return f"{text}; roads of {number(duration)} s: {shorter}"


def _texts(ranges: Sequence[Range], position: Vector) -> tuple[str, ...]:
    return tuple(f"{each.path}={each.value(float(u))!r}" for each, u in zip(ranges, position, strict=True))


def _change(bounds: Range, value: float, digits: str) -> str:
    """Return the change of a parameter as text: in percent, of a coordinate in mm."""
    if bounds.is_linear:
        return f"{1e3 * (value - bounds.start):{digits}} mm"
    return f"{bounds.percent(value - bounds.start, bounds.start):{digits}} %"


def _with_start(vehicle: Vehicle, bounds: Range) -> Range:
    """Return bounds with the present value as their start."""
    start = float(parameter_value(vehicle, bounds.path))
    linear = is_coordinate(vehicle, bounds.path)
    if not (bounds.low <= start <= bounds.high and (linear or bounds.low > 0.0)):
        raise ConfigurationError(
            f"--vary {bounds.path}={bounds.low:g}:{bounds.high:g}: bounds must {'' if linear else 'be above 0 and '}"
            f"contain the present value {start:g}, from which the change counts"
        )
    # A present value at a bound is allowed: the search then goes one way. A range needs a start strictly inside.
    slack = 1e-12 * (LENGTH_OF_ONE if linear else start)
    low, high = min(bounds.low, start - slack), max(bounds.high, start + slack)
    return replace(bounds, low=low, high=high, start=start, length=LENGTH_OF_ONE if linear else math.nan)
