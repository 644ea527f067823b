"""Table in a file: an archive of arrays, or text."""

from __future__ import annotations

from pathlib import Path

from vehicle.signals.formats import npz_format, text_format
from vehicle.signals.formats.table import Table, Wanted


def read_table(path: Path, wanted: Wanted) -> Table:
    """Read a table from an archive of arrays or a text file.

    Args:
        path: table file.
        wanted: requirements on the columns.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: bad data; the message names line and column.
    """
    try:
        with path.open("rb") as file:
            archive = file.read(2) == b"PK"
    except OSError:
        archive = False  # the text reader reports the error
    return npz_format.read(path, wanted) if archive else text_format.read(path, wanted)
