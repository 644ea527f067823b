"""Finished rows of a sweep on disk: a line of JSON each, read again when the sweep is continued."""

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
    """File `rows.jsonl` of a sweep.

    Args:
        path: the file in an existing folder; existing rows are kept.

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
            raise OutputError(f"{path}: cannot be written: {error.strerror}; use another folder") from None

    def add(self, rows: Mapping[str, tuple[str, Result]]) -> None:
        """Append rows to the file and flush them to the disk.

        Args:
            rows: key to label and result.

        Raises:
            OutputError: the file cannot be written.
        """
        lines = []
        for key, (label, result) in rows.items():
            self.finished[key] = result
            # JSON writes floats with all digits, so rows read again are identical; NaN is written as NaN.
            row = {name: getattr(result, name) for name in FIELDS}
            lines.append(json.dumps({"key": key, "case": label, **row}) + "\n")
        try:
            self._file.write("".join(lines))
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise OutputError(
                f"{self.path}: cannot be written after {len(self.finished)} rows: {error.strerror}"
            ) from None

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _read(path: Path) -> dict[str, Result]:
    """Read the rows of a file by key; remove an incomplete last line from the file."""
    if not path.exists():
        return {}
    finished = {}
    content = path.read_bytes()
    whole, _, incomplete = content.rpartition(b"\n")
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
            raise DataError(
                f"{path}, line {number}: not a row of a sweep ({error}); start again with --force"
            ) from None
    if incomplete:
        with path.open("r+b") as file:
            file.truncate(len(content) - len(incomplete))
    return finished
