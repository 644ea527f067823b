"""Read and write HDF5: MAT files of version 7.3, and arrays with units as attributes.

A written file has one array per channel with the attributes name, unit, kind, start, step, function, place, direction,
and uneven frequencies in the group `axes`.
"""

from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.mapped_table import release
from vehicle.signals.formats.channel import Channel, Measurement, even_step, uniform_axis
from vehicle.signals.formats.matlab_format import with_tables
from vehicle.signals.formats.mixed_sources import SAMPLED, check_alternation
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.packed_values import attribute_text, unpacked
from vehicle.signals.formats.pandas_frames import frame_channels
from vehicle.signals.formats.stated_rate import number_of, stated_step
from vehicle.signals.formats.typed_columns import TypedColumn, typed_channels
from vehicle.signals.formats.units import find_unit, seconds_in
from vehicle.signals.formats.unpacked_size import require_unpacked

PLAIN_CLASSES = frozenset(
    ("double", "single", "logical", "char", "struct", "cell", "function_handle", "canonical empty")
) | {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
"""MATLAB classes other than objects."""

LONG = 10
"""Minimum ratio of columns to rows of an array with one channel per row."""

LONG_UNITS = {"days": 86400.0, "hours": 3600.0, "minutes": 60.0}
"""Units of netCDF times in s, in addition to those of `vehicle.signals.formats.units`."""

NO_VALUES = "This is a netCDF dimension but not a netCDF variable"
"""Begin of the attribute NAME of an array that netCDF writes for a dimension alone; its numbers have no meaning."""

STARTS = ("start", "t0", "start_time", "starting_time", "wf_start_offset")
"""Names of the time of the first sample [s], next to a rate."""

AXES = "axes"
"""Name of the group with the uneven axes, under the names of their channels."""


def read(path: Path) -> Measurement:
    """Read the structures of a MATLAB file, or all numeric arrays of another HDF5 file; errors: see `read_record`."""
    h5py = extra("h5py", "hdf5", "an HDF5 file (MAT 7.3)")
    start, notices = "", list[str]()
    variables: dict[str, Any] | None = None
    objects: dict[str, str] = {}
    with reading(path, "HDF5", "it may be truncated; export it again"), h5py.File(path, "r") as file:
        require_unpacked(path, _size(file, h5py), path.stat().st_size)
        if any("MATLAB_class" in item.attrs for item in file.values()):
            objects = {name: matlab_class for name, item in file.items() if (matlab_class := _object_class(item))}
            names = [name for name in file if not name.startswith("#") and name not in objects]
            read_variables = {name: _matlab(file, file[name], h5py) for name in names}
            variables = {name: item for name, item in read_variables.items() if item is not None}
            program = "MATLAB 7.3"
        else:
            channels, start = _walk(path, file, h5py, notices)
            program = _attribute(file, "program")
    if variables is not None:
        channels, notices, start = with_tables(variables, path, objects)
    if not channels:
        raise DataError(f"{path}: contains no numeric array; export the channels as arrays of numbers")
    return Measurement(
        path=path, format="hdf5", channels=channels, program=program, start=start, notices=tuple(notices)
    )


def _size(file: Any, h5py: Any) -> float:
    """Return the size of all arrays of a file [byte], unpacked."""
    sizes: list[float] = []
    file.visititems(lambda _, item: sizes.append(float(item.nbytes)) if isinstance(item, h5py.Dataset) else None)
    return sum(sizes)


def _walk(path: Path, file: Any, h5py: Any, notices: list[str]) -> tuple[tuple[Channel, ...], str]:
    """Return the channels of all arrays and pandas frames, in the order of the file, and the first start time."""
    all_channels: list[Channel] = []
    starts: list[str] = []
    groups: dict[str, tuple[float | None, float, str]] = {}

    def enter(group: Any, prefix: str) -> None:
        for name, item in group.items():
            label = f"{prefix}{name}"
            if isinstance(item, h5py.Dataset):
                all_channels.extend(_arrays(path, label, item, h5py, notices, groups))
            elif item.attrs.get("pandas_type") is not None:
                channels, start = frame_channels(path, label, item, notices)
                all_channels.extend(channels)
                starts.append(start)
            else:
                enter(item, f"{label}/")

    enter(file, "")
    return tuple(all_channels), next(filter(None, starts), "")


def _object_class(variable: Any) -> str:
    """Return the class of a MATLAB object, for example a table; empty for arrays, structures and cells."""
    matlab_class = variable.attrs.get("MATLAB_class", b"")
    matlab_class = matlab_class.decode("latin-1") if isinstance(matlab_class, bytes) else str(matlab_class)
    return (
        matlab_class
        if "MATLAB_object_decode" in variable.attrs or (matlab_class and matlab_class not in PLAIN_CLASSES)
        else ""
    )


def _matlab(file: Any, variable: Any, h5py: Any) -> Any:
    """Read a MATLAB variable as `scipy.io.loadmat` does: structures as records, arrays transposed."""
    if isinstance(variable, h5py.Group):
        fields = {name: _matlab(file, inner, h5py) for name, inner in variable.items()}
        record = np.empty((1, 1), dtype=[(name, object) for name in fields])
        for name, value in fields.items():
            record[0, 0][name] = value
        return record
    matlab_class = variable.attrs.get("MATLAB_class", b"")
    if _object_class(variable):
        return np.empty(
            (1, 1), dtype=[(name, object) for name in ("s0", "s1", "s2", "arr")]
        )  # as in `scipy.io.loadmat`
    if variable.attrs.get("MATLAB_empty", 0):
        return np.array([])
    values = variable[()]
    if matlab_class == b"char":
        return np.array(["".join(chr(int(code)) for code in np.asarray(values).ravel())])
    if variable.dtype.kind == "O":
        references = np.asarray(values).ravel()
        return _matlab(file, file[references[0]], h5py) if references.size == 1 else None
    if variable.dtype.names == ("real", "imag"):
        values = values["real"] + 1j * values["imag"]
    return np.asarray(values).T


def _arrays(
    path: Path,
    name: str,
    dataset: Any,
    h5py: Any,
    notices: list[str],
    groups: dict[str, tuple[float | None, float, str]],
) -> list[Channel]:
    """Return the channels of an array: its columns, or its rows if these are at least `LONG` times longer."""
    if name.startswith(f"{AXES}/") or dataset.size is None or dataset.size < 2:
        return []
    if dataset.dtype.names is not None:
        return _fields(path, name, dataset, notices)
    if h5py.check_string_dtype(dataset.dtype) is not None and dataset.ndim == 1:
        check_alternation(path, name, [attribute_text(cell) for cell in dataset[:SAMPLED]])
    if (
        dataset.dtype.kind not in "fiuc"
        or dataset.ndim not in (1, 2)
        or _attribute(dataset, "NAME").startswith(NO_VALUES)
    ):
        return []
    values, fault, messages = unpacked(name, dataset)
    notices.extend(messages)
    index_text = "(:,{})"
    if values.ndim == 2 and (len(values) == 1 or LONG * len(values) <= values.shape[1]):
        if len(values) > 1:
            notices.append(f"array {name!r} of {len(values)} x {values.shape[1]}: each row is a channel")
        values, index_text = values.T, "({},:)"
    values = values.reshape(len(values), -1)
    unit = _attribute(dataset, "unit") or _attribute(dataset, "units")
    step = number_of(dataset.attrs.get("step", ""))[0]
    start = number_of(dataset.attrs.get("start", 0.0))[0] or 0.0
    axis_quantity = _attribute(dataset, "kind")
    axis = uniform_axis(len(values), step, start) if step is not None and step > 0.0 and axis_quantity else None
    stored_axis = dataset.file.get(f"{AXES}/{name}")
    if getattr(stored_axis, "shape", None) == (len(values),) and axis_quantity:
        axis = np.asarray(stored_axis[()], dtype=np.float64)
    if axis is None:
        axis = _coordinate(dataset, len(values))
    if axis is None and dataset.dtype.kind != "c" and not axis_quantity:
        signed = getattr(find_unit(unit), "quantity", "") == "acceleration" and bool((values < 0.0).any())
        axis = _stated_axis(name, dataset, len(values), notices, groups, signed=signed)
    label = _attribute(dataset, "name") or name
    return [
        Channel(
            name=label if values.shape[1] == 1 else label + index_text.format(n + 1),
            values=values[:, n].copy(),
            unit="" if fault else unit,
            axis=axis,
            kind="frequency" if axis_quantity == "frequency" else "time",
            function=_attribute(dataset, "function") or "time history",
            place=_attribute(dataset, "place"),
            direction=_attribute(dataset, "direction"),
            reference=_attribute(dataset, "reference"),
            remark=f"{fault}, so the unit {unit!r} is ignored" if fault and unit else "",
        )
        for n in range(values.shape[1])
    ]


def _coordinate(dataset: Any, count: int) -> Vector | None:
    """Return the times of the first dimension [s] from its dimension scale; None without a scale in a unit of time.

    Times since a date ("seconds since 2026-01-01" in the CF conventions, 4.4) begin at zero.
    """
    scales = dataset.dims[0]
    if not len(scales) or scales[0].shape != (count,) or scales[0].dtype.kind not in "fiu":
        return None
    unit, since, _ = _attribute(scales[0], "units").partition(" since ")
    factor = LONG_UNITS.get(unit.strip().lower()) or seconds_in(unit.strip())
    if not factor:
        return None
    times = np.asarray(unpacked("", scales[0])[0], dtype=np.float64) * factor
    return times - times[0] if since else times


def _stated_axis(
    name: str,
    dataset: Any,
    count: int,
    notices: list[str],
    groups: dict[str, tuple[float | None, float, str]],
    *,
    signed: bool,
) -> Vector | None:
    """Return times [s] from a rate or step among the attributes and single numbers of an array or its groups.

    Args:
        groups: results of `_stated` by name of group, which many arrays share; extended.
        signed: True for accelerations of both signs, which are no spectrum.
    """
    item = dataset
    while True:
        if item is dataset:
            step, start, remark = _stated(dict(item.attrs), signed=signed)
        else:
            if item.name not in groups:
                groups[item.name] = _stated(_numbers(item))
            step, start, remark = groups[item.name]
        if remark:
            notices.append(f"array {name!r}: {remark}")
        if step is not None:
            return uniform_axis(count, step, start)
        if remark or item.name == "/":
            return None
        item = item.parent


def _numbers(group: Any) -> dict[str, Any]:
    """Return the attributes and single numbers of a group."""
    numbers = dict(group.attrs)
    numbers |= {key: inner[()] for key, inner in group.items() if getattr(inner, "size", None) == 1}
    if "rate" in getattr(group.get("starting_time"), "attrs", {}):  # NWB, TimeSeries
        numbers |= {"sample_rate": group["starting_time"].attrs["rate"], "start": group["starting_time"][()]}
    return numbers


def _stated(numbers: dict[str, Any], *, signed: bool = False) -> tuple[float | None, float, str]:
    """Return step and start [s] among named numbers, and a remark, see `stated_step`."""
    step, remark = stated_step(numbers, of_time=signed and not numbers.keys().isdisjoint(STARTS))
    start = next((number_of(numbers[key])[0] for key in STARTS if key in numbers), None)
    return step, start or 0.0, remark


def _fields(path: Path, name: str, dataset: Any, notices: list[str]) -> list[Channel]:
    """Return the fields of a record array as channels; time fields become their axes."""
    if dataset.ndim != 1:
        notices.append(f"array {name!r} is ignored: it has records in {dataset.ndim} dimensions instead of one")
        return []
    table = dataset[()]
    numeric = [field for field in table.dtype.names if table[field].dtype.kind in "fiu" and table[field].ndim == 1]
    others = [field for field in table.dtype.names if field not in numeric]
    for field in others:
        check_alternation(path, field, [attribute_text(cell) for cell in table[field][:SAMPLED]])
    if others:
        notices.append(f"fields of {name!r} without numbers are ignored: {', '.join(map(repr, others))}")
    return typed_channels(path, [TypedColumn(field, table[field]) for field in numeric], notices, name)[0]


def _attribute(item: Any, name: str) -> str:
    return attribute_text(item.attrs.get(name))


class _Disk(FileIO):
    """New file whose first error is kept instead of raised: HDF5 would end the process as it closes the file."""

    error: OSError | None = None

    def write(self, data: Any, /) -> int:
        """Write all data, or none after an error."""
        rest = memoryview(data).cast("B")
        size = rest.nbytes
        try:
            while rest and self.error is None:
                rest = rest[super().write(rest) :]
        except OSError as error:
            self.error = error
        return size

    def check(self) -> None:
        """Raise the kept error."""
        if self.error is not None:
            raise self.error

    def __exit__(self, *error: object) -> None:
        """Close the file, and raise the kept error, from which HDF5 has others."""
        super().close()
        self.check()


def write(path: Path, channels: tuple[Channel, ...], description: str) -> None:
    """Write channels to an HDF5 file, one array per channel."""
    h5py = extra("h5py", "hdf5", "writing HDF5")
    with _Disk(path, "w+") as disk, h5py.File(disk, "w") as file:
        file.attrs["program"] = description
        for number, channel in enumerate(channels, 1):
            array = file.create_dataset(f"{number:04d}", data=channel.values, compression="gzip", compression_opts=4)
            texts = {
                name: getattr(channel, name) for name in ("name", "unit", "function", "place", "direction", "reference")
            }
            for name, text in texts.items():
                array.attrs[name] = text
            if channel.axis is not None:
                array.attrs["kind"] = channel.kind
                array.attrs["start"] = float(channel.axis[0])
                step = even_step(channel.axis)
                array.attrs["step"] = 0.0 if step is None else step
                if step is None:
                    file.create_dataset(f"{AXES}/{number:04d}", data=channel.axis)
            release(channel.values)
            disk.check()
