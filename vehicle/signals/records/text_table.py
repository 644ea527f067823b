"""Where the table of a text file begins, what separates its cells, and what its columns hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Literal

from vehicle.errors import DataError
from vehicle.signals.records.clock_text import is_clock
from vehicle.signals.records.heads import NUMBER, NUMBER_WITH_COMMA, cells_of

TEXT_LINES = 400
"""Maximum number of lines above the numbers."""
AGREEING = 4
"""Lines of one shape that tell where the table begins."""
SAMPLED = 200
"""Rows, spread over the file, that tell what a column holds where its first cells are empty or texts."""
SAME_SHAPE = 0.9
"""Minimum share of the sampled rows that agree, in a table with columns of text [-]."""
LARGEST_KINDS = 64
"""Maximum number of different texts of a column that tells kinds of rows apart; more are remarks."""

DELIMITERS = (";", "\t", ",", "")

Kind = Literal["number", "clock", "text", "missing", "other"]
_MISSING = ("", "nan", "-", "na", "n/a", "#n/a", "null", "none")


@dataclass(frozen=True, kw_only=True, slots=True)
class TextTable:
    """Place and form of a table.

    Attributes:
        start: index of its first line.
        delimiter: between the cells; "" for blanks.
        kinds: what each column holds: numbers, dates or clocks, or other texts.
    """

    start: int
    delimiter: str
    kinds: tuple[Kind, ...]


def find_table(path: Path, lines: Sequence[str]) -> TextTable:
    """Find the table of numbers in a text: numbers alone, else with dates and clocks, else with columns of text.

    Args:
        path: the file, for messages.
        lines: of the file.

    Raises:
        DataError: there is none.
    """
    for allowed in (("number",), ("number", "clock"), ("number", "clock", "text")):
        for delimiter in DELIMITERS:
            for start in range(min(TEXT_LINES, len(lines))):
                kinds = _shape(lines, start, delimiter, allowed)
                if kinds is not None:
                    return TextTable(start=start, delimiter=delimiter, kinds=kinds)
    for start in range(min(TEXT_LINES, len(lines))):
        following = [line for line in lines[start : start + AGREEING] if line.strip()]
        if len(following) > 2 and all(_kinds(line, ";") == ["number"] for line in following):
            return TextTable(start=start, delimiter=";", kinds=("number",))
    raise DataError(
        f"{path}: no table of numbers in the first {TEXT_LINES} lines; needed are rows of numbers in columns that are "
        "separated by ';', tab, ',' or blanks, with a line of names and units above them"
    )


def _kind(cell: str, delimiter: str) -> Kind:
    if NUMBER.fullmatch(cell) or (delimiter != "," and NUMBER_WITH_COMMA.fullmatch(cell)):
        return "number"
    if cell.lower() in _MISSING:
        return "missing"
    if cell[:1].isdigit() and is_clock(cell):
        return "clock"
    return "text" if any(sign.isalpha() for sign in cell) else "other"


def _kinds(row: str, delimiter: str) -> list[Kind]:
    return [_kind(cell, delimiter) for cell in cells_of(row, delimiter)]


def _shape(lines: Sequence[str], start: int, delimiter: str, allowed: Sequence[str]) -> tuple[Kind, ...] | None:
    """Kinds of the columns of a table that begins at a line; None where no such table does."""
    if not lines[start].strip() or (delimiter and delimiter not in lines[start]):
        return None
    first = _kinds(lines[start], delimiter)
    if len(first) < 2 or "number" not in first or not all(one in (*allowed, "missing") for one in first):
        return None
    if len(allowed) > 1 and allowed[-1] not in first:
        return None
    rows = [line for line in lines[start + 1 : start + 1 + AGREEING] if line.strip()]
    if len(rows) < 2:
        return None
    merged = first
    for row in rows:
        joined = _joined(merged, _kinds(row, delimiter))
        if joined is None:
            return None
        merged = joined
    if "text" in merged and not _goes_on(lines[start:], delimiter, merged):
        return None
    if not all(one in (*allowed, "missing") for one in merged):
        return None
    return tuple(merged)


def _joined(first: Sequence[Kind], second: Sequence[Kind]) -> list[Kind] | None:
    """Kinds of two rows together; None where they differ. A clock or a word may stand in a column of texts."""
    if len(first) != len(second):
        return None
    found: list[Kind] = []
    for one, other in zip(first, second, strict=True):
        if one == other or other == "missing":
            found.append(one)
        elif one == "missing":
            found.append(other)
        elif {one, other} == {"clock", "text"}:
            found.append("text")
        else:
            return None
    return found


def _spread(lines: Sequence[str]) -> list[str]:
    """Some of the lines that are not blank, spread evenly, with the first and the last."""
    step = max(1, len(lines) // SAMPLED)
    return [line for line in (*lines[:SAMPLED:4], *lines[::step], *lines[-3:]) if line.strip()]


def _goes_on(lines: Sequence[str], delimiter: str, kinds: Sequence[Kind]) -> bool:
    """True if most lines to the end of the file have the kinds of the first."""
    rows = _spread(lines)
    good = sum(1 for row in rows if _joined(kinds, _kinds(row, delimiter)) is not None)
    return good >= SAME_SHAPE * len(rows)


def settled_kinds(path: Path, rows: Sequence[str], table: TextTable, names: Sequence[str]) -> tuple[Kind, ...]:
    """Return the kinds of all columns, also of those whose first cells are empty.

    Args:
        path: the file, for messages.
        rows: of the table.
        table: its form.
        names: of the columns, for messages.

    Raises:
        DataError: rows of different sensors alternate in one table.
    """
    if all(one == "number" for one in table.kinds):
        return table.kinds
    sampled = [cells_of(row, table.delimiter) for row in _spread(rows)]
    found: list[Kind] = []
    for column, known in enumerate(table.kinds):
        cells = [row[column] for row in sampled if column < len(row)]
        kinds = {_kind(cell, table.delimiter) for cell in cells} - {"missing"}
        if "other" in kinds:
            kinds = kinds - {"other"} | {"text"}
        if known == "missing":
            known = "number" if "number" in kinds or not kinds else "clock" if kinds == {"clock"} else "text"
        elif known == "clock" and sum(_kind(cell, table.delimiter) == "text" for cell in cells) > len(cells) // 2:
            known = "text"
        found.append(known)
    _check_alternation(path, rows, found, table.delimiter, names)
    return tuple(found)


def _check_alternation(
    path: Path, rows: Sequence[str], kinds: Sequence[Kind], delimiter: str, names: Sequence[str]
) -> None:
    """Refuse a table in which a text tells from row to row which sensor the numbers belong to."""
    head = [cells_of(row, delimiter) for row in rows[:SAMPLED]]
    for column, kind in enumerate(kinds):
        texts = [row[column] for row in head if column < len(row)]
        different = sorted(set(texts))
        changes = sum(1 for one, other in pairwise(texts) if one != other)
        in_turn = changes > max(1 + 0.1 * len(texts), 1.5 * len(different))  # not a text that changes now and then
        if kind == "text" and 1 < len(different) <= LARGEST_KINDS and in_turn:
            shown = ", ".join(map(repr, different[:4]))
            raise DataError(
                f"{path}: column {names[column]!r} holds {shown} in turn: rows of different sources stand in one "
                "table; write a file for each of them"
            )
