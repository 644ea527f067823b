"""From the rows of a signal file to numbers, with the line and column of the first cell that is none."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.excitation.csv_header import CsvHeader

_NUMBER = re.compile(r"^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$", re.ASCII)
_DECIMAL_COMMA = re.compile(r"^[+-]?\d+,\d+([eE][+-]?\d+)?$", re.ASCII)
_MISSING = {"", "nan", "na", "n/a", "#n/a", "#na", "null", "none", "-", "inf", "+inf", "-inf", "infinity", "-infinity"}
_SPREADSHEET_ERROR = re.compile(r"^#(N/?A|NAME\?|VALUE!|DIV/0!|REF!|NUM!|NULL!)", re.IGNORECASE)


@dataclass(frozen=True, kw_only=True, slots=True)
class CsvCells:
    """The numbers of the data rows."""

    values: NDArray[np.float64]
    """Cells as written, without conversion of units, shape (rows, columns); NaN where a value is missing."""
    line_numbers: NDArray[np.int64]
    """Line of the file of each row, shape (rows,)."""
    notices: tuple[str, ...]
    """What was accepted although it is unusual."""


def is_comment(line: str) -> bool:
    """Tell whether a line holds no data: blank, or '#' that does not begin a spreadsheet error such as '#N/A'."""
    text = line.strip()
    return not text or (text[0] == "#" and not _SPREADSHEET_ERROR.match(text))


def parse_cells(path: Path, lines: list[str], header_line: int, header: CsvHeader, *, keep_missing: bool) -> CsvCells:
    """Read all rows below the header.

    The fast way hands all rows to numpy at once. Whatever it does not take as finite numbers in the right shape goes
    through a slow pass cell by cell, which either understands it or names line and column.

    Args:
        path: file, for messages.
        lines: all lines of the file.
        header_line: line number of the header, counted from 1.
        header: meaning of the columns.
        keep_missing: return NaN for missing displacements instead of refusing them.

    Raises:
        DataError: no rows, a row with another number of cells, text, a missing or infinite value, decimal comma in
        doubt.
    """
    numbers = [n for n, line in enumerate(lines[header_line:], header_line + 1) if line and not is_comment(line)]
    if not numbers:
        raise DataError(f"{path}:{header_line}: the file ends after the header; needed is one row per sample below it")
    rows = [lines[n - 1] for n in numbers]
    notices: list[str] = []
    if header.delimiter != "," and any("," in row for row in rows):
        rows = _decimal_points(path, numbers, rows, header)
        notices.append("decimal comma read as decimal point")
    values = _fast(rows, header)
    if values is None:
        values = _careful(path, numbers, rows, header, keep_missing=keep_missing)
    return CsvCells(values=values, line_numbers=np.array(numbers, dtype=np.int64), notices=tuple(notices))


def _fast(rows: list[str], header: CsvHeader) -> NDArray[np.float64] | None:
    try:
        values = np.loadtxt(rows, delimiter=header.delimiter, comments=None, ndmin=2, dtype=np.float64)
    except ValueError:
        return None
    return values if values.shape[1] == len(header.cells) and np.isfinite(values).all() else None


def _careful(
    path: Path, numbers: list[int], rows: list[str], header: CsvHeader, *, keep_missing: bool
) -> NDArray[np.float64]:
    width = len(header.cells)
    values = np.full((len(rows), width), np.nan)
    for index, (line, row) in enumerate(zip(numbers, rows, strict=True)):
        cells = _cells(row, header)
        if len(cells) != width:
            raise _wrong_count(path, index, numbers, rows, header)
        for column, cell in enumerate(cells):
            place = f"{path}:{line}:{column + 1}: column {header.cells[column]!r}"
            number = float(cell) if _NUMBER.match(cell) else np.nan
            if np.isfinite(number):
                values[index, column] = number
                continue
            if cell.lower() not in _MISSING and not _SPREADSHEET_ERROR.match(cell) and np.isnan(number):
                raise DataError(f"{place} holds {cell!r}; allowed is a number with a decimal point, such as -1.25e-4")
            if column == header.time_column:
                raise DataError(f"{place} holds {cell!r}; a time stamp is never interpolated; repair or remove the row")
            if not cell and index > 0 and _ends_here(rows[index:], column, header):
                raise _different_length(place)
            if not keep_missing:
                raise DataError(
                    f"{place} holds {cell!r}; allowed are finite numbers; repair the cell, or ask for "
                    "interpolation (--interpolate)"
                )
    return values


def _cells(row: str, header: CsvHeader) -> list[str]:
    return [cell.strip().strip('"').strip() for cell in row.split(header.delimiter)]


def _ends_here(rows: list[str], column: int, header: CsvHeader) -> bool:
    """Tell whether no row from here on has a value in the column."""
    return not any(column < len(cells) and cells[column] for cells in (_cells(row, header) for row in rows))


def _wrong_count(path: Path, index: int, numbers: list[int], rows: list[str], header: CsvHeader) -> DataError:
    width = len(header.cells)
    cells = _cells(rows[index], header)
    place = f"{path}:{numbers[index]}:{min(len(cells), width) + (len(cells) > width)}"
    if len(cells) < width and index > 0 and _ends_here(rows[index:], width - 1, header):
        if index < len(rows) - 1:
            return _different_length(f"{path}:{numbers[index]}:{width}: column {header.cells[-1]!r}")
        return DataError(
            f"{place}: the last row has {len(cells)} cells, the header {width}; the file was cut off; remove the row"
        )
    hint = "one cell per column"
    if len(cells) < width and any(sign in rows[index] for sign in (";", "\t")):
        hint = f"separate the cells by {header.delimiter!r} as in the header"
    elif len(cells) > width and header.delimiter == ",":
        hint = "with decimal commas the columns must be separated by ';', in the header too; 1,5 is never guessed"
    return DataError(f"{place}: row has {len(cells)} cells, the header {width}; {hint}")


def _different_length(place: str) -> DataError:
    return DataError(
        f"{place} ends here while others go on: columns of different length; all plates need the same samples; "
        "nothing is cut or filled up; export them over the same time"
    )


def _decimal_points(path: Path, numbers: list[int], rows: list[str], header: CsvHeader) -> list[str]:
    """Turn decimal commas into points; refuse when a comma could be anything else."""
    pointed = next((n for n, row in zip(numbers, rows, strict=True) if "." in row), None)
    for line, row in zip(numbers, rows, strict=True):
        for column, cell in enumerate(_cells(row, header)):
            if "," in cell and (pointed is not None or not _DECIMAL_COMMA.match(cell)):
                other = f"; line {pointed} has a decimal point" if pointed is not None else ""
                raise DataError(
                    f"{path}:{line}:{column + 1}: column {header.cells[column]!r} holds {cell!r}{other}; a comma "
                    "may be a decimal "
                    "comma or separate thousands; write all numbers with a decimal point and no other sign"
                )
    return [row.replace(",", ".") for row in rows]
