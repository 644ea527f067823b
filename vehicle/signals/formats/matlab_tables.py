"""Read tables and timetables of MAT files of version 7 and 7.3: columns with names, units and row times.

The library mat-io decodes the objects; the properties are read here, since its data frames round durations to
milliseconds. A duration has `millis` [ms], a datetime `data` = ms since 1970, with the rounding error of its real
part as its imaginary part. Row times of a constant rate are `origin` and `sampleRate` [Hz] or `stepSize`.

Sources: MathWorks, "Tables", "Timetables", "Dates and Time"; mat-io, `docs/field_contents.md`.
"""

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.mixed_sources import SAMPLED, check_alternation
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.typed_columns import TypedColumn, typed_channels

TABLES = ("table", "timetable")
"""Classes that are read."""


def table_channels(path: Path, tables: Mapping[str, str]) -> tuple[list[Channel], list[str], str]:
    """Return the channels of the tables of a file, notices, and the start of the first table with dates."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of pandas, about an option that mat-io sets
        matio = extra("matio", "matlab", "a table of MATLAB")
    name, class_name = next(iter(tables.items()))
    remedy = f"save it again, or export it in MATLAB, for example write{class_name}({name}, '{name}.csv')"
    channels: list[Channel] = []
    notices: list[str] = []
    starts = []
    with reading(path, "a MAT file with tables", remedy), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        objects = matio.load_from_mat(str(path), variable_names=list(tables), raw_data=True)
        for name in tables:
            columns, texts = _columns(path, name, objects[name])
            for column, cells in texts.items():
                check_alternation(path, column, cells)
            if texts:
                notices.append(f"columns without numbers are ignored: {', '.join(map(repr, texts))}")
            of_table, start = typed_channels(path, columns, notices, name, row_times=tables[name] == "timetable")
            channels += of_table
            starts.append(start)
    return channels, notices, next(filter(None, starts), "")


def _columns(path: Path, name: str, table: Any) -> tuple[list[TypedColumn], dict[str, list[str]]]:
    """Return the columns of a table with numbers, dates and durations, and the first texts of its other columns."""
    properties = table.properties
    timetable = table.classname == "timetable"
    record = properties["any"].ravel()[0] if timetable else properties
    settings = record if timetable else properties["props"].ravel()[0]
    rows = int(np.ravel(record["numRows" if timetable else "nrows"])[0])
    label = "varNames" if timetable else "varnames"
    original = "varNamesOrig" if timetable else "VariableNamesOriginal"
    longer = "varNames2048" if timetable else "VariableNames2048"
    heads = _texts(record[label])
    for flag, key in (
        ("use" + original[0].upper() + original[1:], original),
        ("use" + longer[0].upper() + longer[1:], longer),
    ):
        if flag in (settings.dtype.names or ()) and np.any(settings[flag]):
            heads = _texts(settings[key])
    units = _texts(settings["varUnits" if timetable else "VariableUnits"])
    columns: list[TypedColumn] = []
    texts: dict[str, list[str]] = {}
    if timetable:
        columns.append(_row_times(path, name, record["rowTimes"], rows))
    cells = np.ravel(record["data"])
    if len(heads) != len(cells):
        raise DataError(f"{path}: {name} has {len(heads)} names for {len(cells)} columns; the file is damaged")
    for number, (head, values) in enumerate(zip(heads, cells, strict=True)):
        unit = units[number] if number < len(units) else ""
        numbers = _numbers(values)
        if numbers is None:
            texts[head] = _first_texts(values, rows)
            continue
        table_of = numbers[0].reshape(-1, 1) if numbers[0].size == rows else numbers[0]
        if table_of.ndim != 2 or len(table_of) != rows:
            raise DataError(
                f"{path}: {name}.{head} is {' x '.join(map(str, table_of.shape))}, but the table {rows} rows: "
                "save columns"
            )
        width = table_of.shape[1]
        columns += [
            TypedColumn(head if width == 1 else f"{head}({n + 1})", table_of[:, n], numbers[1], unit)
            for n in range(width)
        ]
    return columns, texts


def _row_times(path: Path, name: str, times: Any, rows: int) -> TypedColumn:
    """Return the row times of a timetable: dates, durations, or a constant rate or step from an origin."""
    numbers = _numbers(times)
    if numbers is not None and numbers[0].size == rows:
        return TypedColumn("Time", numbers[0].ravel(), numbers[1])
    fields = getattr(times, "dtype", np.dtype(float)).names or ()
    if "origin" in fields:
        record = np.ravel(times)[0]
        origin = _numbers(record["origin"])
        step = _numbers(record["stepSize"])
        rated = bool(np.any(record["specifiedAsRate"]))
        seconds = 1.0 / float(np.ravel(record["sampleRate"])[0]) if rated else 0.0
        if not rated and step is not None and step[0].size == 1:
            seconds = float(step[0].ravel()[0]) * 1e-3
        if origin is not None and 0.0 < seconds < np.inf:
            begin = float(origin[0].ravel()[0]) * {"ms": 1e-3, "us": 1e-6}[origin[1]]
            begin = begin if origin[1] == "ms" else 0.0  # of a date
            return TypedColumn("Time", begin + seconds * np.arange(rows), "s")
    raise DataError(
        f"{path}: the row times of {name} are not readable (calendar durations?); convert them in MATLAB: "
        f"{name}.Properties.RowTimes = seconds({name}.Properties.RowTimes)"
    )


def _numbers(values: Any) -> tuple[Any, str] | None:
    """Return numbers, and the unit of a duration (ms) or date (us since 1970); None for texts and other objects."""
    properties = getattr(values, "properties", None)
    if properties is not None:
        if values.classname == "duration":
            return np.asarray(properties["millis"], dtype=np.float64), "ms"
        if values.classname == "datetime":
            data = np.asarray(properties["data"])
            missing = ~np.isfinite(data.real)
            counts = np.rint(np.where(missing, 0.0, data.real) * 1e3 + np.where(missing, 0.0, data.imag) * 1e3)
            return (np.where(missing, np.nan, counts) if missing.any() else counts.astype(np.int64)), "us"
        return None
    array = np.asarray(values)
    return (array.astype(np.float64), "") if array.dtype.kind in "fiub" else None


def _texts(cells: Any) -> list[str]:
    return ["".join(map(str, np.ravel(cell))) if np.size(cell) else "" for cell in np.ravel(cells)]


def _first_texts(values: Any, rows: int) -> list[str]:
    """Return the first cells of a column of texts: cells, or the strings and categories of MATLAB."""
    properties = getattr(values, "properties", None)
    if properties is None:
        array = np.ravel(values)
        return _texts(array[:SAMPLED]) if array.size == rows else []
    if values.classname == "categorical":
        return [str(code) for code in np.ravel(properties["codes"])[:SAMPLED]]
    if values.classname == "string":
        return _strings(np.ravel(properties["any"]))[:SAMPLED]
    return []


def _strings(codes: Any) -> list[str]:
    """Return a string array of MATLAB from its words of 64 bits: version, dimensions, sizes, lengths, then UTF-16."""
    dimensions = int(codes[1])
    sizes = [int(size) for size in codes[2 : 2 + dimensions]]
    count = int(np.prod(sizes))
    lengths = [int(length) for length in codes[2 + dimensions : 2 + dimensions + count]]
    text = codes[2 + dimensions + count :].astype("<u8").tobytes().decode("utf-16-le", "replace")
    ends = np.cumsum(lengths)
    return [text[end - length : end] for end, length in zip(ends.tolist(), lengths, strict=True)]
