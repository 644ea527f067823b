"""Additions of a vehicle file to its templates: points, connections between any two parts, outputs and loads."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.air_spring import AIR, AirSpring
from vehicle.model.parameters.composition import PlacedConnection, PlacedOutput, PlacedPart
from vehicle.model.parameters.force_elements import DECOUPLER, MAXWELL, TRACK, Bushing, Hydromount, LinearBushing, Tyre
from vehicle.model.parameters.hardpoints import Axes, Point, axes_along, require_apart, require_point
from vehicle.model.parameters.quantity import NAME_PATTERN
from vehicle.model.parameters.rigid_part import Load
from vehicle.model.parameters.toml_file import build, convert
from vehicle.wording import did_you_mean

CONNECTION_KEYS = {"moving", "carrier", "at", "ground", "axes"}
"""Keys of a connection of the vehicle file other than the numbers of its law."""

LOAD_KEYS = ("mass", "at", "on", "inertia", "products")
"""Keys of a load."""


def point_of(path: str, value: Any) -> Point:
    """Return a point of the vehicle file [m].

    Args:
        path: path of the point, shown in messages.
        value: value in the file.

    Raises:
        ConfigurationError: the value is not a point.
    """
    point: Point = convert(Point, value, path)
    require_point(path, point, right=False)
    return point


def law_kind(table: Mapping[str, Any], *, plate: bool = False) -> type[LinearBushing] | type[Hydromount]:
    """Return the parameter class of a connection; `plate`: the connection is a tyre on its plate."""
    if {*AIR} & set(table):
        return AirSpring
    return Hydromount if {*MAXWELL, *TRACK, *DECOUPLER} & set(table) else Tyre if plate else Bushing


def named_point(path: str, table: Mapping[str, Any], points: Mapping[str, Point]) -> tuple[Point, str]:
    """Return the point of an element [m], given by its name or by coordinates, and the name of the point."""
    name, value = path.partition(".")[2], table.get("at")
    if not NAME_PATTERN.fullmatch(name):
        raise ConfigurationError(f"{path}: found {name!r}, must consist of letters, digits, '_', '.', '-'")
    if value is None:
        raise ConfigurationError(f"{path}.at: missing; give the name of a point, or its coordinates [m]")
    if isinstance(value, str):
        if value not in points:
            raise ConfigurationError(f"{path}.at: unknown point {value!r}{did_you_mean(value, points)}")
        return points[value], value
    return point_of(f"{path}.at", value), name


def named_part(path: str, table: Mapping[str, Any], key: str, names: set[str]) -> str:
    """Return the name of a part that a table gives under a key."""
    if key not in table:
        raise ConfigurationError(f"{path}.{key}: missing; give the name of a part, for example body")
    name: str = convert(str, table[key], f"{path}.{key}")
    if name not in names:
        raise ConfigurationError(f"{path}.{key}: unknown part {name!r}{did_you_mean(name, names)}")
    return name


def further_connection(name: str, value: Any, names: set[str], points: Mapping[str, Point]) -> PlacedConnection:
    """Return a connection that the vehicle file adds between any two parts.

    Args:
        name: name of the connection.
        value: table of the connection.
        names: names of all parts.
        points: hardpoints of the car by name [m].

    Raises:
        ConfigurationError: a name that does not exist, or a wrong value.
    """
    path = f"connection.{name}"
    table = convert(dict, value, path)
    law = {key: inner for key, inner in table.items() if key not in CONNECTION_KEYS}
    at, point = named_point(path, table, points)
    return PlacedConnection(
        name=name,
        moving=named_part(path, table, "moving", names),
        carrier=named_part(path, table, "carrier", names),
        at=at,
        point=point,
        law=build(law_kind(law), law, path) if law else None,
        ground=convert(bool, table.get("ground", False), f"{path}.ground"),
        path=path,
        axes=_axes(path, table, points),
    )


def _axes(path: str, table: Mapping[str, Any], points: Mapping[str, Point]) -> Axes | None:
    """Return the axes of a law whose x axis passes through two points; None for the axes of the carrier."""
    if "axes" not in table:
        return None
    names: tuple[str, ...] = convert(tuple[str, ...], table["axes"], f"{path}.axes")
    for name in names:
        if name not in points:
            raise ConfigurationError(f"{path}.axes: unknown point {name!r}{did_you_mean(name, points)}")
    if len(names) != 2 or table.get("ground"):
        raise ConfigurationError(
            f"{path}.axes: found {list(names)}, must be two points of a connection that does not touch the ground"
        )
    require_apart({f"{path}.axes, {name}": points[name] for name in names})
    return axes_along(points[names[0]], points[names[1]])


def further_output(name: str, value: Any, names: set[str], points: Mapping[str, Point]) -> PlacedOutput:
    """Return an output point of the vehicle file; arguments: see `further_connection`.

    Raises:
        ConfigurationError: a name that does not exist.
    """
    path = f"outputs.{name}"
    table = convert(dict, value, path)
    for key in table:
        if key not in ("on", "at"):
            raise ConfigurationError(f"{path}.{key}: unknown parameter; use on or at")
    at, point = named_point(path, table, points)
    return PlacedOutput(name=name, on=named_part(path, table, "on", names), at=at, point=point)


def new_loads(overrides: Iterable[str]) -> list[str]:
    """Return the paths of overrides that set keys of a load; such a load is optional in a vehicle file."""
    texts = [text.partition("=")[0].strip() for text in overrides]
    return [text for text in texts if re.fullmatch(rf"load\.[A-Za-z0-9_-]+\.({'|'.join(LOAD_KEYS)})", text)]


def placed_load(name: str, value: Any, names: set[str], points: Mapping[str, Point]) -> PlacedPart:
    """Return a load of the vehicle file as a part that is fixed to its carrier.

    Args:
        name: name of the load.
        value: table of the load.
        names: names of the parts that can carry a load.
        points: hardpoints of the car by name [m].

    Raises:
        ConfigurationError: a name that does not exist, or a wrong value.
    """
    path = f"load.{name}"
    table = convert(dict, value, path)
    at, _ = named_point(path, table, points)
    return PlacedPart(
        name=f"load_{name}",
        parent=named_part(path, {"on": "body", **table}, "on", names),
        cog=at,
        numbers=build(Load, {key: inner for key, inner in table.items() if key not in ("on", "at")}, path),
        side=1.0,
        shape="none",
        points={},
        joints=(),
        seat=None,
        path=path,
        tables=(path,),
    )
