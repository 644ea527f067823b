"""Table of a sweep: a row for each case, in the order of the cases."""

import html
import io
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from vehicle.arrays import Vector
from vehicle.drawing.notebook.frames import table_frame
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.output.folder import check_file, write_text
from vehicle.signals.formats.csv_table import RowWriter, read_texts
from vehicle.signals.formats.formats import recognised_format
from vehicle.signals.formats.sheet_format import read_sheet_texts
from vehicle.studies.sweeps.case import Case, parameter_cells
from vehicle.studies.sweeps.case_result import Result, Row
from vehicle.studies.sweeps.store import StoredRows
from vehicle.studies.sweeps.sweep_ranking import ranked_cars, ranking_lines
from vehicle.wording import choose_from

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

    def column(self, name: str) -> Vector:
        """Return the values of a column, NaN for a failed run; (cases,)."""
        if name not in self.units:
            raise ConfigurationError(f"no column {name!r}{choose_from(name, self.units)}")
        return np.array([result.values.get(name, math.nan) for result in self.results])

    @property
    def failed(self) -> list[tuple[Case, str]]:
        """Return the failed cases with their error messages."""
        if isinstance(self.results, StoredRows):
            numbers = np.flatnonzero(self.results.failed).tolist()
        else:
            numbers = [number for number, result in enumerate(self.results) if result.reason]
        return [(self.cases[number], self.results[number].reason) for number in numbers]

    def paths(self) -> list[str]:
        """Return all modified parameter paths, in the order of first occurrence."""
        return list(dict.fromkeys(text.partition("=")[0] for case in self.cases for text in case.overrides))

    def text(self) -> str:
        """Return the table as CSV, units in the header; bitwise identical for equal cases."""
        file = io.StringIO()
        paths = self.paths()
        writer = TableWriter(file, paths, self.units)
        for case, row in zip(self.cases, self.rows(), strict=True):
            writer.add(case, parameter_cells(case, paths), row)
        return file.getvalue()

    def rows(self) -> Iterator[Row]:
        """Return the rows with numbers as texts of all digits, which need no conversion; read when they are used."""
        if isinstance(self.results, StoredRows):
            numbers_as_texts = json.JSONDecoder(parse_float=str)
            for line in self.results.rows():
                row = numbers_as_texts.decode(line.decode())
                if b"null" in line:
                    row["values"] = {name: "nan" if text is None else text for name, text in row["values"].items()}
                yield row
        else:
            for result in self.results:
                texts = {name: repr(value) for name, value in result.values.items()}
                yield {
                    "values": texts,
                    "engine": result.engine,
                    "reason": result.reason,
                    "seconds": repr(result.seconds),
                }

    def __repr__(self) -> str:
        """Return the numbers of runs and of failed runs, and the varied parameters, in a line."""
        return f"SweepTable({len(self.cases)} runs, {len(self.failed)} failed: {', '.join(self.paths())})"

    def __str__(self) -> str:
        """Return the cars in the order of comfort, as the console shows them; without comfort, the line of `repr`."""
        cars = ranked_cars(self)
        return repr(self) if cars is None else "\n".join(ranking_lines(cars))

    def plot(self, ax: Any = None) -> Any:
        """Plot comfort over the varied parameters: a line for one, a map for two, parallel axes for more.

        Args:
            ax: the axes; a new figure by default.

        Returns:
            The axes.

        Raises:
            ConfigurationError: fewer than two cars have comfort values, or a varied value is no number.
        """
        from vehicle.studies.sweeps.sweep_picture import plotted

        return plotted(ranked_cars(self), ax)

    def report(self, file: Path | str, *, force: bool = False, author: str = "", project: str = "") -> Path:
        """Write the report of the sweep as one HTML file: best and base car, picture, tables.

        Args:
            file: name of the report, with the ending .html.
            force: replace a report that was written there before.
            author, project: names in the head of the report; may be empty.

        Raises:
            ConfigurationError: another ending, or a file that exists without `force`.
            OutputError: the file cannot be written.
        """
        from vehicle.studies.sweeps.comfort_ranking import ranking_evaluation
        from vehicle.studies.sweeps.sweep_page import sweep_page

        path = Path(file)
        check_file(path, ending=".html", force=force)
        evaluated = f"evaluated from {self.made.get('evaluated_from_s') or 0:g} s on"
        name = ", ".join(self.made.get("vehicles", ("car",)))
        evaluation = ranking_evaluation(self, evaluated)
        page = sweep_page(self, evaluation, name, caption=evaluated, author=author, project=project)
        write_text(path, page)
        return path

    def _repr_html_(self) -> str:
        """Return the cars in the order of comfort for a notebook."""
        return f"<pre>{html.escape(str(self))}</pre>"

    def to_dataframe(self) -> Any:
        """Return the table in pandas: input, varied parameters, values with their units in the heads, engine, reason.

        Raises:
            MissingPartError: pandas is not installed.
        """
        return table_frame(self.text())


class _Returned:
    """File for the csv module whose rows are the return values of the writer."""

    def write(self, text: str) -> str:
        return text


class TableWriter:
    """Writes a table of a sweep as CSV, row by row, units in the header.

    Args:
        paths: the modified parameter paths of all cases.
        units: name of each value to its unit.
    """

    def __init__(self, file: TextIO, paths: Sequence[str], units: Mapping[str, str]) -> None:
        self.names, self._file = list(units), file
        self._texts = RowWriter(_Returned())
        heads = (f"{name} [{unit}]" for name, unit in units.items())
        RowWriter(file).writerow([INPUT, *paths, *heads, ENGINE, REASON])

    def add(self, case: Case, parameters: Sequence[str], row: Row) -> None:
        """Write the row of a case; `parameters` are its values, see `parameter_cells`."""
        # The csv module takes 10 us for 25 numbers, in which it looks for commas; only texts may contain a comma.
        values = row["values"]
        numbers = "".join([f"{values.get(name, '')}," for name in self.names])
        begin = self._texts.writerow([case.source.name, *parameters, ""])[:-1]
        self._file.write(f"{begin}{numbers}{self._texts.writerow([row['engine'], row['reason']])}")


def read_variations(path: Path) -> tuple[list[str], list[tuple[str, ...]]]:
    """Read parameter paths and rows of values from a table of variations.

    In the table of a sweep only the columns of parameters are read, and repeated rows only once.
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
