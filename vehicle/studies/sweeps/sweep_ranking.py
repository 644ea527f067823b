"""Cars of a sweep ranked by comfort: mean over all inputs, best car, base car, and their printed table."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, Protocol

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import aligned, decimals
from vehicle.digits import number as number_text
from vehicle.errors import DataError
from vehicle.model.parameters.parameter_list import value_text
from vehicle.model.parameters.paths import unit_of_override, values_of_override
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.analysis.ride_comfort import ERROR, MEANING, SEAT_PREFIX, SEAT_VALUE, UNWEIGHTED, WEIGHTED
from vehicle.studies.sweeps.case import Case, parameter_cells
from vehicle.studies.sweeps.case_result import Row
from vehicle.studies.sweeps.change_error import MEANING_OF_ERROR, NO_ERROR, change_errors, half_width
from vehicle.studies.sweeps.estimate_measure import ESTIMATE, WORDS

RANKED_BY = (f"{SEAT_PREFIX}{WEIGHTED}", WEIGHTED)
"""Columns by which cars are ranked: on the cushion of a car with a seat, otherwise at the seat rail."""

ROUNDING = 1e-6
"""Relative difference of two comfort values that is rounding: batches run in single precision, whose values move by
2e-7 if a parameter changes by the last digit."""

STATES = ("load.", "driving.")
"""Beginnings of paths that are no design choice: loads and speeds. Cars are ranked within them."""

SHOWN = 12
"""Maximum number of cars in the printed table."""


class SweptCases(Protocol):
    """Cases of a sweep with their results, as `SweepTable` holds them."""

    @property
    def cases(self) -> Sequence[Case]:
        """Cases in the order of the rows."""

    @property
    def units(self) -> Mapping[str, str]:
        """Name of each value to its unit."""

    @property
    def made(self) -> Mapping[str, Any]:
        """Data that the rows depend on."""

    @property
    def failed(self) -> list[tuple[Case, str]]:
        """Failed cases with their error messages."""

    def column(self, name: str) -> Vector:
        """Return the values of a column, NaN for a failed run; (cases,)."""

    def paths(self) -> list[str]:
        """Return the modified parameter paths."""

    def rows(self) -> Iterator[Row]:
        """Return the rows with numbers as texts of all digits."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RankedCars:
    """Cars of a sweep, ranked by the mean over all inputs of their weighted value over that of the first car."""

    prefix: str  # prefix of the columns: `seat_` for the cushion, empty for the seat rail
    paths: Sequence[str]  # varied parameters
    cells: Sequence[Sequence[str]]  # values of the parameters of each car, as texts; (cars, paths)
    # weighted RMS (ISO 2631-1) at the point, mean over the inputs [m/s2], NaN if a run of the car failed; (cars,)
    weighted: Vector
    # mean over the inputs of the weighted value over that of the first car on the same input [-]; (cars,)
    relative: Vector
    unweighted: Vector  # unweighted RMS there, 2 to 50 Hz, mean over the inputs [m/s2]; (cars,)
    seat_value: Vector | None  # SEAT value [-]; (cars,), None for cars without a seat
    order: Sequence[int]  # cars with a value, most comfortable first
    # half width of the 95 % interval of each change from the first car [%], NaN without one; (cars,)
    half_width: Vector
    error_words: str  # meaning of the half widths, or the reason why an event has no error; may be empty
    inputs: int  # number of inputs
    units: Mapping[str, str]  # varied parameter to its unit; empty for a text

    @property
    def point(self) -> str:
        """Words for the measurement point of the comfort values."""
        return "on the cushion" if self.prefix else "at the seat rail"

    @property
    def best(self) -> int:
        """Car with the lowest relative value."""
        return self.order[0]

    def by_state(self) -> dict[tuple[str, ...], list[int]]:
        """Return the cars by the values of their `STATES`, most comfortable first; all under () without states."""
        columns = [column for column, path in enumerate(self.paths) if path.startswith(STATES)]
        grouped: dict[tuple[str, ...], list[int]] = {}
        for car in sorted(self.order):
            grouped.setdefault(tuple(f"{self.paths[at]} = {self.cells[car][at]}" for at in columns), []).append(car)
        rank = {car: number for number, car in enumerate(self.order)}
        return {state: sorted(cars, key=rank.__getitem__) for state, cars in grouped.items()}

    def state_sentences(self) -> list[str]:
        """Return text on the most comfortable car in each state; empty for a sweep without `STATES`."""
        grouped = self.by_state()
        if () in grouped:
            return []
        if all(len(cars) == 1 for cars in grouped.values()):
            names = ", ".join(path for path in self.paths if path.startswith(STATES))
            return [f"{names}: load, speed and acceleration are not design choices, so the cars are not ranked"]
        chosen = [column for column, path in enumerate(self.paths) if not path.startswith(STATES)]
        sentences = []
        for state, cars in grouped.items():
            first, best = min(cars), cars[0]
            text = ", ".join(f"{self.paths[at]} = {self.cells[best][at]}" for at in chosen)
            change = 100.0 * (float(self.relative[best]) / float(self.relative[first]) - 1.0)
            against = "the first in this state" if best == first else f"{change:+.2f} % weighted, relative to the first"
            sentences.append(f"{', '.join(state)}: the most comfortable car has {text} ({against})")
        return sentences

    @property
    def alike(self) -> bool:
        """True if all cars are equally comfortable, within the rounding of a run."""
        values = self.weighted[list(self.order)]
        return bool(np.ptp(values) <= ROUNDING * np.max(values))

    def change(self, car: int) -> float:
        """Return the mean change of the weighted value from the first car [%]; NaN without a value of the first car."""
        return 100.0 * (float(self.relative[car]) / float(self.relative[0]) - 1.0)

    @property
    def doubt(self) -> str:
        """Words for a best car whose change is not larger than its error; empty otherwise."""
        unsure = abs(self.change(self.best)) <= self.half_width[self.best]
        return ", within the error: use a longer road" if unsure else ""

    def change_text(self, car: int) -> str:
        """Return the change from the first car [%] with its half-width, e.g. "-2.1 +- 0.4"; without one, "-2.10"."""
        width = self.half_width[car]
        error = f" +- {number_text(width, 2)}" if math.isfinite(width) else ""
        return f"{self.change(car):+.{decimals(width)}f}{error}"

    def change_cell(self, car: int, unit: str = "") -> str:
        """Return the change from the first car [%] for a table, with the digits of its half-width."""
        change = self.change(car)
        return f"{change:+.{decimals(self.half_width[car])}f}{unit}" if math.isfinite(change) else "-"

    def half_width_cell(self, car: int) -> str:
        """Return the half-width of a change [%] for a table."""
        width = self.half_width[car]
        return f"{width:.{decimals(width)}f}" if width > 0.0 else "-"

    def headings(self, name_of: Callable[[str], str] = str) -> list[str]:
        """Return the varied parameters with their units; `name_of` returns the name of a path."""
        return [name_of(path) + (f" [{self.units[path]}]" if self.units[path] else "") for path in self.paths]

    def numbers(self) -> Vector | None:
        """Return the parameters as numbers, (cars, paths); None if a value is a text or a vector."""
        try:
            return np.array([[float(cell) for cell in row] for row in self.cells])
        except ValueError:
            return None


