"""Checks of a composition: geometry, names that must exist, and entries that no element uses."""

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.composition import Composition
from vehicle.model.parameters.hardpoints import require_apart, require_triangle
from vehicle.model.parameters.instance import RIGHT, Instance
from vehicle.model.parameters.paths import full_path
from vehicle.model.parameters.toml_file import convert
from vehicle.model.parameters.topology import Template
from vehicle.names import SIDE_SIGN
from vehicle.wording import did_you_mean

GROUPS = ("hardpoints", "parts", "bushings", "ports")
"""Tables of an instance with one entry for each name."""


def require_ports(car: Mapping[str, Instance], names: set[str]) -> None:
    """Check that every port is bound to a part.

    Raises:
        ConfigurationError: a port is bound to an unknown part.
    """
    for i in car.values():
        for port in i.numbers.get("ports", {}):
            for side in i.sides():
                if (part := i.part(port, side)) not in names:
                    near = did_you_mean(part, names)
                    raise ConfigurationError(f"{i.name}.ports.{port}: unknown part {part!r}{near}")


def require_geometry(car: Mapping[str, Instance]) -> None:
    """Check the geometry of all instances: pairs of points above each other, distinct points, triangles of arms.

    Raises:
        ConfigurationError: naming the points.
    """
    for i in car.values():
        for high, low in i.template.above:
            top, bottom = (i.point(name, RIGHT) for name in (high, low))
            if top[2] <= bottom[2]:
                raise ConfigurationError(
                    f"{i.name}.hardpoints.{high}: found z = {top[2]} m, must be above {bottom[2]} m, the z of "
                    f"{i.name}.hardpoints.{low}"
                )
        for names in _distinct_points(i.template):
            require_apart({f"{i.name}.hardpoints.{name}": i.point(name, RIGHT) for name in names})
        for part in i.template.parts.values():
            if part.shape.endswith("arm") and len(part.points) > 2:
                require_triangle({f"{i.name}.hardpoints.{name}": i.point(name, RIGHT) for name in part.points})


def _distinct_points(template: Template) -> Iterator[tuple[str, ...]]:
    """Yield groups of points that must not coincide: of a part, an axis, a wheel, the joints of a part."""
    yield from (part.points for part in template.parts.values())
    yield from (joint.along for joint in template.joint if joint.along)
    yield from (connection.axes for connection in template.connection if connection.axes)
    for name in template.parts:
        points = [
            connection.at for connection in template.connection if name in (connection.moving, connection.carrier)
        ]
        points += [
            joint.at
            for joint in template.joint
            if joint.at and name in (*joint.child, joint.parent) and not joint.along
        ]
        yield tuple(dict.fromkeys(points))
    if template.wheel is not None:
        yield (template.wheel.center, template.wheel.patch)


def require_sound(car: Composition) -> None:
    """Check that names are unique and that connections and springs join two different parts or points.

    Raises:
        ConfigurationError: the first wrong element.
    """
    for connection in car.connections:
        if connection.moving == connection.carrier:
            raise ConfigurationError(
                f"{connection.path}: connects {connection.moving} to itself; name two different parts"
            )
        if getattr(connection.law, "one_sided", False) and not connection.ground:
            raise ConfigurationError(
                f"{connection.path}.one_sided: must be false here; only a contact with the ground lifts off"
            )
    for spring in car.springs:
        require_apart(dict(zip((f"{spring.path}, lower end", "upper end"), spring.at, strict=True)))
    joints = [joint.name for part in car.parts for joint in part.joints]
    parts, links = [element.name for element in car.parts], [element.name for element in car.connections]
    laws, outputs = [element.name for element in car.springs], [element.name for element in car.outputs]
    laws += [element.name for element in car.dampers]
    forces = [element.name for element in car.forces]
    for names in (parts, joints, links, laws, outputs, forces):
        for name, other in itertools.pairwise(sorted(names)):
            if name == other:
                raise ConfigurationError(
                    f"{name}: two elements have this name; rename one of them, or set a prefix for its template"
                )


def require_taken(car: Mapping[str, Instance]) -> None:
    """Check that every table of a side is used; elements that exist once do not use them.

    Raises:
        ConfigurationError: a table of one side is not used.
    """
    for i in car.values():
        for side in SIDE_SIGN:
            for table in _places(i.numbers.get(side, {})):
                if f"{side}.{table}" not in i.taken:
                    why = (
                        "it describes something that exists only once, not on a side"
                        if i.template.mirrored
                        else "it is not mirrored"
                    )
                    raise ConfigurationError(
                        f"{i.name}.{side}.{table}: {i.template.file} does not use this section; {why}"
                    )


def _places(table: Mapping[str, Any]) -> Iterator[str]:
    for key, inner in table.items():
        yield from (f"{key}.{name}" for name in inner) if key in GROUPS else (key,)


def require_points(table: Mapping[str, Any], car: Mapping[str, Instance]) -> None:
    """Check that every hardpoint of the vehicle file is used; skipped with a body model, which may use any hardpoint.

    Raises:
        ConfigurationError: a point is not used.
    """
    if "superelement" in table["body"]:
        return
    users = [entry for key in ("outputs", "connection", "load", "force") for entry in table.get(key, {}).values()]
    used = {entry.get("at") for entry in users if isinstance(entry.get("at"), str)}
    used |= {name for entry in table.get("connection", {}).values() for name in entry.get("axes", ())}
    tables = [side for i in car.values() for side in (i.numbers, *(i.numbers.get(word, {}) for word in SIDE_SIGN))]
    used |= {value for entry in tables for value in entry.get("hardpoints", {}).values() if isinstance(value, str)}
    for name in table.get("hardpoints", {}):
        if name not in used:
            raise ConfigurationError(f"hardpoints.{name}: nothing uses it; remove it, or name it in an output")


def require_aliases(table: Mapping[str, Any]) -> None:
    """Check that every alias is the name of a parameter.

    Raises:
        ConfigurationError: an alias of an unknown parameter.
    """
    for name, path in table.get("alias", {}).items():
        try:
            full_path({**table, "alias": {}}, convert(str, path, f"alias.{name}"))
        except ConfigurationError as error:
            said = str(error)
            raise ConfigurationError(said if said.startswith("alias.") else f"alias.{name}: {said}") from None
