"""Channels of a table whose columns have types: numbers, dates and durations, with units."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.clock_text import epoch_seconds
from vehicle.signals.formats.heads import TIME_NAME, split_head
from vehicle.signals.formats.own_times import is_time, own_times, rises, time_pairs, with_own_rasters
from vehicle.signals.formats.units import seconds_in

_INDEX = re.compile(r"(__)?index(_level_\d+__)?", re.IGNORECASE)
"""Name of the rows of a data frame without a name of its own."""


class TypedColumn(NamedTuple):
    """Column of a table.

    Attributes:
        head: name, with or without a unit.
        values: numbers, (n,), NaN if missing; whole numbers for counts since 1970.
        of_time: unit of a date or duration ("us"); empty for numbers.
        unit: unit of the column in addition to its name; empty if missing.
    """

    head: str
    values: Any
    of_time: str = ""
    unit: str = ""


def typed_channels(
    path: Path, columns: Sequence[TypedColumn], notices: list[str], table: str = "", *, row_times: bool = False
) -> tuple[list[Channel], str]:
    """Return the channels of a table with their times, and the start of dates; adds notices.

    Args:
        row_times: True if the first column has the times of all others (a timetable of MATLAB).
    """
    heads = [(column.head, column.unit) if column.unit else split_head(column.head) for column in columns]
    heads = [(name, column.of_time or unit) for column, (name, unit) in zip(columns, heads, strict=True)]
    units = [unit for _, unit in heads]
    timed = [_is_date(column) or is_time(*head) for column, head in zip(columns, heads, strict=True)]
    pairs = {} if row_times else time_pairs(["time" if each else "channel" for each in timed])
    times = (
        own_times(path, [name for name, _ in heads], units, pairs, [each.values for each in columns]) if pairs else {}
    )
    axis, key, start = (None, -1, "") if times else _axis(columns[: 1 if row_times else None], heads, notices)
    channels = [
        Channel(
            name=name,
            values=np.asarray(columns[index].values, dtype=np.float64),
            unit=unit,
            axis=times.get(index, axis),
            place=table,
        )
        for index, (name, unit) in enumerate(heads)
        if index != key and not (times and timed[index])
    ]
    return with_own_rasters(channels), start


def _is_date(column: TypedColumn) -> bool:
    """Return True for dates that rise: a time, unless they are the same in all rows or fall."""
    values = column.values[np.isfinite(column.values)]
    return bool(column.of_time) and epoch_seconds(values, column.of_time) is not None and rises(values)


def _axis(
    columns: Sequence[TypedColumn], heads: Sequence[tuple[str, str]], notices: list[str]
) -> tuple[Vector | None, int, str]:
    """Return times [s], index of their column, and start, from dates, or a column named time with a unit."""
    for index, column in enumerate(columns):
        epoch = epoch_seconds(column.values, column.of_time) if _is_date(column) else None
        if epoch is not None:
            notices.append(f"column {column.head!r} contains dates: the time begins at {epoch[1]}")
            return epoch[0], index, epoch[1]
    for index, (column, (name, unit)) in enumerate(zip(columns, heads, strict=False)):
        if (TIME_NAME.fullmatch(name) or (column.of_time and _INDEX.fullmatch(name))) and seconds_in(unit):
            return column.values * seconds_in(unit), index, ""
    for index, (column, (name, _)) in enumerate(zip(columns, heads, strict=False)):
        epoch = epoch_seconds(column.values, "") if TIME_NAME.fullmatch(name) else None
        if epoch is not None:
            notices.append(f"column {column.head!r} counts {epoch[2]} since 1970: the time begins at {epoch[1]}")
            return epoch[0], index, epoch[1]
    return None, -1, ""
