"""All parameters of a car by their paths: value, unit, meaning, range and source."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.curves import with_curve_files
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.paths import Optional, component, meant, value_at
from vehicle.model.parameters.value_sources import value_sources
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES, SIDE_SIGN

DEFAULT = "default"
"""Source of a parameter that the vehicle file leaves out."""

CHANGED = "set, or computed from set values"
"""Source of a parameter whose value differs from the vehicle file."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """Parameter of a car.

    Attributes:
        path: path for `--set` and `Car.load`.
        value: number, text, truth value or list.
        unit: SI unit, "-" for none; empty for a name.
        range: permitted values as text; empty without a limit.
        meaning: one line.
        source: comment of the vehicle file behind the value; empty if the file has none.
    """

    path: str
    value: Any
    unit: str
    range: str
    meaning: str
    source: str

    def __repr__(self) -> str:
        """One line."""
        unit = f" {self.unit}" if self.unit not in ("", "-") else ""
        source = f"  # {self.source}" if self.source else ""
        return f"{self.path} = {value_text(self.value)}{unit}{source}"

    def matches(self, words: str) -> bool:
        """Return True if each word is a part of the path or of the meaning; upper and lower case are equal."""
        text = f"{self.path} {self.meaning}".lower()
        return all(word in text for word in words.lower().split())


def value_text(value: Any) -> str:
    """Return a value as in a vehicle file; numbers with at most six digits."""
    if value is None:
        return "not set"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return f"{value:.6g}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(value_text(inner) for inner in value)}]"
    return str(value)


def parameter_list(vehicle: Vehicle, file: Path | None, folder: Path | None = None) -> tuple[Parameter, ...]:
    """Return all parameters of a car in the order of its file, then those with a default that the file leaves out.

    Args:
        vehicle: parameters of the car.
        file: vehicle file of the car; None for a car from no file, whose values have no sources.
        folder: folder of user templates; by default the folder of the file.

    Raises:
        ConfigurationError: the file cannot be read.
    """
    parameters = []
    for path, value in flattened(vehicle.table):
        parameters.append(_parameter(vehicle, path, value, _source(file, path, value)))
    home = folder or (Path() if file is None else file.parent)
    for path in optional_paths(vehicle.table, home):
        if set(SIDE_SIGN) & set(path.split(".")) or path.rpartition(".")[2] in AXES:
            continue  # listed for both sides, and as a vector
        declared = vehicle.quantity_of(path)
        parent = path.rpartition(".")[0]
        present = parent in ("", "driving", "solver") or isinstance(value_at(vehicle.table, parent), Mapping)
        if present and declared.get("default") not in (None, ()):
            parameters.append(_parameter(vehicle, path, declared["default"], DEFAULT))
    return tuple(parameters)


def parameter_at(vehicle: Vehicle, path: str, file: Path | None, optional: Optional) -> Parameter:
    """Return the parameter that a path sets, as `override` understands it.

    A parameter that the file leaves out has its default, or the value None; one of a single side has the value of both
    sides, on the left mirrored where it is a point or a table along y.

    Args:
        vehicle: parameters of the car.
        path: whole path or its end, of a parameter or of a component of a vector; with a leading "*." of all parameters
            with this end, if their values are equal.
        file: see `parameter_list`.
        optional: see `meant`.

    Raises:
        ConfigurationError: no parameter has this path (with the nearest path), it is a table, or several parameters
            that differ have it.
    """
    whole_paths = [path] if value_at(vehicle.table, path) is not None else meant(vehicle.table, path, optional)
    parameters = [_settable(vehicle, whole, file) for whole in whole_paths]
    if any(each.value != parameters[0].value for each in parameters):
        values = ", ".join(f"{each.path} = {value_text(each.value)}" for each in parameters)
        raise ConfigurationError(f"parameter {path} has several values: {values}; give the path of one of them")
    return parameters[0] if len(parameters) == 1 else replace(parameters[0], path=path)


def _settable(vehicle: Vehicle, path: str, file: Path | None) -> Parameter:
    """Return the parameter with a whole path, which the file need not contain."""
    value, sideless = value_at(vehicle.table, path), ".".join(key for key in path.split(".") if key not in SIDE_SIGN)
    if isinstance(value, Mapping):
        raise ConfigurationError(
            f"{path} is a section or a component, not a parameter; car.search({path!r}) lists its parameters"
        )
    if value is not None:
        return _parameter(vehicle, path, value, _source(file, path, value))
    if (value := value_at(vehicle.table, sideless)) is not None:
        return _parameter(vehicle, path, _on_side(path, value), _source(file, sideless, value))
    default = component(vehicle.quantity_of(path).get("default"), path)
    return _parameter(vehicle, path, default, DEFAULT)


def _on_side(path: str, value: Any) -> Any:
    """Return a value of both sides as the path of a single side would set it: mirrored on the left."""
    keys = path.split(".")
    if "left" in keys and isinstance(value, list):
        if "hardpoints" in keys and len(value) == len(AXES):
            return [-number if axis == "y" else number for axis, number in zip(AXES, value, strict=True)]
        if "table_y" in keys:
            return [-number for number in reversed(value)]
    return value


def _source(file: Path | None, path: str, value: Any) -> str:
    """Return the source of a value: its comment in the vehicle file, or `CHANGED` for a changed value."""
    if file is None:
        return ""
    original, sources = _original(file, file.stat().st_mtime_ns)
    if value_at(original, path) != value:
        return CHANGED
    vector, _, last = path.rpartition(".")
    return (
        sources.get(path) or sources.get(vector) or sources.get(vector.rpartition(".")[0] if last in AXES else "", "")
    )


# Cached: all parameters of a car and of its variants have the same file.
@lru_cache(maxsize=4)
def _original(file: Path, modified: int) -> tuple[Mapping[str, Any], Mapping[str, str]]:
    """Return the values of a vehicle file and their sources; `modified`: time of its last change [ns]."""
    return with_curve_files(vehicle_table(file), file.parent), value_sources(file)


def flattened(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield path and value of every parameter of a vehicle file, without its further names.

    Args:
        table: nested dictionaries.
        prefix: path of the table, with a dot at its end; empty for the whole file.
    """
    for key, value in table.items():
        if isinstance(value, Mapping):
            if prefix or key != "alias":
                yield from flattened(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _parameter(vehicle: Vehicle, path: str, value: Any, source: str) -> Parameter:
    declared = vehicle.quantity_of(path)
    meaning = declared.get("meaning", "")
    return Parameter(
        path=path,
        value=value,
        unit=declared.get("unit", ""),
        range=range_text(declared),
        meaning=meaning,
        source="" if source == meaning else source,
    )


def range_text(declared: Mapping[str, Any]) -> str:
    """Return the permitted values of a parameter, for example "0 to 0.9" or "coulomb, stribeck"; empty: all."""
    if declared.get("choices"):
        return ", ".join(declared["choices"])
    low, above, high = (declared.get(key) for key in ("at_least", "above", "at_most"))
    if low is not None and high is not None:
        return f"{low:g} to {high:g}"
    lower = f">= {low:g}" if low is not None else f"> {above:g}" if above is not None else ""
    upper = f"<= {high:g}" if high is not None else ""
    return ", ".join(filter(None, (lower, upper)))
