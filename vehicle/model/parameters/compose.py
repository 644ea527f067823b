"""A vehicle file and its templates into the composition of a car; knows kinds of joints, and no name of a part."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters import topology
from vehicle.model.parameters.additions import further_connection, further_output, law_kind, own_point, placed_load
from vehicle.model.parameters.axes import axes_along
from vehicle.model.parameters.composition import (
    Composition,
    JointSpring,
    PlacedConnection,
    PlacedOutput,
    PlacedPart,
    PlacedSpring,
    PlacedWheel,
    Rolling,
    Source,
)
from vehicle.model.parameters.dampers import placed_damper
from vehicle.model.parameters.elements import Bushing, Damper, Hydromount
from vehicle.model.parameters.freedoms import freedoms
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import Instance
from vehicle.model.parameters.instances import instances
from vehicle.model.parameters.loads import Load
from vehicle.model.parameters.parts import Part
from vehicle.model.parameters.references import (
    require_aliases,
    require_points,
    require_ports,
    require_sound,
    require_taken,
)
from vehicle.model.parameters.springs import placed_spring, spring_kind
from vehicle.model.parameters.toml_file import convert
from vehicle.names import SIDE_SIGN

KEPT_TABLES = ("hardpoints", "connection", "outputs", "alias", "load")
"""Tables of a vehicle file that are no instance and hold tables or points by name."""

Elements = list[tuple[Instance, Any, str | None]]


def compose(table: Mapping[str, Any], folders: tuple[Path, ...]) -> Composition:
    """Put the instances of a vehicle file together.

    Args:
        table: the file, as of `read_table`.
        folders: where its own templates are.

    Returns:
        Everything placed and named; parents before their children.

    Raises:
        ConfigurationError: a name that leads nowhere, numbers that are missing or wrong, a part that nothing holds, a
            loop of joints; the message names table and template.
    """
    given = {key: convert(dict, table.get(key, {}), key) for key in KEPT_TABLES}
    own = {name: own_point(f"hardpoints.{name}", value) for name, value in given["hardpoints"].items()}
    car = instances(table, folders, own)
    points = dict(itertools.chain.from_iterable(map(_points, car.values())))
    if twice := sorted(set(own) & set(points)):
        raise ConfigurationError(f"hardpoints.{twice[0]}: an instance has a point of this name; give it another one")
    points = {**own, **points}
    for instance in car.values():
        instance.require_geometry()
    names = {"body", "world", *(one.plate for one in _wheels(car))}
    names |= {i.label(name, side) for i in car.values() for name in i.template.parts for side in i.sides()}
    require_ports(car, names)
    parts, wheels = _parts(car), _wheels(car)
    laws = _made(_connection, sorted(_elements(car, "connection"), key=lambda one: _rank(one[2])))
    laws.sort(key=lambda one: one[0].law is None)
    connections = [one for one, _ in laws]
    connections += [further_connection(name, one, names, points) for name, one in given["connection"].items()]
    springs = _made(placed_spring, _elements(car, "spring"))
    between, on_joints = ([one for one in springs if isinstance(one[0], kind)] for kind in (PlacedSpring, JointSpring))
    dampers = _made(placed_damper, _elements(car, "damper"))
    added = [further_output(name, one, names, points) for name, one in given["outputs"].items()]
    held = {"body", *(one.name for one, _ in parts if one.seat is None)}
    loads = [placed_load(name, one, held, points) for name, one in given["load"].items()]
    composed = Composition(
        parts=(*(one for one, _ in parts), *loads),
        connections=tuple(connections),
        springs=tuple(one for one, _ in between),
        joint_springs=tuple(one for one, _ in on_joints),
        dampers=tuple(one for one, _ in dampers),
        outputs=tuple(_outputs(car, added)),
        wheels=tuple(wheels),
        points=points,
        kinds=kinds(car, table),
        meanings={f"{i.name}.hardpoints.{n}": text for i in car.values() for n, text in i.template.hardpoints.items()},
        sources={
            kind: tuple(source for _, source in made)
            for kind, made in (
                ("parts", parts),
                ("connections", laws),
                ("springs", between),
                ("joint_springs", on_joints),
                ("dampers", dampers),
            )
        },
    )
    require_sound(composed)
    require_taken(car)
    require_points(table, car)
    require_aliases(table)
    return composed


def _points(instance: Instance) -> Iterator[tuple[str, Point]]:
    for name, side in itertools.product(instance.template.hardpoints, instance.sides()):
        if side is not None or not instance.template.mirrored:
            yield instance.label(name, side), instance.point(name, side)


def _outputs(car: Mapping[str, Instance], added: Sequence[PlacedOutput]) -> list[PlacedOutput]:
    """Outputs of the templates, then those of the file; what the first instance names alone is before the file."""
    found, firsts = list[PlacedOutput](), set[str]()
    for i in car.values():
        for _, e, side in sorted(_elements({i.name: i}, "output"), key=lambda one: _rank(one[2])):
            name = e.name if e.first and e.name not in firsts else i.label(e.name, side)
            firsts |= {e.name} if e.first else set()
            on, at = i.part(e.on, side), i.point(e.at, side)
            found.append(PlacedOutput(name=name, on=on, at=at, point=i.point_name(e.at, side)))
    return [*found, *(one for one in added if one.name not in firsts)]


def _rank(side: str | None) -> int:
    """Right before left before what exists once."""
    return [*SIDE_SIGN, None].index(side)


def _elements(car: Mapping[str, Instance], kind: str) -> Elements:
    """Elements of a kind, each for every side that it exists on."""
    found: Elements = []
    for instance in car.values():
        once = {joint.name for joint in instance.template.joint if _names_a_side(joint)}
        for entry in getattr(instance.template, kind):
            single = _names_a_side(entry) or getattr(entry, "joint", None) in once - {None}
            sides = instance.sides()
            found += [
                (instance, entry, side) for side in (sides if len(sides) == 1 else (None,) if single else sides[:2])
            ]
    return found


def _names_a_side(entry: Any) -> bool:
    parts = [getattr(entry, key, None) for key in ("parent", "moving", "carrier", "on")]
    return any(":" in (word or "") for word in (*parts, *getattr(entry, "child", ())))


def _made(make: Callable[[Instance, Any, str | None], Any], elements: Elements) -> list[tuple[Any, Source]]:
    """Elements, each with what it is made from."""
    return [(make(*one), Source(make, *one)) for one in elements]


def _parts(car: Mapping[str, Instance]) -> list[tuple[Any, Source]]:
    """Every part behind its parent, with its joints."""
    held: dict[str, tuple[Instance, str, str | None, str, list[tuple[topology.Joint, str | None]]]] = {}
    for i, joint, side in _elements(car, "joint"):
        for child in joint.child:
            name, _, own = child.partition(":")
            label, parent = i.part(child, side), i.part(joint.parent, side)
            place = f"{i.template.file}: joint of {child}"
            if name not in i.template.parts:
                raise ConfigurationError(f"{place}: a part of another template cannot hang on a joint of this one")
            if parent == "body" and (joint.kind != "fixed" or joint.at is None):
                raise ConfigurationError(
                    f"{place}: on the trimmed body a part is fixed, with a point in at; one that moves on it is free "
                    "and has a connection, which feels the modes of the body"
                )
            there = held.setdefault(label, (i, name, own or side, parent, []))
            if there[3] != parent:
                raise ConfigurationError(f"{place}: {there[3]} holds it already; close a loop by a connection")
            there[4].append((joint, side))
            if len(there[4]) > 1 and {"free", "fixed"} & {one.kind for one, _ in there[4]}:
                raise ConfigurationError(f"{place}: it is {there[4][0][0].kind} already; a joint beside holds nothing")
    for i in car.values():
        for name, side in itertools.product(i.template.parts, i.sides()):
            if (side is not None or not i.template.mirrored) and i.label(name, side) not in held:
                raise ConfigurationError(
                    f"{i.template.file}: parts.{name}: nothing holds {i.label(name, side)}; give it a joint, or "
                    'kind = "free" and connections'
                )
    children: dict[str, list[str]] = {}
    for label, (_, _, _, parent, _) in held.items():
        children.setdefault(parent, []).append(label)
    for bracket in children.get("body", []):
        for label in children.get(bracket, []):
            raise ConfigurationError(
                f"{held[label][0].template.file}: joint of {label}: {bracket} is fixed to the trimmed body, and what "
                "hangs on it would not feel the modes there; hold it by a connection"
            )
    order = [*children.get("body", []), *children.get("world", [])]
    for label in order:
        order[order.index(label) + 1 : order.index(label) + 1] = children.get(label, [])
    if loose := [label for label in held if label not in order]:
        i = held[loose[0]][0]
        raise ConfigurationError(
            f"{i.template.file}: joints of {', '.join(loose)} lead to no free part; close a loop by a connection"
        )
    made = ((label, *held[label]) for label in order)
    return _made(_part, [(i, (label, name, parent, joints), side) for label, i, name, side, parent, joints in made])


Held = tuple[str, str, str, list[tuple[topology.Joint, str | None]]]
"""A part: its label, its name in the template, what holds it, and the joints between them."""


def _part(i: Instance, held: Held, side: str | None) -> PlacedPart:
    label, name, parent, joints = held
    first, own = joints[0]
    return PlacedPart(
        name=label,
        parent=parent,
        cog=i.cog(name, side),
        numbers=i.body(name, side),
        side=SIDE_SIGN.get(side or "", 1.0),
        shape=i.template.parts[name].shape,
        points={point: i.point(point, side) for point in i.template.parts[name].points},
        joints=tuple(itertools.chain.from_iterable(freedoms(i, joint, where, label) for joint, where in joints)),
        seat=i.point(first.at or "", own) if parent == "body" else None,
        path=f"{i.name}.parts.{name}",
    )


def _wheels(car: Mapping[str, Instance]) -> list[PlacedWheel]:
    return [
        PlacedWheel(
            name=i.label("", side)[1:],
            axle=i.name,
            side=SIDE_SIGN[side],
            part=i.part(i.template.wheel.part, side),
            plate=i.part("plate", side),
            center=i.point(i.template.wheel.center, side),
            patch=i.point(i.template.wheel.patch, side),
            paths=(f"{i.name}.hardpoints.{i.template.wheel.center}", f"{i.name}.hardpoints.{i.template.wheel.patch}"),
        )
        for i in car.values()
        if i.template.wheel is not None
        for side in SIDE_SIGN
    ]


def _connection(i: Instance, e: topology.Connection, side: str | None) -> PlacedConnection:
    law = None
    if not e.ideal or i.has("bushings", e.name):
        law = i.get(_law_kind(i, e), side, "bushings", e.name)
        for axis, stiffness in zip("xyz", law.stiffness, strict=True):
            if stiffness < e.least:
                raise ConfigurationError(
                    f"{i.name}.bushings.{e.name}.stiffness.{axis}: found {stiffness:g} N/m, must be at least "
                    f"{e.least:g} N/m ({e.why})"
                )
    return PlacedConnection(
        name=i.label(e.name, side),
        moving=i.part(e.moving, side),
        carrier=i.part(e.carrier, side),
        at=i.point(e.at, side),
        point=i.point_name(e.at, side),
        law=law,
        ground=e.ground or e.carrier == "plate",
        path=f"{i.name}.bushings.{e.name}",
        axes=None if e.axes is None else axes_along(i.point(e.axes[0], side), i.point(e.axes[1], side)),
        rolling=_rolling(i, side) if e.carrier == "plate" and i.driving.rolling else None,
    )


def _rolling(i: Instance, side: str | None) -> Rolling | None:
    """What a rolling tyre knows beside its law."""
    wheel = i.template.wheel
    if wheel is None:
        return None
    low, high = i.point(wheel.patch, side), i.point(wheel.center, side)
    arm = (high[0] - low[0], high[1] - low[1], high[2] - low[2])
    return Rolling(speed=i.driving.speed, arm=arm)


def _law_kind(i: Instance, e: topology.Connection) -> type[Bushing] | type[Hydromount]:
    return law_kind(i.numbers.get("bushings", {}).get(e.name, {}), plate=e.carrier == "plate")


def kinds(car: Mapping[str, Instance], table: Mapping[str, Any]) -> dict[str, type]:
    """Class of each table of numbers, by its path in the vehicle file."""
    found: dict[str, type] = {f"connection.{name}": law_kind(one) for name, one in table.get("connection", {}).items()}
    found |= {f"load.{name}": Load for name in table.get("load", {})}
    for i in car.values():
        found |= {f"{i.name}.parts.{name}": Part for name in i.template.parts}
        for one in i.template.connection:
            if not one.ideal or i.has("bushings", one.name):
                path = f"{i.name}.bushings.{one.name}"
                found[path] = _law_kind(i, one)
        found |= {f"{i.name}.{one.name}": Damper for one in i.template.damper}
        found |= {f"{i.name}.{one.name}": spring_kind(i, one) for one in i.template.spring}
    return found