def ranked_cars(table: SweptCases) -> RankedCars | None:
    """Return the cars of a sweep in the order of comfort; None for another measure, or if every car has a failed run.

    Args:
        table: table of a sweep with `ComfortMeasure`.
    """
    ranked_by = next((name for name in RANKED_BY if name in table.units), "")
    prefix = ranked_by.removesuffix(WEIGHTED)
    if f"{prefix}{UNWEIGHTED}" not in table.units or (prefix and SEAT_VALUE not in table.units):
        return None
    paths = table.paths()
    base = table.cases[0]
    vehicle = load_vehicle(base.vehicle, base.overrides[: base.shared])
    # A run that does not vary a parameter has the value of the car.
    unchanged = [" or ".join(map(value_text, values_of_override(vehicle, path))) for path in paths]
    rows: dict[tuple[str, ...], list[int]] = {}
    for number, case in enumerate(table.cases):
        cells = tuple(cell or default for cell, default in zip(parameter_cells(case, paths), unchanged, strict=True))
        rows.setdefault(cells, []).append(number)
    # A parameter that each input sets for all cars belongs to the input: speed, tyres that lift off an obstacle.
    of_input: dict[object, list[tuple[str, ...]]] = {}
    for cells, numbers in rows.items():
        for source in {table.cases[number].source for number in numbers}:
            of_input.setdefault(source, []).append(cells)
    varied = [
        column
        for column, path in enumerate(paths)
        if path != "driving.speed" and any(len({cells[column] for cells in each}) > 1 for each in of_input.values())
    ]
    cars: dict[tuple[str, ...], list[int]] = {}
    for cells, numbers in rows.items():
        cars.setdefault(tuple(cells[column] for column in varied), []).extend(numbers)
    names = [paths[column] for column in varied]
    weighted, unweighted, *seat_values = (
        np.array([float(np.mean(column[numbers])) for numbers in cars.values()])
        for column in map(table.column, (ranked_by, f"{prefix}{UNWEIGHTED}", *([SEAT_VALUE] if prefix else [])))
    )
    rows_of_cars, values = list(cars.values()), table.column(ranked_by)
    relative = _relative(values, [case.source for case in table.cases], rows_of_cars)
    order = [int(car) for car in np.argsort(relative, kind="stable") if math.isfinite(relative[car])]
    if not order:
        return None
    errors, events = change_errors(table.rows(), rows_of_cars, ranked_by)
    widths = 100.0 * half_width(errors / values[rows_of_cars[0]])
    error_words = NO_ERROR if events.all() else MEANING_OF_ERROR if np.any(widths > 0.0) else ""
    return RankedCars(
        prefix=prefix,
        paths=names,
        cells=list(cars),
        weighted=weighted,
        relative=relative,
        unweighted=unweighted,
        seat_value=seat_values[0] if seat_values else None,
        order=order,
        half_width=widths,
        error_words=WORDS if base.engine == ESTIMATE else error_words,
        inputs=len({case.source for case in table.cases}),
        units={path: unit_of_override(vehicle, path) for path in names},
    )


