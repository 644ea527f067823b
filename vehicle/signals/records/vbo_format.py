"""VBOX files of Racelogic (.vbo): sections in brackets, names of columns, and rows separated by blanks.

Times are HHMMSS.sss after midnight UTC, latitude and longitude minutes of arc, the longitude positive to the west.

Source: Racelogic, VBO file format.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement
from vehicle.signals.records.clock_text import DAY, clock_of_day
from vehicle.signals.records.table import Header, Vector, Wanted
from vehicle.signals.records.text import read_text
from vehicle.signals.records.text_format import careful, decimal_points, fast
from vehicle.signals.records.units import find_unit

FIXED_UNITS = {"heading": "deg", "height": "m"}
"""Units of columns that the format fixes."""
STANDARD = frozenset(
    (
        *("sats", "time", "lat", "long", "velocity", "heading", "height", "vert-vel", "vertvel", "event", "event1"),
        *("tsample", "solution_type", "avifileindex", "avisynctime", "avitime"),
    )
)
"""Columns whose units are not among `[channel units]`."""
_SECTION = re.compile(r"\[(?P<name>[^\[\]]+)\]\s*")
_CREATED = re.compile(r"File created on\s+(?P<date>\S+)", re.IGNORECASE)


def read(path: Path) -> Measurement:
    """Read all columns over the clock of the file.

    Raises:
        ConfigurationError: there is no such file.
        DataError: a section is missing, a row of another length, a time of day that is none.
    """
    text = read_text(path, western=True)
    sections: dict[str, list[tuple[int, str]]] = {"": []}
    name = ""
    for number, line in enumerate(text.lines, 1):
        match = _SECTION.fullmatch(line.strip())
        if match and name != "data":
            name = match["name"].strip().lower()
            sections.setdefault(name, [])
        elif line.strip() or name == "channel units":  # there, a blank line is a column without a unit
            sections[name].append((number, line))
    heads = [line.strip() for _, line in sections.get("header", [])]
    columns = " ".join(line for _, line in sections.get("column names", [])).split() or heads
    rows = sections.get("data", [])
    if not columns or len(rows) < 2:
        raise DataError(f"{path}: {len(columns)} columns and {len(rows)} rows; needed are [column names] and [data]")
    header = Header(path=path, line=rows[0][0] - 1, cells=tuple(columns), delimiter=" ")
    numbers, plain = [number for number, _ in rows], [" ".join(line.split()) for _, line in rows]
    notices = list(text.notices)
    if any("," in row for row in plain):
        plain = decimal_points(numbers, plain, header)
        notices.append("decimal comma read as decimal point")
    values = fast(plain, header)
    if values is None:
        values = careful(numbers, plain, header, -1, Wanted(needed="", key=lambda _: -1, missing="mark"))
    axis, date = None, next((match["date"] for _, line in sections[""] if (match := _CREATED.search(line))), "")
    start = date
    if "time" in columns:
        key = columns.index("time")
        axis, clock = _clock(path, values[:, key], numbers, notices)
        start = f"{date} {clock} UTC".strip()
    units = _units(columns, heads, [line.strip() for _, line in sections.get("channel units", [])], notices)
    channels = []
    for index, column in enumerate(columns):
        if column == "time":
            continue
        unit, remark = units[index], ""
        if column in ("lat", "long"):
            latitude = values[:, columns.index("lat" if "lat" in columns else "long")]
            unit, remark = _angle(latitude, column)
        channels.append(Channel(name=column, values=values[:, index].copy(), unit=unit, axis=axis, remark=remark))
    program = next((line.strip() for _, line in sections.get("comments", [])), "VBOX")
    return Measurement(
        path=path, format="vbo", channels=tuple(channels), sha256=text.sha256, program=program[:80], start=start,
        notices=tuple(notices),
    )  # fmt: skip


def _clock(path: Path, column: Vector, numbers: list[int], notices: list[str]) -> tuple[Vector, str]:
    """Times after the first row [s], and its time of day; a clock that passes midnight goes on."""
    seconds = np.empty(column.size)
    for row, value in enumerate(column.tolist()):
        try:
            seconds[row] = clock_of_day(value)
        except ValueError:
            raise DataError(
                f"{path}:{numbers[row]}: time {value!r}; needed is a time of day as 162235.40; repair or remove the row"
            ) from None
    for at in np.flatnonzero(np.diff(seconds) < -0.5 * DAY):
        seconds[at + 1 :] += DAY
        notices.append("the clock passes midnight: 24 h added behind it")
    first = f"{column[0]:09.2f}"
    return seconds - seconds[0], f"{first[:2]}:{first[2:4]}:{first[4:]}"


def _units(columns: list[str], heads: list[str], told: list[str], notices: list[str]) -> list[str]:
    """Units of the columns: fixed, of the section of units, or the last word of the line in the header."""
    found = [FIXED_UNITS.get(column, "") for column in columns]
    if len(heads) == len(columns):
        for index, line in enumerate(heads):
            _, blank, word = line.rpartition(" ")
            if blank and find_unit(word) is not None:
                found[index] = word
    while told and not told[-1]:
        told = told[:-1]
    own = [index for index, column in enumerate(columns) if column.lower() not in STANDARD]
    if told:
        places = range(len(columns)) if len(told) == len(columns) else own if len(told) == len(own) else []
        if not places:
            notices.append(
                f"{len(told)} units for {len(columns)} columns ({len(own)} beside those of the format): which belongs "
                f"to which is open, none is used: {', '.join(unit or '-' for unit in told)}; give --unit"
            )
        for index, unit in zip(places, told, strict=True) if places else ():
            found[index] = found[index] or ("" if unit.lower() in ("(null)", "null", "-") else unit)
    return found


def _angle(latitude: Vector, column: str) -> tuple[str, str]:
    """Unit and remark of latitude or longitude, by the latitudes: none beyond 90 may be degrees."""
    if not (np.nanmax(np.abs(latitude)) > 90.0):
        return "", "minutes of arc by the format, but no latitude is above 90: give --unit arcmin or deg"
    return "arcmin", "positive to the west" if column == "long" else ""
