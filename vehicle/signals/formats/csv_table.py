"""Read and write tables as text: UTF-8, `#` comments, one header line, one row per time or frequency."""

import csv
import io
import itertools
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.table import TIME, Header, Record, Table, Wanted
from vehicle.signals.formats.text import LARGEST, Text, read_text

ROWS_AT_ONCE = 4096
"""Number of rows written at once, to limit the memory for the text of a long table."""

TITLE_LINES = 400
"""Maximum number of lines above a header."""

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?", re.ASCII)
_SPREADSHEET_ERROR = re.compile(r"#(N/?A|NAME\?|VALUE!|DIV/0!|REF!|NUM!|NULL!)", re.IGNORECASE)
_MISSING = re.compile(r"|nan|#?na|n/a|null|none|-|[+-]?inf(inity)?", re.IGNORECASE)


def read(path: Path, wanted: Wanted) -> Table:
    """Read a table with cells separated by commas, semicolons or tabs, with or without quotes.

    NumPy parses many rows at once. If the result is not finite or has a wrong shape, the table is parsed cell by cell,
    and errors name line and column.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: not text, no rows, a row with another number of cells, a non-numeric cell, an ambiguous decimal
            comma, or a violated requirement of `wanted`.
    """
    text = read_text(path)
    numbered = ((n, line) for start, lines in text.pieces() for n, line in enumerate(lines, start))
    head, first = next(((n, line) for n, line in numbered if not _is_comment(line)), (0, ""))
    if not head:
        raise DataError(f"{path}: contains only comments; it needs a header line with the columns {wanted.needed} and "
        "one row per sample")  # fmt: skip
    header, notices = _header(path, head, first), list(text.notices)
    try:
        key = wanted.key(header)
    except DataError:
        below = _header_below(path, itertools.islice(numbered, TITLE_LINES))
        if below is None:
            raise
        try:
            key = wanted.key(below)
        except DataError:
            below = None
        if below is None:
            raise
        header, head = below, below.line
        notices.append(f"the lines above the header in line {head} are skipped")
    if header.delimiter != ",":
        notices.append(f"the columns are separated by {header.delimiter!r} instead of the usual ','")
    parsed = _plain(text, header)
    if parsed is None:
        lines = text.lines
        numbers = [n for n, line in enumerate(lines[head:], head + 1) if not _is_comment(line)]
        if not numbers:
            raise DataError(f"{path}:{head}: the file ends after the header; add one row per sample below it")
        rows = [lines[n - 1] for n in numbers]
        rows, remarks = decimal_points(numbers, rows, header)
        notices += remarks
        values = fast(rows, header)
        parsed = careful(numbers, rows, header, key, wanted) if values is None else values, np.array(numbers)
    return Table(header=header, key=key, values=parsed[0], lines=parsed[1], notices=tuple(notices), sha256=text.sha256)


def _header(path: Path, number: int, line: str) -> Header:
    """Return the cells of a header line, and the delimiter."""
    delimiter = next((sign for sign in (";", "\t") if sign in line), ",")
    return Header(path=path, line=number, cells=tuple(_split(line, delimiter)), delimiter=delimiter)


def _header_below(path: Path, lines: Iterable[tuple[int, str]]) -> Header | None:
    """Return the header below lines of a title: the line directly above the first row of numbers; None without one."""
    above: Header | None = None
    for number, line in lines:
        if _is_comment(line):
            continue
        header = _header(path, number, line)
        if any(map(_NUMBER.fullmatch, header.cells)):
            return above if above is not None and len(above.cells) == len(header.cells) else None
        above = header
    return None


def _plain(text: Text, header: Header) -> tuple[Vector, NDArray[np.int64]] | None:
    """Return the numbers below the header and their line numbers; None unless `fast` parses all rows."""
    values, line_numbers = [], []
    for start, lines in text.pieces():
        numbers = [n for n, line in enumerate(lines, start) if n > header.line and not _is_comment(line)]
        rows = [lines[n - start] for n in numbers]
        if not rows:
            continue
        if header.delimiter != "," and any("," in row for row in rows):
            return None
        block = fast(rows, header)
        if block is None:
            return None
        values.append(block)
        line_numbers.append(np.array(numbers))
    return (np.concatenate(values), np.concatenate(line_numbers)) if values else None


