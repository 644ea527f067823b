"""Read and write MAT files up to version 7: one structure per channel, as exported by Testlab, or plain arrays."""

import struct
import warnings
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError, MissingPartError
from vehicle.signals.formats.channel import Channel, Measurement, check_length, clock_step, even_step, uniform_axis
from vehicle.signals.formats.matlab_elements import COMPRESSED, MATRIX, check_matrix, object_name
from vehicle.signals.formats.matlab_structures import columns_of, is_structure, structure_channels, word
from vehicle.signals.formats.matlab_tables import TABLES, table_channels
from vehicle.signals.formats.optional_library import reading
from vehicle.signals.formats.units import find_ratio, find_unit
from vehicle.signals.formats.unpacked_size import require_unpacked

HEADER = b"MATLAB 5.0 MAT-file, vehicle-on-shaker".ljust(116)
"""Text of the first 116 bytes, without the time and the system that SciPy writes: equal results are equal bytes."""


def read(path: Path) -> Measurement:
    """Read structures of x_values and y_values, numeric vectors and columns of matrices; errors: see `read_record`."""
    from scipy.io import loadmat

    objects = _check_elements(path)
    with reading(path, "a MAT file", "save it again as version 7"), warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        variables = loadmat(path, squeeze_me=False, struct_as_record=True)
    texts = [str(warning.message).split("\n")[0] for warning in caught]
    warned = [text for text in texts if 'variable name "None"' not in text]  # of objects, which have no name
    program = variables.get("__header__", b"")
    channels, notices, start = with_tables(variables, path, objects)
    return Measurement(
        path=path,
        format="mat",
        channels=channels,
        start=start,
        program=(program.decode("latin-1") if isinstance(program, bytes) else str(program)).strip()[:80],
        notices=(*warned, *notices),
    )


def with_tables(
    variables: Mapping[str, Any], path: Path, objects: Mapping[str, str]
) -> tuple[tuple[Channel, ...], list[str], str]:
    """Return the channels of MATLAB variables and of tables and timetables, notices, and the start of dates."""
    tables = {name: class_name for name, class_name in objects.items() if class_name in TABLES}
    others = {name: class_name for name, class_name in objects.items() if name not in tables}
    if not tables:
        return (*channels_of(variables, path, objects), "")
    arrays = {name: value for name, value in variables.items() if name not in tables}
    try:
        channels, notices = channels_of(arrays, path, others)
    except DataError:  # tables alone
        channels, notices = (), []
    try:
        of_tables, said, start = table_channels(path, tables)
    except (MissingPartError, DataError) as error:
        if not channels:
            raise
        return channels, [*notices, f"ignored: {', '.join(tables)}: {error}"], ""
    return (*of_tables, *channels), [*said, *notices], start


def channels_of(
    variables: Mapping[str, Any], path: Path, objects: Mapping[str, str]
) -> tuple[tuple[Channel, ...], list[str]]:
    """Return the channels among MATLAB variables, and notices; for MAT files of all versions.

    Args:
        variables: name to array; structures are record arrays.
        objects: name to class of variables that are objects (tables, timetables, dates), which are not read.
    """
    channels: list[Channel] = []
    scalars: list[str] = []
    left_out: list[str] = []
    objects = dict(objects)
    for name, value in variables.items():
        if name.startswith("__") or _is_object(value):
            continue
        for label, record in _records(name, value):
            if "x_values" in record and "y_values" in record:
                channels += _signal(path, label, record)
                continue
            if is_structure(record):
                channels += structure_channels(label, record)
                continue
            objects |= {
                f"{label}.{field}": "object" for field, inner_value in record.items() if _is_object(inner_value)
            }
            inner = {f"{label}.{field}": np.asarray(inner_value) for field, inner_value in record.items()}
            for text, inner_value in inner.items():
                if inner_value.dtype.kind in "fiuc" and inner_value.ndim > 2 and inner_value.size > 1:
                    left_out.append(f"{text} ({' x '.join(map(str, inner_value.shape))})")
                elif inner_value.dtype.kind in "fiuc" and inner_value.size > 1:
                    channels += [_plain(*column) for column in columns_of(text, inner_value)]
        array = np.asarray(value)
        if array.dtype.kind not in "fiuc" or array.size == 0:
            continue
        if array.ndim > 2:
            left_out.append(f"{name} ({' x '.join(map(str, array.shape))})")
        elif array.size == 1:
            scalars.append(f"{name} = {array.ravel()[0]:g}")
        else:
            channels += [_plain(*column) for column in columns_of(name, array)]
    remedy = _remedy(objects)
    if not channels and objects:
        raise DataError(f"{path}: no numeric array; {remedy}")
    if not channels:
        names = ", ".join(name for name in list(variables)[:12] if not name.startswith("__")) or "nothing"
        raise DataError(f"{path}: has {names}; it needs a structure with x_values and y_values or a numeric array")
    notices = [f"single numbers: {', '.join(scalars[:12])}"] if scalars else []
    if objects:
        notices.append(f"ignored: {remedy}")
    if left_out:
        notices.append(
            f"arrays with more than two dimensions are ignored: {', '.join(left_out[:8])}; save their columns as "
            "vectors"
        )
    if any(inner_value.axis is None for inner_value in channels):
        notices.append("the arrays have no times; set --rate HZ, or --channel time=NAME --unit time=s")
    return tuple(channels), notices


