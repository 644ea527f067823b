"""Frames of pandas in HDF5 files (`DataFrame.to_hdf`), without pandas: names, index and blocks of columns.

A fixed frame keeps the names of all columns in `axis0`, its index in `axis1`, and for each block of columns of one
type the names in `blockN_items` and the numbers in `blockN_values`, (rows, columns). A frame that was stored as a
table keeps the names of its columns as pickled objects, which are not loaded from files.

Source: pandas, `pandas/io/pytables.py`.
"""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel
from vehicle.signals.records.heads import TIME_NAME, split_head
from vehicle.signals.records.table import Vector
from vehicle.signals.records.units import find_unit

NANOSECONDS = 1e-9


def frame_channels(path: Path, name: str, group: Any) -> tuple[list[Channel], str]:
    """Return the columns of a frame or a series, and its start.

    Args:
        path: the file, for messages.
        name: of the group.
        group: of an HDF5 file, with the attribute `pandas_type`.

    Raises:
        DataError: a form that is not read; the message tells the line that converts it.
    """
    kind = _text(group.attrs.get("pandas_type"))
    if kind not in ("frame", "series"):
        convert = f"import pandas; pandas.read_hdf({path.name!r}, {name!r}).to_csv({name.replace('/', '_') + '.csv'!r})"
        raise DataError(
            f"{path}: {name!r} is a {kind} of pandas, stored as a table, whose names of columns are not readable "
            f'without pandas; convert it: python -c "{convert}"'
        )
    index = group["axis1" if kind == "frame" else "index"]
    columns: dict[str, Vector] = {}
    if kind == "series":
        title = _text(group.attrs.get("name")) or name
        columns[title] = _numbers(group["values"])
    else:
        for number in range(int(group.attrs.get("nblocks", 0))):
            block = group[f"block{number}_values"]
            if block.dtype.kind not in "fiub":
                continue
            values = np.asarray(block[()])
            if not group[f"block{number}_values"].attrs.get("transposed", True):
                values = values.T
            items = [_text(one) for one in group[f"block{number}_items"][()]]
            if values.ndim != 2 or values.shape != (index.shape[0], len(items)):
                raise DataError(f"{path}: {name!r}: block {number} has another shape than its names; it was damaged")
            columns |= {item: values[:, n].astype(np.float64) for n, item in enumerate(items)}
        order = [_text(one) for one in group["axis0"][()]]
        columns = {item: columns[item] for item in order if item in columns}
    axis, start, own = _index(index)
    heads = {column: split_head(column) for column in columns}
    if axis is None:
        key = next((c for c, (text, unit) in heads.items() if TIME_NAME.fullmatch(text) and _is_time(unit)), None)
        known = find_unit(heads[key][1]) if key is not None else None
        if key is not None and known is not None:
            axis = columns.pop(key) * known.factor
    found = [
        Channel(name=heads[column][0], values=values, unit=heads[column][1], axis=axis, place=name)
        for column, values in columns.items()
    ]
    if own is not None:
        found.insert(0, Channel(name=_text(index.attrs.get("name")) or "index", values=own, axis=axis, place=name))
    return found, start


def _index(index: Any) -> tuple[Vector | None, str, Vector | None]:
    """Times of an index of dates, their start, or the index as a channel where it counts something else than rows."""
    if index.dtype.kind not in "iuf" or not index.size:
        return None, "", None
    values = np.asarray(index[()])
    kind = _text(index.attrs.get("kind"))
    if kind.startswith(("datetime64", "timedelta64")):
        scale = {"[s]": 1.0, "[ms]": 1e-3, "[us]": 1e-6}.get(kind[kind.find("[") :] if "[" in kind else "", NANOSECONDS)
        seconds = (values - values[0]).astype(np.float64) * scale
        first = float(values[0]) * scale
        start = datetime.fromtimestamp(first, tz=UTC).isoformat(timespec="milliseconds") if kind[0] == "d" else ""
        return seconds, start, None
    if np.array_equal(values, np.arange(values.size)):
        return None, "", None
    return None, "", values.astype(np.float64)


def _numbers(block: Any) -> Vector:
    values = np.asarray(block[()])
    return values.astype(np.float64).ravel() if values.dtype.kind in "fiub" else np.full(values.shape[0], np.nan)


def _is_time(unit: str) -> bool:
    known = find_unit(unit)
    return known is not None and known.quantity == "time"


def _text(value: Any) -> str:
    """Text of an attribute or a name; a number as text; empty for a pickled object or None."""
    if value is None:
        return ""
    if isinstance(value, bytes):
        return "" if value[:1] in (b"\x80", b"N", b"(") and value[-1:] == b"." else value.decode("utf-8", "replace")
    return str(value)
