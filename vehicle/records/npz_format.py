"""Tables as arrays: an `.npz` with `time`, one array for each channel, and their units as texts "name [unit]"."""

from __future__ import annotations

import hashlib
import zipfile
import zlib
from pathlib import Path
from tokenize import TokenError

import numpy as np

from vehicle.errors import DataError
from vehicle.records.table import Header, Record, Table, Wanted, name_and_unit
from vehicle.records.text import MEMORY_LIMIT


def read(path: Path, wanted: Wanted) -> Table:
    """Read all arrays of numbers that are as long as the time.

    Raises:
        DataError: no archive of arrays, one too large, no time, or arrays of other lengths or with values that are not
            finite; or of `wanted`.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(one.file_size for one in archive.infolist())
        if size > MEMORY_LIMIT:
            raise DataError(
                f"{path}: its arrays need {size / 1024**3:.3g} GiB of memory; allowed "
                f"{MEMORY_LIMIT / 1024**3:.3g} GiB; cut the record into parts"
            )
        with np.load(path, allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in arrays.files}
    except (
        OSError,
        ValueError,
        EOFError,
        zipfile.BadZipFile,
        NotImplementedError,
        RuntimeError,
        SyntaxError,
        KeyError,
        TokenError,
        zlib.error,
    ) as error:
        raise DataError(f"{path}: no file of arrays ({error}); give a time.npz of a run, or a CSV file") from None
    texts = [str(text) for text in np.atleast_1d(found.pop("units", np.array([], dtype=str)))]
    units = {"time": "s"} | dict(name_and_unit(text) for text in texts)
    numbers = {name: values for name, values in found.items() if values.ndim == 1 and values.dtype.kind in "fiu"}
    if "time" not in numbers:
        raise DataError(f"{path}: no array 'time'; found {', '.join(found)}; needed are {wanted.needed}")
    count = numbers["time"].size
    for name, values in numbers.items():
        if values.size != count or not np.isfinite(values).all():
            raise DataError(
                f"{path}: array {name!r} has {values.size} samples for {count} times, or one that is not finite; "
                "repair or cut the record"
            )
    header = Header(path=path, line=0, cells=tuple(f"{name} [{units.get(name) or ''}]" for name in numbers))
    key = wanted.key(header)
    found.clear()
    table = np.empty((count, len(numbers)), order="F")
    for column, name in enumerate(tuple(numbers)):
        table[:, column] = numbers.pop(name)  # a long record stands in memory once
    return Table(
        header=header,
        key=key,
        values=table,
        lines=np.arange(1, count + 1),
        notices=(),
        sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
    )


def write(path: Path, record: Record, frame: str) -> None:
    """Write a record, with its units and its frame as texts; arguments as of `Format.write`.

    Not compressed: that takes more time than the run, and spares a sixth of the file.
    """
    with path.open("wb") as file:
        np.savez(
            file,
            allow_pickle=False,
            time=record.time,
            **{name: np.asarray(values) for name, values in record.channels.items()},
            units=np.array([f"{name} [{unit}]" for name, unit in record.units.items()]),
            frame=np.array(frame),
        )
