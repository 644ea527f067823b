"""Hardpoints and masses of an Adams Car subsystem (`.sub`): text in TeimOrbit format with repeated blocks.

    [SUBSYSTEM_HEADER]              [HARDPOINT]                                         [PART_ASSEMBLY]
    MINOR_ROLE = 'front'            {hardpoint_name symmetry x_value y_value z_value}   USAGE = 'upright'
                                    'lca_front' 'left/right' -200.0 -400.0 150.0        MASS = 12.0

A pair (symmetry left/right) has the coordinates of its left point. Frame of Adams Car: x rearward, y right, z up.
"""

import re
from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.formats.teim_orbit import UNITS
from vehicle.signals.formats.text import read_text
from vehicle.studies.tables.name_words import AXLES, NameWords, name_words
from vehicle.studies.tables.statements import Number, Point, Statements

_POINT = re.compile(r"'([^']+?) *' +'([^']+?) *' +(\S+) +(\S+) +(\S+)")
_VALUE = re.compile(r"\s*(\w+)\s*=\s*'?([^'$]*?)'?\s*(?:\$.*)?")
FRAME = "axes: x rearward, y right, z up"


def subsystems(path: Path) -> list[str]:
    """Return the names of the subsystems of an assembly (`.asy`)."""
    usages = [match[2] for line in read_text(path).lines if (match := _VALUE.fullmatch(line)) and match[1] == "USAGE"]
    return [usage.replace("\\", "/").rpartition("/")[2] for usage in usages if usage.lower().endswith(".sub")]


def read_subsystem(path: Path) -> Statements:
    """Return the statements of a subsystem.

    Raises:
        DataError: units or hardpoints are missing, or a coordinate is no number.
    """
    content = Statements(file=path.name, remarks=[FRAME])
    block, axle, usage, units = "", "", "", dict[str, str]()
    for number, line in enumerate(read_text(path).lines, 1):
        where = f"{path}:{number}"
        if line.startswith("["):
            block, usage = line.strip().strip("[]").upper(), ""
        elif block == "HARDPOINT" and (match := _POINT.match(line.strip())):
            side = {"left/right": "left", "left": "left", "right": "right"}.get(match[2], "single")
            name = _named(match[1], axle, side)
            try:
                at = (float(match[3]), float(match[4]), float(match[5]))
            except ValueError:
                raise DataError(f"{where}: {match[1]!r} has no three coordinates; correct the row") from None
            content.points.append(Point(where=where, name=name, at=at, unit=units.get("LENGTH", "")))
        elif match := _VALUE.fullmatch(line):
            key, value = match[1].upper(), match[2]
            if block == "UNITS":
                units[key] = value.lower()
            elif key == "MINOR_ROLE" and value.lower() in AXLES:
                axle = value.lower()
            elif key == "USAGE":
                usage = value
            elif key == "PROPERTY_FILE":
                content.left_out.append((where, f'{usage}: {value}; name it in the vehicle file as curve = "FILE"'))
            elif key == "MASS" and usage:
                unit = {"kilogram": "kg", "pound_mass": "lb"}.get(units.get("MASS", "kg"), units.get("MASS", "kg"))
                content.numbers.append(Number(where=where, name=_named(f"{usage} mass", axle, ""), value=float(value),
                                              unit=unit))  # fmt: skip
    if not content.points:
        raise DataError(f"{path}: has no block [HARDPOINT] with points; export its hardpoints as CSV")
    if units.get("LENGTH") not in UNITS["LENGTH"]:
        raise DataError(f"{path}: does not state its unit of length in [UNITS]; add LENGTH = 'mm'")
    return content


def _named(text: str, axle: str, side: str) -> NameWords:
    """Return the words of a name of a subsystem, whose axle holds where the name has none."""
    name = name_words(text, right_letter="")
    return NameWords(text=text, terms=name.terms, axle=name.axle or axle, side=side)
