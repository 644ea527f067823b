"""TeimOrbit text: the property files of Adams Car and of programs that read them (MotionView, Simpack).

Blocks are named in brackets, their parts in parentheses, the columns of a table in braces; "$" and "!" begin a comment:

    [MDI_HEADER]
    FILE_TYPE = 'dpr'
    [UNITS]
    LENGTH = 'mm'
    FORCE = 'newton'
    [CURVE]
    { vel  force }
    -100.0 -300.0
     100.0  500.0

Source: documentation of Adams, "About Adams Tire" (TeimOrbit format).
"""

import itertools
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from vehicle.errors import ConfigurationError, DataError

LARGEST_FILE = 1_000_000
"""Maximum size of a property file [byte]; those of Adams have 1e3 to 1e5."""

POUND_FORCE, INCH, FOOT = 4.4482216152605, 0.0254, 0.3048

UNITS: dict[str, dict[str, float]] = {
    "LENGTH": {
        "millimeter": 1e-3, "mm": 1e-3, "centimeter": 1e-2, "cm": 1e-2, "meter": 1.0, "m": 1.0, "kilometer": 1e3,
        "km": 1e3, "inch": INCH, "in": INCH, "foot": FOOT, "feet": FOOT, "ft": FOOT,
    },
    "FORCE": {
        "newton": 1.0, "n": 1.0, "knewton": 1e3, "kilonewton": 1e3, "kn": 1e3, "kilogram_force": 9.80665,
        "kg_force": 9.80665, "kgf": 9.80665, "pound_force": POUND_FORCE, "lbf": POUND_FORCE, "dyne": 1e-5,
    },
    "TIME": {
        "second": 1.0, "seconds": 1.0, "sec": 1.0, "s": 1.0, "millisecond": 1e-3, "ms": 1e-3, "minute": 60.0,
        "min": 60.0, "hour": 3600.0,
    },
    "ANGLE": {
        "degree": math.pi / 180, "degrees": math.pi / 180, "deg": math.pi / 180, "radian": 1.0, "radians": 1.0,
        "rad": 1.0,
    },
}  # fmt: skip
"""Factors to SI units of the names of units in a [UNITS] block."""

_NAMES = {"[": "]", "(": ")", "{": "}"}
_ASSIGNMENT = re.compile(r"\s*([A-Za-z_][\w ]*?)\s*=\s*(.*)", re.DOTALL)
_COMMENT = re.compile(r"'[^']*'|\"[^\"]*\"|([$!].*)")


@dataclass(slots=True)
class Block:
    """Block of a property file.

    Attributes:
        values: texts by name in upper case, without quotes.
        rows: line number and words of each row of its table.
        columns: names of the columns of its table.
    """

    values: dict[str, str] = field(default_factory=dict)
    rows: list[tuple[int, list[str]]] = field(default_factory=list)
    columns: list[str] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True, slots=True)
class PropertyFile:
    """Property file.

    Attributes:
        path: path of the file.
        blocks: blocks by name in upper case.
    """

    path: Path
    blocks: Mapping[str, Block]

    @property
    def source(self) -> str:
        """Return file, type and units: "front.dpr (dpr; mm, newton, second, degrees)"."""
        units = self.blocks.get("UNITS", Block()).values
        return f"{self.path.name} ({self.file_type}; {', '.join(units[name] for name in UNITS if name in units)})"

    @property
    def file_type(self) -> str:
        """Return the type in lower case ("dpr"): FILE_TYPE of [MDI_HEADER], or else the suffix of the file."""
        header = self.blocks.get("MDI_HEADER", Block())
        return header.values.get("FILE_TYPE", self.path.suffix.lstrip(".")).lower()

    def block(self, name: str) -> Block:
        """Return a block."""
        if name not in self.blocks:
            present = ", ".join(f"[{other}]" for other in self.blocks) or "none"
            raise DataError(f"{self.path}: the block [{name}] is missing; found {present}; add it")
        return self.blocks[name]

    def unit(self, quantity: str) -> float:
        """Return the factor of a quantity to its SI unit."""
        units = self.block("UNITS").values
        if quantity not in units:
            raise DataError(f"{self.path}: [UNITS] has no {quantity}; add a line such as {quantity} = "
                            f"'{next(iter(UNITS[quantity]))}'")  # fmt: skip
        if (name := units[quantity].lower()) not in UNITS[quantity]:
            raise DataError(f"{self.path}: [UNITS] has {quantity} = {units[quantity]!r}, which must be one of "
                            f"{', '.join(UNITS[quantity])}")  # fmt: skip
        return UNITS[quantity][name]

    def number(self, block: str, name: str) -> float | None:
        """Return a number of a block in the units of the file; None if it is missing."""
        text = self.blocks.get(block, Block()).values.get(name)
        return None if text is None else _finite(text, f"{self.path}: [{block}] {name}")

    def points(self, block: str, x_unit: float, y_unit: float) -> list[tuple[float, float]]:
        """Return the points of a curve in SI units, x ascending.

        Points on a straight line between their neighbours, which do not change a law of straight lines, are left out.

        Args:
            x_unit: factor of the first column.
            y_unit: factor of the second column.
        """
        points: list[tuple[float, float]] = []
        for line, row in self.block(block).rows:
            where = f"{self.path}:{line}: [{block}]"
            if len(row) != 2:
                raise DataError(f"{where} has a row of {len(row)} columns instead of 2: curves of two variables "
                "cannot be read")  # fmt: skip
            x, y = (_finite(word, where) for word in row)
            if points and x * x_unit <= points[-1][0]:
                raise DataError(f"{where} has {x:g} after {points[-1][0] / x_unit:g} but must be ascending; sort the "
                                "points, and give each once")  # fmt: skip
            points.append((x * x_unit, y * y_unit))
        if len(points) < 2:
            raise DataError(f"{self.path}: [{block}] has {len(points)} points, but at least 2 are needed")
        return _corners(points)


