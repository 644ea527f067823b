"""Tables as arrays: an `.npz` with `time`, one array for each channel, and their units as texts "name [unit]"."""

from __future__ import annotations

import hashlib
import math
import zipfile
import zlib
from pathlib import Path
from tokenize import TokenError

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.table import Header, Record, Table, Wanted, name_and_unit
from vehicle.signals.records.text import MEMORY_LIMIT

FREELY = 100_000_000
"""Arrays up to this size are read however they are packed [byte]: a channel at rest for an hour is a constant."""
DENSEST = 200
"""Largest ratio of the size of larger arrays to that of their file; noise of a sensor gives up to 20, zeros 1000."""


def read(path: Path, wanted: Wanted) -> Table:
    """Read all arrays of numbers that are as long as the time.

    Raises:
        DataError: no archive of arrays, one too large, no time, or arrays of other lengths or with values that are not
            finite; or of `wanted`.
    """
    try:
        names = _wanted_arrays(path)
        with np.load(path, allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in names}
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
        raise DataError(
            f"{path}: no array 'time'; found {', '.join(found) or 'none of one dimension'}; needed are {wanted.needed}"
        )
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


def _wanted_arrays(path: Path) -> list[str]:
    """Names of the arrays of one dimension, from their headers alone; the others are no channels and stay unread.

    Raises:
        DataError: the arrays would not fit into memory, or are packed as no measurement is.
    """
    names, size, packed = [], 0, 0
    with zipfile.ZipFile(path) as archive:
        for one in archive.infolist():
            with archive.open(one) as member:
                version = np.lib.format.read_magic(member)
                header = (
                    np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
                )
                shape, _, kind = header(member)
            if len(shape) == 1 or kind.kind in "US":
                names.append(one.filename.removesuffix(".npy"))
                size += max(math.prod(shape) * kind.itemsize, one.file_size)
                packed += one.compress_size
    if size > MEMORY_LIMIT:
        raise DataError(
            f"{path}: its arrays need {size / 1024**3:.3g} GiB of memory; allowed {MEMORY_LIMIT / 1024**3:.3g} GiB; "
            "cut the record into parts"
        )
    if size > FREELY and size > DENSEST * packed:
        raise DataError(
            f"{path}: {size / 1e6:.3g} MB are packed into {packed / 1e6:.3g} MB, {size / packed:.0f} to 1; allowed is "
            f"{DENSEST} to 1: its arrays hold hardly more than one value, which no sensor gives; record again"
        )
    return names


def write(path: Path, record: Record, frame: str) -> None:
    """Write a record, with its units and its frame as texts; arguments of
    `vehicle.signals.records.formats.write_record`.

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
