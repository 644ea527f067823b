"""Read sheets of XLSX files as tables of a logger."""

from __future__ import annotations

from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.records.channel import Measurement
from vehicle.signals.records.logger_format import read_lines
from vehicle.signals.records.reader import digest, extra
from vehicle.signals.records.text import Text


def read(path: Path) -> Measurement:
    """Read the first sheet with a table of numbers.

    Raises:
        MissingPartError: openpyxl is not installed.
        DataError: the file is damaged or has no table of numbers.
    """
    sheets = _sheets(path)
    first_error: DataError | None = None
    for title, cells in sheets.items():
        body = "\n".join(_row(row) for row in cells)
        notice = () if len(sheets) == 1 else (f"sheet {title!r} of {len(sheets)}",)
        try:
            return read_lines(path, Text(body=body, notices=notice, sha256=digest(path)), "xlsx")
        except DataError as error:
            first_error = first_error or error
    raise first_error or DataError(f"{path}: no sheet; save it again")


def _sheets(path: Path) -> dict[str, list[tuple[object, ...]]]:
    """Return the rows of each sheet by sheet title."""
    openpyxl = extra("openpyxl", "xlsx", "an XLSX file")
    try:
        with path.open("rb") as file:  # openpyxl rejects other file extensions
            book = openpyxl.load_workbook(file, read_only=True, data_only=True)
            return {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book.worksheets}
    except Exception as error:  # openpyxl raises errors of any type for damaged archives
        raise DataError(f"{path}: cannot be read as XLSX ({error}); save it again, or as CSV") from None


def read_sheet_texts(path: Path) -> list[list[str]]:
    """Read the cells of the first sheet as texts, numbers with all digits; skip empty rows.

    Raises:
        MissingPartError: openpyxl is not installed.
        DataError: the file is damaged or has no sheet.
    """
    rows = next(iter(_sheets(path).values()), [])
    texts = [["" if cell is None else str(cell).strip() for cell in row] for row in rows]
    return [row for row in texts if any(row)]


def _row(cells: tuple[object, ...]) -> str:
    """Join a row to text: numbers with all digits, other cells in quotes."""
    return ";".join(
        repr(float(cell))
        if isinstance(cell, (int, float)) and not isinstance(cell, bool)
        else ""
        if cell is None
        else f'"{cell}"'.replace(";", ",").replace("\n", " ")
        for cell in cells
    )
