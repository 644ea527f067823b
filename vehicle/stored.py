"""Frozen dataclasses that are objects of a JSON file: they write themselves, and check keys and types when read."""

from collections.abc import Mapping
from dataclasses import MISSING, field, fields
from functools import cache
from types import NoneType, UnionType
from typing import Any, Self, get_args, get_origin, get_type_hints


def omitted() -> Any:
    """Declare a field that has no key in the file while it is None, in name of a null."""
    return field(default=None, metadata={"omitted": True})


class Stored:
    """Base of a frozen dataclass whose fields are the keys of an object in a file, in their order.

    A field with a default may be missing in a file of an earlier version; other keys of the file are ignored.
    """

    __slots__ = ()

    def to_json(self) -> dict[str, Any]:
        """Return the object as it is written."""
        values = {each.name: (each, getattr(self, each.name)) for each in fields(self)}  # type: ignore[arg-type]
        return {
            name: _plain(value)
            for name, (each, value) in values.items()
            if value is not None or "omitted" not in each.metadata
        }

    @classmethod
    def from_json(cls, content: object) -> Self:
        """Return the instance of an object of a file.

        Raises:
            ValueError: a key is missing, or a value has another type; the message contains its path.
        """
        instance: Self = _read(content, cls, "")
        return instance


def _plain(value: Any) -> Any:
    """Return a value of a field as dictionaries, lists and numbers."""
    if isinstance(value, Stored):
        return value.to_json()
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value


@cache
def _keys(stored: Any) -> dict[str, tuple[Any, bool]]:
    """Return the type of each key of a class of `Stored`, and True if the key must be in the file."""
    hints, keys = get_type_hints(stored), {}
    for each in fields(stored):
        expected = hints[each.name]
        if "omitted" in each.metadata:  # absent, but never null
            (expected,) = (each for each in get_args(expected) if each is not NoneType)
        keys[each.name] = expected, each.default is MISSING and each.default_factory is MISSING
    return keys


def _read(value: Any, expected: Any, path: str) -> Any:
    """Return a value of a file as the expected type; `path` ends with a dot."""
    name = path.rstrip(".") or "content"
    if isinstance(expected, type) and issubclass(expected, Stored):
        if not isinstance(value, dict):
            raise ValueError(f"{name}: must be an object")
        keys = _keys(expected)  # type: ignore[arg-type]
        if missing := sorted(key for key, (_, required) in keys.items() if required and key not in value):
            raise ValueError(f"{path}{missing[0]}: missing")
        values = {key: _read(value[key], type_, f"{path}{key}.") for key, (type_, _) in keys.items() if key in value}
        return expected(**values)
    kinds = get_args(expected)
    if isinstance(expected, UnionType):
        faults = []
        for alternative in kinds:
            try:
                return _read(value, alternative, path)
            except ValueError as error:
                faults.append(error)
        raise faults[0]
    container = get_origin(expected)
    if container is dict:
        if not isinstance(value, dict):
            raise ValueError(f"{name}: must be an object")
        return {key: _read(item, kinds[1], f"{path}{key}.") for key, item in value.items()}
    if container in (list, tuple):
        if not isinstance(value, list):
            raise ValueError(f"{name}: must be a list")
        return container(_read(item, kinds[0], f"{path}{number}.") for number, item in enumerate(value))
    if expected is not Any and not isinstance(value, (int, float) if expected is float else expected):
        raise ValueError(f"{name}: found {value!r}, must be {expected.__name__}")
    return value
