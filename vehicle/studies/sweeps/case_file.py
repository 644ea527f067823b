"""Cases of a file: roads and speeds, laden states and variants of a car, run as one sweep in one table."""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import aligned
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.parameter_list import flattened
from vehicle.model.parameters.paths import assignments
from vehicle.model.parameters.toml_file import build, read_table
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED
from vehicle.signals.formats.csv_table import RowWriter
from vehicle.studies.sweeps.change_error import (
    MEANING_OF_ERROR,
    NO_ERROR,
    NO_PERCENTAGE,
    UNKNOWN_ERROR,
    change_errors,
    half_width,
)
from vehicle.studies.sweeps.evaluation import REPEAT, Evaluation, Part, runs_part
from vehicle.studies.sweeps.plan import SweepPlan, plan_sweep
from vehicle.studies.sweeps.sweep_inputs import Inputs
from vehicle.studies.sweeps.sweep_ranking import SweptCases, figure_names, is_comfort
from vehicle.studies.sweeps.sweep_settings import SweepSettings

CASES = "cases.csv"
"""Name of the file in the folder of a sweep."""

UNCHANGED = "as it is"
"""Name of the car without changes."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CaseFile:
    """Cases of a file: every car on every input; a car is a laden state with a variant.

    Attributes:
        roads: classes of ISO 8608 and obstacles, for example "C" and "cleat:20x50".
        speeds: speeds on each of them [km/h]; or a table of each road to its speeds, for example {C = [80], D = [50]}.
        signals: signal files, or names of shipped files.
        duration: length of a class [s]; by default that of a run.
        vehicle: name or file of the car; by default that of the study.
        states: name of a laden state to its changed parameters.
        variants: name of a variant to its changed parameters.
    """

    roads: tuple[str, ...] = ()
    speeds: tuple[float, ...] | Mapping[str, tuple[float, ...]] = ()
    signals: tuple[str, ...] = ()
    duration: float | None = None
    vehicle: str = ""
    states: Mapping[str, dict] = field(default_factory=dict)  # type: ignore[type-arg]
    variants: Mapping[str, dict] = field(default_factory=dict)  # type: ignore[type-arg]

    def __post_init__(self) -> None:
        if not self.roads and not self.signals:
            raise ConfigurationError('CaseFile.roads: no input; set roads = ["C"] and speeds = [80], or signals')
        if bool(self.roads) != bool(self.speeds):
            raise ConfigurationError("CaseFile.speeds: set roads and speeds [km/h] together")
        by_road = self.speeds if isinstance(self.speeds, Mapping) else dict.fromkeys(self.roads, self.speeds)
        for name in (*by_road, *self.roads):
            if name not in self.roads:
                raise ConfigurationError(f"CaseFile.speeds: {name!r} is not among roads; add it there, or remove it")
            if not by_road.get(name):
                raise ConfigurationError(f"CaseFile.speeds: no speed on {name!r}; add {name!r} = [80], in km/h")

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Return the checked sweep of every car of the file, on its inputs; see `Design`.

        Raises:
            ConfigurationError: a measure with several figures, or without a name for its values.
        """
        plan = plan_sweep(car, list(self.cars.values()), self.inputs, settings, self._evaluation)
        names = figure_names(plan.measure.units) if plan.measure.units else ()
        if len(names) != 1:
            figures = ", ".join(names) or "a function without names"
            raise ConfigurationError(f"--measure: the cars of a file are compared by one figure; found {figures}")
        return plan

    def _evaluation(self, table: SweptCases, caption: str) -> Evaluation:
        results = case_results(table, self)

        def parts(notes: Sequence[str]) -> list[Part]:
            values = {"results": results, "notes": notes}
            return [Part("Result", "result", "cases", values), runs_part(table), REPEAT]

        return Evaluation(results.lines(), {CASES: partial(write_cases, results=results)}, parts)

    @property
    def inputs(self) -> list[Road | str]:
        """Return every road at every speed, then the signals."""
        return [
            *(
                Road(name, speed, duration=self.duration if len(name) == 1 else None)
                for name in self.roads
                for speed in (self.speeds[name] if isinstance(self.speeds, Mapping) else self.speeds)
            ),
            *self.signals,
        ]

    @property
    def base_names(self) -> list[str]:
        """Return for each of `cars` the car without a variant in the same laden state, with which it is compared."""
        names = ((state, variant) for state in ("", *self.states) for variant in ("", *self.variants))
        return [state or UNCHANGED for state, _ in names]

    @property
    def cars(self) -> dict[str, tuple[str, ...]]:
        """Return name to texts "path=value" of every laden state with every variant, the unchanged car first."""
        listed = {UNCHANGED: ()} | {
            ", ".join(filter(None, names)): (*state, *variant)
            for names, state, variant in (
                ((first, second), _texts(self.states, first), _texts(self.variants, second))
                for first, second in itertools.product(("", *self.states), ("", *self.variants))
            )
            if any(names)
        }
        named: dict[tuple[str, ...], str] = {}
        for name, texts in listed.items():
            if (other := named.setdefault(texts, name)) != name:
                raise ConfigurationError(f"cases {other!r} and {name!r} are the same car: remove one of them")
        return listed