def is_property_file(path: Path) -> bool:
    """Return whether a file begins as TeimOrbit text: with a comment, then [MDI_HEADER]."""
    try:
        with path.open("rb") as file:
            return b"[MDI_HEADER]" in file.read(4096).upper()
    except OSError:
        return False


def read_property_file(path: Path) -> PropertyFile:
    """Read a property file.

    Raises:
        ConfigurationError: the file is missing or too large.
        DataError: it is no text in TeimOrbit format, or a block is repeated.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: the file does not exist; give the path of a property file")
    if path.stat().st_size > LARGEST_FILE:
        raise ConfigurationError(f"{path}: is larger than {LARGEST_FILE / 1e6:g} MB, so it is not a property file")
    text = path.read_bytes().decode("latin-1")
    if text.lstrip().startswith("<"):
        raise DataError(f"{path}: is an XML property file; save it in TeimOrbit format (text, FILE_TYPE) with the "
        "property file editor of Adams")  # fmt: skip
    blocks: dict[str, Block] = {}
    current: Block | None = None
    skipped = False
    for number, raw in enumerate(text.splitlines(), start=1):
        line = _COMMENT.sub(lambda match: "" if match[1] else match[0], raw).strip()
        if not line:
            continue
        end = _NAMES.get(line[0])
        if end is not None and not line.endswith(end):
            raise DataError(f"{path}:{number}: {line[:40]!r} has no {end!r} at its end; add it")
        if line[0] == "[":
            name = line[1:-1].strip().upper()
            if name in blocks:
                raise DataError(f"{path}:{number}: the block [{name}] appears twice; remove one of them")
            current, skipped = blocks.setdefault(name, Block()), False
        elif current is None:
            raise DataError(f"{path}:{number}: found {line[:40]!r} before the first block; a property file must "
                "begin with [MDI_HEADER]")  # fmt: skip
        elif line[0] == "(":
            skipped = line[1:-1].strip().upper() == "COMMENTS"
        elif skipped:
            continue
        elif line[0] == "{":
            if current.rows:
                raise DataError(
                    f"{path}:{number}: the block contains a second table; only blocks with one table can be read"
                )
            current.columns = line[1:-1].split()
        elif match := _ASSIGNMENT.fullmatch(line):
            current.values[match[1].upper()] = match[2].strip().strip("'\"").strip()
        else:
            current.rows.append((number, line.replace(",", " ").split()))
    if not blocks:
        raise DataError(f"{path}: contains no block in brackets; a property file must begin with [MDI_HEADER]")
    return PropertyFile(path=path, blocks=blocks)


def _finite(word: str, where: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{where} has {word[:20]!r} instead of a finite number")
    return value


STRAIGHT = 1e-9
"""Deviation from a straight line, as a share of the largest ordinate, that counts as none."""


def _corners(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the ends and the corners of a polygon: points within round-off of a straight line are left out."""
    scale = STRAIGHT * max(abs(y) for _, y in points)
    kept = points[:1]
    for (x, y), (x_next, y_next) in itertools.pairwise(points[1:]):
        x0, y0 = kept[-1]
        if abs(y0 + (y_next - y0) * (x - x0) / (x_next - x0) - y) > scale:
            kept.append((x, y))
    return [*kept, points[-1]]
