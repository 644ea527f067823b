"""Read measurements, tables and time histories from files of any registered format."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.clock import check_increasing, check_stamps, check_uniform, without_rounding
from vehicle.signals.formats.file_digest import digest
from vehicle.signals.formats.formats import recognised_format
from vehicle.signals.formats.mixed_sources import check_cycles
from vehicle.signals.formats.shipped_record import find_record
from vehicle.signals.formats.table import TIME, Record, Wanted, key_column, name_and_unit
from vehicle.signals.formats.table_file import read_table

MINIMUM_SAMPLES = 3
"""Minimum number of samples of a record: two give the step, the third shows that the step is uniform."""


def read_record(path: str | Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read all channels of a measurement file.

    Args:
        path: measurement file of any format of `vehicle.signals.formats.formats`, or the name of a shipped record.
        databases: DBC files that decode the log of a CAN bus.

    Returns:
        Channels with names, units and times, mode shapes and geometry, in the units of the file.

    Raises:
        ConfigurationError: the file does not exist, or databases are passed for a file other than a bus log.
        DataError: an unsupported format, or a damaged file.
        MissingPartError: a library of the format is not installed; the message names the extra.
    """
    file = find_record(path)
    recognised = recognised_format(file)
    if databases and not recognised.databases:
        raise ConfigurationError(
            f"{path}: is a file of the format {recognised.name}, but --dbc decodes logs of a CAN bus (MDF, "
            "BLF, .asc, .trc, candump); leave --dbc out"
        )
    read = recognised.function("reader", "read")
    measurement: Measurement = read(file, databases) if databases else read(file)
    check_cycles(measurement)
    return measurement if measurement.sha256 else replace(measurement, sha256=digest(file))


def read(file: str | Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read all channels of a measurement file of any format, or of the folder of a run.

    Args:
        file: measurement file, or the folder of a run, whose time histories are read.
        databases: see `read_record`.

    Returns:
        Channels with names, units and times; `read(file)["Seat Z"]` is one of them.
    """
    return read_record(time_file(Path(file)), databases)


def is_table(path: Path) -> bool:
    """Return True for a file in a table format; also for a missing file, which `read_table` reports."""
    return not path.is_file() or bool(recognised_format(path).table)


def read_columns(path: Path, needed: str = "'time [s]' and '<channel> [<unit>]'") -> Record:
    """Read a record: a table with a uniform column `time [s]`.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: the file is not a record; the message names line and column.
    """
    table = read_table(path, Wanted(needed=needed, key=key_column(TIME, needed)))
    channels: dict[str, Vector] = {}
    units = {}
    for index, cell in enumerate(table.header.cells):
        name, unit = name_and_unit(cell)
        if name in channels:
            raise DataError(f"{table.header.where}: column {name!r} appears twice; rename or remove one of them")
        channels[name], units[name] = table.values[:, index], unit or ""
    time, _ = channels.pop("time"), units.pop("time")
    if time.size < MINIMUM_SAMPLES:
        raise DataError(f"{path}: contains {time.size} samples, but at least {MINIMUM_SAMPLES} are needed")
    check_stamps(path, time)
    check_increasing(table, time)
    uniform, notices = without_rounding(time)
    check_uniform(table, uniform)
    return Record(time=uniform, channels=channels, units=units, notices=(*table.notices, *notices))


def time_file(run: Path) -> Path:
    """Return the file of the time histories of a run: the path itself, or `time.npz` or `time.csv` in a folder."""
    if not run.is_dir():
        return run
    for name in ("time.npz", "time.csv"):
        if (run / name).is_file():
            return run / name
    raise ConfigurationError(f"{run}: contains no time.npz or time.csv; give the folder of a run, or a file")