FORMULA_TEXT = re.compile(r"^'(?=[=+@\t\r-])")
"""Apostrophe before a text that a spreadsheet would compute; written by `plain_cell`, left out by `read_texts`."""


def plain_cell(cell: Any) -> Any:
    """Return a cell as spreadsheets show it: a text that begins like a formula, and is no number, gets an apostrophe.

    Names of files, channels and cases come from other people: "=HYPERLINK(...)" in one would be computed.
    """
    return f"'{cell}" if isinstance(cell, str) and cell[:1] in set("=+@\t\r-") and not _NUMBER.fullmatch(cell) else cell


def comment_line(text: str) -> str:
    """Return a comment of a table, one line without a formula in any cell into which a spreadsheet would split it."""
    return "# " + re.sub(r"([,;\t])(?=[=+@-])", r"\1 ", re.sub(r"[\r\n]+", " ", text))


class RowWriter:
    """Writer of rows of any cells as CSV, see `plain_cell`; methods of the module csv."""

    def __init__(self, file: Any) -> None:
        self._rows = csv.writer(file, lineterminator="\n")

    def writerow(self, cells: Iterable[Any]) -> Any:
        """Write a row; returns what `write` of the file returns."""
        return self._rows.writerow([plain_cell(cell) for cell in cells])

    def writerows(self, rows: Iterable[Iterable[Any]]) -> None:
        """Write rows."""
        for cells in rows:
            self.writerow(cells)


def read_texts(path: Path) -> list[list[str]]:
    """Read the cells of all rows as texts, the header first; keep commas within quotes."""
    try:
        rows = csv.reader(line for line in read_text(path).lines if not _is_comment(line))
        return [[FORMULA_TEXT.sub("", cell.strip()) for cell in row] for row in rows]
    except csv.Error as error:
        raise DataError(f"{path}: cannot be read ({error})") from None


def write_table(
    path: Path, cells: Sequence[str], columns: Sequence[Vector], comments: Sequence[str] = (), formats: str = "%.9g"
) -> None:
    """Write a table in the format of `read`; undefined values (NaN) become empty cells.

    Args:
        cells: column headers, including units.
        columns: numbers of each column, (rows,).
        comments: lines above the header.
        formats: format of all numbers, or formats of the columns separated by commas.
    """
    cell_formats = formats.split(",") if "," in formats else [formats] * len(cells)
    row = ",".join(cell_formats)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"{line}\n" for line in (*map(comment_line, comments), ",".join(map(plain_cell, cells))))
        for first in range(0, len(columns[0]), ROWS_AT_ONCE):
            table = np.column_stack([column[first : first + ROWS_AT_ONCE] for column in columns])
            gaps = set(np.flatnonzero(np.isnan(table).any(axis=1)).tolist())
            file.writelines(
                ",".join(
                    "" if value != value else number_format % value
                    for number_format, value in zip(cell_formats, values, strict=True)
                )
                + "\n"
                if index in gaps
                else row % tuple(values) + "\n"
                for index, values in enumerate(table.tolist())
            )


def write(path: Path, record: Record, frame: str) -> None:
    """Write a record, one row per sample; see `vehicle.signals.formats.formats.write_record`."""
    heads = [TIME, *(f"{name} [{record.units[name]}]" for name in record.channels)]
    write_table(path, heads, [record.time, *record.channels.values()], [f"frame: {frame}"])


def _is_comment(line: str) -> bool:
    """Return True for a blank line or a comment; '#N/A' and other spreadsheet errors are data."""
    text = line.strip()
    return not text or (text[0] == "#" and not _SPREADSHEET_ERROR.match(text))


