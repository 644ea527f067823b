"""Verdict: the figures of a targets file on finished runs, met, missed, or undecided within their error."""

import math
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import resources
from pathlib import Path

import numpy as np

from vehicle.engines.simulation.recording import Recording
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.model.parameters.toml_file import build, read_table
from vehicle.runs.car import Car
from vehicle.runs.car.run_twin import last_period, repeats_after
from vehicle.runs.figures.run_batch import Runs
from vehicle.runs.figures.value import require_unit, values_of
from vehicle.runs.targets.target import Target
from vehicle.signals.records.run_summary import RunSummary

MET, MISSED, UNDECIDED, NOT_RUN = "met", "missed", "undecided", "no run"
"""States of a figure."""

CONFIDENCE = 2.0
"""Standard errors between a value and its limit from which the verdict is decided: 95 % for a normal error."""

SHIPPED = "ride"
"""Name of the targets file that is shipped."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Rated:
    """Figure of a car.

    Attributes:
        value: value, that of the worst run if several belong to the figure; NaN without a run.
        error: standard error; None if unknown.
        state: `MET`, `MISSED`, `UNDECIDED` or `NOT_RUN`.
        run: name of the run; empty without one.
        runs: number of runs of the figure.
        unknown: True for a value on a random road whose standard error is unknown; the value alone decides.
    """

    value: float = math.nan
    error: float | None = None
    state: str = NOT_RUN
    run: str = ""
    runs: int = 0
    unknown: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class RatedRun:
    """Finished run for the verdict.

    Attributes:
        name: name of its folder.
        car: its car.
        recording: time histories.
        summary: content of its `summary.json`.
    """

    name: str
    car: Car
    recording: Recording
    summary: RunSummary

    @property
    def skip(self) -> float:
        """Begin of the evaluated span [s]."""
        return self.summary.evaluated_from

    @property
    def label(self) -> str:
        """Name of the car and its changed parameters, except those set by the road."""
        return ", ".join([self.summary.vehicle.name, *self.changes])

    @property
    def changes(self) -> list[str]:
        """Changed parameters of the car, "path=value", except those set by the road."""
        overrides = self.summary.vehicle.overrides
        return [text for text in overrides if not text.startswith("driving.speed=") and "one_sided=" not in text]

    @cached_property
    def runs(self) -> Runs:
        """Time histories and static data for the figures."""
        recording = self.recording
        road, obstacle = self.summary.input.road or {}, self.summary.obstacle
        plates = {wheel: recording[f"plate_{wheel}_displacement"] for wheel in recording.excited}
        return Runs(
            time=recording.time,
            channels={name: history[None] for name, history in recording.channels.items()},
            vehicles=(self.car.vehicle,),
            tyre_load={wheel: np.array([load]) for wheel, load in self.summary.static.tyre_load_n.items()},
            random=road.get("class") is not None or road.get("profile") is not None,
            left_obstacle=None if obstacle is None else obstacle.to_s,
            cars=(self.car,),
            skip=self.skip,
            band=self.summary.comfort_band,
            period=last_period(plates, recording.timestep, repeats_after(road)),
        )

    def value_of(self, target: Target) -> tuple[float, float | None]:
        """Return the value of a target on this run and its standard error; None without an error.

        Raises:
            ConfigurationError: a channel or wheel is missing in the run, or the unit of the target is wrong.
            DataError: the record is too short for the band.
        """
        chosen = target.recorded_in(tuple(self.recording.channels))
        require_unit(chosen, target.unit, self.recording.units)
        return values_of(chosen, self.runs).first()


def read_targets(file: Path | str) -> dict[str, Target]:
    """Return the figures of a targets file by the names of their tables.

    Args:
        file: TOML file with a table for each figure, see `Target`; or "ride", the shipped one.

    Raises:
        ConfigurationError: the file is missing, has no table, or a table is wrong; the message names it.
    """
    shipped = str(file) == SHIPPED and not Path(file).exists()
    path = Path(str(resources.files("vehicle.runs.targets") / f"{SHIPPED}.toml")) if shipped else Path(file)
    tables = read_table(path)
    if not tables:
        raise ConfigurationError(
            f"{path}: contains no target; write a section for each figure, for example [primary_ride]"
        )
    figures = {}
    for name, table in tables.items():
        if not isinstance(table, Mapping):
            raise ConfigurationError(f"{path}: {name}: must be a section [{name}], not {table!r}")
        try:
            figures[name] = build(Target, table, name)
        except ConfigurationError as error:
            raise ConfigurationError(f"{path}: {error}") from None
    return figures


def state_of(figure: Target, value: float, error: float | None) -> str:
    """Return the state of a figure: `MET`, `MISSED` or `UNDECIDED`.

    Args:
        value: its value; infinite for an acceleration that does not settle.
        error: standard error; None or NaN if unknown.
    """
    doubt = CONFIDENCE * error if error is not None and math.isfinite(error) else 0.0
    excess = figure.sense * (value - figure.limit)
    return MET if excess + doubt <= 0.0 else MISSED if excess - doubt > 0.0 else UNDECIDED


def verdict(figures: Mapping[str, Target], runs: Sequence[RatedRun]) -> dict[str, dict[str, Rated]]:
    """Compare the figures of finished runs with their limits.

    Returns:
        Car to the rated figures by name.

    Raises:
        ConfigurationError: a channel is not recorded, or the unit of a figure is wrong; with figure and run.
        DataError: a record is too short for a band.
    """
    rated: dict[str, dict[str, Rated]] = {run.label: {} for run in runs}
    for name, figure in figures.items():
        values: dict[str, list[Rated]] = {car: [] for car in rated}
        for run in runs:
            if not _is_on(run, figure):
                continue
            try:
                value, error = run.value_of(figure)
            except ConfigurationError as fault:
                raise ConfigurationError(f"{name} on {run.name}: {fault}") from None
            state, unknown = state_of(figure, value, error), error is None and run.runs.random and math.isfinite(value)
            values[run.label].append(
                Rated(value=value, error=error, state=state, run=run.name, runs=1, unknown=unknown)
            )
        for car, each in values.items():
            # A ratio over a channel at rest is no number, and not worse than the values of other runs.
            known = [rated_run for rated_run in each if not math.isnan(rated_run.value)] or each
            worst = max(known, key=lambda rated_run: figure.sense * rated_run.value, default=Rated())
            rated[car][name] = replace(worst, runs=len(each))
    return rated


def missing_runs(figures: Mapping[str, Target], runs: Sequence[RatedRun]) -> str:
    """Return a line on the inputs without a run, and the commands that make them; empty if every figure has its runs.

    Args:
        figures: figures with their limits.
        runs: finished runs of one or several cars.
    """
    inputs, commands, without = dict[str, None](), dict[str, None](), dict[str, None]()
    cars = {run.label: run for run in runs}
    for name, figure in figures.items():
        for label, car in cars.items():
            if not any(run.label == label and _is_on(run, figure) for run in runs):
                without[name] = inputs[figure.where] = commands[_command_for(figure, car)] = None
    if not without:
        return ""
    return (f"{len(without)} of {len(figures)} targets have no run; run {'; '.join(inputs)}: "
            f"{' && '.join(commands)}")  # fmt: skip


def _is_on(run: RatedRun, figure: Target) -> bool:
    """Return True if a run is on the input of a figure."""
    excitation = run.summary.input
    return figure.on(run.name, excitation.file, excitation.road)


def _command_for(figure: Target, run: RatedRun) -> str:
    """Return the command that runs the car of a run on the input of a figure."""
    name, file = run.summary.vehicle.name, run.summary.vehicle.file
    shipped = name in CARS and (file is None or Path(file) == vehicle_file(name))
    parts = ["python", "-m", "vehicle", "shaker", "--vehicle", name if shipped else str(file)]
    if road := figure.road or figure.obstacle:
        parts += ["--road", road, *([] if figure.speed is None else ["--speed", f"{figure.speed:g}"])]
    else:
        parts += ["--input", figure.signal or "FILE.csv"]
    for text in run.changes:
        parts += ["--set", text]
    return shlex.join([*parts, "--output", f"runs/{figure.run}"] if figure.run else parts)


def sentence(figures: Mapping[str, Target], car: str, rated: Mapping[str, Rated]) -> str:
    """Return text with the met and missed targets of a car."""

    def named(chosen: Callable[[Rated], bool]) -> list[str]:
        return [figures[name].words or name.replace("_", " ") for name, each in rated.items() if chosen(each)]

    def in_state(state: str) -> list[str]:
        return named(lambda each: each.state == state)

    met, missed, undecided, absent = (in_state(state) for state in (MET, MISSED, UNDECIDED, NOT_RUN))
    if len(absent) == len(rated):
        return f"No target was checked for {car}: none of its runs is on an input of the targets file."
    text = f"{car} meets {len(met)} of {len(rated) - len(absent)} targets"
    if missed:
        text += f" and misses {_enumeration(missed)}"
    if undecided:
        text += f"; the run is too short to decide on {_enumeration(undecided)}"
    if absent:
        text += f"; {_enumeration(absent)} had no run"
    if unknown := named(lambda each: each.unknown):
        text += f"; on another road of this kind {_enumeration(unknown)} may differ by an amount that is not known"
    return f"{text}."


def _enumeration(texts: Sequence[str]) -> str:
    """Return texts as "a, b and c"."""
    return " and ".join(filter(None, (", ".join(texts[:-1]), texts[-1])))
