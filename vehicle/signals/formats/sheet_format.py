"""Read sheets of XLSX files as tables of a logger."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.csv_format import read_lines
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.text import Text
from vehicle.signals.formats.unpacked_size import require_archive

LARGEST_SHEETS, FREE_SHEETS, DENSEST_SHEETS = 500e6, 20e6, 50.0
"""Maximum size of the XML of a workbook, size at any compression ratio [byte], and maximum ratio above it [-]: a cell
takes some 40 bytes of XML and 100 bytes of memory, and numbers of a sensor are compressed 4 to 10 to 1."""

NO_VALUES = "formulas without saved values: open the file in a spreadsheet program and save it"
"""Remark on the cells of formulas that another program wrote without computing them."""


def read(path: Path) -> Measurement:
    """Read the first sheet with a table of numbers; errors: see `read_record`."""
    sheets = _sheets(path)
    first_error: DataError | None = None
    for title, cells in sheets.items():
        body = "\n".join(_row(row) for row in cells)
        notice = () if len(sheets) == 1 else (f"sheet {title!r} of {len(sheets)}",)
        try:
            measurement = read_lines(path, Text(body=body, notices=notice, sha256=""), "xlsx")
        except DataError as error:
            first_error = first_error or error
            continue
        empty = [not np.isfinite(channel.values).any() for channel in measurement.channels]
        if not any(empty) or not _formulas(path, title):
            return measurement
        channels = tuple(
            replace(channel, remark=NO_VALUES) if none else channel
            for channel, none in zip(measurement.channels, empty, strict=True)
        )
        return replace(measurement, channels=channels)
    if first_error is not None and any(_formulas(path, title) for title in sheets):
        raise DataError(f"{first_error}; the sheet has {NO_VALUES}") from None
    raise first_error or DataError(f"{path}: contains no sheet; save it again")


def _formulas(path: Path, title: str) -> bool:
    """Return True if a sheet has a formula whose value was not saved."""
    values, formulas = _sheets(path)[title], _sheets(path, formulas=True)[title]
    return any(
        value is None and isinstance(formula, str) and formula.startswith("=")
        for row, row_formulas in zip(values, formulas, strict=False)
        for value, formula in zip(row, row_formulas, strict=False)
    )


def _sheets(path: Path, *, formulas: bool = False) -> dict[str, list[tuple[object, ...]]]:
    """Return the rows of each sheet by sheet title: saved values, or formulas."""
    openpyxl = extra("openpyxl", "xlsx", "an XLSX file")
    with path.open("rb") as archive:
        require_archive(path, archive, limit=LARGEST_SHEETS, freely=FREE_SHEETS, densest=DENSEST_SHEETS)
    with reading(path, "XLSX", "save it again, or as CSV"), path.open("rb") as file:  # openpyxl rejects other suffixes
        book = openpyxl.load_workbook(file, read_only=True, data_only=not formulas)
        return {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book.worksheets}


def read_sheet_texts(path: Path) -> list[list[str]]:
    """Read the cells of the first sheet as texts, numbers with all digits; skip empty rows."""
    sheet = next(iter(sheet_cells(path, first=True).values()), [])
    texts = [["" if cell is None else str(cell).strip() for cell in row] for row in sheet]
    return [row for row in texts if any(row)]


def sheet_cells(path: Path, *, first: bool = False) -> dict[str, list[tuple[object, ...]]]:
    """Read the cells of all sheets, or of the first, by sheet title: texts, numbers, None for an empty cell."""
    sheets = dict(list(_sheets(path).items())[: 1 if first else None])
    for title in sheets:
        if _formulas(path, title):
            raise DataError(f"{path}: {NO_VALUES}")
    return sheets


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
