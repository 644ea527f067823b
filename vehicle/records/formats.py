"""The one way to tables and records in files. A format is a module with `read` and `write`, and a line in `FORMATS`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import DataError
from vehicle.records import npz_format, text_format
from vehicle.records.clock import check_increasing, check_uniform, without_rounding
from vehicle.records.reader import recognise
from vehicle.records.table import TIME, Record, Table, Vector, Wanted, key_column, name_and_unit

LEAST_SAMPLES = 3
"""Of a record: two tell a step, the third that it is uniform."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Format:
    """A kind of file.

    Attributes:
        begins: first bytes of its files; none for the format of all others.
        read: the table of a file, refused with the place of what is wrong.
        write: a record, with the axes of its vectors in words.
    """

    begins: bytes
    read: Callable[[Path, Wanted], Table]
    write: Callable[[Path, Record, str], None]


FORMATS = {
    "npz": Format(begins=b"PK", read=npz_format.read, write=npz_format.write),
    "csv": Format(begins=b"", read=text_format.read, write=text_format.write),
}
"""Name of a format, which is the ending of its files, and the format; files are recognised by what they hold."""


def is_table(path: Path) -> bool:
    """Whether a file is of a format of this module; one that is not there counts as one, its reader says so."""
    return not path.is_file() or recognise(path) in FORMATS


def read_table(path: Path, wanted: Wanted) -> Table:
    """Read a table of any format.

    Args:
        path: the file.
        wanted: what is asked of it.

    Raises:
        ConfigurationError: there is no such file.
        DataError: bad data; the message names the place.
    """
    try:
        with path.open("rb") as file:
            head = file.read(8)
    except OSError:
        head = b""  # the reader of text says what is wrong
    return next(one for one in FORMATS.values() if head.startswith(one.begins)).read(path, wanted)


def read_columns(path: Path, needed: str = "'time [s]' and '<channel> [<unit>]'") -> Record:
    """Read a record: a table with a column `time [s]` that is uniform.

    Args:
        path: the file.
        needed: the columns in words, for messages.

    Raises:
        ConfigurationError: there is no such file.
        DataError: it holds no record; the message names the place.
    """
    table = read_table(path, Wanted(needed=needed, key=key_column(TIME, needed)))
    channels: dict[str, Vector] = {}
    units = {}
    for index, cell in enumerate(table.header.cells):
        name, unit = name_and_unit(cell)
        if name in channels:
            raise DataError(f"{table.header.where}: column {name!r} appears twice; each may appear once")
        channels[name], units[name] = table.values[:, index], unit or ""
    time, _ = channels.pop("time"), units.pop("time")
    if time.size < LEAST_SAMPLES:
        raise DataError(f"{path}: {time.size} samples, at least {LEAST_SAMPLES} are needed")
    check_increasing(table, time)
    uniform, notices = without_rounding(time)
    check_uniform(table, uniform)
    return Record(time=uniform, channels=channels, units=units, notices=(*table.notices, *notices))
