"""The parameters of a search in a car: which values they set, their units, what the car has there."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import meant, value_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.toml_file import as_table
from vehicle.model.parameters.vehicle import Vehicle, load_vehicle
from vehicle.studies.optimisation.problem import Problem, Tolerance, Wish


def values_at(vehicle: Vehicle, option: str, path: str) -> dict[str, float]:
    """Whole paths that a path stands for, and their values.

    Args:
        vehicle: the car.
        option: that names the path, for messages.
        path: as of `vehicle.model.parameters.paths`.

    Raises:
        ConfigurationError: there is no such number.
    """
    try:
        return {place: value_of(vehicle, place) for place in meant(as_table(vehicle), path)}
    except ConfigurationError as error:
        raise ConfigurationError(f"{option} {path}: {error}") from None


def problem_of(vehicle: Vehicle, ranges: Sequence[Range], wishes: Sequence[Wish], inputs: Sequence[str]) -> Problem:
    """A search in a car.

    Args:
        vehicle: the car.
        ranges: parameters.
        wishes: objectives and limits, with their units.
        inputs: names.

    Raises:
        ConfigurationError: there is no parameter, it is no number of the car, or two of them set the same one.
    """
    if not ranges:
        raise ConfigurationError("nothing to vary; give --vary PATH=LOW:HIGH, once for each parameter")
    each = [values_at(vehicle, "--vary", one.path) for one in ranges]
    _once("--vary", each)
    return Problem(
        ranges=tuple(ranges),
        places=tuple(tuple(values) for values in each),
        units=tuple(str(vehicle.quantity_of(next(iter(values)))["unit"]) for values in each),
        base=tuple(next(iter(values.values())) if len(set(values.values())) == 1 else math.nan for values in each),
        wishes=tuple(wishes),
        inputs=tuple(inputs),
    )


def toleranced(vehicle: Vehicle, tolerances: Sequence[Tolerance]) -> tuple[tuple[Tolerance, Mapping[str, float]], ...]:
    """Tolerances with their paths and values in a car.

    Raises:
        ConfigurationError: one is no number of the car, or two are of the same one.
    """
    each = [values_at(vehicle, "--tolerance", one.path) for one in tolerances]
    _once("--tolerance", each)
    return tuple(zip(tolerances, each, strict=True))


def _once(option: str, each: Sequence[Mapping[str, float]]) -> None:
    paths = [path for values in each for path in values]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"{option} {twice}: set by {paths.count(twice)} of these options; give it once")


def require_bounds(vehicle: Path | None, fixed: Sequence[str], problem: Problem) -> None:
    """Refuse bounds that no car can have, each taken alone, before anything is run.

    Raises:
        ConfigurationError: naming the parameter and why.
    """
    for one, places in zip(problem.ranges, problem.places, strict=True):
        for value in (one.low, one.high):
            try:
                load_vehicle(vehicle, [*fixed, *(f"{place}={value!r}" for place in places)])
            except ConfigurationError as error:
                raise ConfigurationError(f"--vary {one.path}={one.low:g}:{one.high:g}: {error}") from None
