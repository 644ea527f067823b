"""Read the structures in which Simulink and dSPACE ControlDesk save signals in MAT files.

Simulink, "Structure With Time": `time` [s], (n, 1), and `signals(k)` with `values`, (n, w) or (w, ..., n), and `label`,
the names of its w columns separated by commas. ControlDesk: `X(i)` with `Data`, the times [s], and `Y(k)` with `Name`,
`Data`, `Unit` and `XIndex`, the number of its times.

Sources: MathWorks, Simulink, "Data Format for Logged Simulation Data"; dSPACE, ControlDesk, "MAT File Format".
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.units import seconds_in


def is_structure(record: Mapping[str, Any]) -> bool:
    """Return True if the fields of a structure, with their values, are of Simulink or dSPACE."""
    return _has(record, "signals", "values") or (_has(record, "X", "Data") and _has(record, "Y", "Data"))


def structure_channels(label: str, record: Mapping[str, Any]) -> list[Channel]:
    """Return the signals of a structure of Simulink or dSPACE as channels with names, units and times.

    Args:
        label: name of the structure, for signals without a name.
        record: field to value, see `is_structure`.
    """
    if "signals" in record:
        time = numbers(record.get("time"))
        signals: Iterator[tuple[str, Vector, str, Vector | None]] = (
            (name, columns, "", time) for name, columns in _simulink(f"{label}.signals", record["signals"])
        )
    else:
        signals = _dspace(label, record)
    channels = []
    for name, values, unit, times in signals:
        axis = times if times is not None and times.size == values.size and times.size > 1 else None
        channels.append(Channel(name=name, values=values, unit=unit, axis=axis))
    return channels


def columns_of(name: str, values: Any) -> list[tuple[str, Vector]]:
    """Return the columns of an array with numbered names; the longest dimension is that of the samples.

    Args:
        values: numbers, (n,), (n, w), (w, n) or (w, ..., n).
    """
    array = np.asarray(values)
    if array.size == max(array.shape):
        return [(name, array.ravel())]
    samples = int(np.argmax(array.shape)) if array.ndim == 2 else array.ndim - 1
    table = np.moveaxis(array, samples, 0)
    table = table.reshape(table.shape[0], -1)
    return [(f"{name}(:,{n + 1})", table[:, n]) for n in range(table.shape[1])]


def _simulink(label: str, signals: Any) -> Iterator[tuple[str, Vector]]:
    elements = np.asarray(signals).ravel()
    for number, element in enumerate(elements, 1):
        values = np.asarray(element["values"])
        if values.dtype.kind not in "fiub" or not values.size:
            continue
        element_label = label if elements.size == 1 else f"{label}({number})"
        columns = columns_of(f"{element_label}.values", values.astype(np.float64))
        text = word(element["label"]) if "label" in (elements.dtype.names or ()) else ""
        names = [part.strip(" <>") for part in text.split(",")]
        if len(names) != len(columns):
            names = [f"{text}({n})" if text else name for n, (name, _) in enumerate(columns, 1)]
        yield from ((name or element_label, values) for name, (_, values) in zip(names, columns, strict=True))


def _dspace(label: str, record: Mapping[str, Any]) -> Iterator[tuple[str, Vector, str, Vector | None]]:
    axes = np.asarray(record["X"]).ravel()
    signals = np.asarray(record["Y"]).ravel()
    fields = signals.dtype.names or ()
    for number, element in enumerate(signals, 1):
        values = numbers(element["Data"])
        if values is None:
            continue
        index = numbers(element["XIndex"]) if "XIndex" in fields else None
        at = int(index[0]) - 1 if index is not None and index.size == 1 else 0
        axis = axes[at] if 0 <= at < axes.size else None
        unit = word(axis["Unit"]) if axis is not None and "Unit" in (axes.dtype.names or ()) else ""
        factor = seconds_in(unit) or 1.0
        times = None if axis is None else numbers(axis["Data"])
        name = word(element["Name"]).strip('"') if "Name" in fields else ""
        own_unit = word(element["Unit"]) if "Unit" in fields else ""
        yield name or f"{label}.Y({number})", values, own_unit, None if times is None else times * factor


def _has(record: Mapping[str, Any], field: str, inner: str) -> bool:
    return inner in (np.asarray(record[field]).dtype.names or ()) if field in record else False


def numbers(value: Any) -> Vector | None:
    """Return a field of a structure as floats, (n,); None if it is no numeric vector."""
    array = np.asarray(value) if value is not None else np.zeros(0)
    vector = array.dtype.kind in "fiub" and array.size > 0 and array.size == max(array.shape, default=1)
    return array.astype(np.float64).ravel() if vector else None


def word(value: Any) -> str:
    """Return a field of a structure as text; empty for other values."""
    array = np.asarray("" if value is None else value)
    while array.dtype == object and array.size == 1:
        array = np.asarray(array.ravel()[0])
    return str(array.ravel()[0]).strip() if array.size == 1 and array.dtype.kind in "US" else ""