def _split(row: str, delimiter: str) -> list[str]:
    """Split a row into cells; strip blanks and quotes."""
    return [cell.strip().strip('"').strip() for cell in row.split(delimiter)]


def fast(rows: list[str], header: Header) -> Vector | None:
    """Parse all numbers at once, (rows, columns); None unless all are finite and the number of columns is right."""
    try:
        values = np.loadtxt(rows, delimiter=header.delimiter, comments=None, ndmin=2, dtype=np.float64)
    except ValueError:
        return None
    whole = values.shape[1] == len(header.cells)
    # The comparison is False for NaN.
    return values if whole and (not values.size or -LARGEST <= values.min() <= values.max() <= LARGEST) else None


def fast_with_gaps(rows: list[str], header: Header, key: int) -> Vector | None:
    """Parse all numbers at once, (rows, columns), NaN for missing values; None if `careful` must parse the rows.

    Infinite cells stay infinite: they are no missing values, and the user of the channel refuses them.

    Args:
        rows, header: lines of text; header with delimiter and number of columns.
        key: index of the column without missing values; -1 for none.
    """
    sign = re.escape(header.delimiter)
    gap = re.compile(rf"(?:(?<=^)|(?<={sign}))[ ]*(?:#?na|n/a|null|none|-)?[ ]*(?=$|{sign})", re.IGNORECASE)
    try:
        filled = [gap.sub("nan", row) for row in rows]
        values = np.loadtxt(filled, delimiter=header.delimiter, comments=None, ndmin=2, dtype=np.float64)
    except ValueError:
        return None
    if values.shape[1] != len(header.cells) or (key >= 0 and not np.isfinite(values[:, key]).all()):
        return None
    return values


def logged(
    numbers: list[int], rows: list[str], header: Header, key: int = -1, texts: dict[int, str] | None = None
) -> Vector:
    """Parse the numbers of a logger as fast as their cells allow, (rows, columns), NaN for missing values.

    Args:
        numbers, rows, header, key: see `careful`.
        texts: receives the first text among the numbers of a column, and its line; None refuses texts.
    """
    values = fast(rows, header)
    values = fast_with_gaps(rows, header, key) if values is None else values
    wanted = Wanted(needed="", key=lambda _: key, missing="mark")
    return careful(numbers, rows, header, key, wanted, texts) if values is None else values


def careful(
    numbers: list[int], rows: list[str], header: Header, key: int, wanted: Wanted, texts: dict[int, str] | None = None
) -> Vector:
    """Parse numbers cell by cell, (rows, columns), NaN for missing values if `Wanted.missing` allows.

    Args:
        rows, header: see `fast_with_gaps`.
        key: index of the column of times or frequencies; -1 for none.
        wanted: requirements on the table.
        texts: see `logged`.
    """
    width, used = len(header.cells), None if wanted.columns is None else wanted.columns(header)
    values: Vector = np.full((len(rows), width), np.nan)
    for index, (line, row) in enumerate(zip(numbers, rows, strict=True)):
        cells = _split(row, header.delimiter)
        if len(cells) != width:
            raise _wrong_count(index, numbers, rows, header)
        for column, cell in enumerate(cells):
            number = float(cell) if _NUMBER.fullmatch(cell) else np.nan
            if abs(number) <= LARGEST:
                values[index, column] = number
                continue
            where = f"{header.path}:{line}:{column + 1}: column {header.cells[column]!r}"
            if used is not None and column not in used and column != key:
                continue
            if np.isfinite(number) and wanted.missing != "mark":
                raise DataError(f"{where} is {cell!r} but must be a number up to {LARGEST:g}; correct the cell")
            if not (_MISSING.fullmatch(cell) or _SPREADSHEET_ERROR.match(cell) or not np.isnan(number)):
                if texts is not None and column != key:
                    texts.setdefault(column, f"{cell!r} in line {line} is not a number")
                    continue
                raise DataError(f"{where} is {cell!r} but must be a number, for example -1.25e-4; correct the cell")
            if column == key:
                stamp = "time stamp" if header.cells[column].lower().startswith("time") else "frequency"
                raise DataError(f"{where} is {cell!r}; a {stamp} is never interpolated; correct or remove the row")
            if wanted.missing == "empty":
                if cell:
                    raise DataError(f"{where} is {cell!r} but must be a finite number, or empty if "
                    "undefined")  # fmt: skip
                continue
            if wanted.missing == "mark":
                if "inf" in cell.lower():
                    values[index, column] = -np.inf if cell.startswith("-") else np.inf
                continue
            if not cell and index > 0 and _ends_here(rows[index:], column, header):
                raise _different_length(where)
            if wanted.missing == "refuse":
                raise DataError(f"{where} is {cell!r} but must be a finite number; {wanted.remedy}")
    return values


