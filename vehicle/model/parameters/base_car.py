"""Reading a vehicle file, which may give only its differences from a base car."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.alternatives import replaced_by
from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.model.parameters.tested_range import merged_law
from vehicle.model.parameters.toml_file import convert, read_table
from vehicle.model.parameters.whole_body import body_moves, followers, put


def vehicle_table(path: Path, above: tuple[Path, ...] = ()) -> dict[str, Any]:
    """Read a vehicle file; with `base = "focus_road"` it contains only the differences from that car.

    Tables are merged with the base, key by key; a table with a template replaces the table of the base. The
    inertia of the body follows another mass or CoG (`vehicle.model.parameters.whole_body`).

    Args:
        path: path of the file, or the name of a shipped car.
        above: files whose base is this file, directly or not.

    Raises:
        ConfigurationError: the file or its base cannot be read, or the bases form a loop.
    """
    file = vehicle_file(path)
    table = read_table(file)
    if (base := base_file(file)) is None:
        return table
    del table["base"]
    if base.resolve() in (*above, file.resolve()):
        raise ConfigurationError(f"base: {file} uses itself as base, directly or through other files; name another car")
    return with_body(vehicle_table(base, (*above, file.resolve())), table)


def base_file(file: Path) -> Path | None:
    """Return the vehicle file of the base of a vehicle file; None if it has no base.

    Raises:
        ConfigurationError: the file cannot be read, or its base is no vehicle file.
    """
    table = read_table(file)
    if "base" not in table:
        return None
    name = convert(str, table["base"], "base")
    beside = file.parent / name
    if not beside.is_file() and name not in CARS:
        raise ConfigurationError(
            f"base: found {name!r}, must be a shipped car ({', '.join(CARS)}) or a vehicle file in the same folder"
        )
    return beside if beside.is_file() else vehicle_file(name)


def with_body(below: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """Return a vehicle file merged with its base; moments of inertia that it leaves out follow its mass and CoG.

    Args:
        below: table of the base.
        above: table of the file. With all three moments, its [body.inertia] replaces the table of the base.
    """
    body, base = (convert(dict, table.get("body", {}), "body") for table in (above, below))
    inertia = convert(dict, body.get("inertia", {}), "body.inertia")
    if set(MOMENTS[:3]) <= set(inertia):
        below = {**below, "body": {key: value for key, value in base.items() if key != "inertia"}}
    merged = _merged(below, above)
    if "inertia" in base and body_moves({"body": base}, merged):
        paths = {f"body.{key}" for key in body} | {f"body.inertia.{key}" for key in inertia}
        put(merged, followers(base, merged["body"], paths))
    return merged


def _merged(below: Mapping[str, Any], above: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Return two tables merged key by key; values of `above` take precedence, see also `replaced_by`."""
    replaced = replaced_by(above, path)
    merged = {key: value for key, value in merged_law(below, above).items() if key in above or key not in replaced}
    for key, value in above.items():
        both = isinstance(value, Mapping) and isinstance(below.get(key), Mapping)
        inner = f"{path}.{key}" if path else key
        merged[key] = _merged(below[key], value, inner) if both and "template" not in value else value
    return merged
