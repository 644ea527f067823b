"""The instances of a vehicle file: its tables with a template, at any depth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.driving import as_driven, driving_of
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import OWN, Instance
from vehicle.model.parameters.quantity import NAME_PATTERN
from vehicle.model.parameters.template import read_template
from vehicle.model.parameters.toml_file import convert, nearest

KEPT = (
    "name",
    "gravity",
    "shaker_wheel",
    "shaker_wheel_in_source",
    "body",
    "solver",
    "driving",
    "hardpoints",
    "outputs",
    "connection",
    "load",
    "alias",
)
"""Keys of a vehicle file that are no instance."""


def instances(
    table: Mapping[str, Any], folders: tuple[Path, ...], own: Mapping[str, Point] = MappingProxyType({})
) -> dict[str, Instance]:
    """Instances of a vehicle file by their paths.

    Args:
        table: the file, as of `read_table`.
        folders: where its own templates are.
        own: points of the file [m].

    Raises:
        ConfigurationError: as of `compose`.
    """
    car: dict[str, Instance] = {}
    driving = driving_of(table)
    for path, numbers in _instances(table, "", ""):
        found = read_template(convert(str, numbers["template"], f"{path}.template"), numbers, folders)
        found = as_driven(found, driving)
        car[path] = Instance(name=path, numbers=numbers, template=found, others=car, given=own, driving=driving)
    return car


def _instances(table: Mapping[str, Any], prefix: str, inside: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Tables with a template, at any depth; outside of an instance every table holds one.

    Args:
        table: to be looked through.
        prefix: path of it.
        inside: the same where it is an instance, or lies in one; empty elsewhere.
    """
    for key, value in table.items():
        place = f"{prefix}{key}"
        if not prefix and key in KEPT:
            continue
        if isinstance(value, Mapping) and "template" in value:
            if not NAME_PATTERN.fullmatch(key):
                raise ConfigurationError(f"{place}: found {key!r}, allowed are letters, digits, '_', '.', '-'")
            yield place, value
            yield from _instances(value, f"{place}.", place)
        elif inside:
            yield from _instances(value, f"{place}.", inside) if isinstance(value, Mapping) else ()
        elif isinstance(value, Mapping) and _holds(value):
            yield from _instances(value, f"{place}.", "")
        elif isinstance(value, Mapping) and set(value) & set(OWN):
            raise ConfigurationError(f"{place}.template: missing; an instance needs template = NAME")
        else:
            near = nearest(key, [other for other in (table if prefix else (*KEPT, *table)) if other != key])
            raise ConfigurationError(
                f"{place}: unknown parameter; the nearest known name is {near}. A table of its own needs template "
                "= NAME"
            )


def _holds(table: Mapping[str, Any]) -> bool:
    """Whether a table holds an instance at any depth, or what lacks a template to be one."""
    inner = [value for value in table.values() if isinstance(value, Mapping)]
    return any(set(value) & {"template", *OWN} or _holds(value) for value in inner)
