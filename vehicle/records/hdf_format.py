"""HDF5: MAT files of version 7.3, and arrays with their units as attributes.

Written are one array a channel, with the attributes name, unit, kind, start, step, function, place, direction, and
under `axes` the frequencies that are not even.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.records.channel import Channel, Measurement, even_step, uniform_axis
from vehicle.records.matlab_format import channels_of
from vehicle.records.reader import digest, extra

AXES = "axes"
"""Group of the axes that are not even, under the names of their channels."""


def read(path: Path) -> Measurement:
    """Read structures of MATLAB, or all arrays of numbers.

    Raises:
        MissingPartError: h5py is not installed.
        DataError: damaged, cut off, or without numbers.
    """
    h5py = extra("h5py", "hdf5", "an HDF5 file (MAT 7.3)")
    try:
        with h5py.File(path, "r") as file:
            if any("MATLAB_class" in one.attrs for one in file.values()):
                held = {name: _matlab(file, one, h5py) for name, one in file.items() if not name.startswith("#")}
                channels, notices = channels_of({name: one for name, one in held.items() if one is not None}, path)
                program = "MATLAB 7.3"
            else:
                found: list[Channel] = []
                file.visititems(lambda name, one: found.extend(_arrays(name, one, h5py)))
                channels, notices = tuple(found), []
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
        path=path, format="hdf5", channels=channels, sha256=digest(path), program=program, notices=tuple(notices)
    )


def _matlab(file: Any, one: Any, h5py: Any) -> Any:
    """A variable of MATLAB as `scipy.io.loadmat` gives it: structures as records, arrays with their axes turned."""
    if isinstance(one, h5py.Group):
        fields = {name: _matlab(file, inner, h5py) for name, inner in one.items()}
        record = np.empty((1, 1), dtype=[(name, object) for name in fields])
        for name, value in fields.items():
            record[0, 0][name] = value
        return record
    kind = one.attrs.get("MATLAB_class", b"")
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


def _arrays(name: str, one: Any, h5py: Any) -> list[Channel]:
    """Channels of an array: its columns, where it has two axes."""
    if not isinstance(one, h5py.Dataset) or one.dtype.kind not in "fiuc" or one.ndim not in (1, 2) or one.size < 2:
        return []
    if name.startswith(f"{AXES}/"):
        return []
    values = np.asarray(one[()])
    values = values.astype(complex if values.dtype.kind == "c" else np.float64).reshape(len(values), -1)
    step, start = one.attrs.get("step"), float(one.attrs.get("start", 0.0))
    kind = _attribute(one, "kind")
    axis = uniform_axis(len(values), float(step), start) if step is not None and step > 0.0 and kind else None
    own = one.file.get(f"{AXES}/{name}")
    if isinstance(own, h5py.Dataset) and own.shape == (len(values),) and kind:
        axis = np.asarray(own[()], dtype=np.float64)
    label = _attribute(one, "name") or name
    return [
        Channel(
            name=label if values.shape[1] == 1 else f"{label}(:,{n + 1})",
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
