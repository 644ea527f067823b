"""Parameters by their dotted paths: list, values, units and overrides.

A path names the tables down to a value, for example "front.bushings.suspension_mount.stiffness", and a component by its
axis, "front.bushings.suspension_mount.stiffness.z". The end of a path is sufficient if it is unique:
"suspension_mount.stiffness.z". A vehicle file may define further names in the table `alias`.
"""

import contextlib
import difflib
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import PurePath
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.alternatives import NAMING, remove_excluded
from vehicle.model.parameters.quantity import PATH_PATTERN, field_quantity
from vehicle.model.parameters.tested_range import StaleRanges
from vehicle.model.parameters.toml_file import as_table, copy_table, literal
from vehicle.names import AXES, SIDE_SIGN

Optional = Callable[[], Iterable[str]]
"""Function that returns the optional paths of a table, see `optional_paths`."""

RELATIVE = re.compile(r"^\+|[%*]|\d[+]\d")
"""A change of a value, such as +20, *1.2, 125% or 80+20; not an exponent such as 1e+5."""

DECIMAL = re.compile(r"[+-]?(0|[1-9][0-9]*)(\.[0-9]+([eE][+-]?[0-9]+)?|[eE][+-]?[0-9]+)")
"""TOML number with a decimal point or an exponent."""

SIDES = frozenset(SIDE_SIGN)
"""Names of the tables of one side."""

SHOWN = 4
"""Maximum number of paths that a message lists."""


def full_path(table: Mapping[str, Any], path: str) -> str:
    """Return the whole path of a parameter or of a group.

    Args:
        table: nested dictionaries, see `read_table`.
        path: whole path, or the end of a path.

    Raises:
        ConfigurationError: the path does not exist (with the nearest path), or is ambiguous.
    """
    if not (matches := _existing(table, path)):
        raise _missing(table, path, paths(table))
    return _only(matches, path)


def _existing(table: Mapping[str, Any], path: str) -> list[str]:
    """Return the whole paths in a table with this path or this end; an alias counts as its path."""
    if value_at(table, path) is not None:
        return [path]
    if isinstance(other := table.get("alias", {}).get(path), str):
        return [full_path({**table, "alias": {}}, other)]
    end, every_path = f".{path}", paths(table)
    groups = [candidate.rpartition(".")[0] for candidate in every_path]
    return list(dict.fromkeys(candidate for candidate in (*every_path, *groups) if candidate.endswith(end)))


def _only(matches: Sequence[str], path: str) -> str:
    if len(matches) > 1:
        more = f" or one of {len(matches) - SHOWN} others" if len(matches) > SHOWN else ""
        raise ConfigurationError(
            f"parameter {path} is ambiguous: it may be {', '.join(matches[:SHOWN])}{more}; write more of its path"
        )
    return matches[0]


def paths(table: Mapping[str, Any], prefix: str = "") -> list[str]:
    """Return the paths of all values and of the components of all vectors, in the order of the file."""
    listed: list[str] = []
    for key, value in table.items():
        if key == "alias" and not prefix:
            continue
        path = f"{prefix}{key}"
        if isinstance(value, Mapping):
            listed += paths(value, f"{path}.")
        else:
            listed += [path, *(f"{path}.{axis}" for axis in AXES if _is_vector(value))]
    return listed


def nearest(path: str, known: Iterable[str]) -> str:
    """Return the path that starts with the given path, otherwise the path with the most similar spelling."""
    # A short path is compared with the ends of all paths; of equal ends the first path counts.
    ends = {".".join(candidate.split(".")[-(path.count(".") + 1) :]): candidate for candidate in reversed(list(known))}
    begun = min((end for end in ends if end.startswith(path)), key=len, default=None)
    if begun is not None:
        return ends[begun]
    return ends[difflib.get_close_matches(path, list(ends)[::-1], n=1, cutoff=0.0)[0]]


def _missing(table: Mapping[str, Any], path: str, candidates: Iterable[str]) -> ConfigurationError:
    """Return the error of a path that does not exist, with the nearest path or the law that lacks the parameter."""
    law = next(iter(_existing(table, f"{path}_law")), "")
    if not law.endswith("viscous_law"):
        return ConfigurationError(f"unknown parameter {path}; did you mean {nearest(path, candidates)}?")
    return ConfigurationError(
        f"unknown parameter {path}: {law} = {value_at(table, law)} has none; to add it, set --set "
        f"{law}=linear --set {path}=VALUE"
    )


def meant(table: Mapping[str, Any], path: str, optional: Optional = list) -> list[str]:
    """Return the whole paths of the parameters that an override sets: one, or with a leading "*." all with this end.

    Args:
        table: nested dictionaries.
        path: whole path, or the end of a path.
        optional: function that returns further paths, including those of sides; called if the table has no match.

    Raises:
        ConfigurationError: the path does not exist (with the nearest path), or is ambiguous.
    """
    every = path.startswith("*.")
    if not every and (matches := _existing(table, path)):
        return [_only(matches, path)]
    end, existing, further = path.removeprefix("*."), paths(table), list(optional())
    # A path without a side means both sides.
    sided = _of_one_side(path)
    matches = [each for each in existing if _ends(each, end)]
    matches += [each for each in further if _ends(each, end) and (sided or not _of_one_side(each))]
    if not matches:
        candidates = [*existing, *(each for each in further if sided or not _of_one_side(each))]
        raise _missing(table, path, candidates)
    return matches if every else [path if path in matches else _only(matches, path)]


