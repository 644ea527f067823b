"""MAT files up to version 7: one structure a channel, as Testlab exports, or plain arrays."""

from __future__ import annotations

import struct
import warnings
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, check_length, clock_step, even_step, uniform_axis
from vehicle.signals.records.matlab_elements import COMPRESSED, MATRIX, check_matrix, object_name
from vehicle.signals.records.reader import digest
from vehicle.signals.records.table import Vector
from vehicle.signals.records.units import find_ratio, find_unit


def read(path: Path) -> Measurement:
    """Read structures with x_values and y_values, and vectors and columns of numbers.

    Raises:
        DataError: damaged, cut off, or without numbers.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    objects = _check_elements(path)
    told: list[str] = []
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            held = loadmat(path, squeeze_me=False, struct_as_record=True)
        told = [str(one.message).split("\n")[0] for one in caught]
        told = [text for text in told if 'variable name "None"' not in text]  # objects, which have no name there
    except (
        ValueError, TypeError, KeyError, IndexError, EOFError, OSError, OverflowError, MemoryError, AttributeError,
        NotImplementedError, UnicodeDecodeError, struct.error, zlib.error, MatReadError,
    ) as error:  # fmt: skip
        raise DataError(f"{path}: no MAT file that can be read ({error}); save it again, as version 7") from None
    program = held.get("__header__", b"")
    found, notices = channels_of(held, path, objects)
    return Measurement(
        path=path,
        format="mat",
        channels=found,
        sha256=digest(path),
        program=(program.decode("latin-1") if isinstance(program, bytes) else str(program)).strip()[:80],
        notices=(*told, *notices),
    )


def channels_of(
    held: Mapping[str, Any], path: Path, objects: Mapping[str, str]
) -> tuple[tuple[Channel, ...], list[str]]:
    """Channels among variables, and notices; MAT files of all versions hold the same.

    Args:
        held: name to array; a structure is an array of records.
        path: for messages.
        objects: name to class of the variables that are objects: tables, timetables, dates; they are not read.

    Raises:
        DataError: there are none.
    """
    found: list[Channel] = []
    scalars: list[str] = []
    objects = dict(objects)
    for name, value in held.items():
        if name.startswith("__") or _is_object(value):
            continue
        for label, record in _records(name, value):
            if "x_values" in record and "y_values" in record:
                found += _signal(path, label, record)
                continue
            objects |= {f"{label}.{field}": "object" for field, one in record.items() if _is_object(one)}
            inner = {f"{label}.{field}": np.asarray(one) for field, one in record.items()}
            found += [_plain(text, one) for text, one in inner.items() if _is_vector(one)]
        array = np.asarray(value)
        if array.dtype.kind not in "fiuc" or array.ndim > 2 or array.size == 0:
            continue
        if array.size == 1:
            scalars.append(f"{name} = {array.ravel()[0]:g}")
            continue
        if array.ndim < 2 or 1 in array.shape:
            found.append(_plain(name, array.ravel()))
            continue
        columns = array if array.shape[0] >= array.shape[1] else array.T
        found += [_plain(f"{name}(:,{n + 1})", columns[:, n]) for n in range(columns.shape[1])]
    remedy = _remedy(objects)
    if not found and objects:
        raise DataError(f"{path}: no array of numbers; {remedy}")
    if not found:
        names = ", ".join(name for name in list(held)[:12] if not name.startswith("__")) or "nothing"
        raise DataError(f"{path}: no structure with x_values and y_values and no array of numbers; it holds {names}")
    notices = [f"single numbers: {', '.join(scalars[:12])}"] if scalars else []
    if objects:
        notices.append(f"left out: {remedy}")
    if any(one.axis is None for one in found):
        notices.append("arrays without times: give --rate HZ, or --channel time=NAME --unit time=s")
    return tuple(found), notices


def _is_object(value: Any) -> bool:
    """True for an object as scipy gives it: pointers into a part of the file that is not read."""
    names = np.asarray(value).dtype.names
    return names is not None and "s2" in names and "arr" in names


def _remedy(objects: Mapping[str, str]) -> str:
    """What the objects of a file are, and the line of MATLAB that converts the first table or the first of all."""
    if not objects:
        return ""
    shown = ", ".join(f"{name} ({kind})" for name, kind in list(objects.items())[:8])
    name, kind = next(((n, k) for n, k in objects.items() if k in ("table", "timetable")), next(iter(objects.items())))
    line = {"table": f"writetable({name}, '{name}.csv')", "timetable": f"writetimetable({name}, '{name}.csv')"}.get(
        kind, f"x = double({name})" if kind != "datetime" else f"x = posixtime({name})"
    )
    return f"{shown} are objects of MATLAB, which only MATLAB reads; convert them there, as {line}"


def _is_vector(array: Any) -> bool:
    return array.dtype.kind in "fiuc" and array.size > 1 and array.size == max(array.shape)


def _plain(name: str, values: Any) -> Channel:
    kind = complex if np.iscomplexobj(values) else np.float64
    return Channel(name=name, values=np.array(values, dtype=kind).ravel())


def _records(name: str, value: Any, depth: int = 0) -> Iterator[tuple[str, dict[str, Any]]]:
    """Structures of a variable, and those within them."""
    array = np.asarray(value)
    if depth > 4 or array.dtype.names is None or _is_object(array):
        return
    flat = array.ravel()
    for index, one in enumerate(flat):
        label = name if flat.size == 1 else f"{name}({index + 1})"
        record = {field: one[field] for field in array.dtype.names}
        yield label, record
        if "x_values" not in record:
            for field, inner in record.items():
                yield from _records(f"{label}.{field}", inner, depth + 1)


def _field(value: Any, *names: str) -> Any:
    """An inner field of structures of one element; None where there is none."""
    for name in names:
        array = np.asarray(value)
        if array.dtype.names is None or name not in array.dtype.names or array.size != 1:
            return None
        value = array.ravel()[0][name]
    return value


def _text(value: Any) -> str:
    array = np.asarray(value) if value is not None else np.array("")
    while array.dtype == object and array.size == 1:
        array = np.asarray(array.ravel()[0])
    return str(array.ravel()[0]).strip() if array.size == 1 and array.dtype.kind in "US" else ""


def _number(value: Any) -> float | None:
    array = np.asarray(value) if value is not None else np.array([])
    return float(array.ravel()[0]) if array.size == 1 and array.dtype.kind in "fiu" else None


def _signal(path: Path, label: str, record: Mapping[str, Any]) -> list[Channel]:
    """Channels of a structure of Testlab: x_values.increment and start_value, y_values.values, their quantities."""
    x, y = record["x_values"], record["y_values"]
    values = np.asarray(_field(y, "values"))
    if values.dtype.kind not in "fiuc" or values.ndim > 2 or values.size < 2:
        return []
    columns = values.reshape(-1, 1) if values.ndim < 2 or 1 in values.shape else values
    if columns.shape[0] < columns.shape[1]:
        columns = columns.T
    step, start = _number(_field(x, "increment")), _number(_field(x, "start_value")) or 0.0
    given, told = _field(x, "values"), _number(_field(x, "number_of_values"))
    if told is not None and int(told) != columns.shape[0]:
        raise DataError(f"{path}: {label}: {told:g} values are told, {columns.shape[0]} are held; it was damaged")
    known = find_unit(_text(_field(x, "quantity", "label")))
    kind = known.quantity if known is not None else ""
    axis: Vector | None = None
    remark = ""
    if kind in ("time", "frequency") and known is not None:
        if given is not None and np.asarray(given).size == columns.shape[0]:
            axis = np.asarray(given, dtype=np.float64).ravel() * known.factor
        elif step is not None and step > 0.0:
            length = step * known.factor
            length, remark = clock_step(length) if kind == "time" else (length, "")
            axis = uniform_axis(columns.shape[0], length, start * known.factor)
    unit = _text(_field(y, "quantity", "label"))
    factor, meant = _number(_field(y, "quantity", "unit_transformation", "factor")), find_ratio(unit)
    if factor is not None and meant is not None and abs(factor / meant.factor - 1.0) > 0.01:
        remark = f"the unit is {unit!r}, its factor {factor:g} to SI: a contradiction"
        unit = ""
    name = _text(_field(record.get("function_record"), "name")) or _text(_field(record.get("function_record"), "title"))
    function = _text(_field(record.get("function_record"), "type"))
    place = _text(_field(record.get("function_record"), "point"))
    found = []
    for n in range(columns.shape[1]):
        channel = _plain(name or label, columns[:, n])
        found.append(
            Channel(
                name=channel.name if columns.shape[1] == 1 else f"{channel.name}({n + 1})",
                values=channel.values,
                unit=unit,
                axis=axis,
                kind="frequency" if kind == "frequency" else "time",
                function=function or ("time history" if kind == "time" else "spectrum"),
                place=place,
                direction=_text(_field(record.get("function_record"), "direction")),
                reference=_text(_field(record.get("function_record"), "reference")),
                remark=remark,
            )
        )
    return found


def _check_elements(path: Path) -> dict[str, str]:
    """Refuse an element of a version 5 file that claims more bytes than are there; return the objects and classes."""
    size = path.stat().st_size
    objects: dict[str, str] = {}
    with path.open("rb") as file:
        head = file.read(128)
        if head[126:128] not in (b"IM", b"MI"):
            return {}  # version 4: its reader checks each matrix
        order = "<" if head[126:128] == b"IM" else ">"
        position = 128
        while position + 8 <= size:
            file.seek(position)
            kind, count = struct.unpack(f"{order}II", file.read(8))
            if kind >> 16:
                raise DataError(f"{path}: byte {position} begins no element; the file was damaged; save it again")
            check_length(path, count, size - position - 8, f"element at byte {position}")
            if kind not in (MATRIX, COMPRESSED):
                raise DataError(f"{path}: byte {position} begins no matrix; the file was damaged; save it again")
            body = file.read(count)
            if kind == COMPRESSED:
                try:
                    body = zlib.decompress(body)
                except zlib.error as error:
                    raise DataError(f"{path}: element at byte {position}: {error}; save the file again") from None
                body = body[8:]
            check_matrix(path, body, order, f"element at byte {position}")
            named = object_name(path, body, order) if kind in (MATRIX, COMPRESSED) else None
            if named is not None:
                objects[named[0]] = named[1]
            position += 8 + count if kind == 15 else 8 + count + -count % 8
        if position != size and size - position > 7:
            raise DataError(f"{path}: the file ends within an element; it was cut off; save it again")
    return objects


def write(path: Path, channels: tuple[Channel, ...], about: str) -> None:
    """Write one structure a channel, in the form of Testlab.

    Args:
        path: the file.
        channels: any.
        about: what the record is.
    """
    from scipy.io import savemat

    savemat(path, structures(channels) | {"about": about}, do_compression=True, oned_as="column", long_field_names=True)


def structures(channels: tuple[Channel, ...]) -> dict[str, Any]:
    """Name of a variable to the structure of a channel."""
    found: dict[str, Any] = {}
    for number, one in enumerate(channels, 1):
        plain = "".join(sign if sign.isascii() and sign.isalnum() else "_" for sign in one.name)[:50]
        name = plain if plain and plain[0].isalpha() else f"channel_{plain}"
        step = even_step(one.axis) if one.axis is not None else 0.0
        quantity = "s" if one.kind == "time" else "Hz"
        found[name if name not in found else f"{name}_{number}"] = {
            "x_values": {
                "start_value": float(one.axis[0]) if one.axis is not None else 0.0,
                "increment": 0.0 if step is None else step,
                "number_of_values": float(one.values.size),
                "quantity": {"label": quantity},
                **({"values": one.axis} if step is None else {}),
            },
            "y_values": {"values": one.values, "quantity": {"label": one.unit}},
            "function_record": {
                "name": one.name,
                "type": one.function,
                "point": one.place,
                "direction": one.direction,
                "reference": one.reference,
            },
        }
    return found