def _texts(tables: Mapping[str, Mapping[str, Any]], name: str) -> tuple[str, ...]:
    """Return the changes of a state or a variant; none for an empty name."""
    return tuple(assignments(dict(flattened(tables[name], "")))) if name else ()


def read_cases(file: Path) -> CaseFile:
    """Read the cases of a TOML file."""
    try:
        cases = build(CaseFile, read_table(file))
        if not cases.states and not cases.variants:
            raise ConfigurationError(
                'no states and no variants: add one, for example [variants.soft] with "damper.viscous" = 900'
            )
        return cases
    except ConfigurationError as error:
        text = str(error)
        raise ConfigurationError(text if text.startswith(str(file)) else f"{file}: {text}") from None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CaseResults:
    """Comfort of every car on every input; variants are compared within a laden state, which is no design choice."""

    cars: tuple[str, ...]  # names of the cars, the unchanged one first
    bases: tuple[int, ...]  # number of the car without a variant in the state of each car
    inputs: tuple[str, ...]  # names of the inputs
    name: str  # name, unit: compared figure, for example "weighted", and its unit
    unit: str
    values: Vector  # the figure, NaN for a failed run or an undefined value; (inputs, cars)
    # unweighted comfort [m/s2], NaN for a failed run, (inputs, cars); None for another figure
    unweighted: Vector | None
    errors: Vector  # standard errors of the changes from the base of each car, 0 on one event; (inputs, cars)
    event: bool  # True if all inputs are single events

    @property
    def half_widths(self) -> Vector:
        """Return the half width of the 95 % interval of each change [%], NaN on one event, (inputs + 1, cars).

        The last row is that of the mean change.
        """
        relative = 100.0 * (self.errors / np.abs(self._base_values)).T
        each = [half_width(relative[:, [number]]) for number in range(len(self.inputs))]
        return np.array([*each, half_width(relative)])

    @property
    def changes(self) -> Vector:
        """Return the change of the figure from the base of each car on the same input [%], (inputs, cars)."""
        base = self._base_values
        return np.asarray(100.0 * np.sign(base) * (self.values / base - 1.0))

    @property
    def _base_values(self) -> Vector:
        """Values of the base of each car, NaN for 0, which has no percentage; (inputs, cars)."""
        base = self.values[:, list(self.bases)]
        return np.where(base == 0.0, np.nan, base)

    def rows(self, sign: str = "+-") -> list[list[str]]:
        """Return the head and a row for each car as texts: figure and change on each input, mean change.

        Args:
            sign: sign before the half width of the mean change.
        """
        heads = ["car", *(f"{name} [{self.unit}]" for name in self.inputs), "mean change"]
        rows, widths = [heads], self.half_widths[-1]
        for number, car in enumerate(self.cars):
            cells = []
            for value, change in zip(self.values[:, number], self.changes[:, number], strict=True):
                cell = f"{value:.4g}" if math.isfinite(value) else "no value"
                varied = self.bases[number] != number
                cells.append(f"{cell} ({change:+.1f} %)" if varied and math.isfinite(change) else cell)
            mean = float(np.mean(self.changes[:, number]))
            error = f" {sign} {widths[number]:.1f}" if widths[number] > 0.0 else ""
            rows.append(
                [car, *cells, "base" if not varied else f"{mean:+.1f}{error} %" if math.isfinite(mean) else "-"]
            )
        return rows

    def lines(self) -> list[str]:
        """Return the printed table, and the best car in words."""
        meaning = "" if self.unweighted is None else ": RMS with the weightings for a seat (ISO 2631-1)"
        return [*aligned(self.rows()), f"{self.name}{meaning}; {self.error_words}", self.sentence]

    @property
    def error_words(self) -> str:
        """Meaning of the half widths, or the reason why an event has no error."""
        unknown = self.unweighted is None and not self.event
        return MEANING_OF_ERROR if np.any(self.half_widths > 0.0) else UNKNOWN_ERROR if unknown else NO_ERROR

    @property
    def sentence(self) -> str:
        """Return text on the variant with the lowest mean change in each laden state."""
        states = dict.fromkeys(self.bases)
        if all(self.bases[number] == number for number in range(len(self.cars))):
            return "The file has no variants to compare: the load is not a design choice, so no state is ranked."
        return " ".join(self._best_in(base, several=len(states) > 1) for base in states)

    def _best_in(self, base: int, *, several: bool) -> str:
        """Return text on the variant with the lowest mean change in a state; `several` for more than one state."""
        means, name = np.mean(self.changes, axis=0), self.cars[base]
        state = f"{name}: " if several else ""
        variants = [number for number, each in enumerate(self.bases) if each == base and math.isfinite(means[number])]
        if not variants:
            return f"{state or 'Result: '}no car has a value of {self.name} on all inputs."
        best = min(variants, key=lambda number: float(means[number]))
        over = "over all inputs" if len(self.inputs) > 1 else f"on {self.inputs[0]}"
        over = over if several else f"{over[0].upper()}{over[1:]}"
        comfort = self.unweighted is not None
        if best == base:
            better = "is smoother" if comfort else f"has a lower {self.name}"
            return f"{state}{over} no variant {better} than the car without a variant."
        doubt = ", within the error" if abs(means[best]) <= self.half_widths[-1, best] else ""
        variant = self.cars[best].removeprefix(f"{name}, ")
        change = f"{means[best]:+.1f} % from the car without a variant"
        named = "the smoothest variant is" if comfort else f"the variant with the lowest {self.name} is"
        return f"{state}{over} {named} {variant!r}: {change}{doubt}."


