"""Read text files of loggers: free text, header lines, then rows of numbers, dates and times of day."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.clock_text import clock_seconds, epoch_seconds, is_date
from vehicle.signals.formats.csv_table import decimal_points, logged
from vehicle.signals.formats.frf_file import FREQUENCY, RANDOM_ERROR, SUFFIXES, read_frf
from vehicle.signals.formats.heads import FREQUENCY_NAME, TIME_NAME, Heads, cells_of, read_heads
from vehicle.signals.formats.own_times import is_time, own_times, time_pairs, with_own_rasters
from vehicle.signals.formats.spectrum_columns import joined
from vehicle.signals.formats.table import Header
from vehicle.signals.formats.text import Text, read_text
from vehicle.signals.formats.text_table import AGREEING, Kind, TextTable, find_table, settled_kinds, with_remarks
from vehicle.signals.formats.units import find_unit

_RATE = re.compile(
    r"((sampl\w*|data|log\w*)[ _]?(rate|freq\w*)|hz)\W{0,6}(?P<rate>\d+(\.\d+)?)\W{0,3}(k?hz)?", re.IGNORECASE
)
_EPOCH_UNITS = {"unix time": "s", "unix": "s", "unix_time": "s"}


class _Axis(NamedTuple):
    """Times or frequencies of a table: values, source columns, quantity, start and messages."""

    values: Vector | None
    columns: tuple[int, ...]
    kind: str
    start: str = ""
    notices: tuple[str, ...] = ()
    remark: str = ""


def read(path: Path) -> Measurement:
    """Read the table of a text file with the headers above the table."""
    text = read_text(path)
    if any(line.startswith(FREQUENCY) and SUFFIXES[0] in line for line in text.lines[:20]):
        return _responses(path, text.sha256)
    return read_lines(path, text, "csv")


def read_lines(path: Path, text: Text, format_name: str) -> Measurement:
    """Read a table of numbers from lines of text."""
    lines = text.lines
    table = find_table(path, lines)
    lines, table = _without_last_delimiter(lines, table)
    lines, table, remarks = with_remarks(lines, table)
    start, delimiter = table.start, table.delimiter
    heads = read_heads(path, lines, start, delimiter, len(table.kinds))
    if not heads.named and delimiter == "," and not any("." in line for line in lines[start : start + AGREEING]):
        raise DataError(
            f"{path}:{start + 1}: are the commas decimal commas? The rows have {len(table.kinds)} numbers "
            "without a decimal point, and no line above with as many names; with decimal commas, separate the "
            "columns by ';' or tabs"
        )
    numbers = [n + 1 for n in range(start, len(lines)) if lines[n].strip()]
    rows = [lines[n - 1] for n in numbers]
    kinds = settled_kinds(path, rows, table, heads.names)
    notices = [*text.notices, *remarks]
    if not heads.named:
        notices.append(f"no line with names above line {start + 1}; the columns are named by their numbers")
    texts, rows, delimiter = _texts(path, numbers, rows, delimiter, kinds)
    if not delimiter:
        rows = [" ".join(row.split()) for row in rows]
    header = Header(path=path, line=start + 1, cells=heads.names, delimiter=delimiter or " ")
    rows, points = decimal_points(numbers, rows, header)
    notices += points
    heads_of = zip(kinds, heads.names, heads.units, strict=True)
    columns = [("time" if is_time(*head) else "channel") if each == "number" else each for each, *head in heads_of]
    pairs = {} if "clock" in kinds else time_pairs(columns)
    remarks_of: dict[int, str] = {}
    values = logged(numbers, rows, header, -1 if pairs else _key(heads, kinds), remarks_of)
    own_axes = own_times(path, heads.names, heads.units, pairs, list(values.T)) if pairs else {}
    if pairs and not own_axes:
        values = logged(numbers, rows, header, _key(heads, kinds), remarks_of)
    axis = _axis(path, heads, kinds, values, texts, numbers)
    if own_axes:
        axis = axis._replace(values=None, columns=tuple(sorted(set(pairs.values()))))
    notices += axis.notices
    text_columns = [name for name, column_type, n in zip(heads.names, kinds, range(len(kinds)), strict=True)
            if column_type != "number" and n not in axis.columns]  # fmt: skip
    if text_columns:
        notices.append(f"text columns are ignored: {', '.join(map(repr, text_columns[:12]))}")
    channels = tuple(
        Channel(
            name=name,
            values=np.ascontiguousarray(values[:, index]),
            unit=heads.units[index],
            axis=own_axes.get(index, axis.values),
            kind="frequency" if axis.kind == "frequency" else "time",
            function="time history" if axis.kind == "time" else "spectrum",
            place=heads.sources[index],
            remark=axis.remark if index in axis.columns else remarks_of.get(index, ""),
        )
        for index, name in enumerate(heads.names)
        if kinds[index] == "number" and (index not in axis.columns or (axis.values is None and not own_axes))
    )
    channels = joined(path, channels) if axis.kind == "frequency" else tuple(with_own_rasters(channels))
    if axis.values is None:
        notices += _rates_above(lines[:start])
    above = [line.strip(' \t#;,"') for line in lines[: heads.first] if not line.strip('" ').lower().startswith("sep=")]
    return Measurement(
        path=path,
        format=format_name,
        channels=channels,
        sha256=text.sha256,
        program=next((line for line in above if line), "")[:80],
        start=axis.start,
        notices=tuple(notices),
    )


def _without_last_delimiter(lines: list[str], table: TextTable) -> tuple[list[str], TextTable]:
    """Remove a trailing delimiter from all lines if it is not followed by a column."""
    delimiter, start = table.delimiter, table.start
    above = next((line for line in reversed(lines[:start]) if line.strip()), "")
    if not delimiter or table.kinds[-1] != "missing" or not lines[start].rstrip("\r ").endswith(delimiter):
        return lines, table
    names = next((line for line in reversed(lines[:start]) if line.count(delimiter) + 2 >= len(table.kinds)), above)
    shorter = len(cells_of(names, delimiter)) == len(table.kinds) - 1
    if not (names.rstrip("\r ").endswith(delimiter) or shorter or delimiter not in above):
        return lines, table
    stripped = [line.rstrip("\r ").removesuffix(delimiter) for line in lines]
    return stripped, replace(table, kinds=table.kinds[:-1])


def _texts(
    path: Path, numbers: Sequence[int], rows: list[str], delimiter: str, kinds: Sequence[Kind]
) -> tuple[dict[int, list[str]], list[str], str]:
    """Return the cells of clock columns, the rows with texts replaced by 0 and quotes removed, and the delimiter."""
    quoted = any('"' in row for row in rows[:AGREEING])
    columns = [column for column, column_type in enumerate(kinds) if column_type != "number"]
    if not columns and not quoted:
        return {}, rows, delimiter
    texts: dict[int, list[str]] = {column: [] for column in columns if kinds[column] == "clock"}
    numeric_rows: list[str] = []
    sign, unquoted = delimiter, not any('"' in row for row in rows)
    for line, row in zip(numbers, rows, strict=True):
        cells = row.split(delimiter or None) if unquoted else cells_of(row, delimiter)
        if len(cells) != len(kinds):
            raise DataError(
                f"{path}:{line}: the row has {len(cells)} cells, but the header {len(kinds)}; correct the row"
            )
        for column in columns:
            if column in texts:
                texts[column].append(cells[column].strip())
            cells[column] = "0"
        if not unquoted and sign == "," and any("," in cell for cell in cells):  # quoted decimal commas
            sign = ";"
            numeric_rows = [numeric_row.replace(",", ";") for numeric_row in numeric_rows]
        numeric_rows.append((sign or " ").join(cells))
    return texts, numeric_rows, sign


def _key(heads: Heads, kinds: Sequence[Kind]) -> int:
    """Return the index of the numeric time column, preferably with a known unit; -1 if there is none."""
    named = _time_columns(heads, kinds)
    with_unit = [index for index in named if find_unit(heads.units[index]) is not None]
    return next(iter((*with_unit, *named)), -1)


def _time_columns(heads: Heads, kinds: Sequence[Kind]) -> list[int]:
    """Return the indices of the numeric columns with the name of a time."""
    return [
        index
        for index, name in enumerate(heads.names)
        if kinds[index] == "number" and _is_axis(name, heads.units[index], "time")
    ]


def _rises(values: Vector) -> bool:
    """Return True if the values of a column never decrease; a clock that restarts decreases."""
    return bool((np.diff(values) >= 0.0).all() and values[-1] > values[0])


def _axis(
    path: Path, heads: Heads, kinds: Sequence[Kind], values: Vector, texts: dict[int, list[str]], numbers: Sequence[int]
) -> _Axis:
    """Return the axis of a table: times from a time column, a count since 1970, or dates and clocks; or frequencies."""
    clock = _clock_axis(path, heads, texts, numbers) if texts else None
    start = clock.start if clock is not None else ""
    key = _key(heads, kinds)
    others = [column for column in _time_columns(heads, kinds) if column != key and _rises(values[:, column])]
    if key >= 0 and not _rises(values[:, key]) and others:
        key = others[0]
    if key >= 0:
        name, unit = heads.names[key], heads.units[key]
        time_unit = find_unit(unit)
        if time_unit is None or time_unit.factor < 1.0:
            prefix = {1e-3: "ms", 1e-6: "us"}.get(time_unit.factor if time_unit else 1.0, "")
            epoch = epoch_seconds(values[:, key], prefix or _EPOCH_UNITS.get(unit.lower(), ""))
        else:
            epoch = epoch_seconds(values[:, key], "s") if unit else None
        if epoch is not None:
            notice = f"column {name!r} counts {epoch[2]} since 1970: the time begins at {epoch[1]}"
            return _Axis(epoch[0], (key,), "time", epoch[1], (notice,))
        if time_unit is not None:
            return _Axis(values[:, key] * time_unit.factor, (key,), "time", start or _start_of(heads, kinds, values))
    if clock is not None:
        return clock
    if key >= 0:
        return _Axis(None, (key,), "time", remark=_without_unit("time", heads.names[key]))
    if kinds[0] == "number" and _is_axis(heads.names[0], heads.units[0], "frequency"):
        unit_of_first = find_unit(heads.units[0])
        if unit_of_first is not None:
            return _Axis(values[:, 0] * unit_of_first.factor, (0,), "frequency")
        return _Axis(None, (0,), "frequency", remark=_without_unit("frequency", heads.names[0]))
    return _Axis(None, (), "time")


def _without_unit(quantity: str, name: str) -> str:
    return f"the {quantity} column has no known unit; set --rate HZ, or --channel time={name} --unit time=s"


def _start_of(heads: Heads, kinds: Sequence[Kind], values: Vector) -> str:
    """Return date and time of the first row from a column that counts time since 1970; empty without one."""
    for column, name in enumerate(heads.names):
        unit = heads.units[column].lower()
        if kinds[column] == "number" and TIME_NAME.fullmatch(name) and (not unit or unit in _EPOCH_UNITS):
            epoch = epoch_seconds(values[:, column], _EPOCH_UNITS.get(unit, ""))
            if epoch is not None:
                return epoch[1]
    return ""


def _clock_axis(path: Path, heads: Heads, texts: dict[int, list[str]], numbers: Sequence[int]) -> _Axis | None:
    """Return the times of the first increasing clock column, with dates of another column; None without clocks."""
    days = [column for column, cells in texts.items() if is_date(cells[0])]
    clocks: list[_Axis] = []
    for column, cells in texts.items():
        if column in days:
            continue
        day = next((day_column for day_column in days if not is_date(cells[0].split(" ")[0].split("T")[0])), None)
        try:
            seconds, start, notices = clock_seconds(cells, texts[day] if day is not None else None)
        except ValueError as error:
            row = int(error.args[0])
            raise DataError(
                f"{path}:{numbers[row]}:{column + 1}: column {heads.names[column]!r} has the cell {cells[row]!r}, not "
                f"a date or clock such as {cells[0]!r}; correct or remove the row"
            ) from None
        columns = (column,) if day is None else (day, column)
        shown = " and ".join(repr(heads.names[day_column]) for day_column in columns)
        notice = f"dates and clocks of column {shown}: the time begins at {start}"
        clocks.append(_Axis(seconds, columns, "time", start, (notice, *notices)))
    rising = [clock for clock in clocks if clock.values is not None and (np.diff(clock.values) > 0.0).all()]
    return next(iter((*rising, *clocks)), None)


def _rates_above(above: Sequence[str]) -> list[str]:
    """Return a notice on a sampling rate in the text above a table without times."""
    for line in above:
        if match := _RATE.search(line):
            text = match.group().strip()
            return [
                f"the text above the table contains {text!r}; if this is the sampling rate, set --rate {match['rate']}"
            ]
    return []


def _responses(path: Path, sha256: str) -> Measurement:
    """Read the `frf.csv` of a run as channels: frequency responses, coherences and random errors."""
    frfs = read_frf(path)
    channels = []
    for row, name in enumerate(frfs.channels):
        for end, values, unit, function in (
            ("", frfs.response, "(m/s2)/m", "frequency response"),
            (SUFFIXES[2], frfs.coherence, "", "coherence"),
            (RANDOM_ERROR, frfs.random_error, "(m/s2)/m", "random error"),
        ):
            channel = Channel(name=name + end, values=values[row], unit=unit, axis=frfs.frequency, kind="frequency")
            if end != RANDOM_ERROR or np.isfinite(channel.values).any():
                channels.append(replace(channel, function=function))
    return Measurement(path=path, format="csv", channels=tuple(channels), sha256=sha256)


def _is_axis(name: str, unit: str, quantity: str) -> bool:
    """Return True if name and unit of a column mean the time or the frequency."""
    pattern = TIME_NAME if quantity == "time" else FREQUENCY_NAME
    unit_entry = find_unit(unit)
    return bool(pattern.fullmatch(name.strip())) and (unit_entry is None or unit_entry.quantity == quantity)