def _relative(values: Vector, sources: Sequence[object], rows_of_cars: Sequence[Sequence[int]]) -> Vector:
    """Return the mean over the inputs of the values of each car over those of the first car, (cars,).

    An input counts by its relative change, so that a loud one does not outweigh the others. Where the first car failed,
    the mean of the other cars takes its place.
    """
    scale = {}
    for source in set(sources):
        rows = [row for row, each in enumerate(sources) if each == source]
        first = float(np.mean(values[[row for row in rows_of_cars[0] if sources[row] == source]]))
        others = values[rows][np.isfinite(values[rows])]
        scale[source] = first if math.isfinite(first) else float(np.mean(others)) if others.size else math.nan
    over = values / np.array([scale[source] for source in sources])
    return np.array([float(np.mean(over[list(rows)])) for rows in rows_of_cars])


def ranking_lines(cars: RankedCars) -> list[str]:
    """Return the printed table: parameters, comfort and change from the first car, most comfortable car first."""
    shown = list(cars.order[:SHOWN])
    if 0 in cars.order and 0 not in shown:
        shown.append(0)
    heads = [*cars.headings(), f"{cars.prefix}{WEIGHTED} [m/s2]", "change"]
    with_errors = bool(np.any(cars.half_width > 0.0))
    heads += [*(["+-"] if with_errors else []), f"{cars.prefix}{UNWEIGHTED} [m/s2]"]
    heads += [] if cars.seat_value is None else [f"{SEAT_VALUE} [-]"]
    rows = [
        [
            *cars.cells[car],
            f"{cars.weighted[car]:.4g}",
            "base" if car == 0 else cars.change_cell(car, " %"),
            *([cars.half_width_cell(car)] if with_errors else []),
            f"{cars.unweighted[car]:.4g}",
            *([] if cars.seat_value is None else [f"{cars.seat_value[car]:.4g}"]),
        ]
        for car in shown
    ]
    lines = aligned([heads, *rows], left=0)
    left = len(cars.order) - len(shown)
    if left > 0:
        lines.append(f"{left} more cars: see table.csv")
    over = f", mean of {cars.inputs} inputs; change: mean of the changes on each input" if cars.inputs > 1 else ""
    definitions = ", ".join(f"{cars.prefix}{name}: {MEANING[name]}" for name in (WEIGHTED, UNWEIGHTED))
    lines.append("; ".join(filter(None, (definitions, f"{cars.point}{over}", cars.error_words))))
    best = ", ".join(f"{path} = {cell}" for path, cell in zip(cars.paths, cars.cells[cars.best], strict=True))
    if states := cars.state_sentences():
        lines += states
    elif cars.alike and len(cars.order) > 1:
        lines.append(f"all {len(cars.order)} cars are equally comfortable: the varied parameters have no effect here")
    elif best and cars.best == 0:
        lines.append(f"the first car is the most comfortable: {best}")
    elif best:
        change = f"{cars.change_text(cars.best)} % weighted, relative to the first{cars.doubt}"
        lines.append(f"most comfortable car: {best} ({change})")
    return lines