def _is_object(value: Any) -> bool:
    """Return True for an object as read by SciPy: pointers into an unread part of the file."""
    names = np.asarray(value).dtype.names
    return names is not None and "s2" in names and "arr" in names


def _remedy(objects: Mapping[str, str]) -> str:
    """List the objects of a file, with the MATLAB command that converts the first table or else the first object."""
    if not objects:
        return ""
    shown = ", ".join(f"{name} ({class_name})" for name, class_name in list(objects.items())[:8])
    name, class_name = next(
        ((n, c) for n, c in objects.items() if c in ("table", "timetable")), next(iter(objects.items()))
    )
    line = {"table": f"writetable({name}, '{name}.csv')", "timetable": f"writetimetable({name}, '{name}.csv')"}.get(
        class_name, f"x = double({name})" if class_name != "datetime" else f"x = posixtime({name})"
    )
    return f"{shown} are MATLAB objects, which only MATLAB can read; convert them there, for example {line}"


def _plain(name: str, values: Any) -> Channel:
    value_type = complex if np.iscomplexobj(values) else np.float64
    return Channel(name=name, values=np.array(values, dtype=value_type).ravel())


def _records(name: str, value: Any, depth: int = 0) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield label and fields of each structure of a variable, including nested structures."""
    array = np.asarray(value)
    if depth > 4 or array.dtype.names is None or _is_object(array):
        return
    flat = array.ravel()
    for index, element in enumerate(flat):
        label = name if flat.size == 1 else f"{name}({index + 1})"
        record = {field: element[field] for field in array.dtype.names}
        yield label, record
        if "x_values" not in record and not is_structure(record):
            for field, inner in record.items():
                yield from _records(f"{label}.{field}", inner, depth + 1)


def _field(value: Any, *names: str) -> Any:
    """Return a nested field of single structures; None if missing."""
    for name in names:
        array = np.asarray(value)
        if array.dtype.names is None or name not in array.dtype.names or array.size != 1:
            return None
        value = array.ravel()[0][name]
    return value


def _number(value: Any) -> float | None:
    array = np.asarray(value) if value is not None else np.array([])
    return float(array.ravel()[0]) if array.size == 1 and array.dtype.kind in "fiu" else None


def _signal(path: Path, label: str, record: Mapping[str, Any]) -> list[Channel]:
    """Return the channels of a Testlab structure: x_values.increment and start_value, y_values.values, quantities.

    A structure with a factor stores SI values; value in the unit of its label = SI value * factor. Without a factor the
    values are in the unit of the label.
    """
    x, y = record["x_values"], record["y_values"]
    values = np.asarray(_field(y, "values"))
    if values.dtype.kind not in "fiuc" or values.ndim > 2 or values.size < 2:
        return []
    columns = values.reshape(-1, 1) if values.ndim < 2 or 1 in values.shape else values
    if columns.shape[0] < columns.shape[1]:
        columns = columns.T
    step, start = _number(_field(x, "increment")), _number(_field(x, "start_value")) or 0.0
    axis_values, stated_count = _field(x, "values"), _number(_field(x, "number_of_values"))
    if stated_count is not None and int(stated_count) != columns.shape[0]:
        raise DataError(
            f"{path}: {label}: contains {columns.shape[0]} values, but states {stated_count:g}; the file is "
            "damaged; save it again"
        )
    axis_unit = find_unit(word(_field(x, "quantity", "label")))
    axis_quantity = axis_unit.quantity if axis_unit is not None else ""
    axis: Vector | None = None
    remark = ""
    if axis_quantity in ("time", "frequency") and axis_unit is not None:
        if axis_values is not None and np.asarray(axis_values).size == columns.shape[0]:
            axis = np.asarray(axis_values, dtype=np.float64).ravel() * axis_unit.factor
        elif step is not None and step > 0.0:
            length = step * axis_unit.factor
            length, remark = clock_step(length) if axis_quantity == "time" else (length, "")
            axis = uniform_axis(columns.shape[0], length, start * axis_unit.factor)
    unit = word(_field(y, "quantity", "label"))
    factor, unit_entry = _number(_field(y, "quantity", "unit_transformation", "factor")), find_ratio(unit)
    if factor is not None and unit_entry is not None:
        if abs(factor * unit_entry.factor - 1.0) > 0.01:
            note = f"unit {unit!r} and its stated factor to SI, {factor:g}, contradict each other"
            unit = ""
        elif unit_entry.factor != 1.0:
            note = f"read in SI units; the file displays {unit!r} ({factor:g} {unit} = 1 {unit_entry.si})"
            unit = unit_entry.si
        else:
            note = ""
        remark = "; ".join(text for text in (remark, note) if text)
    about = {key: word(_field(record.get("function_record"), key))
             for key in ("name", "title", "type", "point", "direction", "reference")}  # fmt: skip
    name = about["name"] or about["title"] or label
    return [
        replace(
            _plain(name if columns.shape[1] == 1 else f"{name}({n + 1})", columns[:, n]),
            unit=unit,
            axis=axis,
            kind="frequency" if axis_quantity == "frequency" else "time",
            function=about["type"] or ("time history" if axis_quantity == "time" else "spectrum"),
            place=about["point"],
            direction=about["direction"],
            reference=about["reference"],
            remark=remark,
        )
        for n in range(columns.shape[1])
    ]


def _check_elements(path: Path) -> dict[str, str]:
    """Check the elements of a version 5 file; return name and class of its objects."""
    size, unpacked = path.stat().st_size, 0
    objects: dict[str, str] = {}
    with path.open("rb") as file:
        head = file.read(128)
        if head[126:128] not in (b"IM", b"MI"):
            return {}  # version 4: its reader checks each matrix
        order = "<" if head[126:128] == b"IM" else ">"
        position = 128
        while position + 8 <= size:
            file.seek(position)
            data_type, count = struct.unpack(f"{order}II", file.read(8))
            if data_type >> 16:
                raise DataError(f"{path}: no data element at byte {position}; the file is damaged; save it again")
            check_length(path, count, size - position - 8, f"element at byte {position}")
            if data_type not in (MATRIX, COMPRESSED):
                raise DataError(f"{path}: expected a matrix at byte {position}; the file is damaged; save it again")
            body = file.read(count)
            if data_type == COMPRESSED:
                try:
                    # The tag of the element inside has its size.
                    stream = zlib.decompressobj()
                    inside = struct.unpack(f"{order}II", stream.decompress(body, 8))[1]
                    unpacked += inside
                    require_unpacked(path, unpacked, size)
                    body = stream.decompress(stream.unconsumed_tail, inside + 1)
                    if len(body) != inside or not stream.eof:
                        raise zlib.error("the compressed data are truncated, or have another size than stated")
                except (zlib.error, struct.error) as error:
                    raise DataError(f"{path}: element at byte {position}: {error}; save the file again") from None
            check_matrix(path, body, order, f"element at byte {position}")
            if named_object := object_name(path, body, order):
                objects[named_object[0]] = named_object[1]
            position += 8 + count if data_type == COMPRESSED else 8 + count + -count % 8
        if position != size and size - position > 7:
            raise DataError(f"{path}: the file ends within an element; it is truncated: save it again")
    return objects


def write(path: Path, channels: tuple[Channel, ...], description: str) -> None:
    """Write one structure per channel, in the layout of Testlab."""
    from scipy.io import savemat

    savemat(
        path,
        structures(channels) | {"about": description},
        do_compression=True,
        oned_as="column",
        long_field_names=True,
    )
    with path.open("r+b") as file:
        file.write(HEADER)


def structures(channels: tuple[Channel, ...]) -> dict[str, Any]:
    """Return the variables of a MAT file: name to structure of a channel."""
    records: dict[str, Any] = {}
    for number, channel in enumerate(channels, 1):
        letters = "".join(sign if sign.isascii() and sign.isalnum() else "_" for sign in channel.name)[:50]
        name = letters if letters and letters[0].isalpha() else f"channel_{letters}"
        step = even_step(channel.axis) if channel.axis is not None else 0.0
        quantity = "s" if channel.kind == "time" else "Hz"
        records[name if name not in records else f"{name}_{number}"] = {
            "x_values": {
                "start_value": float(channel.axis[0]) if channel.axis is not None else 0.0,
                "increment": 0.0 if step is None else step,
                "number_of_values": float(channel.values.size),
                "quantity": {"label": quantity},
                **({"values": channel.axis} if step is None else {}),
            },
            "y_values": {"values": channel.values, "quantity": {"label": channel.unit}},
            "function_record": {
                "name": channel.name,
                "type": channel.function,
                "point": channel.place,
                "direction": channel.direction,
                "reference": channel.reference,
            },
        }
    return records
