"""Finished rows on disk: one line of JSON each, written as they arrive, read again when a sweep goes on."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

from vehicle.errors import DataError, OutputError
from vehicle.runs.output.written_files import note
from vehicle.studies.sweeps.case_result import Result

ROWS = "rows.jsonl"

FIELDS = tuple(field.name for field in fields(Result))


class Store:
    """The file `rows.jsonl` of a sweep.

    Args:
        path: the file; its folder must exist. Lines that are there are kept.

    Raises:
        DataError: a line in the middle of the file is damaged.
        OutputError: the file cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.finished = _read(path)
        try:
            note(path)
            self._file = path.open("a", encoding="utf-8")
        except OSError as error:
            raise OutputError(f"{path}: cannot be written: {error.strerror}; give another folder") from None

    def add(self, rows: Mapping[str, tuple[str, Result]]) -> None:
        """Keep rows, key to label and result; when this returns they are on the disk.

        Raises:
            OutputError: the disk refuses it.
        """
        lines = []
        for key, (label, result) in rows.items():
            self.finished[key] = result
            # JSON writes a float with all its digits, so that a row read again is the same row; NaN is its own word.
            row = {name: getattr(result, name) for name in FIELDS}
            lines.append(json.dumps({"key": key, "case": label, **row}) + "\n")
        try:
            self._file.write("".join(lines))
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise OutputError(f"{self.path}: cannot be written: {error.strerror}; {len(self.finished)} rows") from None

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _read(path: Path) -> dict[str, Result]:
    """Rows of a file by key; a last line that was cut off in the middle is dropped, and cut from the file."""
    if not path.exists():
        return {}
    finished = {}
    content = path.read_bytes()
    whole, _, rest = content.rpartition(b"\n")
    for number, line in enumerate(whole.split(b"\n") if whole else [], start=1):
        try:
            row = json.loads(line)
            key = str(row["key"])
            finished[key] = Result(
                values={str(name): float(value) for name, value in row["values"].items()},
                engine=str(row["engine"]),
                reason=str(row["reason"]),
                seconds=float(row["seconds"]),
            )
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise DataError(f"{path}, line {number}: not a row of a sweep ({error}); start anew with --force") from None
    if rest:
        with path.open("r+b") as file:
            file.truncate(len(content) - len(rest))
    return finished
