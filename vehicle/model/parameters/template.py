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
from vehicle.model.parameters.quantity import NAME_PATTERN
from vehicle.model.parameters.template_file import LISTS, read_template_file
from vehicle.model.parameters.toml_file import build, nearest
from vehicle.model.parameters.topology import RolePart, Template, Wheel

SHIPPED = Path(str(resources.files("vehicle.model"))) / "templates"
FREE_PORTS = ("body", "world", "plate")
"""Parts of others that every template may name: the trimmed body, the ground, what the tyre of this side stands on."""

_POINTS, _PARTS = (
    {"at", "along", "axes", "points", "center", "patch"},
    {"child", "parent", "moving", "carrier", "part", "on"},
)
_ON = {"damper": ("slide",), "spring": ("slide", "hinge")}
"""Kinds of joints that these elements may be on."""


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


def own_templates(names: Iterable[str], folders: Iterable[Path]) -> list[Path]:
    """Files of templates, and of those that they use, that lie in one of these folders and not in the package.

    Args:
        names: of the templates.
        folders: as of `read_template`.
    """
    found, wanted = dict[str, Path](), list(names)
    for name in wanted:
        path = next(place / f"{name}.toml" for place in (*folders, SHIPPED) if (place / f"{name}.toml").is_file())
        if name not in found:
            found[name] = path
            wanted += [use["template"] for use in read_template_file(path)["use"]]
    return [path for path in found.values() if path.parent != SHIPPED]


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
            for key, kind in LISTS.items()
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
        known = sorted({file.stem for place in places for file in place.glob("*.toml")})
        reason = "uses itself" if name in above else "no such file beside the vehicle file nor in the package"
        raise ConfigurationError(
            f"template {name!r}: {reason}; the nearest is {nearest(name, set(known) - {name})}, there are "
            f"{', '.join(known)}"
        )
    own = read_template_file(path)
    chosen = [use for use in own.pop("use") if use.get("when") is None or use["when"] in options]
    used = [(use, _merged(use["template"], options, places, (*above, name))) for use in chosen]
    found: dict[str, Any] = {"mirrored": own["mirrored"], "wheel": None}
    try:
        first = [_renamed(other, use) for use, other in used if "when" not in use]
        for one in [*first, own, *(_renamed(other, use) for use, other in used if "when" in use)]:
            for key in ("hardpoints", "parts"):
                twice = set(found.setdefault(key, {})) & set(one[key])
                if twice:
                    raise ConfigurationError(f"{key}.{min(twice)}: comes twice; give what it uses a prefix")
                found[key] |= one[key]
            for key in (*LISTS, "above"):
                found[key] = [*found.get(key, []), *one[key]]
            if found["wheel"] and one["wheel"]:
                raise ConfigurationError("wheel: comes twice; a template has one wheel, on both sides")
            found["wheel"] = found["wheel"] or one["wheel"]
    except ConfigurationError as error:
        raise ConfigurationError(f"{path.name}: {error}") from None
    return {**found, "ports": own["ports"]}


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
    elements = [entry["name"] for key in LISTS for entry in table[key] if "name" in entry]
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
        **{key: [turned(entry) for entry in table[key]] for key in LISTS},
        "above": turned(table["above"], "at"),
        "wheel": turned(table["wheel"]),
    }


def _check(template: Template, raw: Mapping[str, Any]) -> None:
    """Every name of a part, point and joint leads somewhere, and names are names."""
    parts = {*template.parts, *template.ports, *FREE_PORTS}
    joints = {joint.name: joint.kind for joint in template.joint if joint.name is not None}
    names = [joint.name for joint in template.joint if joint.name is not None]
    for name in names:
        if names.count(name) > 1:
            raise ConfigurationError(f"joint.{name}: comes twice; a joint has a name of its own")
    for key, kinds in _ON.items():
        for element in getattr(template, key):
            if joints.get(element.joint, kinds[0]) not in kinds:
                raise ConfigurationError(
                    f"{key}.{element.name}.joint: {element.joint!r} is a {joints[element.joint]}, needed is a "
                    f"{' or a '.join(kinds)}"
                )

    used: set[str] = set()

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
                    besides = f", and beside its own there are {', '.join(FREE_PORTS)}" if known is parts else ""
                    raise ConfigurationError(
                        f"{where}.{key}: {word!r} leads nowhere; the nearest is {nearest(head, known)}{besides}"
                    )
                if known is not None and side not in ("", "left", "right", "middle"):
                    raise ConfigurationError(f"{where}.{key}: found side {side!r}, allowed are left, right, middle")
                if known is template.hardpoints:
                    used.add(head)

    for key in LISTS:
        for position, entry in enumerate(raw[key]):
            look(f"{key}.{entry.get('name', position)}", entry)
    for name, part in raw["parts"].items():
        look(f"parts.{name}", part)
    look("wheel", raw["wheel"] or {})
    look("above", {"at": [point for pair in raw["above"] for point in pair]})
    if spare := [name for name in template.hardpoints if name not in used]:
        raise ConfigurationError(
            f"hardpoints.{spare[0]}: nothing of the template uses it; take it out, or put it into [hardpoints] of the "
            "vehicle file"
        )
