"""Templates: elements of an axle, an engine suspension or a seat, as TOML without numbers.

A template lists hardpoints with their meaning, parts with the role of their shape, joints, connections, springs,
dampers and outputs. It may include other templates: `use = [{template, prefix, with, when}]` adds the elements of a
template with `prefix` before their names and its ports bound to parts by `with`, but only if the vehicle file has the
table `when`. A `mirrored` template describes the right side and exists on both; `part:left` and `point:middle` name a
side, and an element with such a name exists once.
"""

import functools
from collections.abc import Collection, Iterable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import NAME_PATTERN
from vehicle.model.parameters.template_file import LISTS, read_template_file
from vehicle.model.parameters.toml_file import build
from vehicle.model.parameters.topology import RolePart, SteeringAxis, Template, Wheel
from vehicle.wording import did_you_mean

SHIPPED = Path(str(resources.files("vehicle.model"))) / "templates"
FREE_PORTS = ("body", "world", "plate")
"""Names that every template may use: the trimmed body, the ground, the plate under the tyre of this side."""

_POINTS = {"at", "along", "axes", "points", "center", "patch"}
_PARTS = {"child", "parent", "moving", "carrier", "part", "on"}
SINGLE = {"wheel": Wheel, "steering_axis": SteeringAxis}
"""Elements that a template has at most once, and their classes."""
_ON = {"damper": ("slide",), "spring": ("slide", "hinge")}
"""Types of joints on which these elements may act."""


def read_template(name: str, options: Iterable[str], folders: Iterable[Path]) -> Template:
    """Read a template and merge the templates that it includes.

    Args:
        name: name of the file, without its extension.
        options: tables of the vehicle file that enable a `use` with `when`.
        folders: folders searched before the package.

    Raises:
        ConfigurationError: a missing template, an unknown key, or a name that does not exist; with file and table.
    """
    searched = (*folders, SHIPPED)
    files = [file for folder in searched[:-1] for file in sorted(folder.glob("*.toml")) if file.is_file()]
    return _read_once(name, frozenset(options), searched, tuple((file, file.stat().st_mtime_ns) for file in files))


def own_templates(names: Iterable[str], folders: Iterable[Path]) -> list[Path]:
    """Return the user files of templates and of the templates that they include."""
    files, listed = dict[str, Path](), list(names)
    for name in listed:
        path = next(folder / f"{name}.toml" for folder in (*folders, SHIPPED) if (folder / f"{name}.toml").is_file())
        if name not in files:
            files[name] = path
            listed += [use["template"] for use in read_template_file(path)["use"]]
    return [path for path in files.values() if path.parent != SHIPPED]


# A sweep composes thousands of cars of the same templates; a changed file is read again.
@functools.lru_cache(maxsize=32)
def _read_once(
    name: str, options: frozenset[str], searched: tuple[Path, ...], stamps: tuple[tuple[Path, int], ...]
) -> Template:
    raw = _merged(name, options, searched, ())
    try:
        lists: dict[str, Any] = {
            key: tuple(
                build(parameters, entry, f"{key}.{entry.get('name', position)}")
                for position, entry in enumerate(raw[key])
            )
            for key, parameters in LISTS.items()
        }
        parts = {part: build(RolePart, table, f"parts.{part}") for part, table in raw["parts"].items()}
        single: dict[str, Any] = {
            key: None if raw[key] is None else build(parameters, raw[key], key) for key, parameters in SINGLE.items()
        }
        template = Template(
            file=f"{name}.toml",
            parts=parts,
            above=tuple(map(tuple, raw["above"])),
            **{key: raw[key] for key in ("mirrored", "hardpoints", "ports", "port_defaults")},
            **lists,
            **single,
        )
        _check(template, raw)
    except ConfigurationError as error:
        raise ConfigurationError(f"{name}.toml: {error}") from None
    return template


def _merged(name: str, options: frozenset[str], searched: tuple[Path, ...], above: tuple[str, ...]) -> dict[str, Any]:
    """Return the merged tables of a template: included templates, the template, templates included by option."""
    path = next((folder / f"{name}.toml" for folder in searched if (folder / f"{name}.toml").is_file()), None)
    if path is None or not NAME_PATTERN.fullmatch(name) or name in above:
        names = sorted({file.stem for folder in searched for file in folder.glob("*.toml")})
        reason = (
            "uses itself"
            if name in above
            else "the file is neither in the same folder as the vehicle file nor in the package"
        )
        raise ConfigurationError(
            f"template {name!r}: {reason}{did_you_mean(name, set(names) - {name})} Templates are {', '.join(names)}"
        )
    template = read_template_file(path)
    chosen = [use for use in template.pop("use") if use.get("when") is None or use["when"] in options]
    used = [(use, _merged(use["template"], options, searched, (*above, name))) for use in chosen]
    merged: dict[str, Any] = {"mirrored": template["mirrored"], **dict.fromkeys(SINGLE)}
    try:
        first = [_renamed(other, use) for use, other in used if "when" not in use]
        for table in [*first, template, *(_renamed(other, use) for use, other in used if "when" in use)]:
            for key in ("hardpoints", "parts"):
                twice = set(merged.setdefault(key, {})) & set(table[key])
                if twice:
                    raise ConfigurationError(
                        f"{key}.{min(twice)}: defined twice; set a prefix for an included template"
                    )
                merged[key] |= table[key]
            for key in (*LISTS, "above"):
                merged[key] = [*merged.get(key, []), *table[key]]
            for key in SINGLE:
                if merged[key] and table[key]:
                    raise ConfigurationError(
                        f"{key}: defined twice; a template has only one, which applies to both sides"
                    )
                merged[key] = merged[key] or table[key]
    except ConfigurationError as error:
        raise ConfigurationError(f"{path.name}: {error}") from None
    return {**merged, "ports": template["ports"], "port_defaults": template["port_defaults"]}


