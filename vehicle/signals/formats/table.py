"""Tables with named columns, as returned by the readers of table formats, and records over uniform time."""

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.mapped_table import release
from vehicle.signals.analysis import samples

TIME = "time [s]"
"""Header of the column of sample times."""

USABLE = samples.USABLE
"""Maximum usable frequency of a record over its sampling rate [-]."""

_HEAD = re.compile(r"(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")


@dataclass(frozen=True, kw_only=True, slots=True)
class Header:
    """Column headers of a table.

    Attributes:
        path: table file.
        line: line number of the header, from 1; 0 in a file without lines.
        cells: column headers in the file, including units.
        delimiter: delimiter of the cells of a row.
    """

    path: Path
    line: int
    cells: tuple[str, ...]
    delimiter: str = ","

    @property
    def where(self) -> str:
        """File and line of the header, for messages."""
        return f"{self.path}:{self.line}" if self.line else str(self.path)

    @property
    def found(self) -> str:
        """List of the column headers, for messages."""
        return ", ".join(map(repr, self.cells))


@dataclass(frozen=True, kw_only=True, slots=True)
class Wanted:
    """Requirements on a table.

    Attributes:
        needed: description of the required columns, for messages.
        key: function that checks the header and returns the index of the column without missing values.
        missing: treatment of a missing value: "refuse": error; "fill": NaN, for later interpolation, but all columns
            must have equal length; "empty": NaN for an empty cell (undefined value), error for other texts; "mark":
            NaN for all missing values.
        remedy: remedy for a missing value, for messages.
        columns: function from the header to the indices of the columns that are used; NaN for a text in another one.
            None for all columns.
    """

    needed: str
    key: Callable[[Header], int]
    missing: Literal["refuse", "fill", "empty", "mark"] = "refuse"
    remedy: str = "correct the cell or cut the record"
    columns: Callable[[Header], Collection[int]] | None = None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Table:
    """Table of numbers.

    Attributes:
        header: column headers.
        key: index of the column of times or frequencies.
        values: numbers in the units of the file, (rows, columns); NaN for missing values if `Wanted.missing` allows.
        lines: line number of each row, (rows,); row number from 1 in a file without lines.
        notices: messages on unusual content that was accepted.
        sha256: hexadecimal digest of the bytes of the file.
    """

    header: Header
    key: int
    values: Vector
    lines: NDArray[np.int64]
    notices: tuple[str, ...]
    sha256: str

    def row(self, row: int) -> str:
        """Return the name of a row for messages: "line 7"."""
        return f"{'line' if self.header.line else 'sample'} {self.lines[row]}"

    def place(self, row: int) -> str:
        """Return file and line of a row, for messages."""
        return f"{self.header.path}:" + (f"{self.lines[row]}" if self.header.line else f" {self.row(row)}")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Record:
    """Channels over uniform time.

    Attributes:
        time: sample times [s], (n,).
        channels: channel name to samples, (n,), in the order and units of the file.
        units: channel name to unit; empty if unknown.
        notices: messages on unusual content that was accepted.
        highest: maximum usable frequency of a resampled record [Hz]; None for 0.4 times its rate.
    """

    time: Vector
    channels: Mapping[str, Vector]
    units: Mapping[str, str]
    notices: tuple[str, ...] = ()
    highest: float | None = None

    def __post_init__(self) -> None:
        for name, values in self.channels.items():
            if values.shape != self.time.shape:
                raise DataError(
                    f"record: {name} has {values.size} samples, but the time {self.time.size}; store equally many"
                )
            if not np.isfinite(values).all():
                raise DataError(f"record: {name} contains NaN or infinity; correct the record, or cut this part out")
            release(values)

    @property
    def start(self) -> float:
        """Time of the first sample [s]."""
        return float(self.time[0])

    @property
    def step(self) -> float:
        """Sampling interval [s]."""
        return float(self.time[-1] - self.time[0]) / (self.time.size - 1)

    @property
    def usable(self) -> float:
        """Maximum usable frequency [Hz]."""
        limit = USABLE / self.step
        return limit if self.highest is None else min(self.highest, limit)


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """Split a column header into name and unit; unit None without brackets or with unbalanced brackets."""
    match = _HEAD.fullmatch(cell)
    return (match["name"], None if match["unit"] is None else match["unit"].strip()) if match else (cell, None)


def key_column(cell: str, needed: str) -> Callable[[Header], int]:
    """Return a function for `Wanted.key`: it checks for unique headers and finds the key column.

    Returns:
        Function from a header to the index of the key column; it raises DataError for other headers.
    """

    def check(header: Header) -> int:
        twice = next((name for name in header.cells if header.cells.count(name) > 1), None)
        if twice is not None:
            raise DataError(f"{header.where}: column {twice!r} appears twice; rename or remove one of them")
        if cell not in header.cells:
            shown = ", ".join(map(repr, header.cells[:8]))
            raise DataError(f"{header.where}: column {cell!r} is missing; expected {needed}, found {shown}")
        return header.cells.index(cell)

    return check
