"""Value of a figure: on a batch of runs, and on one run in Python."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Run
from vehicle.runs.figures.chosen_figure import ChosenFigure, chosen_figure
from vehicle.runs.figures.figure import Values
from vehicle.runs.figures.run_batch import Runs, evaluated
from vehicle.signals.analysis.comfort_error import paired


def values_of(chosen: ChosenFigure, runs: Runs) -> Values:
    """Return the values of a figure on r runs, with their standard errors on a random road.

    Args:
        chosen: the figure, its channels by name.
        runs: the runs.

    Raises:
        ConfigurationError: a channel or wheel is missing in the runs.
        DataError: the record is too short for the band.
    """
    figure = chosen.figure
    values = figure.reduces.of(figure.reads.of(chosen, runs), chosen, runs)
    if not (figure.certain or (runs.random and runs.errors)):
        return Values(values.value)
    if values.error is None or values.waves is None or (twin := runs.twin) is None or figure.reduces.lines is None:
        return values
    if not {*chosen.channels_of(runs.vehicles[0])} <= {*twin.channels}:
        return values
    of_twins, reduce = [], figure.reduces.lines
    for road in twin.roads:
        of_twins.append(reduce(figure.reads.lines(chosen, runs, road), chosen, runs, road))
    phase = of_twins[0].value - np.mean([each.expected for each in of_twins], axis=0)
    return Values(values.value, *paired(values.error, values.waves, of_twins[0].waves, phase))


def require_unit(chosen: ChosenFigure, unit: str, units: Mapping[str, str]) -> None:
    """Check the unit of a figure.

    Args:
        chosen: the figure, its channels by name.
        unit: required unit.
        units: recorded channel to its unit.

    Raises:
        ConfigurationError: another unit.
    """
    needed = chosen.unit_in(units)
    if unit != needed:
        where = ", ".join(chosen.channels) or "the car"
        raise ConfigurationError(f"unit: found {unit!r}, must be {needed!r} for {chosen.quantity} of {where}")


@dataclass(frozen=True, kw_only=True, slots=True)
class ShownFigure:
    """Figure of a run for a reader.

    Attributes:
        title: figure in words.
        value: value in its unit; NaN where undefined.
        error: standard error in the unit; None if unknown.
        unit: unit.
    """

    title: str
    value: float
    error: float | None
    unit: str


def shown_figures(names: Sequence[str], runs: Runs, option: str = "--measure") -> list[ShownFigure]:
    """Return figures of a run.

    Args:
        names: names of figures, see `Run.figure`.
        runs: batch of this run.
        option: option of the names, for messages.

    Raises:
        ConfigurationError: an unknown figure, or the run lacks a channel.
        DataError: the record is too short for a band.
    """
    shown = []
    for name in names:
        chosen = chosen_figure(name, runs.vehicles[0], option)
        if missing := [each for each in chosen.channels_of(runs.vehicles[0]) if each not in runs.channels]:
            raise ConfigurationError(f"{option} {name!r}: the run did not record {', '.join(missing)}")
        try:
            values = values_of(chosen, runs)
        except ConfigurationError as fault:
            raise ConfigurationError(f"{option} {name!r}: {fault}") from None
        value, error = values.first()
        shown.append(ShownFigure(title=chosen.title, value=value, error=error, unit=chosen.unit_in()))
    return shown


def figure_of(run: Run, name: str) -> float:
    """Return a figure of a run; arguments and errors as in `Run.figure`."""
    return shown_figures([name], evaluated(run), "figure")[0].value
