"""Text files of loggers: lines of text, lines of names, units and sources, then rows of numbers, dates and clocks."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement
from vehicle.signals.records.clock_text import clock_seconds, epoch_seconds, is_date
from vehicle.signals.records.frf import FREQUENCY, RANDOM_ERROR, SUFFIXES, read_frf
from vehicle.signals.records.heads import FREQUENCY_NAME, TIME_NAME, Heads, cells_of, read_heads
from vehicle.signals.records.spectrum_columns import joined
from vehicle.signals.records.table import Header, Vector, Wanted
from vehicle.signals.records.text import Text, read_text
from vehicle.signals.records.text_format import careful, decimal_points, fast, fast_with_gaps
from vehicle.signals.records.text_table import AGREEING, Kind, TextTable, find_table, settled_kinds
from vehicle.signals.records.units import find_unit

_RATE = re.compile(
    r"((sampl\w*|data|log\w*)[ _]?(rate|freq\w*)|hz)\W{0,6}(?P<rate>\d+(\.\d+)?)\W{0,3}(k?hz)?", re.IGNORECASE
)
_EPOCH_UNITS = {"unix time": "s", "unix": "s", "unix_time": "s"}


class _Axis(NamedTuple):
    """Times or frequencies of a table: values, the columns that hold them, and what is said about them."""

    values: Vector | None
    columns: tuple[int, ...]
    kind: str
    start: str = ""
    notices: tuple[str, ...] = ()
    remark: str = ""


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
    """Read a table of numbers in lines of text.

    Args:
        path: the file, for messages.
        text: its lines.
        form: name of its format.

    Raises:
        DataError: see `read`.
    """
    lines = text.lines
    table = find_table(path, lines)
    lines, table = _without_last_delimiter(lines, table)
    start, delimiter = table.start, table.delimiter
    heads = read_heads(path, lines, start, delimiter, len(table.kinds))
    if not heads.named and delimiter == "," and not any("." in line for line in lines[start : start + AGREEING]):
        raise DataError(
            f"{path}:{start + 1}: rows of {len(table.kinds)} numbers without a decimal point, and no line of as many "
            "names above them; with decimal commas the columns must be separated by ';' or tabs; 1,5 is never guessed"
        )
    numbers = [n + 1 for n in range(start, len(lines)) if lines[n].strip()]
    rows = [lines[n - 1] for n in numbers]
    kinds = settled_kinds(path, rows, table, heads.names)
    notices = list(text.notices)
    if not heads.named:
        notices.append(f"no line of names above line {start + 1}: the columns are numbered")
    texts, rows, delimiter = _texts(path, numbers, rows, delimiter, kinds)
    if not delimiter:
        rows = [" ".join(row.split()) for row in rows]
    header = Header(path=path, line=start + 1, cells=heads.names, delimiter=delimiter or " ")
    if delimiter != "," and any("," in row for row in rows):
        rows = decimal_points(numbers, rows, header)
        notices.append("decimal comma read as decimal point")
    key = _key(heads, kinds)
    values = fast(rows, header)
    if values is None:
        values = fast_with_gaps(rows, header, key)
    if values is None:
        values = careful(numbers, rows, header, key, Wanted(needed="", key=lambda _: key, missing="mark"))
    axis = _axis(path, heads, kinds, values, texts, numbers)
    notices += axis.notices
    left = [name for name, kind, n in zip(heads.names, kinds, range(len(kinds)), strict=True)
            if kind != "number" and n not in axis.columns]  # fmt: skip
    if left:
        notices.append(f"columns of text are left out: {', '.join(map(repr, left[:12]))}")
    channels = tuple(
        Channel(
            name=name,
            values=np.ascontiguousarray(values[:, index]),
            unit=heads.units[index],
            axis=axis.values,
            kind="frequency" if axis.kind == "frequency" else "time",
            function="time history" if axis.kind == "time" else "spectrum",
            place=heads.sources[index],
            remark=axis.remark if index in axis.columns else "",
        )
        for index, name in enumerate(heads.names)
        if kinds[index] == "number" and (index not in axis.columns or axis.values is None)
    )
    if axis.kind == "frequency":
        channels = joined(channels)
    if axis.values is None:
        notices += _rates_above(lines[:start])
    return Measurement(
        path=path,
        format=form,
        channels=channels,
        sha256=text.sha256,
        program=_program(lines[: heads.first]),
        start=axis.start,
        notices=tuple(notices),
    )


def _without_last_delimiter(lines: list[str], table: TextTable) -> tuple[list[str], TextTable]:
    """Lines without a delimiter at the end that no cell follows: the line above the table has it too, or no other."""
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
    """Cells of the columns of dates and clocks; rows with zeros in place of all texts and without quotes; delimiter."""
    quoted = any('"' in row for row in rows[:AGREEING])
    columns = [column for column, kind in enumerate(kinds) if kind != "number"]
    if not columns and not quoted:
        return {}, rows, delimiter
    texts: dict[int, list[str]] = {column: [] for column in columns if kinds[column] == "clock"}
    found: list[str] = []
    sign, plain = delimiter, not any('"' in row for row in rows)
    for line, row in zip(numbers, rows, strict=True):
        cells = row.split(delimiter or None) if plain else cells_of(row, delimiter)
        if len(cells) != len(kinds):
            raise DataError(
                f"{path}:{line}: row has {len(cells)} cells, the header {len(kinds)}; repair or remove the row"
            )
        for column in columns:
            if column in texts:
                texts[column].append(cells[column].strip())
            cells[column] = "0"
        if not plain and sign == "," and any("," in cell for cell in cells):  # decimal commas within quotes
            sign = ";"
            found = [one.replace(",", ";") for one in found]
        found.append((sign or " ").join(cells))
    return texts, found, sign


def _key(heads: Heads, kinds: Sequence[Kind]) -> int:
    """Column of numbers that holds the times; -1 for none. A known unit of time comes first."""
    named = [
        index
        for index, name in enumerate(heads.names)
        if kinds[index] == "number" and _is_axis(name, heads.units[index], "time")
    ]
    known = [index for index in named if find_unit(heads.units[index]) is not None]
    return next(iter((*known, *named)), -1)


def _axis(
    path: Path, heads: Heads, kinds: Sequence[Kind], values: Vector, texts: dict[int, list[str]], numbers: Sequence[int]
) -> _Axis:
    """Times of a table: of a column with a unit of time, of a count since 1970, of dates and clocks; or frequencies."""
    clock = _clock_axis(path, heads, texts, numbers) if texts else None
    start = clock.start if clock is not None else ""
    key = _key(heads, kinds)
    if key >= 0:
        name, unit = heads.names[key], heads.units[key]
        known = find_unit(unit)
        if known is None or known.factor < 1.0:
            told = next((text for text, one in (("ms", 1e-3), ("us", 1e-6)) if known and known.factor == one), "")
            epoch = epoch_seconds(values[:, key], told or _EPOCH_UNITS.get(unit.lower(), ""))
        else:
            epoch = epoch_seconds(values[:, key], "s") if unit else None
        if epoch is not None:
            said = f"column {name!r} counts {epoch[2]} since 1970: the time begins at {epoch[1]}"
            return _Axis(epoch[0], (key,), "time", epoch[1], (said,))
        if known is not None:
            return _Axis(values[:, key] * known.factor, (key,), "time", start or _start_of(heads, kinds, values))
    if clock is not None:
        return clock
    if key >= 0:
        remark = f"the time, without a known unit: give --rate HZ, or --channel time={heads.names[key]} --unit time=s"
        return _Axis(None, (key,), "time", remark=remark)
    if kinds[0] == "number" and _is_axis(heads.names[0], heads.units[0], "frequency"):
        unit_of_first = find_unit(heads.units[0])
        if unit_of_first is not None:
            return _Axis(values[:, 0] * unit_of_first.factor, (0,), "frequency")
        remark = (
            f"the frequency, without a known unit: give --rate HZ, or --channel time={heads.names[0]} --unit time=s"
        )
        return _Axis(None, (0,), "frequency", remark=remark)
    return _Axis(None, (), "time")


def _start_of(heads: Heads, kinds: Sequence[Kind], values: Vector) -> str:
    """Date and time of the first row, of a column that counts the time since 1970; empty where there is none."""
    for column, name in enumerate(heads.names):
        unit = heads.units[column].lower()
        if kinds[column] == "number" and TIME_NAME.fullmatch(name) and (not unit or unit in _EPOCH_UNITS):
            epoch = epoch_seconds(values[:, column], _EPOCH_UNITS.get(unit, ""))
            if epoch is not None:
                return epoch[1]
    return ""


def _clock_axis(path: Path, heads: Heads, texts: dict[int, list[str]], numbers: Sequence[int]) -> _Axis | None:
    """Times of the column of clocks that rises, with the dates of another column; None where there are dates alone."""
    days = [column for column, cells in texts.items() if is_date(cells[0])]
    found: list[_Axis] = []
    for column, cells in texts.items():
        if column in days:
            continue
        day = next((one for one in days if not is_date(cells[0].split(" ")[0].split("T")[0])), None)
        try:
            seconds, start, notices = clock_seconds(cells, texts[day] if day is not None else None)
        except ValueError as error:
            row = int(error.args[0])
            raise DataError(
                f"{path}:{numbers[row]}:{column + 1}: column {heads.names[column]!r} holds {cells[row]!r}; needed is a "
                f"date or clock as {cells[0]!r}; repair or remove the row"
            ) from None
        columns = (column,) if day is None else (day, column)
        shown = " and ".join(repr(heads.names[one]) for one in columns)
        said = f"dates and clocks of column {shown}: the time begins at {start}"
        found.append(_Axis(seconds, columns, "time", start, (said, *notices)))
    rising = [one for one in found if one.values is not None and (np.diff(one.values) > 0.0).all()]
    return next(iter((*rising, *found)), None)


def _program(above: Sequence[str]) -> str:
    """First line of text that is no head of a column."""
    plain = [line.strip(' \t#;,"') for line in above if not line.strip('" ').lower().startswith("sep=")]
    return next((line for line in plain if line), "")[:80]


def _rates_above(above: Sequence[str]) -> list[str]:
    """Notice of a rate in the text above a table that has no times."""
    for line in above:
        if match := _RATE.search(line):
            said = match.group().strip()
            return [f"the text above the table says {said!r}: give --rate {match['rate']} if it is the rate"]
    return []


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
    pattern = TIME_NAME if kind == "time" else FREQUENCY_NAME
    known = find_unit(unit)
    return bool(pattern.fullmatch(name.strip())) and (known is None or known.quantity == kind)
