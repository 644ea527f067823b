"""The way into files: measurements, tables and time histories of any registered format."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError, DataError, MissingPartError
from vehicle.signals.records.channel import Measurement
from vehicle.signals.records.clock import check_increasing, check_uniform, without_rounding
from vehicle.signals.records.formats import BY_NAME, recognised_format
from vehicle.signals.records.table import TIME, Record, Table, Vector, Wanted, key_column, name_and_unit

MINIMUM_SAMPLES = 3
"""Of a record: two samples give the step, the third shows that it is uniform."""


def read_record(path: str | Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read all channels of a measurement file.

    Args:
        path: the file, of any format of `vehicle.signals.records.formats`.
        databases: DBC files, which decode the log of a CAN bus.

    Returns:
        Channels with names, units and times, mode shapes and geometry, in the units of the file.

    Raises:
        ConfigurationError: there is no such file, or databases are given for another kind of file.
        DataError: a format that is not read, or a damaged file.
        MissingPartError: the format needs a library that is not installed; the message names the extra.
    """
    file = Path(path)
    recognised = recognised_format(file)
    if databases and not recognised.databases:
        raise ConfigurationError(
            f"{path}: --dbc decodes the log of a CAN bus (MDF, .asc, .trc, candump); it is {recognised.name}"
        )
    read = recognised.function("reader", "read")
    measurement: Measurement = read(file, databases) if databases else read(file)
    return measurement


def is_table(path: Path) -> bool:
    """Return True for a file with a table of our own format, or none at all: the reader of text reports that."""
    return not path.is_file() or bool(recognised_format(path).table)


def read_table(path: Path, wanted: Wanted) -> Table:
    """Read a table: an archive of arrays, or text.

    Args:
        path: the file.
        wanted: requirements on its columns.

    Raises:
        ConfigurationError: there is no such file.
        DataError: bad data; the message names the place.
    """
    try:
        with path.open("rb") as file:
            archive = file.read(2) == b"PK"
    except OSError:
        archive = False  # the reader of text reports the error
    table: Table = BY_NAME["npz" if archive else "csv"].function("table", "read")(path, wanted)
    return table


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
    if time.size < MINIMUM_SAMPLES:
        raise DataError(f"{path}: {time.size} samples, at least {MINIMUM_SAMPLES} are needed")
    check_increasing(table, time)
    uniform, notices = without_rounding(time)
    check_uniform(table, uniform)
    return Record(time=uniform, channels=channels, units=units, notices=(*table.notices, *notices))


def extra(package: str, name: str, what: str) -> Any:
    """Import a library of an extra.

    Args:
        package: to be imported.
        name: of the extra.
        what: the format, for the message.

    Raises:
        MissingPartError: the library is not installed.
    """
    try:
        return import_module(package)
    except ImportError:
        raise MissingPartError(
            f"{what} needs {package}, which is not installed; install it with: pip install 'vehicle-on-shaker[{name}]'"
        ) from None


def digest(path: Path) -> str:
    """SHA-256 of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
