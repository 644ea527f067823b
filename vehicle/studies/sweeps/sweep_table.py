"""Table of a sweep: a row for each case, in the order of the cases."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.notebook.frames import table_frame
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.output.folder import write_json, write_text
from vehicle.signals.records.formats import recognised_format
from vehicle.signals.records.sheet_format import read_sheet_texts
from vehicle.signals.records.text_format import read_texts
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_result import Result

INPUT, ENGINE, REASON = "input", "engine", "failed because"
"""Heads of the columns without unit."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class SweepTable:
    """Table of a sweep: a row of values for each run.

    Attributes:
        cases: cases in the order of the rows.
        results: result of each case.
        units: name of each value to its unit.
        made: data that the rows depend on, for `sweep.json`.
    """

    cases: Sequence[Case]
    results: Sequence[Result]
    units: Mapping[str, str]
    made: Mapping[str, Any]

    def column(self, name: str) -> npt.NDArray[np.float64]:
        """Return the values of a column, NaN for a failed run; (cases,)."""
        if name not in self.units:
            raise ConfigurationError(f"no column {name!r}; choose from {', '.join(self.units)}")
        return np.array([result.values.get(name, math.nan) for result in self.results])

    @property
    def failed(self) -> list[tuple[Case, str]]:
        """Return the failed cases with their error messages."""
        pairs = zip(self.cases, self.results, strict=True)
        return [(case, result.reason) for case, result in pairs if result.reason]

    def paths(self) -> list[str]:
        """Return all modified parameter paths, in the order of first occurrence."""
        return list(dict.fromkeys(path for case in self.cases for path in changes(case)))

    def text(self) -> str:
        """Return the table as CSV, units in the header; bitwise identical for equal cases."""
        paths, file = self.paths(), io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([INPUT, *paths, *(f"{name} [{unit}]" for name, unit in self.units.items()), ENGINE, REASON])
        for case, result in zip(self.cases, self.results, strict=True):
            changed = changes(case)
            numbers = [repr(result.values[name]) if name in result.values else "" for name in self.units]
            writer.writerow(
                [case.source.name, *(changed.get(path, "") for path in paths), *numbers, result.engine, result.reason]
            )
        return file.getvalue()

    def __repr__(self) -> str:
        """Return the numbers of runs and of failed runs, and the columns, in a line."""
        return f"SweepTable({len(self.cases)} runs, {len(self.failed)} failed: {', '.join(self.units)})"

    def to_dataframe(self) -> Any:
        """Return the table in pandas: input, varied parameters, values with their units in the heads, engine, reason.

        Raises:
            MissingPartError: pandas is not installed.
        """
        return table_frame(self.text())

    def write(self, folder: Path, computed: str = "") -> None:
        """Write `table.csv`, `sweep.json` and `timing.csv`.

        Args:
            folder: folder of the files.
            computed: last line of `timing.csv`; empty for none.
        """
        text = self.text()
        write_text(folder / "table.csv", text)
        write_json(folder / "sweep.json", {**self.made, "failed": [case.label for case, _ in self.failed]})
        times = "case,seconds [s]\n" + "".join(f"{i},{r.seconds:.4f}\n" for i, r in enumerate(self.results))
        write_text(folder / "timing.csv", times + (f"# {computed}\n" if computed else ""))


def changes(case: Case) -> dict[str, str]:
    """Return parameter path to value text; the last value of a repeated path."""
    return {path: value for path, _, value in (text.partition("=") for text in case.overrides)}


def read_variations(path: Path) -> tuple[list[str], list[tuple[str, ...]]]:
    """Read parameter paths and rows of values from a table of variations.

    In the table of a sweep only the columns of parameters are read, and repeated rows only once.

    Raises:
        DataError: the file cannot be read, has no rows, has a repeated column, or a row with missing cells.
    """
    if not path.is_file():
        raise DataError(f"--table {path}: cannot be read: no such file, or not a file")
    try:
        header, *rows = (read_sheet_texts(path) if recognised_format(path).name == "xlsx" else read_texts(path)) or [[]]
    except DataError as error:
        raise DataError(f"--table {error}") from None
    if not rows:
        raise DataError(f"--table {path}: must have a header of parameter paths and at least one row of values")
    twice = sorted({cell for cell in header if header.count(cell) > 1})
    if twice:
        raise DataError(f"--table {path}: repeated column {', '.join(twice)}; remove the repetition")
    # The table of a sweep has further columns, which are not parameters.
    kept = [index for index, cell in enumerate(header) if cell not in (INPUT, ENGINE, REASON) and "[" not in cell]
    for number, row in enumerate(rows, start=1):
        if len(row) != len(header) or not all(row[index] for index in kept):
            raise DataError(
                f"--table {path}, row {number}: found {len(row)} cells, must be {len(header)} without empty cells"
            )
    values = [tuple(row[index] for index in kept) for row in rows]
    # The table of a sweep repeats every row on each input.
    return [header[index] for index in kept], list(dict.fromkeys(values)) if INPUT in header else values
