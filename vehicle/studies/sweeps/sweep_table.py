"""The result of a sweep: a row for each case, in the order of the cases."""

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
"""Columns beside the parameters and the numbers, whose heads have units."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class SweepTable:
    """Table of a sweep: a row of values for each run, and what they depend on.

    Attributes:
        cases: in the order they were given.
        results: one for each case.
        units: name of each number to its unit.
        made: what the rows depend on, for `sweep.json`.
    """

    cases: Sequence[Case]
    results: Sequence[Result]
    units: Mapping[str, str]
    made: Mapping[str, Any]

    def column(self, name: str) -> npt.NDArray[np.float64]:
        """Numbers of a column, NaN where a run failed; (cases,)."""
        if name not in self.units:
            raise ConfigurationError(f"no column {name!r}; the table has {', '.join(self.units)}")
        return np.array([result.values.get(name, math.nan) for result in self.results])

    @property
    def failed(self) -> list[tuple[Case, str]]:
        """Cases that failed, with their reasons."""
        pairs = zip(self.cases, self.results, strict=True)
        return [(case, result.reason) for case, result in pairs if result.reason]

    def paths(self) -> list[str]:
        """All parameter paths that are changed in some case, in the order of their first use."""
        return list(dict.fromkeys(path for case in self.cases for path in changes(case)))

    def text(self) -> str:
        """The table as CSV, units in the header; the same bytes for the same cases, whoever computed them."""
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
        """Return the number of runs and of failed ones in a line."""
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
            folder: where to.
            computed: last line of `timing.csv`, where there is one.
        """
        text = self.text()
        write_text(folder / "table.csv", text)
        write_json(folder / "sweep.json", {**self.made, "failed": [case.label for case, _ in self.failed]})
        times = "case,seconds [s]\n" + "".join(f"{i},{r.seconds:.4f}\n" for i, r in enumerate(self.results))
        write_text(folder / "timing.csv", times + (f"# {computed}\n" if computed else ""))


def changes(case: Case) -> dict[str, str]:
    """Return parameter path to value text; of a path that is changed twice the last."""
    return {path: value for path, _, value in (text.partition("=") for text in case.overrides)}


def read_variations(path: Path) -> tuple[list[str], list[tuple[str, ...]]]:
    """Parameter paths and rows of a table of variations; of the table of a sweep, the parameters, each row once.

    Raises:
        DataError: it cannot be read, has no rows, a column twice, or a row has another number of cells than the header.
    """
    if not path.is_file():
        raise DataError(f"--table {path}: cannot be read: no such file, or not a file")
    try:
        header, *rows = (read_sheet_texts(path) if recognised_format(path).name == "xlsx" else read_texts(path)) or [[]]
    except DataError as error:
        raise DataError(f"--table {error}") from None
    if not rows:
        raise DataError(f"--table {path}: needed are a header of parameter paths and at least one row of values")
    twice = sorted({cell for cell in header if header.count(cell) > 1})
    if twice:
        raise DataError(f"--table {path}: column {', '.join(twice)} stands there more than once; keep one of them")
    # Of a sweep's own table the columns that no parameter has.
    kept = [index for index, cell in enumerate(header) if cell not in (INPUT, ENGINE, REASON) and "[" not in cell]
    for number, row in enumerate(rows, start=1):
        if len(row) != len(header) or not all(row[index] for index in kept):
            raise DataError(
                f"--table {path}, row {number}: {len(row)} cells, the header has {len(header)}; none is empty"
            )
    found = [tuple(row[index] for index in kept) for row in rows]
    # A sweep has each of them on every input.
    return [header[index] for index in kept], list(dict.fromkeys(found)) if INPUT in header else found