def _ends_here(rows: list[str], column: int, header: Header) -> bool:
    """Return True if no row has a value in the column."""
    return not any(column < len(cells) and cells[column] for cells in (_split(row, header.delimiter) for row in rows))


def _wrong_count(index: int, numbers: list[int], rows: list[str], header: Header) -> DataError:
    width, cells = len(header.cells), _split(rows[index], header.delimiter)
    where = f"{header.path}:{numbers[index]}:{min(len(cells), width) + (len(cells) > width)}"
    if len(cells) < width and index > 0 and _ends_here(rows[index:], width - 1, header):
        if index < len(rows) - 1:
            return _different_length(f"{header.path}:{numbers[index]}:{width}: column {header.cells[-1]!r}")
        return DataError(
            f"{where}: the last row has {len(cells)} cells, but the header {width}; the file is truncated: remove the "
            "row"
        )
    hint = "one cell per column"
    if len(cells) < width and any(sign in rows[index] for sign in (";", "\t")):
        hint = f"separate the cells by {header.delimiter!r} as in the header"
    elif len(cells) > width and header.delimiter == ",":
        hint = (
            "with decimal commas, separate the columns by ';', in the header too, because 1,5 may be one number or two"
        )
    return DataError(f"{where}: the row has {len(cells)} cells, but the header {width}; {hint}")


def _different_length(where: str) -> DataError:
    return DataError(
        f"{where} ends before the other columns but must have the same length; export all columns over the same time"
    )


def decimal_points(numbers: list[int], rows: list[str], header: Header) -> tuple[list[str], list[str]]:
    """Replace decimal commas by decimal points, with a notice; reject ambiguous commas."""
    if header.delimiter == "," or not any("," in row for row in rows):
        return rows, []
    pointed = next((n for n, row in zip(numbers, rows, strict=True) if "." in row), None)
    for line, row in zip(numbers, rows, strict=True):
        for column, cell in enumerate(_split(row, header.delimiter)):
            if "," in cell and (pointed is not None or not _DECIMAL_COMMA.fullmatch(cell)):
                other = f"; line {pointed} has a decimal point" if pointed is not None else ""
                raise DataError(
                    f"{header.path}:{line}:{column + 1}: column {header.cells[column]!r} is {cell!r}{other}; the "
                    "comma may be a decimal comma or separate thousands; write all numbers with a decimal point "
                    "and without separators"
                )
    return [row.replace(",", ".") for row in rows], ["decimal comma read as decimal point"]


def table_text(rows: Iterable[Sequence[Any]], comments: Sequence[str] = (), digits: int = 6) -> str:
    """Return a table of any cells as CSV text: numbers with significant digits, None and NaN empty, texts unchanged."""

    def shown(cell: Any) -> str:
        if isinstance(cell, str):
            return cell
        return "" if cell is None or cell != cell else f"{cell:.{digits}g}"

    file = io.StringIO()
    file.writelines(f"{comment_line(comment)}\n" for comment in comments)
    RowWriter(file).writerows([shown(cell) for cell in row] for row in rows)
    return file.getvalue()
