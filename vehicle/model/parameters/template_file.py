"""Reading one template file, without the templates that it includes: keys and types."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.toml_file import convert, read_table
from vehicle.model.parameters.topology import Connection, Damper, Joint, Output, Spring
from vehicle.wording import did_you_mean

LISTS = {"joint": Joint, "connection": Connection, "spring": Spring, "damper": Damper, "output": Output}
"""Lists of elements, and their classes."""

TEMPLATE_KEYS: dict[str, Any] = {
    "mirrored": bool,
    "use": tuple[dict, ...],  # type: ignore[type-arg]
    "hardpoints": Mapping[str, str],
    "ports": Mapping[str, str],
    "port_defaults": Mapping[str, str],
    "parts": Mapping[str, dict],  # type: ignore[type-arg]
    "wheel": dict,
    "steering_axis": dict,
    "above": tuple[tuple[str, ...], ...],
    **dict.fromkeys(LISTS, tuple[dict, ...]),  # type: ignore[type-arg]
}
USE_KEYS: dict[str, Any] = {"template": str, "prefix": str, "with": Mapping[str, str], "when": str}


def read_template_file(path: Path) -> dict[str, Any]:
    """Read a template file without included templates.

    Returns:
        Tables and lists; missing tables and lists are empty, a missing wheel or steering axis is None.

    Raises:
        ConfigurationError: not a TOML file, an unknown key or a wrong type; the message names the file.
    """
    table = read_table(path)
    try:
        for key, value in table.items():
            if key not in TEMPLATE_KEYS:
                raise ConfigurationError(f"{key}: unknown key{did_you_mean(key, TEMPLATE_KEYS)}")
            convert(TEMPLATE_KEYS[key], value, key)
        for position, use in enumerate(table.get("use", [])):
            if "template" not in use or set(use) - set(USE_KEYS):
                raise ConfigurationError(f"use: found {use}; must have template, and may have prefix, with, when")
            for key, value in use.items():
                convert(USE_KEYS[key], value, f"use.{position}.{key}")
        for pair in table.get("above", []):
            if len(pair) != 2:
                raise ConfigurationError(f"above: found {pair}, must be two points, the upper point first")
    except ConfigurationError as error:
        raise ConfigurationError(f"{path.name}: {error}") from None
    return {
        "mirrored": table.get("mirrored", False),
        "wheel": table.get("wheel"),
        "steering_axis": table.get("steering_axis"),
        "use": table.get("use", []),
        "above": list(table.get("above", [])),
        **{key: dict(table.get(key, {})) for key in ("hardpoints", "ports", "port_defaults", "parts")},
        **{key: [_listed(entry) for entry in table.get(key, [])] for key in LISTS},
    }


def _listed(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Return an entry whose child is a list of names."""
    return {**entry, "child": [entry["child"]]} if isinstance(entry.get("child"), str) else dict(entry)
