"""Read pandas frames in HDF5 files (`DataFrame.to_hdf`) without pandas: names, index and blocks of columns.

A fixed frame stores the names of all columns in `axis0`, its index in `axis1`, and for each block of columns of one
type the names in `blockN_items` and the numbers in `blockN_values`, (rows, columns). Frames in table format store
column names as pickled objects, which are not loaded for security.

Source: pandas, `pandas/io/pytables.py`.
"""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.heads import split_head
from vehicle.signals.formats.mixed_sources import rows_at_once
from vehicle.signals.formats.own_times import with_own_rasters
from vehicle.signals.formats.packed_values import attribute_text
from vehicle.signals.formats.typed_columns import TypedColumn, typed_channels

NANOSECONDS = 1e-9
"""Length of a nanosecond [s]."""


def frame_channels(path: Path, name: str, group: Any, notices: list[str]) -> tuple[list[Channel], str]:
    """Return the columns of a pandas frame or series as channels, and its start time; adds notices."""
    frame_type = _text(group.attrs.get("pandas_type"))
    if frame_type not in ("frame", "series"):
        convert = f"import pandas; pandas.read_hdf({path.name!r}, {name!r}).to_csv({name.replace('/', '_') + '.csv'!r})"
        raise DataError(
            f"{path}: {name!r} is a pandas {frame_type} in table format, whose column names are not readable "
            f'without pandas; convert the file to CSV with the command python -c "{convert}"'
        )
    index = group["axis1" if frame_type == "frame" else "index"]
    columns: dict[str, Vector] = {}
    unreadable: list[str] = []
    if frame_type == "series":
        title = _text(group.attrs.get("name")) or name
        columns[title] = _numbers(group["values"])
    else:
        for number in range(int(np.ravel(group.attrs.get("nblocks", 0))[0])):
            block = group[f"block{number}_values"]
            if block.dtype.kind not in "fiub":
                unreadable += [_text(item_name) for item_name in group[f"block{number}_items"][()]]
                continue
            values = np.asarray(block[()])
            values = values if block.attrs.get("transposed", True) else values.T
            items = [_text(item_name) for item_name in group[f"block{number}_items"][()]]
            if values.ndim != 2 or values.shape != (index.shape[0], len(items)):
                raise DataError(f"{path}: {name!r}: block {number} contradicts its names; the file is damaged")
            columns |= {item: values[:, n].astype(np.float64) for n, item in enumerate(items)}
        order = [_text(item_name) for item_name in group["axis0"][()]]
        columns = {item: columns[item] for item in order if item in columns}
    axis, start, index_values = _index(index)
    if axis is None:
        typed = [TypedColumn(column, values) for column, values in columns.items()]
        channels, start = typed_channels(path, typed, notices, name)
        axis = channels[0].axis if channels else None
    else:
        heads = [split_head(column) for column in columns]
        channels = with_own_rasters(
            [
                Channel(name=text, values=values, unit=unit, axis=axis, place=name)
                for (text, unit), values in zip(heads, columns.values(), strict=True)
            ]
        )
    if axis is not None and unreadable and (rows := rows_at_once(axis)) > 1:
        raise DataError(
            f"{path}: {name!r} has {rows} rows for each time, and the column {unreadable[0]!r} is not readable without "
            "pandas: probably the names of sensors; write one column per sensor"
        )
    if index_values is not None and (axis is None or axis.size == index_values.size):
        title = _text(index.attrs.get("name")) or "index"
        channels.insert(0, Channel(name=title, values=index_values, axis=axis, place=name))
    return channels, start


def _index(index: Any) -> tuple[Vector | None, str, Vector | None]:
    """Return times and start of an index of dates, or the values of another index; None for a plain row index."""
    if index.dtype.kind not in "iuf" or not index.size:
        return None, "", None
    values = np.asarray(index[()])
    index_type = _text(index.attrs.get("kind"))
    if index_type.startswith(("datetime64", "timedelta64")):
        scale = {"[s]": 1.0, "[ms]": 1e-3, "[us]": 1e-6}.get(
            index_type[index_type.find("[") :] if "[" in index_type else "", NANOSECONDS
        )
        seconds = (values - values[0]).astype(np.float64) * scale
        first = float(values[0]) * scale
        start = datetime.fromtimestamp(first, tz=UTC).isoformat(timespec="milliseconds") if index_type[0] == "d" else ""
        return seconds, start, None
    return None, "", None if np.array_equal(values, np.arange(values.size)) else values.astype(np.float64)


def _numbers(block: Any) -> Vector:
    values = np.asarray(block[()])
    return values.astype(np.float64).ravel() if values.dtype.kind in "fiub" else np.full(values.shape[0], np.nan)


def _text(value: Any) -> str:
    """Return an attribute or a name as text; empty for a pickled object or None."""
    pickled = isinstance(value, bytes) and value[:1] in (b"\x80", b"N", b"(") and value[-1:] == b"."
    return "" if pickled else attribute_text(value)