def case_results(table: SweptCases, cases: CaseFile) -> CaseResults:
    """Return the figure of a sweep over the cars of a file.

    Args:
        table: the table, the inputs varying slowest.

    Raises:
        DataError: the figure of a car without a variant is 0.
    """
    cars = list(cases.cars)
    bases = [cars.index(name) for name in cases.base_names]
    name = figure_names(table.units)[0]
    inputs = dict.fromkeys(case.source.name for case in table.cases)
    rows, numbers = list(table.rows()), np.arange(len(table.cases)).reshape(len(inputs), -1).T.tolist()
    values = table.column(name).reshape(len(inputs), -1)
    for base, source in itertools.product(dict.fromkeys(bases) if cases.variants else (), range(len(inputs))):
        if values[source, base] == 0.0:
            where = f"{name} of {cars[base]!r} on {list(inputs)[source]}"
            raise DataError(f"--cases: {where} is 0, so {NO_PERCENTAGE}")
    errors, events = np.zeros((len(cars), len(inputs))), np.zeros(len(inputs))
    for base in dict.fromkeys(bases):
        in_state = [number for number, each in enumerate(bases) if each == base]
        errors[in_state], events = change_errors(rows, [numbers[number] for number in in_state], name)
    unweighted = name.replace(WEIGHTED, UNWEIGHTED) if is_comfort(table.units) else ""
    return CaseResults(
        cars=tuple(cars),
        bases=tuple(bases),
        inputs=tuple(inputs),
        name=name,
        unit=table.units[name],
        values=values,
        unweighted=table.column(unweighted).reshape(len(inputs), -1) if unweighted else None,
        errors=errors.T,
        event=bool(events.all()),
    )


def write_cases(path: Path, results: CaseResults) -> None:
    """Write a row for each car and input.

    Args:
        path: CSV file.
        results: see `case_results`.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = RowWriter(file)
        columns = {f"{results.name} [{results.unit}]": results.values, "change [%]": results.changes}
        if results.unweighted is not None:
            columns["unweighted [m/s2]"] = results.unweighted
        columns["half_width_95 [%]"] = results.half_widths
        rows.writerow(["input", "car", *columns])
        for number, source in enumerate(results.inputs):
            for car, *values in zip(results.cars, *(column[number] for column in columns.values()), strict=True):
                rows.writerow([source, car, *(f"{value:.6g}" if math.isfinite(value) else "" for value in values)])
