"""What every format hands over: a table with named columns and the places of its rows; and a record made of it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.signals.analysis import samples

Vector = NDArray[np.float64]

TIME = "time [s]"
"""Head of the column of sample times."""

USABLE = samples.USABLE
"""Highest frequency that a record holds, as a share of its sampling rate [-]."""

_HEAD = re.compile(r"(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")


@dataclass(frozen=True, kw_only=True, slots=True)
class Header:
    """The heads of the columns.

    Attributes:
        path: the file.
        line: of the header, from 1; 0 in a file without lines.
        cells: heads as written, units included.
        delimiter: between the cells of a row.
    """

    path: Path
    line: int
    cells: tuple[str, ...]
    delimiter: str = ","

    @property
    def where(self) -> str:
        """Its place, for messages."""
        return f"{self.path}:{self.line}" if self.line else str(self.path)

    @property
    def found(self) -> str:
        """The heads, for messages."""
        return ", ".join(map(repr, self.cells))


@dataclass(frozen=True, kw_only=True, slots=True)
class Wanted:
    """What the reader of a table asks for.

    Attributes:
        needed: the columns in words, for messages.
        key: looks at the header before any row is read; returns the index of the column that no row may leave empty.
        missing: what to do about a missing value: "refuse" it; "fill": NaN, for those that will be filled in, so that
            no column may end before the others; "empty": NaN for an empty cell, the form of an undefined value;
            "mark": NaN for every missing value.
        remedy: for a missing value, for messages.
    """

    needed: str
    key: Callable[[Header], int]
    missing: Literal["refuse", "fill", "empty", "mark"] = "refuse"
    remedy: str = "repair the cell or cut the record"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Table:
    """The columns.

    Attributes:
        header: their heads.
        key: index of the time or frequency.
        values: as written, without conversion of units, (rows, columns); NaN where `Wanted.missing` allows it.
        lines: line of the file of each row, (rows,); its number from 1 in a file without lines.
        notices: what was accepted although it is unusual.
        sha256: hexadecimal digest of the bytes of the file.
    """

    header: Header
    key: int
    values: Vector
    lines: NDArray[np.int64]
    notices: tuple[str, ...]
    sha256: str

    def row(self, row: int) -> str:
        """A row in words."""
        return f"{'line' if self.header.line else 'sample'} {self.lines[row]}"

    def place(self, row: int) -> str:
        """Where a row stands, for messages."""
        return f"{self.header.path}:" + (f"{self.lines[row]}" if self.header.line else f" {self.row(row)}")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Record:
    """Channels over uniform time.

    Attributes:
        time: of the samples [s], (n,).
        channels: name to samples, (n,) each, in the order of the file and in the units as found.
        units: name to unit; empty where the file tells none.
        notices: what was accepted although it is unusual.
        highest: highest frequency that a resampled record holds [Hz]; None for 0.4 of its rate.

    Raises:
        DataError: a channel of another length, or with a value that is not finite.
    """

    time: Vector
    channels: Mapping[str, Vector]
    units: Mapping[str, str]
    notices: tuple[str, ...] = ()
    highest: float | None = None

    def __post_init__(self) -> None:
        for name, values in self.channels.items():
            if values.shape != self.time.shape or not np.isfinite(values).all():
                raise DataError(
                    f"record: {name} has {values.size} samples for {self.time.size} times, or one that is not finite; "
                    "repair or cut the record"
                )

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
        """Highest frequency that the samples hold [Hz]."""
        own = USABLE / self.step
        return own if self.highest is None else min(self.highest, own)


def name_and_unit(cell: str) -> tuple[str, str | None]:
    """Name and unit of the head of a column; None where it has no brackets, the whole text where they make no sense."""
    match = _HEAD.fullmatch(cell)
    return (match["name"], None if match["unit"] is None else match["unit"].strip()) if match else (cell, None)


def key_column(cell: str, needed: str) -> Callable[[Header], int]:
    """The check of a header whose heads are all different and hold a given one.

    Args:
        cell: head of the key column.
        needed: the columns in words, for messages.

    Returns:
        For `Wanted.key`; it raises DataError.
    """

    def check(header: Header) -> int:
        twice = next((name for name in header.cells if header.cells.count(name) > 1), None)
        if twice is not None:
            raise DataError(f"{header.where}: column {twice!r} appears twice; each may appear once")
        if cell not in header.cells:
            shown = ", ".join(map(repr, header.cells[:8]))
            raise DataError(f"{header.where}: no column {cell!r}; found {shown}; needed are {needed}")
        return header.cells.index(cell)

    return check
