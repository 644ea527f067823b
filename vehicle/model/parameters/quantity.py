"""Fields of parameter classes with unit, meaning and range, and their validation."""

import dataclasses
import functools
import math
import re
import typing
from collections.abc import Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.names import AXES

NAME_PATTERN = re.compile(r"[A-Za-z0-9_.-]+")
PATH_PATTERN = re.compile(r"[^\s\"'\[\]{}#\\]([^\"'\[\]{}#\\\r\n\t]*[^\s\"'\[\]{}#\\])?")
"""Path of a file: may contain blanks, but no character with a meaning in TOML."""


def quantity(
    unit: str,
    meaning: str,
    *,
    above: float | None = None,
    at_least: float | None = None,
    at_most: float | None = None,
    why: str = "",
    length: int | None = None,
    choices: tuple[str, ...] | None = None,
    is_file: bool = False,
    laws: tuple[str, ...] = (),
    default: Any = dataclasses.MISSING,
) -> Any:
    """Declare a field of a parameter class.

    Args:
        unit: SI unit as written in files, "-" for a pure number.
        meaning: one line, shown in documentation and error messages.
        above: the value (each component) must be greater than this.
        at_least: the value (each component) must not be less than this.
        at_most: the value (each component) must not exceed this.
        why: reason of the range, shown if a value is outside.
        length: number of components of a vector; None for a scalar.
        choices: allowed values of a text field.
        is_file: True for a text field that may be the path of a file; by default texts are names.
        laws: names of the laws that require the value and alone use it; empty for a value of every law.
        default: value if a file leaves the field out; by default the field is required.
    """
    metadata = {
        "unit": unit,
        "meaning": meaning,
        "above": above,
        "at_least": at_least,
        "at_most": at_most,
        "why": why,
        "length": length,
        "choices": choices,
        "is_file": is_file,
        "laws": laws,
        "default": None if default is dataclasses.MISSING else default,
    }
    if default is dataclasses.MISSING:
        return dataclasses.field(metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


def validate(instance: Any, where: str = "") -> None:
    """Check every field of a parameter object against its description; for `__post_init__`.

    Args:
        instance: a dataclass object whose fields were made by `quantity`.
        where: dotted path of the object, shown in messages; the class name by default.

    Raises:
        ConfigurationError: a value is wrong; with field, value, unit and range.
    """
    prefix = where or type(instance).__name__
    for name, metadata in _described(type(instance)):  # type: ignore[arg-type]
        check(f"{prefix}.{name}", getattr(instance, name), metadata)


@functools.cache
def _described(parameters: type[Any]) -> tuple[tuple[str, Mapping[str, Any]], ...]:
    """Return name and description of the fields of a class; cached, because a sweep needs them thousands of times."""
    return tuple((entry.name, entry.metadata) for entry in dataclasses.fields(parameters) if "unit" in entry.metadata)


class Validated:
    """Base of parameter classes whose objects are validated when they are created."""

    __slots__ = ()

    def __post_init__(self) -> None:
        validate(self)


def check(path: str, value: Any, metadata: Any) -> None:
    """Check a value against the metadata of a field.

    Args:
        path: name shown in the message.
        value: number, array of numbers, vector, word or words.
        metadata: metadata of the field, see `quantity`.

    Raises:
        ConfigurationError: with the path, the value (the first wrong value of an array) and the range.
    """
    if metadata["choices"] is not None:
        if value not in metadata["choices"]:
            raise ConfigurationError(f"{path}: must be one of {', '.join(metadata['choices'])}, not {value!r}")
        return
    if type(value) is float and metadata["length"] is None:
        return _check_number(path, value, metadata)
    names = (value,) if isinstance(value, str) else value
    texts = isinstance(names, tuple) and names and all(isinstance(name, str) for name in names)
    if texts and metadata["unit"] == "-":
        if metadata["is_file"] and PATH_PATTERN.fullmatch(value):
            return
        for name in names:
            if not NAME_PATTERN.fullmatch(name):
                raise ConfigurationError(f"{path}: must be a name of letters, digits, '_', '.', '-', not {name!r}")
        return
    if value is None:
        return
    length = metadata["length"]
    if length is not None and (not isinstance(value, tuple) or len(value) != length):
        raise ConfigurationError(f"{path}: must be a list of {length} numbers [{metadata['unit']}], not {value!r}")
    # numpy is not imported here; only its arrays have `ravel`.
    numbers = value.ravel().tolist() if hasattr(value, "ravel") else value if isinstance(value, tuple) else (value,)
    for number in numbers:
        _check_number(path, number, metadata)


def _check_number(path: str, number: Any, metadata: Any) -> None:
    """Check a number against the range of a field."""
    unit = metadata["unit"]
    if isinstance(number, bool) or not isinstance(number, int | float):
        raise ConfigurationError(f"{path}: must be a number [{unit}], not {number!r}")
    found = f"{path}: found {number!r} {unit}".removesuffix(" -")
    if not math.isfinite(number):
        raise ConfigurationError(f"{found}, must be a finite number ({metadata['meaning']})")
    if metadata["above"] is not None and not number > metadata["above"]:
        raise ConfigurationError(f"{found}, must be greater than {metadata['above']!r}")
    minimum, maximum = metadata["at_least"], metadata["at_most"]
    if (minimum is None or number >= minimum) and (maximum is None or number <= maximum):
        return
    why = (
        f" ({metadata['why']})" if metadata["why"] and number >= 0.0 else ""
    )  # no reason is needed for a negative mass
    if minimum is not None and number < minimum:
        raise ConfigurationError(f"{found}, must be at least {minimum!r}{why}")
    raise ConfigurationError(f"{found}, must be at most {maximum!r}{why}")


@functools.cache
def field_quantity(parameters: type[Any], path: str) -> Mapping[str, Any]:
    """Return the declaration of a field, see `quantity`; an empty mapping if the path does not exist.

    Args:
        parameters: a parameter class.
        path: path of a value in the class, or of a component.
    """
    inner: Any = parameters
    declared: Mapping[str, Any] = {}
    for key in path.split("."):
        origin = typing.get_origin(inner)
        if dataclasses.is_dataclass(inner) and key in (
            fields := {entry.name: entry for entry in dataclasses.fields(inner)}
        ):
            declared, inner = fields[key].metadata, type_hints(inner)[key]  # type: ignore[arg-type]
            if typing.get_origin(inner) is not Mapping:
                # For an optional table, continue with its class.
                inner = next((entry for entry in typing.get_args(inner) if dataclasses.is_dataclass(entry)), inner)
        elif isinstance(origin, type) and issubclass(origin, Mapping):
            inner = typing.get_args(inner)[1]
        elif key in AXES and declared.get("length") == len(AXES):
            declared, inner = {**declared, "length": None}, float
        else:
            return {}
    return declared


@functools.cache
def type_hints(parameters: type[Any]) -> dict[str, Any]:
    """Return the types of the fields of a dataclass; cached, because every override and every sweep needs them."""
    return typing.get_type_hints(parameters)
