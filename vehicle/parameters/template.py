"""Templates: what an axle, an engine suspension or a seat is made of, as TOML without a number.

A template lists hardpoints with their meaning, parts with the role of their shape, joints, connections, springs,
dampers and outputs. It may use others: `use = [{template, prefix, with, when}]` puts in the elements of another one,
their names behind `prefix`, its ports bound to parts by `with`, all of it only `when` the vehicle gives a table of that
name. What is `mirrored` is written for the right side and exists on both; `part:left` and `point:middle` name a side,
and an element that does so exists once.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.parameters.quantity import NAME_PATTERN
from vehicle.parameters.toml_file import build, nearest, read_table
from vehicle.parameters.topology import Connection, Damper, Joint, Output, RolePart, Spring, Template, Wheel

SHIPPED = Path(str(resources.files("vehicle"))) / "templates"
FREE_PORTS = ("body", "world", "plate")
"""Parts of others that every template may name: the trimmed body, the ground, what the tyre of this side stands on."""

_LISTS = {"joint": Joint, "connection": Connection, "spring": Spring, "damper": Damper, "output": Output}
_POINTS, _PARTS = {"at", "along", "points", "center", "patch"}, {"child", "parent", "moving", "carrier", "part", "on"}
_KEYS = {"mirrored", "use", "hardpoints", "ports", "parts", "wheel", "above", *_LISTS}


def read_template(name: str, options: Iterable[str], folders: Iterable[Path]) -> Template:
    """Read a template with all that it uses.

    Args:
        name: of its file, without the ending.
        options: tables that the vehicle gives: what is used `when` one of them is there.
        folders: where it is looked for before the shipped ones.

    Raises:
        ConfigurationError: no such template, an unknown key, or a name that leads nowhere; with file and table.
    """
    places = (*folders, SHIPPED)
    files = [file for place in places[:-1] for file in sorted(place.glob("*.toml")) if file.is_file()]
    return _read_once(name, frozenset(options), places, tuple((file, file.stat().st_mtime_ns) for file in files))


# A sweep composes thousands of cars of the same templates; a file that has changed is read again.
@functools.lru_cache(maxsize=32)
def _read_once(
    name: str, options: frozenset[str], places: tuple[Path, ...], stamps: tuple[tuple[Path, int], ...]
) -> Template:
    raw = _merged(name, options, places, ())
    try:
        lists: dict[str, Any] = {
            key: tuple(
                build(kind, entry, f"{key}.{entry.get('name', position)}") for position, entry in enumerate(raw[key])
            )
            for key, kind in _LISTS.items()
        }
        parts = {part: build(RolePart, table, f"parts.{part}") for part, table in raw["parts"].items()}
        wheel = None if raw["wheel"] is None else build(Wheel, raw["wheel"], "wheel")
        template = Template(
            file=f"{name}.toml",
            parts=parts,
            wheel=wheel,
            above=tuple(map(tuple, raw["above"])),
            **{key: raw[key] for key in ("mirrored", "hardpoints", "ports")},
            **lists,
        )
        _check(template, raw)
    except ConfigurationError as error:
        raise ConfigurationError(f"{name}.toml: {error}") from None
    return template


def _merged(name: str, options: frozenset[str], places: tuple[Path, ...], above: tuple[str, ...]) -> dict[str, Any]:
    """Tables of a template and of what it uses: what it always uses, its own, what it uses on request."""
    path = next((place / f"{name}.toml" for place in places if (place / f"{name}.toml").is_file()), None)
    if path is None or not NAME_PATTERN.fullmatch(name) or name in above:
        known = ", ".join(sorted({file.stem for place in places for file in place.glob("*.toml")}))
        reason = "uses itself" if name in above else "no such file beside the vehicle file nor in the package"
        raise ConfigurationError(f"template {name!r}: {reason}; there are {known}")
    table = read_table(path)
    for key in table:
        if key not in _KEYS:
            raise ConfigurationError(f"{path.name}: {key}: unknown; the nearest known name is {nearest(key, _KEYS)}")
    own = {
        "mirrored": table.get("mirrored", False),
        "wheel": table.get("wheel"),
        **{key: dict(table.get(key, {})) for key in ("hardpoints", "ports", "parts")},
        **{key: [_listed(entry) for entry in table.get(key, [])] for key in _LISTS},
        "above": list(table.get("above", [])),
    }
    used = [(use, _merged(use["template"], options, places, (*above, name))) for use in _chosen(table, options, path)]
    first = [_renamed(other, use) for use, other in used if "when" not in use]
    found: dict[str, Any] = {"mirrored": own["mirrored"], "wheel": None}
    for one in [*first, own, *(_renamed(other, use) for use, other in used if "when" in use)]:
        for key in ("hardpoints", "parts"):
            twice = set(found.setdefault(key, {})) & set(one[key])
            if twice:
                raise ConfigurationError(f"{path.name}: {key}.{min(twice)}: comes twice; give what it uses a prefix")
            found[key] |= one[key]
        for key in (*_LISTS, "above"):
            found[key] = [*found.get(key, []), *one[key]]
        found["wheel"] = found["wheel"] or one["wheel"]
    return {**found, "ports": own["ports"]}


def _chosen(table: Mapping[str, Any], options: frozenset[str], path: Path) -> list[dict[str, Any]]:
    """What a template uses of others, with the options that the vehicle takes."""
    for use in table.get("use", []):
        if "template" not in use or set(use) - {"template", "prefix", "with", "when"}:
            raise ConfigurationError(
                f"{path.name}: use: needed is template, allowed are prefix, with, when; found {use}"
            )
    return [use for use in table.get("use", []) if use.get("when") is None or use["when"] in options]


def _listed(entry: Mapping[str, Any]) -> dict[str, Any]:
    """One child is a list of one."""
    return {**entry, "child": [entry["child"]]} if isinstance(entry.get("child"), str) else dict(entry)


def _renamed(table: dict[str, Any], use: Mapping[str, Any]) -> dict[str, Any]:
    """A used template with its own names behind a prefix and its ports bound."""
    prefix, bound = use.get("prefix", ""), use.get("with", {})
    for port in bound:
        if port not in table["ports"] and port not in FREE_PORTS:
            raise ConfigurationError(
                f"use.with.{port}: {use['template']}.toml has no such port; it has {[*table['ports']]}"
            )
    free = [port for port in table["ports"] if port not in bound]
    if free:
        raise ConfigurationError(
            f"use.with.{free[0]}: missing; {use['template']}.toml needs it ({table['ports'][free[0]]})"
        )
    elements = [entry["name"] for key in _LISTS for entry in table[key] if "name" in entry]
    own = {name: prefix + name for name in (*table["parts"], *table["hardpoints"], *elements)}

    def turned(value: Any, key: str = "") -> Any:
        if isinstance(value, Mapping):
            return {name: turned(inner, name) for name, inner in value.items()}
        if isinstance(value, list):
            return [turned(inner, key) for inner in value]
        if isinstance(value, str) and key in {"name", "joint", *_POINTS, *_PARTS}:
            word, colon, side = value.partition(":")
            return ({**own, **bound} if key in _PARTS else own).get(word, word) + colon + side
        return value

    return {
        **table,
        **{key: {own[name]: turned(value) for name, value in table[key].items()} for key in ("parts", "hardpoints")},
        **{key: [turned(entry) for entry in table[key]] for key in _LISTS},
        "above": turned(table["above"], "at"),
        "wheel": turned(table["wheel"]),
    }


def _check(template: Template, raw: Mapping[str, Any]) -> None:
    """Every name of a part, point and joint leads somewhere, and names are names."""
    parts = {*template.parts, *template.ports, *FREE_PORTS}
    joints = {joint.name for joint in template.joint if joint.name is not None}

    def look(where: str, table: Mapping[str, Any]) -> None:
        for key, value in table.items():
            if isinstance(value, Mapping):
                look(f"{where}.{key}", value)
                continue
            known = (
                parts
                if key in _PARTS
                else template.hardpoints
                if key in _POINTS
                else joints
                if key == "joint"
                else None
            )
            for word in value if isinstance(value, list) else [value]:
                head, _, side = str(word).partition(":")
                if key == "name" and not NAME_PATTERN.fullmatch(head):
                    raise ConfigurationError(
                        f"{where}.name: found {word!r}, allowed are letters, digits, '_', '.', '-'"
                    )
                if known is not None and head not in known:
                    raise ConfigurationError(
                        f"{where}.{key}: {word!r} leads nowhere; the nearest is {nearest(head, known)}"
                    )
                if known is not None and side not in ("", "left", "right", "middle"):
                    raise ConfigurationError(f"{where}.{key}: found side {side!r}, allowed are left, right, middle")

    for key in _LISTS:
        for position, entry in enumerate(raw[key]):
            look(f"{key}.{entry.get('name', position)}", entry)
    for name, part in raw["parts"].items():
        look(f"parts.{name}", part)
    look("wheel", raw["wheel"] or {})
    look("above", {"at": [point for pair in raw["above"] for point in pair]})
