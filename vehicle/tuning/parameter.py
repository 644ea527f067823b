"""A parameter that is fitted: its path, its bounds, where the fit begins, and how it gets into a vehicle."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.parameters.toml_file import as_table
from vehicle.parameters.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """One unknown of a fit, which moves on a logarithmic scale: u = ln(value / start).

    Args:
        path: dotted path as in the vehicle file; a component of a vector has its axis behind it, as in
            "bushings.suspension_mount.stiffness.z".
        lower: smallest value allowed, above 0.
        upper: largest value allowed.
        start: where the fit begins, between both.

    Raises:
        ConfigurationError: bounds that are not finite, not positive or out of order, or a start outside of them.
    """

    path: str
    lower: float
    upper: float
    start: float

    def __post_init__(self) -> None:
        if not 0.0 < self.lower < self.start < self.upper < math.inf:
            raise ConfigurationError(
                f"parameter {self.path}: found bounds {self.lower:g} and {self.upper:g}, start {self.start:g}; needed "
                "is 0 < lower < start < upper, all finite (the fit moves on a logarithmic scale; a parameter that may "
                "be zero needs a small positive bound)"
            )

    @property
    def half_width(self) -> float:
        """Half the distance of the bounds on the logarithmic scale [-]."""
        return 0.5 * math.log(self.upper / self.lower)

    def value(self, logarithm: float) -> float:
        """Value at u = ln(value / start)."""
        return self.start * math.exp(logarithm)


def checked_parameters(parameters: Sequence[Parameter]) -> tuple[Parameter, ...]:
    """The parameters, refused if there is none or a path appears twice.

    Raises:
        ConfigurationError: none, or a path twice.
    """
    paths = [parameter.path for parameter in parameters]
    if not paths:
        raise ConfigurationError("parameters: none to fit; give at least one with its bounds")
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"parameter {twice}: given {paths.count(twice)} times; give each once")
    return tuple(parameters)


def overrides_of(vehicle: Vehicle, values: Mapping[str, float]) -> tuple[str, ...]:
    """Overrides "path=value" that put fitted values into a vehicle; components of one vector come together.

    Args:
        vehicle: the car whose other values stay, which fills the components that are not fitted.
        values: path of `Parameter` to value.

    Returns:
        Texts for `Car.load`.

    Raises:
        ConfigurationError: a path that is no number of a vehicle.
    """
    table = as_table(vehicle)
    numbers: dict[str, str] = {}
    vectors: dict[str, list[float]] = {}
    for path, value in values.items():
        if _is_number(_at(table, path)):
            numbers[path] = repr(float(value))
            continue
        parent, _, axis = path.rpartition(".")
        vector = _at(table, parent) if axis in AXES else None
        if not isinstance(vector, list) or len(vector) != len(AXES):
            raise _unknown(table, path)
        vectors.setdefault(parent, [float(member) for member in vector])[AXES.index(axis)] = float(value)
    return (
        *(f"{path}={text}" for path, text in numbers.items()),
        *(f"{path}={vector!r}" for path, vector in vectors.items()),
    )


def value_of(vehicle: Vehicle, path: str) -> float:
    """Value of a parameter in a vehicle.

    Raises:
        ConfigurationError: the path is no number of a vehicle.
    """
    table = as_table(vehicle)
    found = _at(table, path)
    if found is None:
        parent, _, axis = path.rpartition(".")
        vector = _at(table, parent)
        found = vector[AXES.index(axis)] if axis in AXES and isinstance(vector, list) else None
    if not _is_number(found):
        raise _unknown(table, path)
    return float(found)


def _unknown(table: Mapping[str, Any], path: str) -> ConfigurationError:
    near = difflib.get_close_matches(path, _number_paths(table), n=1, cutoff=0.0)[0]
    return ConfigurationError(f"parameter {path}: no number of a vehicle; the nearest is {near}")


def _at(table: Mapping[str, Any], path: str) -> Any:
    """What a dotted path leads to; None where it leads nowhere."""
    inner: Any = table
    for key in path.split("."):
        inner = inner.get(key) if isinstance(inner, Mapping) else None
    return inner


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _number_paths(table: Mapping[str, Any], prefix: str = "") -> list[str]:
    found: list[str] = []
    for key, value in table.items():
        place = f"{prefix}{key}"
        if isinstance(value, Mapping):
            found += _number_paths(value, f"{place}.")
        elif _is_number(value):
            found.append(place)
        elif isinstance(value, list) and len(value) == len(AXES) and all(_is_number(member) for member in value):
            found += [f"{place}.{axis}" for axis in AXES]
    return found
