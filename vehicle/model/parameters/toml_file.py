"""Conversion of TOML files to parameter objects and back, with strict names and types."""

import dataclasses
import functools
import json
import tomllib
import types
import typing
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import NAME_PATTERN, field_quantity, type_hints
from vehicle.wording import did_you_mean

T = TypeVar("T")

LARGEST_FILE = 10_000_000
"""Maximum size of a parameter file [byte], far above that of any body."""


def read_table(path: Path) -> dict[str, Any]:
    """Read a TOML file into nested dictionaries.

    Raises:
        ConfigurationError: the file is missing, not a file, too large, not UTF-8 or not TOML.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: the file does not exist; give the path of a parameter file (TOML)")
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ConfigurationError(f"{path}: is larger than {LARGEST_FILE / 1e6:g} MB, so it is not a parameter file")
        return copy_table(_parsed(path.read_text(encoding="utf-8")))
    except RecursionError:
        raise ConfigurationError(
            f"{path}: sections or lists are nested too deep, so it is not a parameter file"
        ) from None
    except UnicodeDecodeError as error:
        raise ConfigurationError(f"{path}: is not UTF-8 text at byte {error.start}; save the file as UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        raise ConfigurationError(f"{path}: not a TOML file: {error}") from None
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read: {error.strerror}") from None


# A sweep reads the same file for each of its thousands of cars.
@functools.lru_cache(maxsize=16)
def _parsed(text: str) -> dict[str, Any]:
    return tomllib.loads(text)


def build(cls: type[T], table: Mapping[str, Any], path: str = "") -> T:
    """Build a parameter object from nested dictionaries.

    Args:
        cls: a dataclass whose fields are numbers, texts, vectors (tuples), parameter classes or mappings of them.
        table: values by the names of the fields.
        path: dotted path of this table, shown in messages.

    Raises:
        ConfigurationError: an unknown name (with the nearest known name), a missing name or a wrong type.
    """
    hints, fields = type_hints(cls), _fields(cls)  # type: ignore[arg-type]
    for key in table:
        if key not in fields:
            raise ConfigurationError(f"{_join(path, key)}: unknown parameter{did_you_mean(key, fields)}")
    values: dict[str, Any] = {}
    missing: list[dataclasses.Field[Any]] = []
    for name, entry in fields.items():
        if name in table:
            values[name] = convert(hints[name], table[name], _join(path, name))
        elif entry.default is dataclasses.MISSING and entry.default_factory is dataclasses.MISSING:
            missing.append(entry)
    if missing:
        first, *others = missing
        also = f"; so must {', '.join(f'{entry.name}{_needed(entry)}' for entry in others)}" if others else ""
        raise ConfigurationError(
            f"{_join(path, first.name)}: missing; this parameter must be given{_needed(first)}{also}"
        )
    try:
        return cls(**values)
    except ConfigurationError as error:
        # Replace the name of the class by the path in the file.
        message = str(error)
        if path and message.startswith(cls.__name__ + "."):
            message = path + message[len(cls.__name__) :]
        elif not path and message.startswith(cls.__name__ + "."):
            message = message[len(cls.__name__) + 1 :]
        raise ConfigurationError(message) from None


def _needed(entry: dataclasses.Field[Any]) -> str:
    """Return the choices or the unit of a field, in brackets, for messages."""
    choices, unit = entry.metadata.get("choices"), entry.metadata.get("unit")
    return f" [{' or '.join(choices)}]" if choices else f" [{unit}]" if unit else ""


def as_table(instance: Any) -> dict[str, Any]:
    """Return nested dictionaries of a parameter object, the inverse of `build`; for a vehicle, its stored table."""
    if isinstance(table := getattr(instance, "table", None), Mapping):
        return copy_table(table)
    return {
        entry.name: _plain(getattr(instance, entry.name))
        for entry in dataclasses.fields(instance)
        if getattr(instance, entry.name) is not None
    }


def write_text(instance: Any, header: str = "", describe: Callable[[str], Mapping[str, Any]] | None = None) -> str:
    """Return the TOML text of a parameter object, with unit and meaning of each value as a comment.

    Args:
        instance: the object.
        header: first lines of the text, without the comment sign.
        describe: function of the path of a value that returns its "unit" and "meaning"; by default its declaration.

    Returns:
        The text; `build(type(instance), tomllib.loads(text))` returns an equal object.
    """
    lines = [f"# {line}".rstrip() for line in header.splitlines()]
    declared = getattr(instance, "quantity_of", lambda path: field_quantity(type(instance), path))  # type: ignore[arg-type]
    _write(as_table(instance), "", lines, describe or declared)
    return "\n".join(lines).strip() + "\n"


def _write(table: Mapping[str, Any], path: str, lines: list[str], describe: Callable[[str], Mapping[str, Any]]) -> None:
    for key, value in table.items():
        if not isinstance(value, Mapping):
            declared = describe(_join(path, key))
            comment = f"  # [{declared['unit']}] {declared['meaning']}".rstrip() if "unit" in declared else ""
            lines.append(f"{_key(key)} = {literal(value)}{comment}")
    for key, value in table.items():
        if isinstance(value, Mapping):
            prefix = _join(path, _key(key))
            if not value or any(not isinstance(inner, Mapping) for inner in value.values()):
                lines.extend(["", f"[{prefix}]"])
            _write(value, prefix, lines, describe)


def _key(key: str) -> str:
    return key if NAME_PATTERN.fullmatch(key) and "." not in key else literal(key)


def literal(value: Any) -> str:
    """Return a number, truth value, text or list as TOML text."""
    if isinstance(value, str | bool):
        return json.dumps(value, ensure_ascii=False)  # a text of JSON is one of TOML
    if isinstance(value, tuple | list):
        return "[" + ", ".join(literal(item) for item in value) + "]"
    return repr(value)


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return as_table(value)
    if isinstance(value, Mapping):
        return {key: _plain(member) for key, member in value.items()}
    if isinstance(value, tuple):
        return [_plain(member) for member in value]
    return value


def convert(hint: Any, value: Any, path: str) -> Any:
    """Convert a TOML value to the type of its field.

    Args:
        hint: float, str, bool, dict, a tuple, a mapping, a parameter class, or a union of one of these with None
            or with a mapping.
        value: value in the file.
        path: path of the parameter, shown in messages.

    Raises:
        ConfigurationError: the value has another type.
    """
    if hint is float:
        return _number(value, path)
    origin, arguments = _parts_of(hint)
    if origin in (types.UnionType, typing.Union):
        first, *others = (option for option in arguments if option is not type(None))
        table = isinstance(value, Mapping) and any(typing.get_origin(option) is Mapping for option in others)
        return convert(others[-1] if table else first, value, path)
    if hint is dict and not isinstance(value, Mapping):
        raise ConfigurationError(f"{path}: must be a section, not {value!r}")
    if dataclasses.is_dataclass(hint):
        if not isinstance(value, Mapping):
            raise ConfigurationError(f"{path}: must be a section [{path}] with lines name = value, not {value!r}")
        return build(typing.cast(type[Any], hint), value, path)
    if origin is not None and isinstance(origin, type) and issubclass(origin, Mapping):
        if not isinstance(value, Mapping):
            raise ConfigurationError(f"{path}: must be a section, not {value!r}")
        inner_hint = arguments[1]
        return types.MappingProxyType(
            {key: convert(inner_hint, member, _join(path, key)) for key, member in value.items()}
        )
    if origin is tuple:
        if not isinstance(value, list | tuple):
            raise ConfigurationError(f"{path}: must be a list, not {value!r}")
        return tuple(convert(arguments[0], item, path) for item in value)
    if hint is str and not isinstance(value, str):
        raise ConfigurationError(f"{path}: must be a text in quotes, not {value!r}")
    if hint is bool and not isinstance(value, bool):
        raise ConfigurationError(f"{path}: must be true or false, not {value!r}")
    return value


def _number(value: Any, path: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ConfigurationError(f"{path}: must be a number, not {value!r}")
    try:
        return float(value)
    except OverflowError:
        raise ConfigurationError(f"{path}: found a whole number beyond 1.8e308, must be a finite number") from None


def copy_table(table: Mapping[str, Any]) -> dict[str, Any]:
    """Copy nested dictionaries, lists included."""
    return {
        key: copy_table(value) if isinstance(value, Mapping) else list(value) if isinstance(value, list) else value
        for key, value in table.items()
    }


def _join(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


@functools.cache
def _fields(parameters: type[Any]) -> dict[str, dataclasses.Field[Any]]:
    """Return the fields of a dataclass by name; cached, see `type_hints`."""
    return {entry.name: entry for entry in dataclasses.fields(parameters)}


@functools.cache
def _parts_of(hint: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return origin and arguments of a generic type; cached, see `type_hints`."""
    return typing.get_origin(hint), typing.get_args(hint)
