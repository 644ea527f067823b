"""Sources of the values of a vehicle file: the comments behind them."""

import re
from pathlib import Path

from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.curves import curve_sources
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.model.parameters.toml_file import read_table

_HEAD = re.compile(r"\s*\[([^\[\]]+)\]\s*(?:#.*)?")
_KEY = re.compile(r"\s*([A-Za-z0-9_.\"'-]+)\s*=\s*(.*)", re.DOTALL)
_QUOTED = re.compile(r"\"\"\".*?\"\"\"|'''.*?'''|\"(?:[^\"\\\n]|\\.)*\"|'[^'\n]*'", re.DOTALL)
_UNIT = re.compile(r"\[[^\]]*\]\s*")


def value_sources(file: Path) -> dict[str, str]:
    """Read the comment behind each value of a vehicle file, without the unit at its beginning.

    A number from a file that the vehicle file names has that file as its source.

    Args:
        file: vehicle file; sources of values that it takes from its base come from the file of the base.

    Returns:
        Path of a parameter to the text of its comment; a value without a comment is left out.

    Raises:
        ConfigurationError: the file, its base, or a file that it names cannot be read.
    """
    table = read_table(file)
    sources: dict[str, str] = {}
    if isinstance(base := table.get("base"), str):
        beside = file.parent / base
        if beside.is_file() or base in CARS:
            sources = value_sources(beside if beside.is_file() else vehicle_file(base))
    sources.update(comments(file.read_text(encoding="utf-8")))
    sources.update(curve_sources(vehicle_table(file), file.parent))
    return sources


def comments(text: str) -> dict[str, str]:
    """Return the comment behind each value of a TOML text by its path, without the unit at its beginning.

    Args:
        text: text of a TOML file that was parsed without an error.
    """
    sources: dict[str, str] = {}
    prefix, statement = "", ""
    for line in text.splitlines():
        statement = f"{statement}\n{line}" if statement else line
        bare = _QUOTED.sub(lambda match: "_" * len(match[0]), statement)
        # The comment of a list over several lines is behind its closing bracket; comments inside it are not read.
        code = re.sub(r"#[^\n]*", "", bare)
        if code.count("[") > code.count("]") or code.count("{") > code.count("}"):
            continue
        if head := _HEAD.fullmatch(bare):
            prefix = head[1].strip() + "."
        elif _KEY.match(bare) and (match := _KEY.match(statement)):
            last = bare.rfind("\n") + 1
            _, sign, _ = bare[last:].partition("#")
            comment = statement[last + bare[last:].index("#") + 1 :].strip() if sign else ""
            if comment := _UNIT.sub("", comment, count=1) if _UNIT.match(comment) else comment:
                sources[prefix + match[1].strip("\"'")] = comment
        statement = ""
    return sources
