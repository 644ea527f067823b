"""Measures: a few values of each run of a sweep."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, runtime_checkable

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.batch_simulation import COARSE_STEP
from vehicle.engines.reduced.reduced_run import LONGEST_STEP
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES, CORNERS
from vehicle.runs.car import Run
from vehicle.runs.figures.chosen_figure import ChosenFigure, chosen_figure
from vehicle.runs.figures.run_batch import Runs, single
from vehicle.runs.figures.turning_figures import ORDER_FREQUENCY
from vehicle.runs.figures.value import values_of
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.ride_comfort import ERROR, comfort_columns, comfort_units, wave_names, with_twins
from vehicle.studies.sweeps.function_measure import FunctionMeasure, NamedFunctions, RunFunction


@runtime_checkable
class Measure(Protocol):
    """Function that returns the values of a run; picklable, with a `repr` that identifies the measure."""

    @property
    def channels(self) -> tuple[str, ...] | None:
        """Return the required channels; None for all channels."""

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run, NaN for undefined values."""


@runtime_checkable
class BatchMeasure(Measure, Protocol):
    """Measure of a batch of runs: the reduced engine then simulates the cars as a batch, several times as fast."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""

    @property
    def timestep(self) -> float:
        """Return the maximum step of the reduced engine [s]."""

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the values of r runs, (r,) each; values of a run must be bitwise independent of the other runs."""


def of_one(measure: BatchMeasure, run: Run) -> dict[str, float]:
    """Return the values of a single run."""
    return {name: float(values[0]) for name, values in measure.of(single(run)).items()}


STEP = COARSE_STEP
"""Default of the maximum step of a measure [s]. Its values differ from those of a single run, at 0.2 ms, by less than a
tenth of the standard error of a road of 30 s: see `vehicle.engines.reduced.batch_simulation`."""

SHARP = "damper_top"
"""Points whose accelerations have peaks at the instants of sticking: 1.6 % off at `STEP`, 2.6 % at obstacles. Measures
that read them have the step of a single run; all other figures are within 0.25 %."""

FRONT = tuple(CORNERS.values())[:2]
"""Front wheels."""


def _require_skip(skip: float) -> None:
    if not 0.0 <= skip < math.inf:
        raise ConfigurationError(f"measure: skip {skip:g} s, must be a finite number of seconds, at least 0")


@dataclass(frozen=True, kw_only=True, slots=True)
class FigureMeasure:
    """Measure of figures of the catalogue."""

    figures: tuple[tuple[str, ChosenFigure], ...]  # name of the value and figure, with channels by name
    channels: tuple[str, ...]  # channels that the figures read
    skip: float = 0.0  # excluded time at the beginning [s]
    timestep: float = STEP  # maximum step of the reduced engine [s]
    errors: bool = True  # add the standard error of each value, in its unit and NaN where unknown
    random: bool = True  # False for values without standard errors

    def __post_init__(self) -> None:
        _require_skip(self.skip)

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value and of its standard error."""
        units: dict[str, str] = {}
        for name, chosen in self.figures:
            suffixes = ("", ERROR) if self.errors and not chosen.figure.exact else ("",)
            units |= {f"{name}{suffix}": chosen.unit_in() for suffix in suffixes}
        return units

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the values of r runs, (r,) each, with the waves of an RMS (`wave_names`), which are in no table.

        NaN for an undefined value, and for a motion that has not settled.
        """
        runs = replace(runs, skip=self.skip, errors=self.errors, random=runs.random and self.random)
        columns: dict[str, Vector] = {}
        for name, chosen in self.figures:
            value, error, waves, _ = values_of(chosen, runs)
            columns[name] = np.where(np.isinf(value), np.nan, value)
            if not self.errors or chosen.figure.exact:
                continue
            columns[f"{name}{ERROR}"] = np.full(len(value), np.nan) if error is None else error
            if not runs.random:
                columns |= dict.fromkeys(wave_names(name), np.full(len(value), np.nan))
            elif waves is not None:
                parts = np.ascontiguousarray(waves).view(np.float64).T
                columns |= dict(zip(wave_names(name), parts, strict=True))
        return columns


@dataclass(frozen=True, kw_only=True, slots=True)
class SingleMeasure:
    """Measure of single runs in double precision."""

    each: FigureMeasure  # measure of a run

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        return self.each.channels

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        return self.each.units

    @property
    def skip(self) -> float:
        """Return the excluded time at the beginning [s]."""
        return self.each.skip

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return self.each(run)


def measure_of(
    vehicle: Vehicle, figures: Mapping[str, ChosenFigure], skip: float, *, errors: bool = True, random: bool = True
) -> FigureMeasure | SingleMeasure:
    """Return the measure of named figures of a car.

    Args:
        figures: name of the value to figure, with channels by name.
        skip, errors, random: see `FigureMeasure`.
    """
    channels = dict.fromkeys(name for each in figures.values() for name in each.channels_of(vehicle))
    measure = FigureMeasure(
        figures=tuple(figures.items()),
        channels=tuple(channels),
        skip=skip,
        timestep=LONGEST_STEP if any(name.startswith(SHARP) for name in channels) else STEP,
        errors=errors,
        random=random,
    )
    # A batch records no force elements (`Vehicle.load_channels`).
    unbatched = any(each.figure.alone for each in figures.values()) or not {*channels} <= {*vehicle.channels}
    return SingleMeasure(each=measure) if unbatched else measure


def figures_of(measure: Measure) -> tuple[ChosenFigure, ...]:
    """Return the figures of the catalogue in a measure; none for another measure."""
    each = measure.each if isinstance(measure, SingleMeasure) else measure
    if isinstance(each, FunctionMeasure):
        return each.figures
    return tuple(chosen for _, chosen in each.figures) if isinstance(each, FigureMeasure) else ()


