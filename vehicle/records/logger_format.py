"""Text files of loggers: lines of text, a line of names, perhaps one of units, then numbers in any columns."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.records.channel import Channel, Measurement
from vehicle.records.frf import FREQUENCY, RANDOM_ERROR, SUFFIXES, read_frf
from vehicle.records.spectrum_columns import joined
from vehicle.records.table import Header, Vector, Wanted
from vehicle.records.text import Text, read_text
from vehicle.records.text_format import careful, decimal_points, fast
from vehicle.records.units import find_unit

TEXT_LINES = 400
"""The numbers must begin within so many lines."""
AGREEING = 4
"""Lines of numbers in one shape that tell where the table begins."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_WITH_COMMA = re.compile(r"[+-]?\d+(,\d+)?([eE][+-]?\d+)?", re.ASCII)
_MISSING = ("", "nan", "-", "na", "n/a", "#n/a", "null")
_TIME = re.compile(r"((rel\w*|abs\w*|elapsed|x)[ _.]?)?(time([ _]?(stamp|axis|value))?s?|zeit\w*|timestamps?|t|temps|"
                   r"x-?values?|seconds|sec)\b.*", re.IGNORECASE)  # fmt: skip
_FREQUENCY = re.compile(r"(freq\w*|frequenz\w*|f|x-?values?)\b.*", re.IGNORECASE)
_BRACKETS = re.compile(r"(?P<name>.*?)\s*(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*(?:\([^()]*\)[^()]*)?)\))\s*")


def read(path: Path) -> Measurement:
    """Read a table of numbers with what stands above it.

    Raises:
        ConfigurationError: there is no such file.
        DataError: no numbers in columns, a row of another length, a cell that is no number, a comma in doubt.
    """
    text = read_text(path, western=True)
    if any(line.startswith(FREQUENCY) and SUFFIXES[0] in line for line in text.lines[:20]):
        return _responses(path, text.sha256)
    return read_lines(path, text, "csv")


def read_lines(path: Path, text: Text, form: str) -> Measurement:
    """A table of numbers in lines of text.

    Args:
        path: the file, for messages.
        text: its lines.
        form: name of its format.

    Raises:
        DataError: as of `read`.
    """
    lines = text.lines
    start, delimiter = _table(path, lines)
    above = next((line for line in reversed(lines[:start]) if line.strip()), "")
    if _trailing(lines[start], delimiter) and (_trailing(above, delimiter) or delimiter not in above):
        lines = [line.rstrip().removesuffix(delimiter) for line in lines]  # no cell follows the last delimiter
    count = len(_cells(lines[start], delimiter))
    names, units, titled = _heads(path, lines, start, delimiter, count)
    if not titled and delimiter == "," and not any("." in line for line in lines[start : start + AGREEING]):
        raise DataError(
            f"{path}:{start + 1}: rows of {count} numbers without a decimal point, and no line of as many names above "
            "them; with decimal commas the columns must be separated by ';' or tabs; 1,5 is never guessed"
        )
    where = [n for n in range(start, len(lines)) if lines[n].strip()]
    header = Header(path=path, line=start + 1, cells=tuple(names), delimiter=delimiter or " ")
    notices = list(text.notices)
    if not titled:
        notices.append(f"no line of names above line {start + 1}: the columns are numbered")
    rows = [lines[n] for n in where]
    if not delimiter:
        rows = [" ".join(row.split()) for row in rows]
    numbers = [n + 1 for n in where]
    if delimiter != "," and any("," in row for row in rows):
        rows = decimal_points(numbers, rows, header)
        notices.append("decimal comma read as decimal point")
    key = next((n for n, name in enumerate(names) if _is_axis(name, units[n], "time")), -1)
    kind: str = "time"
    if key < 0 and _is_axis(names[0], units[0], "frequency"):
        key, kind = 0, "frequency"
    values = fast(rows, header)
    if values is None:
        values = careful(numbers, rows, header, key, Wanted(needed="", key=lambda _: key, missing="mark"))
    axis: Vector | None = None
    remark = ""
    if key >= 0:
        unit = find_unit(units[key])
        if unit is not None:
            axis = values[:, key] * unit.factor
        else:
            remark = f"the {kind}, without a known unit: give --rate HZ, or --channel time={names[key]} --unit time=s"
    channels = tuple(
        Channel(
            name=name,
            values=np.ascontiguousarray(values[:, index]),
            unit=units[index],
            axis=axis,
            kind="frequency" if kind == "frequency" else "time",
            function="time history" if kind == "time" else "spectrum",
            remark=remark if index == key else "",
        )
        for index, name in enumerate(names)
        if index != key or axis is None
    )
    if kind == "frequency":
        channels = joined(channels)
    program = next((line.strip(" \t#;,") for line in lines[:start] if line.strip(" \t#;,")), "") if start > 1 else ""
    return Measurement(
        path=path, format=form, channels=channels, sha256=text.sha256, program=program[:80], notices=tuple(notices)
    )


