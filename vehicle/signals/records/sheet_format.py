"""Sheets of XLSX files: read as the table of a logger."""

from __future__ import annotations

from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.records.channel import Measurement
from vehicle.signals.records.logger_format import read_lines
from vehicle.signals.records.reader import digest, extra
from vehicle.signals.records.text import Text


def read(path: Path) -> Measurement:
    """Read the first sheet that holds a table of numbers.

    Raises:
        MissingPartError: openpyxl is not installed.
        DataError: damaged, or without such a table.
    """
    sheets = _sheets(path)
    told: DataError | None = None
    for title, cells in sheets.items():
        body = "\n".join(_row(row) for row in cells)
        notice = () if len(sheets) == 1 else (f"sheet {title!r} of {len(sheets)}",)
        try:
            return read_lines(path, Text(body=body, notices=notice, sha256=digest(path)), "xlsx")
        except DataError as error:
            told = told or error
    raise told or DataError(f"{path}: no sheet; save it again")


def _sheets(path: Path) -> dict[str, list[tuple[object, ...]]]:
    """Title of each sheet to its rows."""
    openpyxl = extra("openpyxl", "xlsx", "an XLSX file")
    try:
        with path.open("rb") as file:  # the library refuses other endings of a name
            book = openpyxl.load_workbook(file, read_only=True, data_only=True)
            return {one.title: list(one.iter_rows(values_only=True)) for one in book.worksheets}
    except Exception as error:  # damaged archives raise what they like
        raise DataError(f"{path}: no XLSX file that can be read ({error}); save it again, or as CSV") from None


def read_sheet_texts(path: Path) -> list[list[str]]:
    """Cells of the first sheet as texts, rows without any left out; numbers with all their digits.

    Raises:
        MissingPartError: openpyxl is not installed.
        DataError: damaged, or without a sheet.
    """
    rows = next(iter(_sheets(path).values()), [])
    texts = [["" if cell is None else str(cell).strip() for cell in row] for row in rows]
    return [row for row in texts if any(row)]


def _row(cells: tuple[object, ...]) -> str:
    """A row as text; a number with all its digits, so that nothing but a number looks like one."""
    return ";".join(
        repr(float(cell))
        if isinstance(cell, (int, float)) and not isinstance(cell, bool)
        else ""
        if cell is None
        else f'"{cell}"'.replace(";", ",").replace("\n", " ")
        for cell in cells
    )
