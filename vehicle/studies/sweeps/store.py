"""Rows of a sweep in a file: appended as their tasks finish, found by the number of the case, used again later.

The process of a sweep holds only the position of each row in the file (16 byte a case). The file is open only while it
is written or read: Windows moves no folder with an open file. Without a folder the file is a temporary one.
"""

import os
import tempfile
import time as clock
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Literal

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Indices, Mask
from vehicle.errors import OutputError
from vehicle.leftovers import say
from vehicle.runs.output.written_files import note
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_keys import KEY_DIGITS
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.lazy_sequence import LazySequence

ROWS = "rows.jsonl"

SYNCHRONISED_S = 1.0
"""Maximum age of rows that a loss of power takes [s]. A flush to the disk takes milliseconds, as long as many blocks of
a large cluster; rows survive the death of the process without it."""

BEGINNING = b'{"key": "'
"""Beginning of a row, before its key."""


class StoredRows(LazySequence[Result]):
    """Results of the cases of a sweep, read from the file when they are used.

    Args:
        path: `rows.jsonl` in an existing folder, whose rows are kept; None for a temporary file.
        count: number of cases.

    Attributes:
        failed: True for each case with a row of a failed run; (count,).
    """

    def __init__(self, path: Path | None, count: int) -> None:
        self.path = path
        try:
            if path is not None:
                note(path)
            self._temporary = tempfile.TemporaryFile(buffering=0) if path is None else None  # noqa: SIM115
            if self._temporary is not None:
                weakref.finalize(self, self._temporary.close)
            with self._opened("ab") as file:
                self._end = file.seek(0, os.SEEK_END)
        except OSError as error:
            raise OutputError(
                f"{path or tempfile.gettempdir()}: cannot be written: {error.strerror}; use another folder"
            ) from None
        self._synchronised = clock.monotonic()
        self._start = np.zeros(count, dtype=np.int64)
        self._length = np.zeros(count, dtype=np.int32)
        self.failed = np.zeros(count, dtype=bool)

    @contextmanager
    def _opened(self, mode: Literal["rb", "ab"]) -> Iterator[BinaryIO]:
        """Yield the file without a buffer; mode: see `open`."""
        if self._temporary is not None:
            yield self._temporary
            return
        assert self.path is not None
        with self.path.open(mode, buffering=0) as file:
            yield file

    @property
    def stored(self) -> Mask:
        """Return True for each case with a row; (count,)."""
        return self._length > 0

    def use_stored(self, cases: Sequence[Case], key_of: Callable[[Case], str]) -> None:
        """Find the rows of cases among those that the file already contains; remove an incomplete last line.

        A damaged line is skipped with a notice, and its run is repeated.

        Args:
            key_of: function that returns the key of a case.
        """
        if not self._end:
            return
        keys, starts, lengths, failed = self._read()
        if not len(keys):
            return
        # The last row of a key counts: a failed run may have been computed again.
        order = np.argsort(keys, kind="stable")
        last = order[np.append(keys[order[1:]] != keys[order[:-1]], True)]
        keys, starts, lengths, failed = keys[last], starts[last], lengths[last], failed[last]
        for number, case in enumerate(cases):
            key = key_of(case).encode()
            row = int(np.searchsorted(keys, key))
            if row < len(keys) and keys[row] == key:
                self._start[number], self._length[number] = starts[row], lengths[row]
                self.failed[number] = failed[row]

    def append(self, numbers: Indices, block: Block) -> None:
        """Append the rows of cases to the file."""
        ends = np.flatnonzero(np.frombuffer(block.rows, dtype=np.uint8) == ord("\n")) + 1
        starts = np.concatenate([[0], ends[:-1]])
        try:
            remaining = memoryview(block.rows)
            with self._opened("ab") as file:
                file.seek(0, os.SEEK_END)
                while remaining:
                    remaining = remaining[file.write(remaining) :]
            if self.path is not None and clock.monotonic() - self._synchronised > SYNCHRONISED_S:
                self.synchronise()
        except OSError as error:
            raise OutputError(
                f"{self.path or tempfile.gettempdir()}: cannot be written after {np.count_nonzero(self.stored)} rows: "
                f"{error.strerror}; free space there" + ("" if self.path is None else " and continue with --resume")
            ) from None
        self._start[numbers], self._length[numbers] = self._end + starts, ends - starts
        self.failed[numbers] = False
        self.failed[numbers[list(block.failed)]] = True
        self._end += len(block.rows)

    def synchronise(self) -> None:
        """Flush the rows to the disk."""
        with self._opened("ab") as file:
            os.fsync(file.fileno())
        self._synchronised = clock.monotonic()

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self._length)

    def item(self, number: int) -> Result:
        """Return the result of a case."""
        return Result.read(self.row(number))

    def __iter__(self) -> Iterator[Result]:
        """Return the results in the order of the cases."""
        return map(Result.read, self.rows())

    def row(self, number: int) -> bytes:
        """Return the row of a case, a line of JSON."""
        with self._opened("rb") as file:
            return self._row(file, number)

    def rows(self) -> Iterator[bytes]:
        """Return the rows in the order of the cases, each a line of JSON."""
        with self._opened("rb") as file:
            for number in range(len(self)):
                yield self._row(file, number)

    def _row(self, file: BinaryIO, number: int) -> bytes:
        file.seek(int(self._start[number]))
        return file.read(int(self._length[number]))

    def _read(self) -> tuple[npt.NDArray[np.bytes_], Indices, Indices, Mask]:
        """Return key, position, length and failure of all whole rows in the file; remove an incomplete last line."""
        keys, starts, lengths, failed = bytearray(), [], [], []
        position = 0
        damaged: list[str] = []
        assert self.path is not None  # a temporary file has no rows yet
        with self.path.open("r+b") as file:
            for number, line in enumerate(file, start=1):
                if not line.endswith(b"\n"):
                    file.truncate(position)
                    break
                try:
                    reason = Result.read(line).reason
                    key = line[len(BEGINNING) :][:KEY_DIGITS]
                    if not line.startswith(BEGINNING) or len(key.split(b'"')[0]) != KEY_DIGITS:
                        raise ValueError("no key")
                except ValueError as error:
                    damaged.append(f"line {number} ({error})")
                else:
                    failed.append(bool(reason))
                    keys += key
                    starts.append(position)
                    lengths.append(len(line))
                position += len(line)
        if damaged:
            say(
                f"{self.path}: {len(damaged)} damaged rows, the first in {damaged[0]}; these runs are repeated, "
                f"{len(starts)} whole rows are kept"
            )
        self._end = position
        return (
            np.frombuffer(bytes(keys), dtype=f"S{KEY_DIGITS}"),
            np.array(starts, dtype=np.intp),
            np.array(lengths, dtype=np.intp),
            np.array(failed, dtype=bool),
        )