SLIP_FIGURES = ("slip_share", "saturated_share", "first_slip")
"""Figures of each damper in the table of comfort."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortMeasure:
    """Measure of comfort and slip: the values of `vehicle.signals.analysis.ride_comfort`, and `SLIP_FIGURES`.

    Attributes:
        skip: excluded time at the beginning for all values except the first slip [s].
        wheels: wheels of the evaluated dampers.
        seat: add the values on the cushion and the SEAT value, for a car with a seat.
        timestep: maximum step of the reduced engine [s].
    """

    skip: float = 0.0
    wheels: tuple[str, ...] = FRONT
    seat: bool = False
    timestep: float = STEP

    def __post_init__(self) -> None:
        _require_skip(self.skip)

    @property
    def _slips(self) -> list[ChosenFigure]:
        return [ChosenFigure(quantity=name, wheels=(wheel,)) for name in SLIP_FIGURES for wheel in self.wheels]

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        points = ("seat_rail", "seat") if self.seat else ("seat_rail",)
        dampers = (f"damper_{wheel}_velocity" for wheel in self.wheels)
        return (*(f"{point}_acc_{axis}" for point in points for axis in AXES), *dampers)

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        return comfort_units(seated=self.seat) | {slip.column: slip.unit_in() for slip in self._slips}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return both comfort values and slip.

        `unweighted_error` and `weighted_error` are the relative standard errors for Gaussian roads of this class and
        length, NaN for one event; SEAT value and slip have no standard error. Slip is motion above
        `damper.slip_velocity`, the saturated share is above 1 mm/s. The first slip refers to the whole run, as in
        `summary.json`; NaN without slip.
        """
        runs = replace(runs, skip=self.skip)
        # The waves are not in `units`, so in no table: they are for the error of the difference of two cars.
        numbers = self._comfort(runs)
        if not runs.random:
            none = np.full(len(runs.vehicles), np.nan)
            numbers |= dict.fromkeys((name for name in numbers if "_error" in name or "_wave_" in name), none)
        elif (twin := runs.twin) is not None:
            points = ["seat_rail", *(["seat"] if self.seat else [])]
            paired = with_twins(numbers, twin.comfort(points, band=COMFORT_BAND))
            numbers = {name: paired[name] for name in numbers}
        runs = replace(runs, errors=False)
        return numbers | {slip.column: values_of(slip, runs).value for slip in self._slips}

    def _comfort(self, runs: Runs) -> dict[str, Vector]:
        """Return the comfort values of runs."""
        rail = runs.stacked(*(f"seat_rail_acc_{axis}" for axis in AXES))
        cushion = runs.stacked(*(f"seat_acc_{axis}" for axis in AXES)) if self.seat else None
        return comfort_columns(runs.timestep, rail, cushion, skip=runs.skip)


def comfort_measure(vehicle: Vehicle, skip: float) -> ComfortMeasure:
    """Return the measure of a vehicle: its front dampers, or the rear dampers if it has none in front.

    Args:
        skip: excluded time at the beginning [s].
    """
    damped = vehicle.damped_wheels
    wheels = tuple(wheel for wheel in FRONT if wheel in damped) or damped
    return ComfortMeasure(skip=skip, wheels=wheels, seat=vehicle.seated)


MeasureChoice = Measure | RunFunction | Mapping[str, RunFunction | str] | str | Sequence[str] | None
"""Measure of a sweep: names of figures, functions of a run by name, a function, an object, or nothing for comfort."""


def chosen_measure(measure: MeasureChoice, vehicle: Vehicle, skip: float) -> Measure:
    """Return the measure of a setting: comfort by default, figures by their names, a function, or a measure itself.

    Args:
        measure: names of figures; a function of a run, or several by name; or a measure; comfort by default.
        skip: excluded time at the beginning [s].

    Raises:
        ConfigurationError: the vehicle lacks a figure.
    """
    if measure is None:
        return comfort_measure(vehicle, skip)
    if isinstance(measure, Measure):
        return measure
    if isinstance(measure, Mapping):
        chosen = {
            name: chosen_figure(each, vehicle, f"measure {name!r}")
            for name, each in measure.items()
            if isinstance(each, str)
        }
        units = {name: chosen[name].unit_in() if name in chosen else "?" for name in measure}
        functions = NamedFunctions(dict(measure))
        return FunctionMeasure(function=functions, skip=skip, units=units, figures=tuple(chosen.values()))
    if callable(measure):
        return FunctionMeasure(function=measure, skip=skip)
    names = [measure] if isinstance(measure, str) else measure
    figures = [each for name in names for each in chosen_figure(name, vehicle, "--measure").columns()]
    return measure_of(vehicle, _columns(figures), skip)


def _columns(figures: Sequence[ChosenFigure]) -> dict[str, ChosenFigure]:
    """Return the figures by the names of their columns; frequencies of several orders have the order in their name."""
    frequencies = {(each.order, each.angle) for each in figures if each.quantity == ORDER_FREQUENCY}
    columns: dict[str, ChosenFigure] = {}
    for each in figures:
        name = each.column
        if each.quantity == ORDER_FREQUENCY:
            name = "_".join([name, f"{each.order:g}", *filter(None, [each.angle])]) if len(frequencies) > 1 else name
        elif columns.get(name, each) != each:
            raise ConfigurationError(
                f"--measure: {columns[name].title!r} and {each.title!r} have the same column {name}; run a sweep for "
                "each of them"
            )
        columns.setdefault(name, each)
    return columns
