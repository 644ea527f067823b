"""Numbers of a vehicle by their dotted paths; a component of a vector has its axis behind it."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.parameters.toml_file import as_table
from vehicle.parameters.vehicle import Vehicle


def value_of(vehicle: Vehicle, path: str) -> float:
    """Value of a parameter in a vehicle.

    Args:
        vehicle: the parameters.
        path: as in `override`: "damper.viscous", "bushings.suspension_mount.stiffness.z".

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
