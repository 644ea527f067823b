"""Read VBOX files of Racelogic (.vbo): sections in brackets, column names, and rows separated by blanks.

Times are HHMMSS.sss UTC; latitude and longitude are in minutes of arc, longitude positive to the west.

Source: Racelogic, VBO file format.
"""

import re
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.clock_text import DAY, clock_of_day
from vehicle.signals.formats.csv_table import decimal_points, logged
from vehicle.signals.formats.table import Header
from vehicle.signals.formats.text import read_text
from vehicle.signals.formats.units import find_unit

FIXED_UNITS = {"heading": "deg", "height": "m"}
"""Units of columns fixed by the format."""

STANDARD = frozenset(
    (
        *("sats", "time", "lat", "long", "velocity", "heading", "height", "vert-vel", "vertvel", "event", "event1"),
        *("tsample", "solution_type", "avifileindex", "avisynctime", "avitime"),
    )
)
"""Standard columns, whose units are not in `[channel units]`."""

_SECTION = re.compile(r"\[(?P<name>[^\[\]]+)\]\s*")
_CREATED = re.compile(r"File created on\s+(?P<date>\S+)", re.IGNORECASE)


def read(path: Path) -> Measurement:
    """Read all columns over the times of the file."""
    text = read_text(path)
    sections: dict[str, list[tuple[int, str]]] = {"": []}
    name = ""
    for number, line in enumerate(text.lines, 1):
        match = _SECTION.fullmatch(line.strip())
        if match and name != "data":
            name = match["name"].strip().lower()
            sections.setdefault(name, [])
        elif line.strip() or name == "channel units":  # a blank line in this section is a column without a unit
            sections[name].append((number, line))
    heads = [line.strip() for _, line in sections.get("header", [])]
    columns = " ".join(line for _, line in sections.get("column names", [])).split() or heads
    rows = sections.get("data", [])
    if not columns or len(rows) < 2:
        raise DataError(
            f"{path}: {len(columns)} columns and {len(rows)} rows; the file needs [column names] and [data]"
        )
    header = Header(path=path, line=rows[0][0] - 1, cells=tuple(columns), delimiter=" ")
    numbers, data_rows = [number for number, _ in rows], [" ".join(line.split()) for _, line in rows]
    data_rows, points = decimal_points(numbers, data_rows, header)
    notices = [*text.notices, *points]
    values = logged(numbers, data_rows, header)
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
            if np.nanmax(np.abs(latitude)) > 90.0:
                unit, remark = "arcmin", "positive to the west" if column == "long" else ""
            else:
                unit, remark = (
                    "",
                    (
                        "minutes of arc by the format, but no latitude is above 90, so perhaps degrees; "
                        "set --unit arcmin or --unit deg"
                    ),
                )
        channels.append(Channel(name=column, values=values[:, index].copy(), unit=unit, axis=axis, remark=remark))
    program = next((line.strip() for _, line in sections.get("comments", [])), "VBOX")
    return Measurement(
        path=path, format="vbo", channels=tuple(channels), sha256=text.sha256, program=program[:80], start=start,
        notices=tuple(notices),
    )  # fmt: skip


def _clock(path: Path, column: Vector, numbers: list[int], notices: list[str]) -> tuple[Vector, str]:
    """Return times after the first row [s], continued over midnight, and the time of day of the first row."""
    seconds = np.empty(column.size)
    for row, value in enumerate(column.tolist()):
        try:
            seconds[row] = clock_of_day(value)
        except ValueError:
            raise DataError(
                f"{path}:{numbers[row]}: {value!r} is not a time of day such as 162235.40; correct or remove the row"
            ) from None
    for at in np.flatnonzero(np.diff(seconds) < -0.5 * DAY):
        seconds[at + 1 :] += DAY
        notices.append("the clock passes midnight; 24 h are added after it")
    first = f"{column[0]:09.2f}"
    return seconds - seconds[0], f"{first[:2]}:{first[2:4]}:{first[4:]}"


def _units(columns: list[str], heads: list[str], unit_lines: list[str], notices: list[str]) -> list[str]:
    """Return the units of the columns: fixed, from the unit section, or the last word of the header line."""
    units = [FIXED_UNITS.get(column, "") for column in columns]
    if len(heads) == len(columns):
        for index, line in enumerate(heads):
            _, blank, word = line.rpartition(" ")
            if blank and find_unit(word) is not None:
                units[index] = word
    while unit_lines and not unit_lines[-1]:
        unit_lines = unit_lines[:-1]
    own_columns = [index for index, column in enumerate(columns) if column.lower() not in STANDARD]
    if unit_lines:
        candidates = ([*range(len(columns))], own_columns)
        indices = next((each for each in candidates if len(each) == len(unit_lines)), [])
        if not indices:
            notices.append(
                f"{len(unit_lines)} units for {len(columns)} columns ({len(own_columns)} not standard) cannot be "
                f"assigned, so no unit is used: {', '.join(unit or '-' for unit in unit_lines)}; set --unit"
            )
        for index, unit in zip(indices, unit_lines, strict=True) if indices else ():
            units[index] = units[index] or ("" if unit.lower() in ("(null)", "null", "-") else unit)
    return units
