"""All parameters of a car by their paths: value, unit, meaning, range and source."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.curves import with_curve_files
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.value_sources import value_sources
from vehicle.model.parameters.vehicle import Vehicle

DEFAULT = "default"
"""Source of a parameter that the vehicle file leaves out."""

CHANGED = "set, or computed from what is set"
"""Source of a parameter whose value is not that of the vehicle file."""


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
        folder: folder of user templates; by default that of the file.

    Raises:
        ConfigurationError: the file cannot be read.
    """
    original: Mapping[str, Any] = {}
    sources: Mapping[str, str] = {}
    if file is not None:
        original, sources = with_curve_files(vehicle_table(file), file.parent), value_sources(file)
    parameters = []
    for path, value in flattened(vehicle.table):
        same = file is None or value_at(original, path) == value
        source = sources.get(path) or sources.get(path.rpartition(".")[0], "") if same else CHANGED
        parameters.append(_parameter(vehicle, path, value, source))
    home = folder or (Path() if file is None else file.parent)
    for path in _single(optional_paths(vehicle.table, home)):
        declared = vehicle.quantity_of(path)
        parent = path.rpartition(".")[0]
        present = parent in ("", "driving", "solver") or isinstance(value_at(vehicle.table, parent), Mapping)
        if present and declared.get("default") not in (None, ()):
            parameters.append(_parameter(vehicle, path, declared["default"], DEFAULT))
    return tuple(parameters)


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


def _single(paths: Iterable[str]) -> list[str]:
    """Return the paths without those of a single side."""
    return [path for path in paths if not {"right", "left"} & set(path.split("."))]


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
    """Return the permitted values of a parameter, as "0 to 0.9", "> 0" or "coulomb, stribeck"; empty without a limit.

    Args:
        declared: declaration of the parameter, see `quantity`.
    """
    if declared.get("choices"):
        return ", ".join(declared["choices"])
    low, above, high = (declared.get(key) for key in ("at_least", "above", "at_most"))
    if low is not None and high is not None:
        return f"{low:g} to {high:g}"
    lower = f">= {low:g}" if low is not None else f"> {above:g}" if above is not None else ""
    upper = f"<= {high:g}" if high is not None else ""
    return ", ".join(filter(None, (lower, upper)))