def _renamed(table: dict[str, Any], use: Mapping[str, Any]) -> dict[str, Any]:
    """Return an included template with a prefix before its names and with its ports bound."""
    prefix, bound = use.get("prefix", ""), {**table["port_defaults"], **use.get("with", {})}
    for port in bound:
        if port not in table["ports"] and port not in FREE_PORTS:
            raise ConfigurationError(
                f"use.with.{port}: {use['template']}.toml has no port of this name, only {[*table['ports']]}"
            )
    free = [port for port in table["ports"] if port not in bound]
    if free:
        raise ConfigurationError(
            f"use.with.{free[0]}: missing; {use['template']}.toml needs this port ({table['ports'][free[0]]})"
        )
    elements = [entry["name"] for key in LISTS for entry in table[key] if "name" in entry]
    new_names = {name: prefix + name for name in (*table["parts"], *table["hardpoints"], *elements)}

    def turned(value: Any, key: str = "") -> Any:
        if isinstance(value, Mapping):
            return {name: turned(inner, name) for name, inner in value.items()}
        if isinstance(value, list):
            return [turned(inner, key) for inner in value]
        if isinstance(value, str) and key in {"name", "joint", *_POINTS, *_PARTS}:
            word, colon, side = value.partition(":")
            return ({**new_names, **bound} if key in _PARTS else new_names).get(word, word) + colon + side
        return value

    return {
        **table,
        **{
            key: {new_names[name]: turned(value) for name, value in table[key].items()}
            for key in ("parts", "hardpoints")
        },
        **{key: [turned(entry) for entry in table[key]] for key in LISTS},
        "above": turned(table["above"], "at"),
        **{key: turned(table[key]) for key in SINGLE},
    }


def _check(template: Template, raw: Mapping[str, Any]) -> None:
    """Check that all names of parts, points and joints exist and are valid."""
    parts = {*template.parts, *template.ports, *FREE_PORTS}
    joints = {joint.name: joint.kind for joint in template.joint if joint.name is not None}
    names = [joint.name for joint in template.joint if joint.name is not None]
    for name in names:
        if names.count(name) > 1:
            raise ConfigurationError(f"joint.{name}: defined twice; rename one joint")
    for key, kinds in _ON.items():
        for element in getattr(template, key):
            if joints.get(element.joint, kinds[0]) not in kinds:
                raise ConfigurationError(
                    f"{key}.{element.name}.joint: {element.joint!r} is a {joints[element.joint]} but must be a "
                    f"{' or a '.join(kinds)}"
                )

    for port, part in template.port_defaults.items():
        for word, allowed in ((port, {*template.ports}), (part, parts - {port})):
            if word not in allowed:
                raise ConfigurationError(f"port_defaults.{port}: unknown name {word!r}{did_you_mean(word, allowed)}")
    used: set[str] = set()
    names_of: dict[str, Collection[str]] = {"joint": joints, **dict.fromkeys(_PARTS, parts)}
    names_of |= dict.fromkeys(_POINTS, template.hardpoints)

    def look(where: str, table: Mapping[str, Any]) -> None:
        for key, value in table.items():
            if isinstance(value, Mapping):
                look(f"{where}.{key}", value)
                continue
            allowed = names_of.get(key)
            for word in value if isinstance(value, list) else [value]:
                head, _, side = str(word).partition(":")
                if key == "name" and not NAME_PATTERN.fullmatch(head):
                    raise ConfigurationError(
                        f"{where}.name: found {word!r}, must consist of letters, digits, '_', '.', '-'"
                    )
                if allowed is not None and head not in allowed:
                    besides = f" Every template also has {', '.join(FREE_PORTS)}" if allowed is parts else ""
                    near = did_you_mean(head, allowed)
                    raise ConfigurationError(f"{where}.{key}: unknown name {word!r}{near}{besides}")
                if allowed is not None and side not in ("", "left", "right", "middle"):
                    raise ConfigurationError(f"{where}.{key}: the side must be left, right or middle, not {side!r}")
                if allowed is template.hardpoints:
                    used.add(head)

    for key in LISTS:
        for position, entry in enumerate(raw[key]):
            look(f"{key}.{entry.get('name', position)}", entry)
    for name, part in raw["parts"].items():
        look(f"parts.{name}", part)
    for key in SINGLE:
        look(key, raw[key] or {})
    look("above", {"at": [point for pair in raw["above"] for point in pair]})
    if spare := [name for name in template.hardpoints if name not in used]:
        raise ConfigurationError(
            f"hardpoints.{spare[0]}: not used in the template; remove it, or move it to [hardpoints] of the "
            "vehicle file"
        )
