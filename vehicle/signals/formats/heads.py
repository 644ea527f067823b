"""Read column headers of logger files: names, units and sources in one or several lines, in any order."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.formats.clock_text import is_clock
from vehicle.signals.formats.units import find_unit

HEAD_LINES = 6
"""Maximum number of header lines: device, name, type, unit, sensor, axis."""

UNIT_SHARE = 0.6
"""Minimum share of units among the filled cells of a unit line next to a name line [-]."""

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
NUMBER_WITH_COMMA = re.compile(r"[+-]?\d+(,\d+)?([eE][+-]?\d+)?", re.ASCII)
TIME_NAME = re.compile(
    r"((rel\w*|abs\w*|elapsed|x)[ _.]?)?"
    r"(time([ _]?(stamp|axis|value))?s?|zeit\w*|timestamps?|t|temps|x-?values?|seconds|sec)\b.*|"
    r"time_?(stamps?)?[ _]?(m?s|us|ns|secs?|seconds|millis|micros|unix\w*|utc|since\w*|elapsed)|timestamp\w*|"
    r"seconds_elapsed|elapsed|epoch|(elapsed|unix|epoch|device|gps|log|sample|system|utc|local|session|"
    r"recording)[ _]?time([ _]?stamp)?s?(\b.*|_m?s)|\w+_timestamp(sync)?(_\w+)?|t_(m?s|us|sec)",
    re.IGNORECASE,
)
"""Name of a time column."""

FREQUENCY_NAME = re.compile(r"(freq\w*|frequenz\w*|f|x-?values?)\b.*", re.IGNORECASE)

_BRACKETS = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*(?:\([^()]*\)[^()]*)?)\))\s*")
_ACCELERATION_NAME = re.compile(
    r"(.*[ _.])?(\w*acc\w*|a[xyz]|a[ _][xyz]|[gi]?force\w*|g[ _]?force\w*)([ _.].*)?", re.IGNORECASE
)
_LENGTH_NAME = re.compile(
    r".*(disp|pos|height|dist|alt|travel|stroke|weg|depth|elev|profile|hub|plate).*|[xyz]", re.IGNORECASE
)
_FORCE_NAME = re.compile(r".*(force|load|kraft).*|f[xyz]?", re.IGNORECASE)

_SUFFIXES = {
    "m_s2": "m/s2", "m_s_2": "m/s2", "m_s^2": "m/s2", "mps2": "m/s2", "m_per_s2": "m/s2", "ms2": "m/s2",
    "mm_s": "mm/s", "m_s": "m/s", "mps": "m/s", "m_per_s": "m/s", "km_h": "km/h", "kmh": "km/h", "kph": "km/h",
    "mph": "mph", "deg": "deg", "degrees": "deg", "rad": "rad", "dps": "deg/s", "deg_s": "deg/s", "degs": "deg/s",
    "rad_s": "rad/s", "radps": "rad/s", "rads": "rad/s", "mm": "mm", "cm": "cm", "um": "um", "hz": "Hz", "kN": "kN",
    "Nm": "Nm", "bar": "bar", "kpa": "kPa", "kPa": "kPa", "psi": "psi", "degc": "degC", "degC": "degC", "mV": "mV",
}  # fmt: skip
"""Suffixes that are units after any name."""

_SUFFIXES_OF = (
    (TIME_NAME, {"s": "s", "sec": "s", "seconds": "s", "ms": "ms", "us": "us", "micros": "us", "millis": "ms"}),
    (_ACCELERATION_NAME, {"g": "g", "G": "g", "mg": "mg"}),
    (_LENGTH_NAME, {"m": "m", "M": "m"}),
    (_FORCE_NAME, {"N": "N", "n": "N"}),
)
"""Suffixes that are units only after a name of that quantity: `_g` after `acc_z`, `_s` after `time`."""

_UNIT_WORDS = frozenset(
    (
        "%", "rpm", "1/min", "#", "-", "db", "dba", "count", "counts", "cnt", "bit", "bits", "no_units", "unitless",
        "none", "ut", "t", "mt", "gauss", "mgauss", "lux", "lx", "hpa", "c", "f", "k", "°f", "kg", "l", "ohm",
        "kohm", "kohms", "nohm", "dop", "sats", "hdop", "w", "kw", "hp", "ah", "raw", "adc", "lsb", "mi", "miles",
        "g/s", "l/h", "w/m2", "(null)", "degf", "°c", "°", "date/time", "hhmmss.ss", "hh:mm:ss", "yyyy-mm-dd",
        "hh:mm:ss.sss", "unix", "unix_time", "local_flux", "ml", "mm3", "v/v", "mv/v", "unix time"
    )
)  # fmt: skip
"""Unit texts, in lower case, that `vehicle.signals.formats.units` does not contain."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Heads:
    """Column headers of a table.

    Attributes:
        names: names in the file; "column 3" without a name line.
        units: units in the file, from a unit line or the names; empty if missing.
        sources: sensor, bus or device of each column; empty if missing.
        named: True if the file has a name line.
        first: index of the first header line; without headers, of the first row.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    sources: tuple[str, ...]
    named: bool
    first: int


def cells_of(row: str, delimiter: str) -> list[str]:
    """Split a row into cells; strip blanks and quotes; keep delimiters within quotes.

    Args:
        delimiter: delimiter of the cells; "" for blanks.
    """
    if not delimiter:
        return row.split()
    if '"' in row:
        try:
            return [cell.strip().strip('"').strip() for cell in next(csv.reader([row], delimiter=delimiter))]
        except (csv.Error, StopIteration):
            pass
    return [cell.strip().strip('"').strip() for cell in row.rstrip("\r\n").split(delimiter)]


def read_heads(path: Path, lines: Sequence[str], start: int, delimiter: str, count: int) -> Heads:
    """Read names, units and sources from the lines above a table.

    Args:
        start: index of the first row of numbers.
        delimiter: delimiter of the cells; "" for blanks.
        count: number of columns.
    """
    above, first = _lines_of_heads(path, lines, start, delimiter, count)
    units = _take_units(above)
    names = max(above, key=lambda cells: len(set(filter(None, cells))), default=None)
    sources = [
        " ".join(dict.fromkeys(cells[column] for cells in reversed(above) if cells is not names and cells[column]))
        for column in range(count)
    ]
    line_units = [""] * count if units is None else [bare_unit(cell) for cell in units]
    if names is None:
        numbered = tuple(f"column {n + 1}" for n in range(count))
        return Heads(names=numbered, units=tuple(line_units), sources=("",) * count, named=False, first=first)
    heads = [split_head(cell) if cell else (sources[n] or f"column {n + 1}", "") for n, cell in enumerate(names)]
    return Heads(
        names=tuple(name or f"column {n + 1}" for n, (name, _) in enumerate(heads)),
        units=tuple(line or unit for line, (_, unit) in zip(line_units, heads, strict=True)),
        sources=tuple(sources),
        named=True,
        first=first,
    )


def _lines_of_heads(
    path: Path, lines: Sequence[str], start: int, delimiter: str, count: int
) -> tuple[list[list[str]], int]:
    """Return the cells of the header lines, the lowest line first, and the index of the highest header line."""
    above: list[list[str]] = []
    first = start
    for index in range(start - 1, -1, -1):
        line = lines[index]
        if not line.strip():
            if any(not _is_unit_line(cells) for cells in above):
                break
            continue
        content = line.strip("\r\n ").lstrip("#").strip(" ") if delimiter == "\t" else line.strip().lstrip("#").strip()
        cells = cells_of(content, delimiter)
        if not delimiter and len(cells) != count:
            cells = re.split(r"\t+| {2,}", content)
        while len(cells) > count and not cells[-1]:
            cells = cells[:-1]
        if len(cells) != count and not above:  # names and numbers with different delimiters
            candidates = (cells_of(content, sign) for sign in ",;\t" if sign != delimiter)
            cells = next(
                (
                    candidate
                    for candidate in candidates
                    if len(candidate) == count and not any(map(_is_number, candidate))
                ),
                cells,
            )
        if len(cells) != count:
            similar = len(cells) > 2 and abs(len(cells) - count) <= 2 and not any(map(_is_number, cells))
            if similar and not above and delimiter:
                raise DataError(
                    f"{path}:{index + 1}: found {len(cells)} names for {count} columns: "
                    f"{', '.join(map(repr, cells[:4]))}; write one name per column"
                )
            break
        if not any(cells):
            continue
        if above and count > 2 and sum(map(bool, cells)) == 1:  # a title line
            break
        if above and any(cell[:1].isdigit() and is_clock(cell) for cell in cells):  # times of laps, no sources
            break
        if not above and _is_number(cells[0]) and not all(_is_number(cell) for cell in cells if cell):
            shown = ", ".join(map(repr, cells[:4]))
            raise DataError(
                f"{path}:{index + 1}: the line mixes names and numbers: {shown}; correct or remove the line"
            )
        if above and any(_is_number(cell) for cell in cells) and not all(_is_number(cell) for cell in cells if cell):
            break
        above.append(cells)
        first = index
        if len(above) == HEAD_LINES:
            break
    return above, first


def _is_number(cell: str) -> bool:
    return bool(NUMBER.fullmatch(cell) or NUMBER_WITH_COMMA.fullmatch(cell))


def bare_unit(cell: str) -> str:
    """Strip enclosing blanks and brackets from a unit ("[m/s2]", "(g)", "m/(s^2)"); return "" for a dash."""
    text = cell.strip(" -")
    while len(text) > 1 and text[0] + text[-1] in ("[]", "()"):
        inner = text[1:-1]
        if inner.find(text[-1]) < inner.find(text[0]) or (text[-1] in inner and text[0] not in inner):
            break  # the first bracket ends before the last: (m/s)/(N)
        text = inner.strip(" -")
    return text


def _is_unit(cell: str) -> bool:
    """Return True if a text is a unit, including units that `vehicle.signals.formats.units` does not contain."""
    text = bare_unit(cell)
    return find_unit(text) is not None or text.lower() in _UNIT_WORDS


def _is_unit_line(cells: Sequence[str]) -> bool:
    filled = [cell for cell in cells if bare_unit(cell)]
    return bool(filled) and all(map(_is_unit, filled)) and any(find_unit(bare_unit(cell)) for cell in filled)


def _take_units(above: list[list[str]]) -> list[str] | None:
    """Remove the unit line from the header lines and return it; None without a unit line."""
    scores = []
    for cells in above:
        filled = [cell for cell in cells if bare_unit(cell)]
        has_unit = any(find_unit(bare_unit(cell)) for cell in filled)
        scores.append(sum(map(_is_unit, filled)) / len(filled) if filled and has_unit else 0.0)
    if not scores:
        return None
    best = max(range(len(scores)), key=lambda index: (scores[index], -index))
    if scores[best] == 1.0 or (len(above) > 1 and scores[best] >= UNIT_SHARE):
        return above.pop(best)
    return None


def split_head(cell: str) -> tuple[str, str]:
    """Split a column header into name and unit.

    A unit in brackets or after " / " is removed from the name. A unit suffix (`AccelX_g`) stays in the name,
    because it may be a part of the name.

    Args:
        cell: text of the header: 'Weg [mm]', 'a (g)', 'Weg / mm', 'acc_z_m_s2', 'Time_ms', 'Time since start in ms'.
    """
    match = _BRACKETS.fullmatch(cell)
    if match and match["square"] is not None:
        return match["name"].strip(), match["square"].strip()
    if match and _is_unit(match["round"]):
        return match["name"].strip(), match["round"].strip()
    name, slash, unit = cell.rpartition(" / ")
    if slash and find_unit(unit):
        return name.strip(), unit.strip()
    return cell.strip(), _unit_of_name(cell.strip())


def _unit_of_name(name: str) -> str:
    """Return the unit at the end of a name; empty without a unit or if the suffix may be another word."""
    if re.fullmatch(r"seconds([_ ]?elapsed)?", name, re.IGNORECASE):
        return "s"
    parts = re.split(r"(_| in |, ?| )", name)
    for split in range(1, len(parts), 2):
        head, sign, end = "".join(parts[:split]), parts[split], "".join(parts[split + 1 :])
        if not head or not end:
            continue
        if end in _SUFFIXES and (sign == "_" or "/" in _SUFFIXES[end]):
            return _SUFFIXES[end]
        for pattern, units in _SUFFIXES_OF:
            if end in units and pattern.fullmatch(head):
                return units[end]
        if (sign.strip(" ") or "/" in end) and sign != "_" and find_unit(end) is not None:
            return end
    return ""