def measure_lines(table: SweptCases) -> list[str]:
    """Return the printed table of a sweep of another measure than comfort: parameters and values of the first runs."""
    base, units = table.cases[0], table.units
    shared = {text.partition("=")[0] for text in base.overrides[: base.shared]}
    paths = [path for path in table.paths() if path not in shared]
    columns = {name: table.column(name) for name in units}
    # An error that is known in no run has a column in the file alone.
    columns = {name: each for name, each in columns.items() if np.isfinite(each).any() or not _is_error(name, units)}
    rows = [
        [case.source.name, *parameter_cells(case, paths), *(_cell(float(each[row])) for each in columns.values())]
        for row, case in enumerate(islice(table.cases, SHOWN))
    ]
    lines = aligned([["input", *paths, *(f"{name} [{units[name]}]" for name in columns)], *rows], left=1)
    lines += [WORDS] if base.engine == ESTIMATE else []
    left = len(table.cases) - len(rows)
    return [*lines, f"{left} more runs: see table.csv"] if left else lines


def _cell(value: float) -> str:
    """Return a value as text; a dash for an undefined one."""
    return number_text(value, 4) if math.isfinite(value) else "-"


def is_comfort(units: Mapping[str, str]) -> bool:
    """Return True for a table of comfort, whose errors are relative, False for figures that were asked for."""
    return units.get(f"{UNWEIGHTED}{ERROR}") == "-"


def figure_names(units: Mapping[str, str]) -> tuple[str, ...]:
    """Return the columns of figures: in a table of comfort the one by which cars are ranked, else all without errors.

    Args:
        units: name of each value of a table to its unit.
    """
    if is_comfort(units):
        names = tuple(name for name in RANKED_BY if name in units)[:1]
    else:
        names = tuple(name for name in units if not _is_error(name, units))
    if not names:
        raise DataError("measure: no run has a value; run one car alone for the reason")
    return names


def _is_error(name: str, units: Mapping[str, str]) -> bool:
    """Return True for the standard error of another column; a value of the user may be named "path_error"."""
    return name.endswith(ERROR) and name.removesuffix(ERROR) in units
