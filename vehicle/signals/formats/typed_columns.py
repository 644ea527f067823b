"""Channels of a table whose columns have types: numbers, dates and durations, with units."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.clock_text import epoch_seconds
from vehicle.signals.formats.heads import TIME_NAME, split_head
from vehicle.signals.formats.own_times import is_time, own_times, time_pairs, with_own_rasters
from vehicle.signals.formats.units import seconds_in


class TypedColumn(NamedTuple):
    """Column of a table.

    Attributes:
        head: name, with or without a unit.
        values: numbers, (n,), NaN if missing; whole numbers for counts since 1970.
        of_time: unit of a date or duration, as "us"; empty for numbers.
        unit: unit of the column in addition to its name; empty if missing.
    """

    head: str
    values: Any
    of_time: str = ""
    unit: str = ""


def typed_channels(
    path: Path, columns: Sequence[TypedColumn], notices: list[str], table: str = ""
) -> tuple[list[Channel], str]:
    """Return the channels of a table with their times, and the start of dates; adds notices.

    Raises:
        DataError: see `own_times`.
    """
    heads = [(column.head, column.unit) if column.unit else split_head(column.head) for column in columns]
    timed = [bool(column.of_time) or is_time(*head) for column, head in zip(columns, heads, strict=True)]
    pairs = time_pairs(["time" if each else "channel" for each in timed])
    units = [column.of_time or unit for column, (_, unit) in zip(columns, heads, strict=True)]
    times = (
        own_times(path, [name for name, _ in heads], units, pairs, [each.values for each in columns]) if pairs else {}
    )
    axis, key, start = (None, -1, "") if times else _axis(columns, heads, notices)
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


def _axis(
    columns: Sequence[TypedColumn], heads: Sequence[tuple[str, str]], notices: list[str]
) -> tuple[Vector | None, int, str]:
    """Return times [s], index of their column, and start, from dates, durations, or a column named time with a unit."""
    for index, column in enumerate(columns):
        epoch = epoch_seconds(column.values, column.of_time) if column.of_time else None
        if epoch is not None:
            notices.append(f"column {column.head!r} contains dates: the time begins at {epoch[1]}")
            return epoch[0], index, epoch[1]
    for index, (column, (name, unit)) in enumerate(zip(columns, heads, strict=True)):
        factor = seconds_in(column.of_time or unit)
        if (column.of_time or TIME_NAME.fullmatch(name)) and factor:
            return column.values * factor, index, ""
    for index, (column, (name, _)) in enumerate(zip(columns, heads, strict=True)):
        epoch = epoch_seconds(column.values, "") if TIME_NAME.fullmatch(name) else None
        if epoch is not None:
            notices.append(f"column {column.head!r} counts {epoch[2]} since 1970: the time begins at {epoch[1]}")
            return epoch[0], index, epoch[1]
    return None, -1, ""
