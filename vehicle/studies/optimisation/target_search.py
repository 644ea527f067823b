"""Smallest change of a car's parameters that meets all targets, or the targets that exclude each other."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError, VehicleError
from vehicle.model.parameters.channel_words import channels_named
from vehicle.model.parameters.paths import value_of as parameter_value
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.runs.targets.figure import Figure
from vehicle.runs.targets.values import Histories, value_of
from vehicle.runs.targets.verdict import state_of
from vehicle.studies.optimisation.problem import Vector
from vehicle.studies.optimisation.smallest_change import SmallestChange, smallest_change
from vehicle.studies.sweeps.executors import StandingExecutor, ThisProcess, process_pool
from vehicle.studies.sweeps.measure import STEP, of_one
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.run_batch import Runs
from vehicle.studies.sweeps.sweep_settings import SweepSettings

MOST_PARAMETERS = 8
"""Maximum number of varied parameters: the quadratic surfaces need a sample of about their square."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TargetMeasure:
    """Measure of the figures of one input.

    Attributes:
        figures: name and figure, with channels by name.
        wheels: wheels of the car.
        dampers: wheels with a damper.
        skip: excluded time at the beginning [s].
        left_obstacle: time at which the last wheel leaves an obstacle [s]; None without an obstacle.
        timestep: maximum step of the reduced engine [s].
    """

    figures: tuple[tuple[str, Figure], ...]
    wheels: tuple[str, ...]
    dampers: tuple[str, ...]
    skip: float
    left_obstacle: float | None = None
    timestep: float = STEP

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        names: list[str] = []
        for _, figure in self.figures:
            names += [*figure.channels, *figure.over]
            if figure.quantity == "tyre_load":
                names += [f"tyre_{wheel}_force_z" for wheel in figure.wheels or self.wheels]
            elif figure.quantity in ("stick_share", "travel"):
                names += [f"damper_{wheel}_velocity" for wheel in figure.wheels or self.dampers]
        return tuple(dict.fromkeys(names))

    @property
    def units(self) -> Mapping[str, str]:
        """Return name of each figure to its unit."""
        return {name: figure.unit for name, figure in self.figures}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the figures of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the figures of r runs, (r,) each."""
        columns: dict[str, list[float]] = {name: [] for name, _ in self.figures}
        for row, limit in enumerate(runs.slip_velocity if self.dampers else np.zeros(len(runs.vehicles))):
            samples = {channel: runs[channel][row] for channel in self.channels}
            ride = Histories(
                time=runs.time,
                of=samples.__getitem__,
                unit=str,
                named=tuple,
                skip=self.skip,
                tyre_load={wheel: float(loads[row]) for wheel, loads in runs.tyre_load.items()},
                dampers=self.dampers,
                slip_velocity=float(limit),
                left_obstacle=self.left_obstacle,
            )
            for name, figure in self.figures:
                # The unit was compared with the run of the unchanged car.
                columns[name].append(value_of(figure, ride, checked=True)[0])
        return {name: np.array(values) for name, values in columns.items()}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TargetSearch:
    """Result of a search for the smallest change.

    Attributes:
        car: changed car; of an infeasible problem the nearest one.
        ranges: varied parameters with bounds and present values.
        values: their values in the changed car.
        figures: figures by name.
        before, after: values of the figures of the unchanged and of the changed car.
        change: result of the search.
        inputs: names of the inputs.
    """

    car: Car
    ranges: tuple[Range, ...]
    values: tuple[float, ...]
    figures: Mapping[str, Figure]
    before: tuple[float, ...]
    after: tuple[float, ...]
    change: SmallestChange
    inputs: tuple[str, ...]

    def __str__(self) -> str:
        """Return the printed tables and the result in words."""
        return "\n".join(self.lines())

    @property
    def sentence(self) -> str:
        """Return the result in words."""
        named = [figure.words or name.replace("_", " ") for name, figure in self.figures.items()]
        bound = [self.ranges[index].path for index in self.change.at_bounds]
        if self.change.feasible and self.change.cost == 0.0:
            return f"{self.car.vehicle.name} meets all {len(named)} targets as it is."
        if self.change.feasible:
            changes = [
                f"{each.path} {100.0 * (value / each.start - 1.0):+.3g} %"
                for each, value in zip(self.ranges, self.values, strict=True)
                if abs(value / each.start - 1.0) > 5e-4
            ]
            decisive = [named[index] for index in self.change.active]
            text = f"The smallest change that meets all {len(named)} targets: {', '.join(changes)}"
            if not decisive:
                return f"{text}."
            return (
                f"{text}; decisive is {' and '.join(decisive)}. There the car is just at the limit, and on another "
                "road it may miss it: check it with report --targets, or search with a stricter limit."
            )
        worst, *others = sorted(self.change.active, key=lambda index: -self.change.excess[index])
        text = (
            f"No car within these bounds meets all {len(named)} targets: {named[worst]} misses its limit by "
            f"{100.0 * self.change.excess[worst]:.3g} % at best"
        )
        if others:
            text += f"; there {' and '.join(named[index] for index in others)} is at the limit, too"
        return text + (f"; the bound of {' and '.join(bound)} stops the search." if bound else ".")

    def rows(self) -> list[tuple[str, str, str, str, str, str]]:
        """Return name, input, limit with unit, both values and the state of each figure as texts."""
        return [
            (
                figure.words or name.replace("_", " "),
                figure.where,
                f"{'<=' if figure.sense > 0 else '>='} {number(figure.limit)} {figure.unit}",
                number(before) if math.isfinite(before) else "not settled",
                number(after) if math.isfinite(after) else "not settled",
                state_of(figure, after, None),
            )
            for (name, figure), before, after in zip(self.figures.items(), self.before, self.after, strict=True)
        ]

    def lines(self) -> list[str]:
        """Return the printed tables of parameters and figures, and the result in words."""
        parameters = [("parameter", "before", "after", "change", "within")]
        parameters += [
            (
                each.path,
                number(each.start, 4),
                number(value, 4),
                f"{100.0 * (value / each.start - 1.0):+.2f} %",
                f"{number(each.low, 4)} to {number(each.high, 4)}",
            )
            for each, value in zip(self.ranges, self.values, strict=True)
        ]
        figures = [("target", "input", "limit", "before", "after", "now"), *self.rows()]
        return [*_aligned(parameters), *_aligned(figures), self.sentence]

    def summary(self) -> dict[str, Any]:
        """Return the result for `summary.json`."""
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
                name: {"limit": figure.limit, "unit": figure.unit, "before": _finite(before), "after": _finite(after)}
                for (name, figure), before, after in zip(self.figures.items(), self.before, self.after, strict=True)
            },
        }


def meet_targets(
    car: Car,
    figures: Mapping[str, Figure],
    ranges: Sequence[Range],
    *,
    duration: float | None = None,
    costs: Mapping[str, float] | None = None,
    jobs: int = 1,
    progress: Callable[[float], None] | None = None,
) -> TargetSearch:
    """Search for the smallest change of parameters with which a car meets all targets, with the reduced engine.

    The size of a change is the root of the sum of (c ln(value / present value))^2 over the parameters.

    Args:
        car: car loaded by `Car.load`.
        figures: figures with their limits and inputs, see `vehicle.runs.targets.verdict.read_targets`.
        ranges: parameters with their bounds, which contain the present values.
        duration: length of a road class [s]; by default that of a run.
        costs: path to cost c of a parameter; 1 by default.
        jobs: number of processes.
        progress: called with the finished fraction.

    Raises:
        ConfigurationError: a figure without an input or with an unknown channel, a parameter that is not positive, or
            bounds without the present value.
        SimulationError: the unchanged car cannot be run.
    """
    started = tuple(_with_start(car.vehicle, each) for each in ranges)
    if not 1 <= len(started) <= MOST_PARAMETERS:
        raise ConfigurationError(f"--vary: {len(started)} parameters; must be 1 to {MOST_PARAMETERS}")
    measures = dict(_measures(car, figures, duration))
    names = list(figures)
    scale = np.array([figure.weight / (abs(figure.limit) or 1.0) for figure in figures.values()])
    limits, senses = (np.array([getattr(each, key) for each in figures.values()]) for key in ("limit", "sense"))

    def values(positions: Vector, executor: StandingExecutor) -> Vector:
        changes = [_texts(started, position) for position in positions]
        columns: dict[str, Vector] = {}
        for source, measure in measures.items():
            settings = SweepSettings(engine="reduced", measure=measure, skip=measure.skip, executor=executor)
            table = plan_sweep(car, changes, source, settings).run()
            # With one change the sweep runs the unchanged car first.
            columns |= {name: table.column(name)[-len(changes) :] for name in measure.units}
        return np.stack([columns[name] for name in names], axis=1)

    low, high = (np.log([getattr(each, key) / each.start for each in started]) for key in ("low", "high"))
    # The processes of all batches of cars: each imports the program and builds the reference car once.
    with StandingExecutor(partial(process_pool, jobs) if jobs > 1 else ThisProcess) as executor:
        change = smallest_change(
            lambda positions: scale * senses * (values(positions, executor) - limits),
            low,
            high,
            np.array([(costs or {}).get(each.path, 1.0) for each in started]),
            progress=progress,
        )
        before, after = values(np.stack([np.zeros(len(started)), change.position]), executor)
    changed = {each.path: each.start * math.exp(u) for each, u in zip(started, change.position, strict=True)}
    return TargetSearch(
        car=car.with_(changed),
        ranges=started,
        values=tuple(changed.values()),
        figures=figures,
        before=tuple(before.tolist()),
        after=tuple(after.tolist()),
        change=replace(change, excess=change.excess / np.array([figure.weight for figure in figures.values()])),
        inputs=tuple(str(source) for source in measures),
    )


def _texts(ranges: Sequence[Range], position: Vector) -> tuple[str, ...]:
    return tuple(f"{each.path}={each.start * math.exp(u)!r}" for each, u in zip(ranges, position, strict=True))


def _with_start(vehicle: Vehicle, bounds: Range) -> Range:
    """Return bounds with the present value as their start.

    Raises:
        ConfigurationError: the value is not positive, or outside the bounds.
    """
    start = float(parameter_value(vehicle, bounds.path))
    if not 0.0 < bounds.low <= start <= bounds.high:
        raise ConfigurationError(
            f"--vary {bounds.path}={bounds.low:g}:{bounds.high:g}: the car has {start:g}; the bounds must be above 0 "
            "and contain it, as the change is counted from it"
        )
    # A present value at a bound is allowed: the search then goes one way. A range needs a start strictly inside.
    low, high = min(bounds.low, start * (1.0 - 1e-12)), max(bounds.high, start * (1.0 + 1e-12))
    return replace(bounds, low=low, high=high, start=start)


def _measures(
    car: Car, figures: Mapping[str, Figure], duration: float | None
) -> list[tuple[str | Road, TargetMeasure]]:
    """Return each input of the figures and the measure of its figures."""
    groups: dict[tuple[str, float | None], list[tuple[str, Figure]]] = {}
    for name, figure in figures.items():
        if figure.run or not (figure.road or figure.obstacle or figure.signal):
            raise ConfigurationError(
                f"{name}: a search needs the input of the target; set road or obstacle with speed, or signal, "
                "and remove run"
            )
        if not figure.signal and figure.speed is None:
            raise ConfigurationError(f"{name}: speed [km/h] is missing; a search needs it")
        groups.setdefault((figure.road or figure.obstacle or figure.signal, figure.speed), []).append((name, figure))
    measures = []
    for (source_name, speed), group in groups.items():
        source: str | Road = source_name
        if speed is not None:
            source = Road(source_name, speed, duration=duration if len(source_name) == 1 else None)
        try:
            run = car.run(source, engine="reduced")
            chosen = tuple((name, _checked(name, figure, run)) for name, figure in group)
        except DataError as error:
            raise ConfigurationError(f"{source_name}: {error}") from None
        times = (run.road or {}).get("obstacle_s")
        measures.append(
            (
                source,
                TargetMeasure(
                    figures=chosen,
                    wheels=car.vehicle.wheels,
                    dampers=car.vehicle.damped_wheels,
                    skip=run.skip,
                    left_obstacle=float(times[1]) if isinstance(times, Sequence) else None,
                ),
            )
        )
    return measures


def _checked(name: str, figure: Figure, run: Run) -> Figure:
    """Return a figure with its channels by name.

    Raises:
        ConfigurationError: a channel is not recorded, or the unit is wrong.
    """
    recorded = tuple(run.recording.channels)
    try:
        channels, over = (channels_named(texts, recorded) for texts in (figure.channels, figure.over))
    except VehicleError as error:
        raise ConfigurationError(f"{name}: {error}") from None
    units = {run.recording.units[channel] for channel in channels}
    if figure.quantity in ("rms", "peak", "peak_to_peak") and units != {figure.unit}:
        raise ConfigurationError(f"{name}: unit: found {figure.unit!r}, the channels have {', '.join(sorted(units))!r}")
    return replace(figure, channels=channels, over=over)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return rows of texts as lines with aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
