"""Parameters of a search in a vehicle: full paths, units, and values of the unmodified car."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import meant, value_of
from vehicle.model.parameters.ranges import Range, is_coordinate
from vehicle.model.parameters.toml_file import as_table
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car
from vehicle.studies.optimisation.problem import Criterion, Problem, Tolerance


def values_at(vehicle: Vehicle, option: str, path: str) -> dict[str, float]:
    """Return full path to value for all parameters that a path refers to.

    Args:
        option: name of the option with the path, for messages.
        path: path of a parameter, see `vehicle.model.parameters.paths`.
    """
    try:
        return {full: value_of(vehicle, full) for full in meant(as_table(vehicle), path)}
    except ConfigurationError as error:
        raise ConfigurationError(f"{option} {path}: {error}") from None


def problem_of(
    vehicle: Vehicle, ranges: Sequence[Range], criteria: Sequence[Criterion], inputs: Sequence[str]
) -> Problem:
    """Return the optimisation problem of a vehicle.

    Args:
        ranges: parameters with bounds.
        criteria: objectives and limits, with their units.
        inputs: names of the inputs.
    """
    if not ranges:
        raise ConfigurationError("no parameter to vary; add --vary PATH=LOW:HIGH, once for each parameter")
    each = [values_at(vehicle, "--vary", bounds.path) for bounds in ranges]
    _require_unique("--vary", each)
    return Problem(
        ranges=tuple(ranges),
        paths=tuple(tuple(values) for values in each),
        units=tuple(str(vehicle.quantity_of(next(iter(values)))["unit"]) for values in each),
        base=tuple(next(iter(values.values())) if len(set(values.values())) == 1 else math.nan for values in each),
        criteria=tuple(criteria),
        inputs=tuple(inputs),
    )


def toleranced(vehicle: Vehicle, tolerances: Sequence[Tolerance]) -> tuple[tuple[Tolerance, Mapping[str, float]], ...]:
    """Return tolerances, each with full path to value of the vehicle."""
    each = [values_at(vehicle, "--tolerance", tolerance.path) for tolerance in tolerances]
    for tolerance, values in zip(tolerances, each, strict=True):
        if tolerance.relative and any(is_coordinate(vehicle, path) for path in values):
            raise ConfigurationError(
                f"--tolerance {tolerance.path}={100.0 * tolerance.width:g}%: a percentage of a coordinate depends on "
                f"the origin; give a length in m, for example {tolerance.path}=0.002"
            )
    _require_unique("--tolerance", each)
    return tuple(zip(tolerances, each, strict=True))


def _require_unique(option: str, each: Sequence[Mapping[str, float]]) -> None:
    """Check that no value is set by two options."""
    paths = [path for values in each for path in values]
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"{option} {twice}: set by {paths.count(twice)} of these options; set it once")


def require_bounds(vehicle: Path | None, fixed: Sequence[str], problem: Problem) -> None:
    """Check before any run that each bound of each parameter is a valid value of the vehicle."""
    base = Car.load(vehicle, fixed)
    for bounds, paths in zip(problem.ranges, problem.paths, strict=True):
        for value in (bounds.low, bounds.high):
            try:
                base.with_([f"{path}={value!r}" for path in paths])
            except ConfigurationError as error:
                raise ConfigurationError(f"--vary {bounds.path}={bounds.low:g}:{bounds.high:g}: {error}") from None
