"""Instances: the tables of a vehicle file that name a template, at any depth.

An instance looks up numbers, names and points while a car is composed. `Composition`, the result, contains none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.driving import STANDING, Driving, as_driven, driving_of
from vehicle.model.parameters.engine_orders import ENGINE, ORDERS
from vehicle.model.parameters.hardpoints import Point, mirrored, require_point
from vehicle.model.parameters.quantity import NAME_PATTERN
from vehicle.model.parameters.template import read_template
from vehicle.model.parameters.tested_range import merged_law
from vehicle.model.parameters.toml_file import build, convert
from vehicle.model.parameters.topology import Template
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES
from vehicle.names import SIDE_SIGN
from vehicle.wording import did_you_mean

T = TypeVar("T")
RIGHT, LEFT = SIDE_SIGN

INSTANCE_KEYS = ("template", "hardpoints", "parts", "bushings", "ports", *SIDE_SIGN)
"""Keys of an instance that are not names of elements of its template."""

VEHICLE_KEYS = (
    "name",
    "gravity",
    "shaker_wheel",
    "shaker_wheel_in_source",
    "apply_forces",
    "body",
    "solver",
    "driving",
    "crank",
    "hardpoints",
    "outputs",
    "connection",
    "load",
    "force",
    "alias",
)
"""Keys of a vehicle file that are not instances."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Instance:
    """A template with the numbers of one table of the vehicle file; the table of a side takes precedence.

    Attributes:
        name: path of the table.
        numbers: the table.
        template: elements by name.
        others: all instances of the car by name.
        given: hardpoints of the vehicle file by name [m].
        driving: speed of the car and hold of its course.
        typed: parameter objects and points that are already built, by the path of their table.
        taken: tables and points of a side that an element uses.
    """

    name: str
    numbers: Mapping[str, Any]
    template: Template
    others: Mapping[str, Instance]
    given: Mapping[str, Point] = field(default_factory=dict)
    driving: Driving = STANDING
    typed: dict[str, Any] = field(default_factory=dict)
    taken: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        # A key that the template does not have is a spelling mistake.
        template = self.template
        pools: dict[str, list[str]] = {
            "hardpoints": [*template.hardpoints],
            "parts": [*template.parts],
            "bushings": [connection.name for connection in template.connection],
            "ports": [*template.ports, "body"],
        }
        elements = [*(spring.name for spring in template.spring), *(damper.name for damper in template.damper)]
        elements += WHEEL_FORCES if template.wheel is not None else ()
        elements += [ORDERS] if ENGINE in template.parts else ()
        sides = {f"{side}.": self.numbers.get(side, {}) for side in SIDE_SIGN}
        for prefix, value in (("", self.numbers), *sides.items()):
            table = convert(dict, value, f"{self.name}.{prefix}".rstrip("."))
            groups = INSTANCE_KEYS if not prefix else tuple(pools)
            for key, inner in table.items():
                instance = not prefix and isinstance(inner, Mapping) and "template" in inner
                if key not in groups and key not in elements and not instance:
                    self._unknown(f"{prefix}{key}", key, [*groups, *elements])
            for group, pool in pools.items():
                for key in convert(dict, table.get(group, {}), f"{self.name}.{prefix}{group}"):
                    if key not in pool:
                        self._unknown(f"{prefix}{group}.{key}", key, pool)
        for group in ("hardpoints", "parts"):
            for key in pools[group]:
                if key not in self.numbers.get(group, {}):
                    self.missing(f"{group}.{key}", ", ".join(pools[group]))

    def _unknown(self, path: str, key: str, names: list[str]) -> None:
        near = did_you_mean(key, names) or f"; {self.template.file} has none"
        raise ConfigurationError(f"{self.name}.{path}: unknown parameter{near}")

    def missing(self, path: str, needed: str) -> None:
        """Raise the error of a missing table.

        Args:
            path: path of the table in the instance.
            needed: names that the template requires.

        Raises:
            ConfigurationError: always.
        """
        raise ConfigurationError(f"{self.name}.{path}: missing; {self.template.file} needs {needed}")

    def has(self, *keys: str) -> bool:
        """Return True if the vehicle file gives a table for the instance or for one of its sides."""
        return bool(self._tables(RIGHT, keys) or self._tables(LEFT, keys))

    def get(self, parameters: type[T], side: str | None, *keys: str) -> T:
        """Return the numbers of an element.

        Args:
            parameters: parameter class of the numbers.
            side: "right" or "left"; None for an element that exists once.
            keys: path in the table of the instance.

        Raises:
            ConfigurationError: the table is missing or a value is wrong.
        """
        tables = self._tables(side, keys)
        if not tables:
            self.missing(".".join(keys), "it")
        self.taken.add(f"{side}.{'.'.join(keys)}")
        *_, path = tables
        if len(tables) > 1:
            first, second = tables.values()
            return build(parameters, merged_law(first, second), path)
        if path not in self.typed:
            self.typed[path] = build(parameters, tables[path], path)
        numbers: T = self.typed[path]
        return numbers

    def table_paths(self, side: str | None, *keys: str) -> tuple[str, ...]:
        """Return the paths of the tables that hold the numbers of an element; arguments: see `get`."""
        return tuple(self._tables(side, keys))

    def _tables(self, side: str | None, keys: tuple[str, ...]) -> dict[str, Mapping[str, Any]]:
        """Return the table of the instance and the table of a side, as far as they exist, by path."""
        tables = {}
        for prefix in ((self.name,), (self.name, side)) if side else ((self.name,),):
            table: Any = self.numbers
            for key in (*prefix[1:], *keys):
                table = table.get(key) if isinstance(table, Mapping) else None
            if table is not None:
                tables[".".join((*prefix, *keys))] = convert(dict, table, ".".join((self.name, *keys)))
        return tables

    def sides(self) -> tuple[str | None, ...]:
        """Return right, left and None for a mirrored template; None alone for any other."""
        return (*SIDE_SIGN, None) if self.template.mirrored else (None,)

    def label(self, name: str, side: str | None) -> str:
        """Return the name of an element in the model, for example "knuckle_fr", "cushion_driver" or "engine"."""
        if self.template.wheel is not None:
            corner = {"front": "f", "rear": "r"}.get(self.name, f"{self.name}_")
            return f"{name}_{corner}{side[0]}" if side else f"{name}_{self.name}"
        suffix = self.name.partition(".")[2].replace(".", "_")
        return "_".join(word for word in (name, suffix, side) if word)

    def part(self, ref: str, side: str | None) -> str:
        """Return the name of a part in the model, from its name in the template."""
        name, _, ref_side = ref.partition(":")
        if name in self.template.parts or name == "plate":
            return self.label(name, ref_side or side)
        default = self.template.port_defaults.get(name, name)
        bound = convert(str, self.numbers.get("ports", {}).get(name, default), f"{self.name}.ports.{name}")
        if bound == name and name in self.template.ports:
            self.missing(f"ports.{name}", self.template.ports[name])
        other, dot, inner = bound.rpartition(".")
        if not dot or other not in self.others:
            return str(bound)
        return self.others[other].part(inner, (ref_side or side) if self.others[other].template.mirrored else None)

    def point(self, ref: str, side: str | None, asked: tuple[str, ...] = ()) -> Point:
        """Return a point on a side [m]: its coordinates, a hardpoint of the file, or "other.name" of an instance.

        Args:
            ref: name of the template, optionally with its side.
            side: "right" or "left"; None for a point that exists once.
            asked: paths of the points that refer to this point.

        Raises:
            ConfigurationError: the value is no point, or refers to itself.
        """
        name, _, ref_side = ref.partition(":")
        side, path = ref_side or side or "", f"{self.name}.hardpoints.{name}"
        coordinates = self.numbers.get(side, {}).get("hardpoints", {}).get(name) if side in SIDE_SIGN else None
        if coordinates is not None:
            point: Point = convert(Point, coordinates, f"{self.name}.{side}.hardpoints.{name}")
            require_point(f"{self.name}.{side}.hardpoints.{name}", point, right=False)
            if point[1] * SIDE_SIGN[side] < 0.0:
                raise ConfigurationError(
                    f"{self.name}.{side}.hardpoints.{name}: found y = {point[1]} m, which is on the other side; "
                    "points of a single side are not mirrored, y > 0 is on the right"
                )
            self.taken.add(f"{side}.hardpoints.{name}")
            return point
        value = self.numbers["hardpoints"][name]
        value = self.given.get(value, value) if isinstance(value, str) else value
        if isinstance(value, str):
            other, _, other_point = value.rpartition(".")
            if other not in self.others or other_point not in self.others[other].template.hardpoints:
                raise ConfigurationError(
                    f"{path}: found {value!r}, must be coordinates, the name of a point of [hardpoints], or "
                    "SECTION.POINT for a point of another section"
                )
            if path in asked:
                raise ConfigurationError(
                    f"{path}: found {value!r}, which refers back to this point; give the coordinates of one "
                    "of the points"
                )
            other_side = (side or None) if self.others[other].template.mirrored else None
            return self.others[other].point(other_point, other_side, (*asked, path))
        if path not in self.typed:
            right: Point = convert(Point, value, path)
            require_point(path, right, right=self.template.mirrored)
            self.typed[path] = right
        if side == "middle":
            return (self.typed[path][0], 0.0, self.typed[path][2])
        return mirrored(self.typed[path], SIDE_SIGN.get(side, 1.0))

    def point_name(self, ref: str, side: str | None) -> str:
        """Return the name of a point in the model."""
        name, _, ref_side = ref.partition(":")
        return self.label(name, ref_side or side)