def _ends(path: str, end: str) -> bool:
    """True if a path ends with these names."""
    return path.endswith(end) and (len(path) == len(end) or path[-len(end) - 1] == ".")


def _of_one_side(path: str) -> bool:
    return not SIDES.isdisjoint(path.split("."))


Overrides = Iterable[str] | Mapping[str, Any]
"""Changes of parameters: path to value, or texts "path=value"."""


def assignments(overrides: Overrides) -> list[str]:
    """Return overrides as texts "path=value".

    Args:
        overrides: texts "path=value", or path to value: numbers, texts, booleans, vectors.

    Raises:
        ConfigurationError: a single text, whose letters would count as overrides, or a value of another type.
    """
    if isinstance(overrides, str | bytes):
        raise ConfigurationError(
            f"overrides: must not be the text {overrides!r} but a list, [{str(overrides)!r}], or {{path: value}}"
        )
    if isinstance(overrides, Mapping):
        return [f"{path}={_toml(path, value)}" for path, value in overrides.items()]
    return list(overrides)


def _toml(path: str, value: Any) -> str:
    """Return a value as TOML text."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, int | float | str | PurePath):
        return literal(str(value) if isinstance(value, PurePath) else value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {_toml(path, inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_toml(path, inner) for inner in value) + "]"
    raise ConfigurationError(f"overrides: {path} is a {type(value).__name__}; must be a number, a text or a list")


def override(table: Mapping[str, Any], assignments: Iterable[str], optional: Optional = list) -> dict[str, Any]:
    """Return nested dictionaries with other values; an optional parameter is added.

    Args:
        table: nested dictionaries, see `read_table`; not changed.
        assignments: texts like "damper.coulomb_friction=93.75"; the value is written as in TOML. "*.damper.viscous=2e3"
            sets the value of all dampers.
        optional: see `meant`.

    Raises:
        ConfigurationError: no '=' in the text, a value that is not TOML, a group, or a path that does not exist or is
            ambiguous.
    """
    result: dict[str, Any] = copy_table(table)
    ranges = StaleRanges()
    texts = list(assignments)
    names = [text.partition("=")[0].strip() for text in texts]
    if naming := [name for name in names if name.rpartition(".")[2] in NAMING]:
        whole: dict[str, list[str]] = {}
        for name in names:
            with contextlib.suppress(ConfigurationError):
                whole[name] = meant(result, name, optional)
        for name in naming:
            remove_excluded(result, whole.get(name, ()), [path for each in whole.values() for path in each])
    for assignment in texts:
        name, separator, text = (part.strip() for part in assignment.partition("="))
        if not separator or not name:
            raise ConfigurationError(
                f"--set {assignment}: must be PATH=VALUE, for example damper.coulomb_friction=93.75"
            )
        try:
            paths = meant(result, name, optional)
        except ConfigurationError as error:
            raise ConfigurationError(f"--set {assignment}: {error}") from None
        for path in paths:
            before = value_at(result, path)
            _set(result, path, assignment, text)
            ranges.note(path, changed=value_at(result, path) != before)
    ranges.remove_from(result)
    return result


def _set(table: dict[str, Any], path: str, assignment: str, text: str) -> None:
    """Set the value of a path; create the tables of an optional parameter."""
    old, set_path = value_at(table, path), assignment.partition("=")[0].strip()
    if isinstance(old, Mapping):
        inside = ", ".join(f"{path}.{key}" for key in list(old)[:6])
        raise ConfigurationError(f"--set {assignment}: {set_path} is a group; set one of {inside}")
    value = parsed_value(assignment, text, "" if old is None else old)
    if _is_vector(old) and isinstance(value, int | float):
        raise ConfigurationError(
            f"--set {assignment}: {set_path} is a vector; set all components as [x, y, z], or a single one with "
            f"its axis, for example {set_path}.z={text}"
        )
    *parents, name = path.split(".")
    outer: Any = table
    if name in AXES and value_at(table, ".".join(parents)) is None:
        # A vector that stands at its default, zeros; see `is_zero_vector`.
        *parents, vector = parents
        name, value = vector, [value if axis == name else 0.0 for axis in AXES]
    for parent in parents:
        outer = outer.setdefault(parent, {}) if isinstance(outer, dict) else outer[AXES.index(parent)]
    outer[AXES.index(name) if isinstance(outer, list) else name] = value


def value_of(vehicle: Any, path: str) -> float:
    """Return the value of a number in a parameter object, in its SI unit.

    Args:
        vehicle: the parameter object.
        path: path of a number or of a component, see `full_path`; the whole path for a parameter with its default.

    Raises:
        ConfigurationError: the path does not lead to a number.
    """
    table = as_table(vehicle)
    declared: Mapping[str, Any] = vehicle.quantity_of(path)
    if value_at(table, path) is None and "unit" in declared:
        default = component(declared.get("default"), path)
        if _is_number(default):
            return float(default)
        raise ConfigurationError(f"parameter {path}: not set in this vehicle, and without a default; set its value")
    try:
        value = value_at(table, full_path(table, path))
        if _is_number(value):
            return float(value)
        reason = ""
    except ConfigurationError as error:
        # For a misspelt path, show the nearest number, not the nearest text.
        reason = "" if str(error).startswith("unknown parameter") else str(error)
    reason = reason or f"did you mean {nearest(path, _numbers(table))}?"
    raise ConfigurationError(f"parameter {path}: is not a number of the vehicle; {reason}")


def overrides_of(vehicle: Any, values: Mapping[str, float]) -> tuple[str, ...]:
    """Return overrides "path=value" of numbers, for `override`.

    Raises:
        ConfigurationError: a path does not lead to a number of the car.
    """
    for path in values:
        if "unit" not in vehicle.quantity_of(path):
            value_of(vehicle, path)
    return tuple(f"{path}={float(value)!r}" for path, value in values.items())


def unit_of(car: Any, path: str) -> str:
    """Return the declared unit of a parameter; arguments: see `quantity_of`."""
    return str(quantity_of(car, path)["unit"])


def unit_of_override(vehicle: Any, path: str) -> str:
    """Return the unit of the parameters that an override sets; empty for a text and for a key that the file lacks."""
    try:
        first, *_ = meant(vehicle.table, path)
    except ConfigurationError:
        return ""
    return str(vehicle.quantity_of(first).get("unit", ""))


def values_of_override(vehicle: Any, path: str) -> list[Any]:
    """Return the different values that an override would replace; empty for keys that the file lacks."""
    try:
        values = [value_at(vehicle.table, whole) for whole in meant(vehicle.table, path)]
    except ConfigurationError:
        return []
    return [value for number, value in enumerate(values) if value is not None and value not in values[:number]]


def quantity_of(car: Any, path: str) -> Mapping[str, Any]:
    """Return the declaration of a parameter, see `quantity`: unit, meaning, range.

    Args:
        car: a vehicle, or a parameter class, for example QuarterCar.
        path: path of a value or of a component; for a class the whole path.

    Raises:
        ConfigurationError: the path does not lead to a quantity.
    """
    declared = field_quantity(car, path) if isinstance(car, type) else car.quantity_of(full_path(as_table(car), path))
    if "unit" not in declared:
        owner = car.__name__ if isinstance(car, type) else "a vehicle"
        raise ConfigurationError(f"parameter {path}: is not a value of {owner}; give the whole path of a value")
    return declared


def value_at(table: Any, path: str) -> Any:
    """Return the value at a whole path; None if the path does not exist."""
    inner = table
    for key in path.split("."):
        if isinstance(inner, Mapping):
            inner = inner.get(key)
        else:
            inner = inner[AXES.index(key)] if key in AXES and _is_vector(inner) else None
    return inner


def is_zero_vector(default: Any) -> bool:
    """Return True for the default of a vector along x, y and z that is zero, so that each component can be set."""
    return isinstance(default, tuple) and len(default) == len(AXES) and not any(default)


def component(default: Any, path: str) -> Any:
    """Return the default of a path: the component of a zero vector if the path ends with an axis."""
    return 0.0 if path.rpartition(".")[2] in AXES and is_zero_vector(default) else default


def _numbers(table: Mapping[str, Any]) -> list[str]:
    return [path for path in paths(table) if _is_number(value_at(table, path))]


def _is_vector(value: Any) -> bool:
    return isinstance(value, list) and len(value) == len(AXES)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def parsed_value(assignment: str, text: str, old: Any) -> Any:
    """Parse the value of an override; a word without quotes is a text if the old value is a text.

    Raises:
        ConfigurationError: the text is not a TOML value, or a change of the old value such as +20 or 125%.
    """
    if _is_number(old) and RELATIVE.search(text):
        raise ConfigurationError(
            f"--set {assignment}: must be the new value itself, not a change of the present value {old:g}"
        )
    if DECIMAL.fullmatch(text):
        return float(text)  # the most frequent case; the TOML parser is slow
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except RecursionError:
        raise ConfigurationError(f"--set {assignment[:60]}...: brackets are nested too deep") from None
    except tomllib.TOMLDecodeError:
        if isinstance(old, str) and PATH_PATTERN.fullmatch(text):
            return text
        try:
            return float(text)  # ".5" and "1." are numbers, but not in TOML
        except ValueError:
            pass
        comma = "; decimals have a point, a list has brackets" if "," in text else ""
        raise ConfigurationError(
            f"--set {assignment}: cannot read {text}; give a number (3.5), a list ([1, 2, 3]) or a text in "
            f'quotes ("abc"){comma}'
        ) from None
