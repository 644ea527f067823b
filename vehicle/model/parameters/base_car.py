"""The table of a vehicle file: its own, or laid over that of the car that it names as its base."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.model.parameters.toml_file import convert, read_table
from vehicle.model.parameters.whole_body import body_moves, followers, put


def vehicle_table(path: Path, above: tuple[Path, ...] = ()) -> dict[str, Any]:
    """Read a vehicle file; with `base = "focus_road"` it holds only what differs from that car.

    Tables are laid over those of the base, key by key; one that names a template takes the place of the base's. The
    inertia of the body follows another mass or CoG (`vehicle.model.parameters.whole_body`).

    Args:
        path: of the file, or the name of a shipped car.
        above: files that build on it.

    Raises:
        ConfigurationError: the file or its base cannot be read, or a file builds on itself.
    """
    file = vehicle_file(path)
    table = read_table(file)
    if "base" not in table:
        return table
    name = convert(str, table.pop("base"), "base")
    beside = file.parent / name
    if not beside.is_file() and name not in CARS:
        raise ConfigurationError(
            f"base: found {name!r}; needed is a shipped car ({', '.join(CARS)}) or a vehicle file beside this one"
        )
    base = beside if beside.is_file() else vehicle_file(name)
    if base.resolve() in (*above, file.resolve()):
        raise ConfigurationError(f"base: {file} builds on itself; name another car")
    return with_body(vehicle_table(base, (*above, file.resolve())), table)


def with_body(below: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """Return a vehicle file laid over its base; what it does not give of the inertia follows its mass and CoG.

    Args:
        below: the base.
        above: the file. Where it gives all three moments of [body.inertia], that table takes the place of the base's.
    """
    body, base = (convert(dict, one.get("body", {}), "body") for one in (above, below))
    inertia = convert(dict, body.get("inertia", {}), "body.inertia")
    if set(MOMENTS[:3]) <= set(inertia):
        below = {**below, "body": {key: value for key, value in base.items() if key != "inertia"}}
    found = _over(below, above)
    if "inertia" in base and body_moves({"body": base}, found):
        given = {f"body.{key}" for key in body} | {f"body.inertia.{key}" for key in inertia}
        put(found, followers(base, found["body"], given))
    return found


def _over(below: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """A table laid over another one."""
    found = dict(below)
    for key, value in above.items():
        both = isinstance(value, Mapping) and isinstance(below.get(key), Mapping)
        found[key] = _over(below[key], value) if both and "template" not in value else value
    return found
