"""HDF5: MAT files of version 7.3, and arrays with their units as attributes.

Written are one array a channel, with the attributes name, unit, kind, start, step, function, place, direction, and
under `axes` the frequencies that are not even.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, even_step, uniform_axis
from vehicle.signals.records.heads import TIME_NAME, split_head
from vehicle.signals.records.matlab_format import channels_of
from vehicle.signals.records.pandas_frames import frame_channels
from vehicle.signals.records.reader import digest, extra
from vehicle.signals.records.units import find_unit

PLAIN_CLASSES = frozenset(
    ("double", "single", "logical", "char", "struct", "cell", "function_handle", "canonical empty")
) | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
"""Classes of MATLAB that are no objects."""
LONG = 10
"""An array of at least so many times more columns than rows holds a channel in each row."""
AXES = "axes"
"""Group of the axes that are not even, under the names of their channels."""


def read(path: Path) -> Measurement:
    """Read structures of MATLAB, or all arrays of numbers.

    Raises:
        MissingPartError: h5py is not installed.
        DataError: damaged, cut off, or without numbers.
    """
    h5py = extra("h5py", "hdf5", "an HDF5 file (MAT 7.3)")
    start = ""
    try:
        with h5py.File(path, "r") as file:
            if any("MATLAB_class" in one.attrs for one in file.values()):
                objects = {name: kind for name, one in file.items() if (kind := _object_class(one))}
                plain = [name for name in file if not name.startswith("#") and name not in objects]
                held = {name: _matlab(file, file[name], h5py) for name in plain}
                held = {name: one for name, one in held.items() if one is not None}
                channels, notices = channels_of(held, path, objects)
                program = "MATLAB 7.3"
            else:
                notices = []
                channels, start = _walk(path, file, h5py, notices)
                program = _attribute(file, "program")
    except DataError:
        raise
    except Exception as error:  # damaged files raise what they like
        raise DataError(
            f"{path}: no HDF5 file that can be read ({error}); it may be cut off; export it again"
        ) from None
    if not channels:
        raise DataError(f"{path}: no array of numbers")
    return Measurement(
        path=path,
        format="hdf5",
        channels=channels,
        sha256=digest(path),
        program=program,
        start=start,
        notices=tuple(notices),
    )


def _walk(path: Path, file: Any, h5py: Any, notices: list[str]) -> tuple[tuple[Channel, ...], str]:
    """Channels of all arrays and of the frames of pandas below a group, in the order of the file; a start."""
    found: list[Channel] = []
    starts: list[str] = []

    def enter(group: Any, prefix: str) -> None:
        for name, one in group.items():
            label = f"{prefix}{name}"
            if isinstance(one, h5py.Dataset):
                found.extend(_arrays(label, one, notices))
            elif one.attrs.get("pandas_type") is not None:
                channels, start = frame_channels(path, label, one)
                found.extend(channels)
                starts.append(start)
            else:
                enter(one, f"{label}/")

    enter(file, "")
    return tuple(found), next(filter(None, starts), "")


def _object_class(one: Any) -> str:
    """Class of a variable of MATLAB that is an object, as a table; empty for arrays, structures and cells."""
    kind = one.attrs.get("MATLAB_class", b"")
    kind = kind.decode("latin-1") if isinstance(kind, bytes) else str(kind)
    return kind if "MATLAB_object_decode" in one.attrs or (kind and kind not in PLAIN_CLASSES) else ""


def _matlab(file: Any, one: Any, h5py: Any) -> Any:
    """A variable of MATLAB as `scipy.io.loadmat` gives it: structures as records, arrays with their axes turned."""
    if isinstance(one, h5py.Group):
        fields = {name: _matlab(file, inner, h5py) for name, inner in one.items()}
        record = np.empty((1, 1), dtype=[(name, object) for name in fields])
        for name, value in fields.items():
            record[0, 0][name] = value
        return record
    kind = one.attrs.get("MATLAB_class", b"")
    if _object_class(one):
        return np.empty((1, 1), dtype=[(name, object) for name in ("s0", "s1", "s2", "arr")])  # as scipy gives it
    if one.attrs.get("MATLAB_empty", 0):
        return np.array([])
    values = one[()]
    if kind == b"char":
        return np.array(["".join(chr(int(code)) for code in np.asarray(values).ravel())])
    if one.dtype.kind == "O":
        references = np.asarray(values).ravel()
        return _matlab(file, file[references[0]], h5py) if references.size == 1 else None
    if one.dtype.names == ("real", "imag"):
        values = values["real"] + 1j * values["imag"]
    return np.asarray(values).T


def _arrays(name: str, one: Any, notices: list[str]) -> list[Channel]:
    """Channels of an array: its columns, where it has two axes; its rows where these are the longer ones."""
    if name.startswith(f"{AXES}/") or one.size is None or one.size < 2:
        return []
    if one.dtype.names is not None:
        return _fields(name, one, notices)
    if one.dtype.kind not in "fiuc" or one.ndim not in (1, 2):
        return []
    values = np.asarray(one[()])
    values = values.astype(complex if values.dtype.kind == "c" else np.float64)
    form = "(:,{})"
    if values.ndim == 2 and (len(values) == 1 or LONG * len(values) <= values.shape[1]):
        if len(values) > 1:
            notices.append(f"array {name!r} of {len(values)} x {values.shape[1]}: each row is a channel")
        values, form = values.T, "({},:)"
    values = values.reshape(len(values), -1)
    step, start = one.attrs.get("step"), float(one.attrs.get("start", 0.0))
    kind = _attribute(one, "kind")
    axis = uniform_axis(len(values), float(step), start) if step is not None and step > 0.0 and kind else None
    own = one.file.get(f"{AXES}/{name}")
    if getattr(own, "shape", None) == (len(values),) and kind:
        axis = np.asarray(own[()], dtype=np.float64)
    label = _attribute(one, "name") or name
    return [
        Channel(
            name=label if values.shape[1] == 1 else label + form.format(n + 1),
            values=values[:, n].copy(),
            unit=_attribute(one, "unit") or _attribute(one, "units"),
            axis=axis,
            kind="frequency" if kind == "frequency" else "time",
            function=_attribute(one, "function") or "time history",
            place=_attribute(one, "place"),
            direction=_attribute(one, "direction"),
            reference=_attribute(one, "reference"),
        )
        for n in range(values.shape[1])
    ]


def _fields(name: str, one: Any, notices: list[str]) -> list[Channel]:
    """Channels of an array of records, under the names of its fields; a field of times is their axis."""
    if one.ndim != 1:
        notices.append(f"array {name!r} of records with {one.ndim} axes is left out")
        return []
    table = one[()]
    plain = [field for field in table.dtype.names if table[field].dtype.kind in "fiu" and table[field].ndim == 1]
    left = [field for field in table.dtype.names if field not in plain]
    if left:
        notices.append(f"fields of {name!r} that hold no numbers are left out: {', '.join(map(repr, left))}")
    heads = {field: split_head(field) for field in plain}
    key = next((field for field, (text, unit) in heads.items() if TIME_NAME.fullmatch(text) and _seconds(unit)), None)
    axis = None if key is None else table[key].astype(np.float64) * _seconds(heads[key][1])
    return [
        Channel(name=text, values=table[field].astype(np.float64), unit=unit, axis=axis, place=name)
        for field, (text, unit) in heads.items()
        if field != key
    ]


def _seconds(unit: str) -> float:
    """Factor of a unit of time to seconds; 0 for any other unit."""
    known = find_unit(unit)
    return known.factor if known is not None and known.quantity == "time" else 0.0


def _attribute(one: Any, name: str) -> str:
    value = one.attrs.get(name, "")
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def write(path: Path, channels: tuple[Channel, ...], about: str) -> None:
    """Write one array a channel.

    Args:
        path: the file.
        channels: any.
        about: what the record is.

    Raises:
        MissingPartError: h5py is not installed.
    """
    h5py = extra("h5py", "hdf5", "writing HDF5")
    with h5py.File(path, "w") as file:
        file.attrs["program"] = about
        for number, one in enumerate(channels, 1):
            array = file.create_dataset(f"{number:04d}", data=one.values, compression="gzip", compression_opts=4)
            texts = {
                name: getattr(one, name) for name in ("name", "unit", "function", "place", "direction", "reference")
            }
            for name, text in texts.items():
                array.attrs[name] = text
            if one.axis is not None:
                array.attrs["kind"] = one.kind
                array.attrs["start"] = float(one.axis[0])
                step = even_step(one.axis)
                array.attrs["step"] = 0.0 if step is None else step
                if step is None:
                    file.create_dataset(f"{AXES}/{number:04d}", data=one.axis)
