"""Parameters by their dotted paths: which there are, what they hold, their units, and other values in their places.

A path names the tables down to a value, as "front.bushings.suspension_mount.stiffness"; a component of a vector has
its axis behind it, as in "front.bushings.suspension_mount.stiffness.z". The end of a path is enough where only one path
ends so, as in "suspension_mount.stiffness.z". A file may give other names of its own in the table `alias`.
"""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import PurePath
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import PATH_PATTERN, field_quantity
from vehicle.model.parameters.toml_file import as_table, copy_table
from vehicle.names import AXES

Optional = Callable[[], Iterable[str]]
"""Paths that may be given beside those of a table."""

DECIMAL = re.compile(r"[+-]?(0|[1-9][0-9]*)(\.[0-9]+([eE][+-]?[0-9]+)?|[eE][+-]?[0-9]+)")
"""A TOML number that is not whole."""

SHOWN = 4
"""Most paths that a message lists."""


def full_path(table: Mapping[str, Any], path: str) -> str:
    """The whole path of a parameter or of a group.

    Args:
        table: nested dictionaries, as of `read_table`.
        path: a whole path, or the end of one.

    Raises:
        ConfigurationError: nothing is called so (with the nearest path), or more than one thing is.
    """
    if value_at(table, path) is not None:
        return path
    if isinstance(other := table.get("alias", {}).get(path), str):
        return full_path({**table, "alias": {}}, other)
    known = paths(table)
    groups = [one.rpartition(".")[0] for one in known]
    found = [one for one in dict.fromkeys([*known, *groups]) if one.endswith(f".{path}")]
    if not found:
        raise ConfigurationError(f"no parameter {path}; the nearest is {nearest(path, known)}")
    return _only(found, path)


def _only(found: Sequence[str], path: str) -> str:
    if len(found) > 1:
        more = f" or one of {len(found) - SHOWN} others" if len(found) > SHOWN else ""
        raise ConfigurationError(f"parameter {path} may be {', '.join(found[:SHOWN])}{more}; give more of its path")
    return found[0]


def paths(table: Mapping[str, Any], prefix: str = "") -> list[str]:
    """Paths of all values and of the components of all vectors, in the order of the file."""
    found: list[str] = []
    for key, value in table.items():
        if key == "alias" and not prefix:
            continue
        place = f"{prefix}{key}"
        if isinstance(value, Mapping):
            found += paths(value, f"{place}.")
        else:
            found += [place, *(f"{place}.{axis}" for axis in AXES if _is_vector(value))]
    return found


def nearest(path: str, known: Iterable[str]) -> str:
    """The known path that another one begins, else the one that is spelt most like it."""
    # A short path is compared with the ends of the known ones; of equal ones the first wins.
    ends = {".".join(one.split(".")[-(path.count(".") + 1) :]): one for one in reversed(list(known))}
    begun = min((end for end in ends if end.startswith(path)), key=len, default=None)
    if begun is not None:
        return ends[begun]
    return ends[difflib.get_close_matches(path, list(ends)[::-1], n=1, cutoff=0.0)[0]]


def meant(table: Mapping[str, Any], path: str, optional: Optional = list) -> list[str]:
    """Whole paths of what is to be set: one, or with "*." before it all that end so.

    Args:
        table: nested dictionaries.
        path: a whole path, or the end of one.
        optional: paths that may be given beside those of the table, of sides too; asked for where it has none.

    Raises:
        ConfigurationError: nothing is called so (with the nearest path), or more than one thing is.
    """
    every = path.startswith("*.")
    if not every:
        try:
            return [full_path(table, path)]
        except ConfigurationError as error:
            if not str(error).startswith("no parameter"):
                raise
    # Of what is given for both sides, one side is meant only where it is named.
    sided = bool({"right", "left"} & set(path.split(".")))
    known = paths(table)
    further = [one for one in optional() if sided or not {"right", "left"} & set(one.split("."))]
    found = [one for one in (*known, *further) if f".{one}".endswith(f".{path.removeprefix('*.')}")]
    if not found:
        raise ConfigurationError(f"no parameter {path}; the nearest is {nearest(path, [*known, *further])}")
    return found if every else [path if path in found else _only(found, path)]


def assignments(overrides: Iterable[str] | Mapping[str, Any]) -> list[str]:
    """Return overrides as texts "path=value".

    Args:
        overrides: such texts, or path to value: numbers, texts, booleans, vectors.

    Raises:
        ConfigurationError: a single text, whose letters would be taken for overrides, or a value of another type.
    """
    if isinstance(overrides, str | bytes):
        raise ConfigurationError(
            f"overrides: found the text {overrides!r}; needed is a list, as [{str(overrides)!r}], or {{path: value}}"
        )
    if isinstance(overrides, Mapping):
        return [f"{path}={_toml(path, value)}" for path, value in overrides.items()]
    return list(overrides)


