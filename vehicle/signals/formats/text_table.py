"""Find the table in a text file: first line, delimiter, and data types of the columns."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from vehicle.errors import DataError
from vehicle.signals.formats.clock_text import is_clock
from vehicle.signals.formats.heads import NUMBER, NUMBER_WITH_COMMA, cells_of
from vehicle.signals.formats.mixed_sources import SAMPLED, check_alternation

TEXT_LINES = 400
"""Maximum number of lines above the numbers."""

AGREEING = 4
"""Number of consistent lines that mark the beginning of the table."""

SAME_SHAPE = 0.9
"""Minimum share of consistent sampled rows in a table with text columns [-]."""

DELIMITERS = (";", "\t", ",", "")

Kind = Literal["number", "clock", "text", "missing", "other"]
_MISSING = ("", "nan", "-", "na", "n/a", "#n/a", "null", "none")


@dataclass(frozen=True, kw_only=True, slots=True)
class TextTable:
    """Position and layout of a table.

    Attributes:
        start: index of the first row.
        delimiter: delimiter of the cells; "" for blanks.
        kinds: type of each column: numbers, dates or clocks, or texts.
    """

    start: int
    delimiter: str
    kinds: tuple[Kind, ...]


def find_table(path: Path, lines: Sequence[str]) -> TextTable:
    """Find the table of numbers in a text: numbers only, else with dates and clocks, else with text columns."""
    for allowed in (("number",), ("number", "clock"), ("number", "clock", "text")):
        for delimiter in DELIMITERS:
            for start in range(min(TEXT_LINES, len(lines))):
                kinds = _shape(lines, start, delimiter, allowed)
                if kinds is not None:
                    while start and _is_first_row(lines[start - 1], delimiter, kinds):
                        start -= 1
                    return TextTable(start=start, delimiter=delimiter, kinds=kinds)
    for start in range(min(TEXT_LINES, len(lines))):
        following = [line for line in lines[start : start + AGREEING] if line.strip()]
        if len(following) > 2 and all(kinds_of(line, ";") == ["number"] for line in following):
            return TextTable(start=start, delimiter=";", kinds=("number",))
    raise DataError(
        f"{path}: found no table of numbers in the first {TEXT_LINES} lines; it needs rows of numbers, separated "
        "by ';', tab, ',' or blanks, with a line of names and units above"
    )


def _is_first_row(line: str, delimiter: str, columns: Sequence[Kind]) -> bool:
    """Return True if a line above a table is a row of it: a column of texts may begin with numbers, or the reverse."""
    kinds = kinds_of(line, delimiter)
    return (
        bool(delimiter)
        and len(kinds) == len(columns)
        and kinds[0] == columns[0] in ("number", "clock")
        and sum(cell in (column, "missing") for cell, column in zip(kinds, columns, strict=True)) * 2 >= len(columns)
    )


def _kind(cell: str, delimiter: str) -> Kind:
    if NUMBER.fullmatch(cell) or (delimiter != "," and NUMBER_WITH_COMMA.fullmatch(cell)):
        return "number"
    if cell.lower() in _MISSING:
        return "missing"
    if cell[:1].isdigit() and is_clock(cell):
        return "clock"
    return "text" if any(sign.isalpha() for sign in cell) else "other"


def kinds_of(row: str, delimiter: str) -> list[Kind]:
    """Return the types of the cells of a row."""
    return [_kind(cell, delimiter) for cell in cells_of(row, delimiter)]


def _shape(lines: Sequence[str], start: int, delimiter: str, allowed: Sequence[str]) -> tuple[Kind, ...] | None:
    """Return the column types of the table that begins at a line; None if no table begins there."""
    if not lines[start].strip() or (delimiter and delimiter not in lines[start]):
        return None
    rows = [line for line in lines[start + 1 : start + 1 + AGREEING] if line.strip()]
    parsed = _common([kinds_of(line, delimiter) for line in (lines[start], *rows)]) if delimiter else None
    first = parsed[0] if parsed else kinds_of(lines[start], delimiter)
    if len(first) < 2 or "number" not in first or not all(cell in (*allowed, "missing") for cell in first):
        return None
    if len(allowed) > 1 and allowed[-1] not in first:
        return None
    if len(rows) < 2:
        return None
    merged = first
    for n, row in enumerate(rows, 1):
        combined = _joined(merged, parsed[n] if parsed else kinds_of(row, delimiter))
        if combined is None:
            return None
        merged = combined
    if "text" in merged and not _goes_on(lines[start:], delimiter, merged):
        return None
    if not all(cell in (*allowed, "missing") for cell in merged):
        return None
    return tuple(merged)


def _common(rows: list[list[Kind]]) -> list[list[Kind]]:
    """Remove the cells of remarks, texts beyond the columns of the shortest row; return other rows unchanged."""
    width = min(map(len, rows))
    remarks = [cell for row in rows for cell in row[width:]]
    return [row[:width] for row in rows] if remarks and set(remarks) <= {"text", "missing"} else rows


def _joined(first: Sequence[Kind], second: Sequence[Kind]) -> list[Kind] | None:
    """Combine the column types of two rows; None if they differ. A text column may contain clocks."""
    if len(first) != len(second):
        return None
    combined: list[Kind] = []
    for first_kind, second_kind in zip(first, second, strict=True):
        if first_kind == second_kind or second_kind == "missing":
            combined.append(first_kind)
        elif first_kind == "missing":
            combined.append(second_kind)
        elif {first_kind, second_kind} == {"clock", "text"}:
            combined.append("text")
        else:
            return None
    return combined


def _spread(lines: Sequence[str]) -> list[str]:
    """Return an evenly spread sample of the non-blank lines, including the first and last lines."""
    step = max(1, len(lines) // SAMPLED)
    return [line for line in (*lines[:SAMPLED:4], *lines[::step], *lines[-3:]) if line.strip()]


def _goes_on(lines: Sequence[str], delimiter: str, kinds: Sequence[Kind]) -> bool:
    """Return True if at least `SAME_SHAPE` of the lines up to the end of the file have these column types."""
    rows = _spread(lines)
    cells = [_common([list(kinds), kinds_of(row, delimiter)])[-1] for row in rows]
    good = sum(1 for row_kinds in cells if _joined(kinds, row_kinds) is not None)
    return good >= SAME_SHAPE * len(rows)


def settled_kinds(path: Path, rows: Sequence[str], table: TextTable, names: Sequence[str]) -> tuple[Kind, ...]:
    """Determine the types of all columns, including columns whose first cells are empty."""
    sampled = [cells_of(row, table.delimiter) for row in _spread(rows)]
    settled: list[Kind] = []
    for column, settled_kind in enumerate(table.kinds):
        cells = [row[column] for row in sampled if column < len(row)]
        kinds = {_kind(cell, table.delimiter) for cell in cells} - {"missing"}
        if settled_kind == "missing" and not kinds:  # a few rows may contain remarks
            every = (cells_of(row, table.delimiter) for row in rows)
            filled = {row[column] for row in every if column < len(row) and row[column]}
            kinds = {_kind(cell, table.delimiter) for cell in filled} - {"missing"}
        texts = sum(_kind(cell, table.delimiter) == "text" for cell in cells)
        if settled_kind == "missing":
            settled_kind = "number" if "number" in kinds or not kinds else "clock" if kinds == {"clock"} else "text"
        elif settled_kind in ("clock", "number") and texts > len(cells) // 2:
            settled_kind = "text"
        settled.append(settled_kind)
    head = [cells_of(row, table.delimiter) for row in rows[:SAMPLED]]
    for column, settled_kind in enumerate(settled):
        if settled_kind == "text":
            check_alternation(path, names[column], [row[column] for row in head if column < len(row)])
    return tuple(settled)


def with_remarks(lines: list[str], table: TextTable) -> tuple[list[str], TextTable, list[str]]:
    """Extend all rows to the columns of the names above, if all cells outside the common columns are texts.

    Args:
        table: table with the columns that the rows at its beginning have in common.

    Returns:
        Lines with rows of equal width, the table that begins at its first wide row, and a notice on remarks without a
        name. The arguments if no row has remarks, or if a number is outside the common columns.
    """
    delimiter, width = table.delimiter, len(table.kinds)
    if not delimiter:
        return lines, table, []
    start = table.start
    while start and _is_row(lines[start - 1], delimiter, table.kinds):
        start -= 1
    wide = [n for n in range(start, len(lines)) if lines[n].count(delimiter) >= width]
    wide = [n for n in wide if len(cells_of(lines[n], delimiter)) > width]
    beyond = [kinds_of(lines[n], delimiter)[width:] for n in wide]
    if not any("text" in kinds for kinds in beyond) or any("number" in kinds for kinds in beyond):
        return lines, table, []
    above = next((line for line in reversed(lines[:start]) if line.strip()), "")
    names = len(cells_of(above.lstrip("# "), delimiter))
    names = names if names > width and "number" not in kinds_of(above, delimiter) else width
    filled = list(lines)
    for n in wide:
        cells = cells_of(lines[n], delimiter)[:width]
        filled[n] = delimiter.join(f'"{cell}"' if delimiter in cell else cell for cell in cells)
    if names > width:
        for n in range(start, len(lines)):
            if lines[n].strip():
                filled[n] = filled[n].rstrip() + (names - width) * delimiter
    remark: Kind = "text"
    notices = [] if names > width else [f"remarks behind the last column are ignored, the first in line {wide[0] + 1}"]
    kinds = (*table.kinds, *[remark] * (names - width))
    return filled, TextTable(start=start, delimiter=delimiter, kinds=kinds), notices


def _is_row(line: str, delimiter: str, columns: Sequence[Kind]) -> bool:
    """Return True if a line has the columns of a table, and remarks beyond them."""
    kinds = kinds_of(line, delimiter)
    return (
        len(kinds) > len(columns)
        and all(cell in (column, "missing") for cell, column in zip(kinds, columns, strict=False))
        and "number" in kinds[: len(columns)]
    )
