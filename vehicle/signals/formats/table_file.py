"""Table in a file: an archive of arrays, or text."""

from pathlib import Path

from vehicle.signals.formats import csv_table, npz_format
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.table import TIME, Table, Wanted, key_column, name_and_unit


def read_table(path: Path, wanted: Wanted) -> Table:
    """Read a table from an archive of arrays or a text file."""
    try:
        with path.open("rb") as file:
            archive = file.read(2) == b"PK"
    except OSError:
        archive = False  # the text reader reports the error
    return npz_format.read(path, wanted) if archive else csv_table.read(path, wanted)


def read(path: Path) -> Measurement:
    """Read the array `time` of an archive and all arrays of its length as channels; see `npz_format.read`."""
    needed = "'time', and one array per channel"
    table = npz_format.read(path, Wanted(needed=needed, key=key_column(TIME, needed)))
    time = table.values[:, table.key]
    channels = []
    for index, cell in enumerate(table.header.cells):
        name, unit = name_and_unit(cell)
        if index != table.key:
            channels.append(Channel(name=name, unit=unit or "", values=table.values[:, index], axis=time))
    return Measurement(path=path, format="npz", channels=tuple(channels), sha256=table.sha256, notices=table.notices)
