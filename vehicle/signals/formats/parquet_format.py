"""Read Parquet files: numeric columns, with a column of dates or times as their axis."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.clock_text import epoch_seconds
from vehicle.signals.formats.heads import TIME_NAME, split_head
from vehicle.signals.formats.mixed_sources import SAMPLED, check_alternation
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.own_times import is_time, own_times, time_pairs
from vehicle.signals.formats.units import seconds_in
from vehicle.signals.formats.unpacked_size import require_unpacked


def read(path: Path) -> Measurement:
    """Read all numeric columns of a flat table; errors: see `read_record`, also for an encrypted or too large file."""
    extra("pyarrow", "parquet", "a Parquet file")
    parquet, arrow = import_module("pyarrow.parquet"), import_module("pyarrow.types")
    types = (
        arrow.is_integer,
        arrow.is_floating,
        arrow.is_decimal,
        arrow.is_duration,
        arrow.is_time,
        arrow.is_timestamp,
    )
    notices: list[str] = []
    with reading(path, "Parquet", "export it again, or as CSV"):
        with parquet.ParquetFile(path, page_checksum_verification=True) as file:
            rows, fields = file.metadata.num_rows, file.schema_arrow
            wanted = [n for n, field in enumerate(fields) if any(is_type(field.type) for is_type in types)]
            needed = 2 * 8 * rows * len(wanted)
            require_unpacked(path, needed, path.stat().st_size)
            skipped = [field.name for n, field in enumerate(fields) if n not in wanted]
            table = file.read(columns=[fields[n].name for n in wanted])
            named = [each.name for each in fields if arrow.is_dictionary(each.type) or "string" in str(each.type)]
            first = next(file.iter_batches(SAMPLED, columns=named), None) if named else None
            texts = {} if first is None else first.to_pydict()
            program = str(file.metadata.created_by or "")
        columns = [(name, *_column(table.column(n))) for n, name in enumerate(table.column_names)]
    for name, cells in texts.items():
        check_alternation(path, name, ["" if cell is None else str(cell) for cell in cells])
    if skipped:
        notices.append(f"columns without numbers are ignored: {', '.join(map(repr, skipped[:12]))}")
    heads = [split_head(name) for name, *_ in columns]
    names, units = [name for name, _ in heads], [of or unit for (_, unit), (*_, of) in zip(heads, columns, strict=True)]
    timed = [bool(of) or is_time(*head) for head, (*_, of) in zip(heads, columns, strict=True)]
    pairs = time_pairs(["time" if time else "channel" for time in timed])
    own = own_times(path, names, units, pairs, [values for _, values, _ in columns]) if pairs else {}
    axis, key, start = _axis(columns, notices) if not own else (None, -1, "")
    channels = [
        Channel(name=text, values=np.asarray(columns[index][1], dtype=np.float64), unit=unit, axis=own.get(index, axis))
        for index, (text, unit) in enumerate(heads)
        if index != key and not (own and timed[index])
    ]
    if not channels or not rows:
        raise DataError(
            f"{path}: contains no column with numbers, only "
            f"{', '.join(map(repr, fields.names[:12])) or 'nothing'}; export numbers"
        )
    return Measurement(
        path=path,
        format="parquet",
        channels=tuple(channels),
        program=program[:80],
        start=start,
        notices=tuple(notices),
    )


def _column(column: Any) -> tuple[Any, str]:
    """Return the numbers of a column, NaN if missing, and the unit of a date or duration; keep integer counts."""
    unit = getattr(column.type, "unit", "")
    if unit:
        column = column.cast("int32" if column.type.bit_width == 32 else "int64").cast("int64")
    elif not (column.type.bit_width or 0) or str(column.type).startswith("decimal"):
        column = column.cast("float64")
    values = np.asarray(column.to_numpy())
    return values if unit and values.dtype.kind == "i" else values.astype(np.float64), unit


def _axis(columns: list[tuple[str, Any, str]], notices: list[str]) -> tuple[Vector | None, int, str]:
    """Return times [s], index of their column, and start, from dates, durations, or a column named time with a unit."""
    for index, (name, values, unit) in enumerate(columns):
        epoch = epoch_seconds(values, unit) if unit else None
        if epoch is not None:
            notices.append(f"column {name!r} contains dates: the time begins at {epoch[1]}")
            return epoch[0], index, epoch[1]
    for index, (name, values, unit) in enumerate(columns):
        text, unit_in_name = split_head(name)
        factor = seconds_in(unit or unit_in_name)
        if (unit or TIME_NAME.fullmatch(text)) and factor:
            return values * factor, index, ""
    for index, (name, values, _) in enumerate(columns):
        epoch = epoch_seconds(values, "") if TIME_NAME.fullmatch(split_head(name)[0]) else None
        if epoch is not None:
            notices.append(f"column {name!r} counts {epoch[2]} since 1970: the time begins at {epoch[1]}")
            return epoch[0], index, epoch[1]
    return None, -1, ""
