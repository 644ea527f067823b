"""An instance: a template with the numbers that a table of the vehicle file gives for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.driving import STANDING, Driving
from vehicle.model.parameters.hardpoints import Point, mirrored, require_apart, require_point, require_triangle
from vehicle.model.parameters.parts import Part
from vehicle.model.parameters.toml_file import build, convert, nearest
from vehicle.model.parameters.topology import Template
from vehicle.names import SIDE_SIGN

T = TypeVar("T")
RIGHT, LEFT = SIDE_SIGN
OWN = ("template", "hardpoints", "parts", "bushings", "ports", *SIDE_SIGN)
"""Keys of an instance that are no element of its template."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Instance:
    """A template with numbers; tables of a side lie over those of the instance.

    Attributes:
        name: path of its table.
        numbers: the table.
        template: topology.
        others: all instances of the car by name.
        given: hardpoints of the vehicle file by name [m].
        driving: how the car drives.
        typed: parameter objects of the whole instance that are there already, by path.
        taken: tables and points of a side that something took.
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
        # What the template has no place for is a slip of the pen.
        template = self.template
        pools: dict[str, list[str]] = {
            "hardpoints": [*template.hardpoints],
            "parts": [*template.parts],
            "bushings": [one.name for one in template.connection],
            "ports": [*template.ports, "body"],
        }
        elements = [*(one.name for one in template.spring), *(one.name for one in template.damper)]
        sides = {f"{side}.": self.numbers.get(side, {}) for side in SIDE_SIGN}
        for where, given in (("", self.numbers), *sides.items()):
            table = convert(dict, given, f"{self.name}.{where}".rstrip("."))
            own = OWN if not where else tuple(pools)
            for key, inner in table.items():
                instance = not where and isinstance(inner, Mapping) and "template" in inner
                if key not in own and key not in elements and not instance:
                    self._unknown(f"{where}{key}", key, [*own, *elements])
            for group, pool in pools.items():
                for key in convert(dict, table.get(group, {}), f"{self.name}.{where}{group}"):
                    if key not in pool:
                        self._unknown(f"{where}{group}.{key}", key, pool)
        for group in ("hardpoints", "parts"):
            for key in pools[group]:
                if key not in self.numbers.get(group, {}):
                    self.missing(f"{group}.{key}", ", ".join(pools[group]))

    def _unknown(self, place: str, key: str, known: list[str]) -> None:
        near = f"the nearest known name is {nearest(key, known)}" if known else f"{self.template.file} has none"
        raise ConfigurationError(f"{self.name}.{place}: unknown parameter; {near}")

    def missing(self, place: str, needed: str) -> None:
        """Refuse a table that is not there.

        Raises:
            ConfigurationError: always.
        """
        raise ConfigurationError(f"{self.name}.{place}: missing; {self.template.file} needs {needed}")

    def has(self, *keys: str) -> bool:
        """Whether the vehicle file gives a table."""
        return bool(self._found(RIGHT, keys) or self._found(LEFT, keys))

    def get(self, kind: type[T], side: str | None, *keys: str) -> T:
        """Numbers of an element.

        Args:
            kind: their class.
            side: "right" or "left"; None of what exists once.
            keys: path in the table of the instance.

        Raises:
            ConfigurationError: they are missing or wrong.
        """
        path, tables = ".".join((self.name, *keys)), self._found(side, keys)
        if not tables:
            self.missing(".".join(keys), "it")
        self.taken.add(f"{side}.{'.'.join(keys)}")
        if len(tables) > 1:
            return build(kind, {**tables[0], **tables[1]}, f"{self.name}.{side}.{'.'.join(keys)}")
        if path not in self.typed:
            self.typed[path] = build(kind, tables[0], path)
        found: T = self.typed[path]
        return found

    def _found(self, side: str | None, keys: tuple[str, ...]) -> list[Mapping[str, Any]]:
        """The table of the instance and that of a side, where they are."""
        found = []
        for table in (self.numbers, self.numbers.get(side, {}) if side else {}):
            for key in keys:
                table = table.get(key) if isinstance(table, Mapping) else None
            if table is not None:
                found.append(convert(dict, table, ".".join((self.name, *keys))))
        return found

    def sides(self) -> tuple[str | None, ...]:
        """Right, left and once; once only of what is not mirrored."""
        return (*SIDE_SIGN, None) if self.template.mirrored else (None,)

    def label(self, name: str, side: str | None) -> str:
        """Name of an element in the model: of a corner, of a side, or as it is."""
        if self.template.wheel is not None:
            corner = {"front": "f", "rear": "r"}.get(self.name, f"{self.name}_")
            return f"{name}_{corner}{side[0]}" if side else f"{name}_{self.name}"
        own = self.name.partition(".")[2].replace(".", "_")
        return "_".join(word for word in (name, own, side) if word)

    def part(self, ref: str, side: str | None) -> str:
        """Name of a part in the model, from a name of the template."""
        name, _, own = ref.partition(":")
        if name in self.template.parts or name == "plate":
            return self.label(name, own or side)
        bound = convert(str, self.numbers.get("ports", {}).get(name, name), f"{self.name}.ports.{name}")
        if bound == name and name in self.template.ports:
            self.missing(f"ports.{name}", self.template.ports[name])
        other, dot, inner = bound.rpartition(".")
        if not dot or other not in self.others:
            return str(bound)
        return self.others[other].part(inner, (own or side) if self.others[other].template.mirrored else None)

    def point(self, ref: str, side: str | None, asked: tuple[str, ...] = ()) -> Point:
        """A point on a side [m]: its coordinates, a hardpoint of the file, or "other.name", that of an instance.

        Args:
            ref: name of the template, with its side where it has one.
            side: "right" or "left"; None of what exists once.
            asked: paths of the points that took this one.

        Raises:
            ConfigurationError: it is no point, or leads back to itself.
        """
        name, _, own = ref.partition(":")
        own, path = own or side or "", f"{self.name}.hardpoints.{name}"
        given = self.numbers.get(own, {}).get("hardpoints", {}).get(name) if own in SIDE_SIGN else None
        if given is not None:
            point: Point = convert(Point, given, f"{self.name}.{own}.hardpoints.{name}")
            require_point(f"{self.name}.{own}.hardpoints.{name}", point, right=False)
            if point[1] * SIDE_SIGN[own] < 0.0:
                raise ConfigurationError(
                    f"{self.name}.{own}.hardpoints.{name}: found y = {point[1]} m, which is on the other side; points "
                    "of one side are where they really are, y > 0 on the right"
                )
            self.taken.add(f"{own}.hardpoints.{name}")
            return point
        value = self.numbers["hardpoints"][name]
        value = self.given.get(value, value) if isinstance(value, str) else value
        if isinstance(value, str):
            other, _, there = value.rpartition(".")
            if other not in self.others or there not in self.others[other].template.hardpoints:
                raise ConfigurationError(
                    f"{path}: found {value!r}; needed are coordinates, the name of a point of [hardpoints], or "
                    "INSTANCE.POINT of another one"
                )
            if path in asked:
                raise ConfigurationError(f"{path}: found {value!r}, which leads back to it; give one its coordinates")
            there_side = (own or None) if self.others[other].template.mirrored else None
            return self.others[other].point(there, there_side, (*asked, path))
        if path not in self.typed:
            right: Point = convert(Point, value, path)
            require_point(path, right, right=self.template.mirrored)
            self.typed[path] = right
        if own == "middle":
            return (self.typed[path][0], 0.0, self.typed[path][2])
        return mirrored(self.typed[path], SIDE_SIGN.get(own, 1.0))

    def point_name(self, ref: str, side: str | None) -> str:
        """Name of a point in the model."""
        name, _, own = ref.partition(":")
        return self.label(name, own or side)

    def body(self, name: str, side: str | None) -> Part:
        """Mass and inertia of a part, of a rod where no inertia is given; its frame is that of the right side.

        Raises:
            ConfigurationError: there is no inertia, and no rod between two points either.
        """
        numbers, points = self.get(Part, side, "parts", name), self.template.parts[name].points
        if numbers.inertia is None and len(points) < 2:
            raise ConfigurationError(
                f"{self.name}.parts.{name}.inertia: missing; only a rod between two points has its own"
            )
        if numbers.inertia is not None:
            return numbers
        sign = SIDE_SIGN.get(side or "", 1.0)
        start, end = (mirrored(self.point(point, side), sign) for point in points[:2])
        return numbers.as_rod(start, end)

    def cog(self, name: str, side: str | None) -> Point:
        """Centre of gravity of a part [m]: the mean of its points, and its offset.

        Raises:
            ConfigurationError: it names a point that the template does not have.
        """
        numbers = self.get(Part, side, "parts", name)
        points = self.template.parts[name].points if numbers.between is None else numbers.between
        for point in points:
            if point not in self.template.hardpoints:
                near = nearest(point, self.template.hardpoints)
                raise ConfigurationError(
                    f"{self.name}.parts.{name}.between: unknown hardpoint {point!r}; the nearest is {near}"
                )
        chosen = [self.point(point, side) for point in points]
        x, y, z = (sum(axis) / len(chosen) for axis in zip(*chosen, strict=True))
        offset = mirrored(numbers.offset, SIDE_SIGN.get(side or "", 1.0))
        return (x + offset[0], y + offset[1], z + offset[2])

    def require_geometry(self) -> None:
        """Refuse points that no car has: coincident ones of a part, an arm on one line, a strut that hangs down.

        Raises:
            ConfigurationError: naming the points.
        """
        for high, low in self.template.above:
            top, bottom = (self.point(name, RIGHT) for name in (high, low))
            if top[2] <= bottom[2]:
                raise ConfigurationError(
                    f"{self.name}.hardpoints.{high}: found z = {top[2]} m, must lie above {self.name}.hardpoints.{low} "
                    f"(z = {bottom[2]} m)"
                )
        for names in self._groups():
            points = {f"{self.name}.hardpoints.{name}": self.point(name, RIGHT) for name in names}
            require_apart(points)
        for part in self.template.parts.values():
            if part.shape.endswith("arm") and len(part.points) > 2:
                require_triangle({f"{self.name}.hardpoints.{name}": self.point(name, RIGHT) for name in part.points})

    def _groups(self) -> Iterator[tuple[str, ...]]:
        """Points that must not coincide: those of a part, of an axis, of a wheel, the joints of a part."""
        template = self.template
        yield from (part.points for part in template.parts.values())
        yield from (joint.along for joint in template.joint if joint.along)
        yield from (one.axes for one in template.connection if one.axes)
        for name in template.parts:
            held = [one.at for one in template.connection if name in (one.moving, one.carrier)]
            held += [one.at for one in template.joint if one.at and name in (*one.child, one.parent) and not one.along]
            yield tuple(dict.fromkeys(held))
        if template.wheel is not None:
            yield (template.wheel.center, template.wheel.patch)
