"""Read the `.npz` file of a run as a `Measurement`."""

from __future__ import annotations

from pathlib import Path

from vehicle.signals.formats import npz_format
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.table import TIME, Wanted, key_column, name_and_unit


def read(path: Path) -> Measurement:
    """Read the array `time` and all arrays of its length as channels.

    Raises:
        DataError: see `vehicle.signals.formats.npz_format.read`.
    """
    needed = "'time', and one array per channel"
    table = npz_format.read(path, Wanted(needed=needed, key=key_column(TIME, needed)))
    time = table.values[:, table.key]
    channels = []
    for index, cell in enumerate(table.header.cells):
        name, unit = name_and_unit(cell)
        if index != table.key:
            channels.append(Channel(name=name, unit=unit or "", values=table.values[:, index], axis=time))
    return Measurement(path=path, format="npz", channels=tuple(channels), sha256=table.sha256, notices=table.notices)
