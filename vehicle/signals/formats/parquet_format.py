"""Read Parquet files: numeric columns, with a column of dates or times as their axis."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.mixed_sources import SAMPLED, check_alternation
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.typed_columns import TypedColumn, typed_channels
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
    channels, start = typed_channels(path, [TypedColumn(*column) for column in columns], notices)
    if not channels or not rows:
        raise DataError(
            f"{path}: contains no column with numbers, only "
            f"{', '.join(map(repr, fields.names[:12])) or 'nothing'}; export numbers"
        )
    return Measurement(
        path=path, format="parquet", channels=tuple(channels), program=program[:80], start=start, notices=tuple(notices)
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
