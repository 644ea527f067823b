"""Read and write tables as `.npz`: the array `time`, one array per channel, and units as texts "name [unit]"."""

import math
import zipfile
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.mapped_table import release
from vehicle.signals.formats.file_digest import digest
from vehicle.signals.formats.optional_library import reading
from vehicle.signals.formats.table import Header, Record, Table, Wanted, name_and_unit
from vehicle.signals.formats.unpacked_size import require_unpacked


def read(path: Path, wanted: Wanted) -> Table:
    """Read the array `time` and all numeric arrays of its length as a table."""
    with reading(path, "npz", "use the time.npz of a run, or a CSV file"):
        names = _wanted_arrays(path)
        with np.load(path, allow_pickle=False) as arrays:
            loaded = {name: arrays[name] for name in names}
    texts = [str(text) for text in np.atleast_1d(loaded.pop("units", np.array([], dtype=str)))]
    units = {"time": "s"} | dict(name_and_unit(text) for text in texts)
    numbers = {name: values for name, values in loaded.items() if values.ndim == 1 and values.dtype.kind in "fiu"}
    if "time" not in numbers:
        raise DataError(
            f"{path}: the array 'time' is missing; found {', '.join(loaded) or 'no array of one dimension'}; "
            f"store time and each channel as a vector: {wanted.needed}"
        )
    count = numbers["time"].size
    for name, values in numbers.items():
        if values.size != count:
            raise DataError(f"{path}: array {name!r} has {values.size} samples instead of {count}, one for each time")
        if not np.isfinite(values).all():
            raise DataError(f"{path}: array {name!r} contains NaN or infinity; correct or cut the record")
    header = Header(path=path, line=0, cells=tuple(f"{name} [{units.get(name) or ''}]" for name in numbers))
    key = wanted.key(header)
    loaded.clear()
    table = np.empty((count, len(numbers)), order="F")
    for column, name in enumerate(tuple(numbers)):
        table[:, column] = numbers.pop(name)  # keep only one copy of a long record in memory
    return Table(header=header, key=key, values=table, lines=np.arange(1, count + 1), notices=(), sha256=digest(path))


def _wanted_arrays(path: Path) -> list[str]:
    """Return the names of the arrays of one dimension, from their headers; other arrays are not channels."""
    names, size, packed = [], 0, 0
    with zipfile.ZipFile(path) as archive:
        for entry in archive.infolist():
            with archive.open(entry) as member:
                version = np.lib.format.read_magic(member)
                header = (
                    np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
                )
                shape, _, dtype = header(member)
            if len(shape) == 1 or dtype.kind in "US":
                names.append(entry.filename.removesuffix(".npy"))
                size += max(math.prod(shape) * dtype.itemsize, entry.file_size)
                packed += entry.compress_size
    require_unpacked(path, size, packed)
    return names


def write(path: Path, record: Record, frame: str) -> None:
    """Write a record with its units and its frame as texts; see `vehicle.signals.formats.formats.write_record`.

    Without compression, which takes longer than the run and reduces the file by a sixth only.
    """
    units = np.array([f"{name} [{unit}]" for name, unit in record.units.items()])
    with zipfile.ZipFile(path, "w") as archive:
        # As `numpy.savez` does, channel by channel.
        for name, values in {"time": record.time, **record.channels, "units": units, "frame": np.array(frame)}.items():
            with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                np.lib.format.write_array(member, np.asarray(values), allow_pickle=False)
            release(values)