def instances(
    table: Mapping[str, Any], folders: tuple[Path, ...], points: Mapping[str, Point] = MappingProxyType({})
) -> dict[str, Instance]:
    """Return the instances of a vehicle file by their paths.

    Args:
        table: vehicle file, see `read_table`.
        folders: folders of user templates, searched before the package.
        points: hardpoints of the file [m].

    Raises:
        ConfigurationError: see `compose`.
    """
    car: dict[str, Instance] = {}
    driving = driving_of(table)
    for path, numbers in _instance_tables(table, "", ""):
        template = read_template(convert(str, numbers["template"], f"{path}.template"), numbers, folders)
        template = as_driven(template, driving)
        car[path] = Instance(name=path, numbers=numbers, template=template, others=car, given=points, driving=driving)
    return car


def _instance_tables(table: Mapping[str, Any], prefix: str, instance: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the tables with a template, with their paths; outside an instance, every table contains an instance."""
    for key, value in table.items():
        path = f"{prefix}{key}"
        if not prefix and key in VEHICLE_KEYS:
            continue
        if isinstance(value, Mapping) and "template" in value:
            if not NAME_PATTERN.fullmatch(key):
                raise ConfigurationError(f"{path}: found {key!r}, must consist of letters, digits, '_', '.', '-'")
            yield path, value
            yield from _instance_tables(value, f"{path}.", path)
        elif instance:
            yield from _instance_tables(value, f"{path}.", instance) if isinstance(value, Mapping) else ()
        elif isinstance(value, Mapping) and _contains_instance(value):
            yield from _instance_tables(value, f"{path}.", "")
        elif isinstance(value, Mapping) and set(value) & set(INSTANCE_KEYS):
            raise ConfigurationError(f"{path}.template: missing; the section needs template = NAME")
        else:
            near = did_you_mean(
                key, [other for other in (table if prefix else (*VEHICLE_KEYS, *table)) if other != key]
            )
            raise ConfigurationError(f"{path}: unknown parameter{near} A new section needs template = NAME")


def _contains_instance(table: Mapping[str, Any]) -> bool:
    """Return True if a table contains an instance at any depth, or a table that only lacks the template."""
    inner = [value for value in table.values() if isinstance(value, Mapping)]
    return any(set(value) & {"template", *INSTANCE_KEYS} or _contains_instance(value) for value in inner)


def elements(car: Mapping[str, Instance], group: str) -> list[tuple[Instance, Any, str | None]]:
    """Return the elements of a type on each side: instance, entry of the template, side.

    Args:
        car: instances by name.
        group: list of the template: "joint", "connection", "spring", "damper" or "output".
    """
    listed: list[tuple[Instance, Any, str | None]] = []
    for instance in car.values():
        once = {joint.name for joint in instance.template.joint if _names_a_side(joint)}
        for entry in getattr(instance.template, group):
            single = _names_a_side(entry) or getattr(entry, "joint", None) in once - {None}
            sides = instance.sides()
            listed += [
                (instance, entry, side) for side in (sides if len(sides) == 1 else (None,) if single else sides[:2])
            ]
    return listed


def _names_a_side(entry: Any) -> bool:
    parts = [getattr(entry, key, None) for key in ("parent", "moving", "carrier", "on")]
    return any(":" in (word or "") for word in (*parts, *getattr(entry, "child", ())))