def _toml(path: str, value: Any) -> str:
    """A value as in a TOML file."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str | PurePath):
        return f'"{value}"'
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {_toml(path, inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_toml(path, inner) for inner in value) + "]"
    raise ConfigurationError(f"overrides: {path} is a {type(value).__name__}; needed is a number, a text or a list")


def override(table: Mapping[str, Any], assignments: Iterable[str], optional: Optional = list) -> dict[str, Any]:
    """Replace single values of nested dictionaries, or give optional ones.

    Args:
        table: as of `read_table`; not changed.
        assignments: texts like "damper.coulomb_friction=93.75"; the value is written as in TOML. "*.damper.viscous=2e3"
            is for every damper.
        optional: as of `meant`.

    Returns:
        A new table.

    Raises:
        ConfigurationError: no '=' in the text, a value that is not TOML, a group, or a path that does not exist or is
            not complete enough.
    """
    result: dict[str, Any] = copy_table(table)
    for assignment in assignments:
        given, separator, text = (part.strip() for part in assignment.partition("="))
        if not separator or not given:
            raise ConfigurationError(f"--set {assignment}: needed is PATH=VALUE, as in damper.coulomb_friction=93.75")
        try:
            places = meant(result, given, optional)
        except ConfigurationError as error:
            raise ConfigurationError(f"--set {assignment}: {error}") from None
        for path in places:
            _set(result, path, assignment, text)
    return result


def _set(table: dict[str, Any], path: str, assignment: str, text: str) -> None:
    """Put a value into its place; tables that an optional one needs are made."""
    old, given = value_at(table, path), assignment.partition("=")[0].strip()
    if isinstance(old, Mapping):
        inside = ", ".join(f"{path}.{key}" for key in list(old)[:6])
        raise ConfigurationError(f"--set {assignment}: {given} is a group; set one of {inside}")
    value = parsed_value(assignment, text, "" if old is None else old)
    if _is_vector(old) and isinstance(value, int | float):
        raise ConfigurationError(
            f"--set {assignment}: {given} is a vector; give all as [x, y, z], or one component with its axis "
            f"behind the path: {given}.z={text}"
        )
    *parents, name = path.split(".")
    outer: Any = table
    for parent in parents:
        outer = outer.setdefault(parent, {}) if isinstance(outer, dict) else outer[AXES.index(parent)]
    outer[AXES.index(name) if isinstance(outer, list) else name] = value


def value_of(vehicle: Any, path: str) -> float:
    """Value of a number in a parameter object.

    Args:
        vehicle: the parameters.
        path: as of `full_path`, of a number or of a component; the whole path of one that has its default.

    Raises:
        ConfigurationError: the path is no number of it.
    """
    table = as_table(vehicle)
    declared: Mapping[str, Any] = vehicle.quantity_of(path)
    if value_at(table, path) is None and "unit" in declared:
        if _is_number(declared.get("default")):
            return float(declared["default"])
        raise ConfigurationError(f"parameter {path}: not given in this vehicle, and without a default; give its value")
    try:
        found = value_at(table, full_path(table, path))
        if _is_number(found):
            return float(found)
        raise ConfigurationError(f"the nearest is {nearest(path, _numbers(table))}")
    except ConfigurationError as error:
        # Of a misspelt one the nearest number is wanted, not the nearest text.
        misspelt = str(error).startswith("no parameter")
        reason = f"the nearest is {nearest(path, _numbers(table))}" if misspelt else str(error)
        raise ConfigurationError(f"parameter {path}: no number of a vehicle; {reason}") from None


def overrides_of(vehicle: Any, values: Mapping[str, float]) -> tuple[str, ...]:
    """Overrides "path=value" that put numbers into a parameter object.

    Args:
        vehicle: the car they are for.
        values: path to value.

    Returns:
        Texts for `override`.

    Raises:
        ConfigurationError: a path that is no number of it.
    """
    for path in values:
        if "unit" not in vehicle.quantity_of(path):
            value_of(vehicle, path)
    return tuple(f"{path}={float(value)!r}" for path, value in values.items())


def unit_of(car: Any, path: str) -> str:
    """Unit of a parameter, as it is declared; arguments as of `quantity_of`."""
    return str(quantity_of(car, path)["unit"])


def quantity_of(car: Any, path: str) -> Mapping[str, Any]:
    """What is declared of a parameter, as of `quantity`: unit, meaning, range.

    Args:
        car: a vehicle, or a parameter class, as QuarterCar.
        path: of a value or of a component; of a class the whole path.

    Raises:
        ConfigurationError: the path is no quantity of it.
    """
    found = field_quantity(car, path) if isinstance(car, type) else car.quantity_of(full_path(as_table(car), path))
    if "unit" not in found:
        what = car.__name__ if isinstance(car, type) else "a vehicle"
        raise ConfigurationError(f"parameter {path}: no quantity of {what}; give the whole path of a value")
    return found


def value_at(table: Any, path: str) -> Any:
    """What a whole path leads to; None where it leads nowhere."""
    inner = table
    for key in path.split("."):
        if isinstance(inner, Mapping):
            inner = inner.get(key)
        else:
            inner = inner[AXES.index(key)] if key in AXES and _is_vector(inner) else None
    return inner


def _numbers(table: Mapping[str, Any]) -> list[str]:
    return [path for path in paths(table) if _is_number(value_at(table, path))]


def _is_vector(value: Any) -> bool:
    return isinstance(value, list) and len(value) == len(AXES)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def parsed_value(assignment: str, text: str, old: Any) -> Any:
    """Parse the value of an override; a bare word stands for a text where a text is wanted.

    Args:
        assignment: the override, for messages.
        text: its value.
        old: what stands there; a bare word is a text in place of one.

    Raises:
        ConfigurationError: it is no value.
    """
    if DECIMAL.fullmatch(text):
        return float(text)  # by far the most of them, and a parser of files takes its time
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except RecursionError:
        raise ConfigurationError(f"--set {assignment[:60]}...: brackets are nested too deep") from None
    except tomllib.TOMLDecodeError:
        if isinstance(old, str) and PATH_PATTERN.fullmatch(text):
            return text
        try:
            return float(text)  # ".5" and "1." are numbers to everybody but TOML
        except ValueError:
            pass
        raise ConfigurationError(f"--set {assignment}: {text!r} is not a number, a list of numbers or a text") from None