def _responses(path: Path, sha256: str) -> Measurement:
    """The `frf.csv` of a run: frequency responses and their coherences."""
    found = read_frf(path)
    about: dict[str, Any] = {"axis": found.frequency, "kind": "frequency"}
    channels = []
    for row, name in enumerate(found.channels):
        channels.append(
            Channel(
                name=name,
                values=found.response[row],
                unit="(m/s2)/m",
                function="frequency response",
                **about,
            )
        )
        channels.append(Channel(name=f"{name}_coherence", values=found.coherence[row], function="coherence", **about))
        if np.isfinite(found.random_error[row]).any():
            error = Channel(name=name + RANDOM_ERROR, values=found.random_error[row], unit="(m/s2)/m", **about)
            channels.append(replace(error, function="random error"))
    return Measurement(path=path, format="csv", channels=tuple(channels), sha256=sha256)


def _is_axis(name: str, unit: str, kind: str) -> bool:
    """Whether a column is the time, or the frequency: by its name, and a unit that does not speak against it."""
    pattern = _TIME if kind == "time" else _FREQUENCY
    known = find_unit(unit)
    return bool(pattern.fullmatch(name.strip())) and (known is None or known.quantity == kind)


def _cells(row: str, delimiter: str) -> list[str]:
    if not delimiter:
        return row.split()
    return [cell.strip().strip('"').strip() for cell in row.rstrip("\r\n").split(delimiter)]


def _trailing(row: str, delimiter: str) -> bool:
    """Whether a row ends with a delimiter that no cell follows."""
    return bool(delimiter) and delimiter != "\t" and row.rstrip().endswith(delimiter)


def _numeric(row: str, delimiter: str) -> int:
    """Cells of a row of numbers; 0 for any other row."""
    form = _NUMBER if delimiter == "," else _WITH_COMMA
    cells = _cells(row, delimiter)
    hits = sum(1 for cell in cells if _NUMBER.fullmatch(cell) or form.fullmatch(cell))
    good = hits and all(cell.lower() in _MISSING or _NUMBER.fullmatch(cell) or form.fullmatch(cell) for cell in cells)
    return len(cells) if good else 0


def _table(path: Path, lines: list[str]) -> tuple[int, str]:
    """First line of the numbers, and what separates them; "" for blanks."""
    for delimiter in (";", "\t", ",", ""):
        for start in range(min(TEXT_LINES, len(lines))):
            count = _numeric(lines[start], delimiter) if lines[start].strip() else 0
            if count < 2:
                continue
            following = [line for line in lines[start + 1 : start + 1 + AGREEING] if line.strip()]
            if len(following) >= 2 and all(_numeric(line, delimiter) == count for line in following):
                return start, delimiter
    for start in range(min(TEXT_LINES, len(lines))):
        following = [line for line in lines[start : start + AGREEING] if line.strip()]
        if len(following) > 2 and all(_numeric(line, ";") == 1 for line in following):
            return start, ";"
    raise DataError(
        f"{path}: no table of numbers in the first {TEXT_LINES} lines; needed are rows of numbers in columns that are "
        "separated by ';', tab, ',' or blanks, with a line of names and units above them"
    )


def _heads(path: Path, lines: list[str], start: int, delimiter: str, count: int) -> tuple[list[str], list[str], bool]:
    """Names and units of the columns, and whether a line tells the names."""
    above: list[list[str]] = []
    for line in reversed(lines[:start]):
        if not line.strip():
            continue
        cells = _cells(line.strip().lstrip("#").strip(), delimiter) if delimiter != "\t" else _cells(line, delimiter)
        if len(cells) != count or len(above) == 2:
            break
        above.append(cells)
    unit_line: list[str] | None = None
    if above and _all_units(above[0]):
        unit_line = above.pop(0)
    elif len(above) == 2 and _all_units(above[1]):
        unit_line = above.pop(1)
    elif len(above) == 2 and _all_units(above[0]):
        unit_line = above.pop(0)
    titled = bool(above)
    if titled and _WITH_COMMA.fullmatch(above[0][0].replace(".", ",")):
        shown = ", ".join(map(repr, above[0][:4]))
        raise DataError(f"{path}:{start}: neither names nor numbers: {shown}; repair or remove the line")
    heads = [split_head(cell) for cell in above[0]] if titled else [(f"column {n + 1}", "") for n in range(count)]
    names = [name for name, _ in heads]
    units = [unit for _, unit in heads]
    if unit_line is not None:
        for index, cell in enumerate(unit_line):
            units[index] = units[index] or cell.strip("[]() -")
    return names, units, titled


def _all_units(cells: list[str]) -> bool:
    """Whether a line holds units alone, at least one of them known."""
    texts = [cell.strip("[]() -") for cell in cells]
    return any(find_unit(text) for text in texts) and all(not text or find_unit(text) for text in texts)


def split_head(cell: str) -> tuple[str, str]:
    """Name and unit of the head of a column: 'Weg [mm]', 'a (g)', 'Weg / mm'; brackets around another word stay.

    Args:
        cell: as found.
    """
    match = _BRACKETS.fullmatch(cell)
    if match and match["square"] is not None:
        return match["name"].strip(), match["square"].strip()
    if match and find_unit(match["round"]):
        return match["name"].strip(), match["round"].strip()
    name, slash, unit = cell.rpartition(" / ")
    if slash and find_unit(unit):
        return name.strip(), unit.strip()
    return cell.strip(), ""
