"""Cells of a table file: CSV with any separator, text with blanks, or all sheets of an XLSX file."""

import csv
import re
from dataclasses import dataclass, replace
from pathlib import Path

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.sheet_format import sheet_cells
from vehicle.signals.formats.text import read_text
from vehicle.studies.tables.unit_factor import unit_factor

LARGEST_TABLE = 5e6
"""Largest size of a table [byte]; the points and numbers of a car take 1e3 to 1e5."""

NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")
_POINTED = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+,\d+")
"""Number with points between thousands and a decimal comma."""
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?")
_POINTS = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+")
"""Number with points between thousands where the comma is decimal: "1.280"."""
_GROUPS = re.compile(r"(?<![\w.,])(\d{1,3})((?:[ '\u2019\u202f\u00a0]\d{3})+)(?=[.,]\d|\D|$)(?! *\d)")
"""Thousands with blanks or apostrophes between them: 1 450, 1'450."""
_VECTOR = re.compile(r"([\[({]?)\s*([+-]?[\d.]+)\s*[,;/ ]\s*([+-]?[\d.]+)\s*[,;/ ]\s*([+-]?[\d.]+)\s*[\])}]?")
"""Three coordinates in one cell: "(0, 750, 300)", "0/750/300"."""
_ASSIGNED = re.compile(r"\s*([A-Za-z_][\w. ]*?)\s*[=:]\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?|\[[^\]]+\])\s*;?\s*"
                       r"(?:(?:[%#!]|//)\s*(.*))?")  # fmt: skip
"""Assignment of a script with its remark: "m = 1400; % mass [kg]"."""
WITH_UNIT = re.compile(r"([+-]?[\d.,]+(?:[eE][+-]?\d+)?)\s*([a-zA-Z%°\"(/].*)")
"""Number and unit in one cell: "1250 kg"."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """Row of a table: its place for messages, "points.csv:7", the title of its sheet or "", and its cells.

    `is_loose`: name, value and unit, whatever the header above it.
    """

    where: str
    sheet: str
    cells: tuple[str, ...]
    is_loose: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class CellTable:
    """Rows of a file, and the meaning of a comma in its numbers: "decimal", "thousands" or "unknown".

    `points` is the meaning of the point in "1.280": "decimal", "thousands" or, beside both, "unknown".
    """

    rows: tuple[Row, ...]
    comma: str
    points: str = "decimal"

    def number(self, row: Row, text: str) -> float | None:
        """Return the number of a cell; None for another text.

        Raises:
            DataError: "1,250" or "1.250" in a file whose other numbers do not show the meaning of its sign.
        """
        text = text.strip()
        if _POINTED.fullmatch(text):
            text = text.replace(".", "")
        is_pointed, is_thousand = _POINTS.fullmatch(text), _THOUSANDS.fullmatch(text)
        if (is_thousand and self.comma == "unknown") or (is_pointed and self.points == "unknown"):
            raise DataError(
                f"{row.where}: {text!r} may be a thousand or a decimal number; write it with a decimal point, and no "
                "number of the file with a decimal comma"
            )
        if is_pointed and self.points == "thousands":
            return float(text.replace(".", ""))
        if is_thousand and self.comma == "thousands":
            return float(text.replace(",", ""))
        return float(text.replace(",", ".")) if NUMBER.fullmatch(text) else None


def read_cells(path: Path) -> CellTable:
    """Read a CSV, text or XLSX file.

    Raises:
        ConfigurationError: the file is missing or too large.
        DataError: it is no table.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: the file does not exist; give the path of a table (CSV or XLSX)")
    if path.stat().st_size > LARGEST_TABLE:
        raise ConfigurationError(f"{path}: is larger than {LARGEST_TABLE / 1e6:g} MB, so it is no table of a car")
    if path.suffix.lower() in (".xlsx", ".xlsm"):
        sheets = sheet_cells(path)
        rows = [
            Row(where=f"{path}: sheet {title!r}, row {number}", sheet=title, cells=tuple(map(_sheet_text, cells)))
            for title, sheet in sheets.items()
            for number, cells in enumerate(sheet, 1)
        ]
        # A numeric cell has a decimal point, also where texts have decimal commas.
        texts = [cell.strip() for sheet in sheets.values() for row in sheet for cell in row if isinstance(cell, str)]
    else:
        rows = _text_rows(path)
        texts = [cell for row in rows for cell in row.cells]
    rows = [replace(row, cells=tuple(part for cell in row.cells for part in _parts(_plain(cell)))) for row in rows]
    if not any(NUMBER.fullmatch(cell) or WITH_UNIT.fullmatch(cell) for row in rows for cell in row.cells):
        raise DataError(f"{path}: has no cell with a number; save names, values and units as CSV or XLSX")
    parts = [part for cell in texts for part in _parts(_plain(cell))]
    numbers = [match[1] if (match := WITH_UNIT.fullmatch(cell)) else cell for cell in parts]
    comma = _comma(numbers)
    points = "decimal" if comma != "decimal" else _points(numbers)
    return CellTable(rows=tuple(rows), comma=comma, points=points)


def _sheet_text(cell: object) -> str:
    """Return the text of a cell of Excel; a number has another count of decimals than a thousand with its point."""
    text = "" if cell is None else str(cell).strip()
    return f"{text}0" if isinstance(cell, float) and _POINTS.fullmatch(text) else text


def _plain(cell: str) -> str:
    """Return a cell whose number has no blanks between thousands and no sign of an approximate value before it."""
    text = re.sub(r"^(?:~|≈|ca\.?|approx\.?|about) *(?=[\d+-])", "", cell.replace("\u2212", "-"))
    if not re.match(r"[+-]?\d", text):
        return text
    return _GROUPS.sub(lambda match: match[1] + re.sub(r"\D", "", match[2]), text)


def _parts(cell: str) -> tuple[str, ...]:
    """Return the three coordinates of a cell, or the cell."""
    match = _VECTOR.fullmatch(cell)
    return match.groups()[1:] if match and (match[1] or "/" in cell) else (cell,)


def _assignments(lines: list[str], path: Path) -> list[Row]:
    """Return name, value, unit and remark of the assignments of a script; [] for another text."""
    matches = [_ASSIGNED.fullmatch(line) for line in lines]
    if sum(map(bool, matches)) < 0.5 * sum(bool(line.strip(" %#!/")) for line in lines):
        return []
    rows = []
    for number, (line, match) in enumerate(zip(lines, matches, strict=True), 1):
        cells: tuple[str, ...] = (line.strip(),)
        if match is not None:
            remark = match[3] or ""
            pieces = [piece.strip() for piece in re.split(r"[\[\]();,]", remark)]
            unit = next((piece for piece in pieces if piece and unit_factor(piece) is not None), "")
            cells = (match[1], match[2], unit, remark)
        rows.append(Row(where=f"{path}:{number}", sheet="", cells=cells))
    return rows


def _text_rows(path: Path) -> list[Row]:
    lines = read_text(path).lines
    if rows := _assignments(list(lines), path):
        return rows
    sign = next((sign for sign in (";", "\t") if sum(sign in line for line in lines) > 0.3 * len(lines)), ",")
    if sign == "," and sum("," in line for line in lines) <= 0.3 * sum(bool(line.strip()) for line in lines):
        sign = " "
    for number, line in enumerate(lines, 1):
        where = f"{path}:{number}"
        if line.lstrip().startswith(("#", "!", "%", "//")):
            # A remark may state units and axes.
            cells = [line.strip()]
        elif sign == " ":
            cells = _blank_cells(line)
        else:
            try:
                cells = next(csv.reader([line], delimiter=sign), [])
            except csv.Error as error:
                raise DataError(f"{where}: cannot be read ({error}); correct the line") from None
        rows.append(Row(where=where, sheet="", cells=tuple(cell.strip() for cell in cells)))
    return rows


def _blank_cells(line: str) -> list[str]:
    """Return the cells of a line with blanks between them: words before the first number are one name."""
    terms = re.split(r"\s{2,}|\t", line.strip())
    if len(terms) > 1:
        return [part for word in terms for part in (word.split() if NUMBER.fullmatch(word.split(" ")[0]) else [word])]
    terms = line.split()
    first = next((index for index, word in enumerate(terms) if NUMBER.fullmatch(word)), len(terms))
    name = " ".join(terms[:first]).rstrip("=:").strip()
    last = max((index for index, word in enumerate(terms) if NUMBER.fullmatch(word)), default=first) + 1
    # "N s/m" is one unit.
    ends = (end for end in range(len(terms), last, -1) if unit_factor(" ".join(terms[last:end])) is not None)
    unit = next(ends, last)
    return ([name] if name else []) + terms[first:last] + [" ".join(terms[last:unit])] * (unit > last) + terms[unit:]


def _comma(cells: list[str]) -> str:
    """Return what a comma means in the numbers of a table."""
    numbers = [cell for cell in cells if any(form.fullmatch(cell) for form in (NUMBER, _POINTED, _THOUSANDS))]
    commas = [cell for cell in numbers if "," in cell]
    if any(not _THOUSANDS.fullmatch(cell) for cell in commas):
        return "decimal"
    return "thousands" if any("." in cell for cell in numbers) else "unknown"


def _points(cells: list[str]) -> str:
    """Return what the point of "1.280" means in a table with decimal commas."""
    mixed = any(NUMBER.fullmatch(cell) and "." in cell and not _POINTS.fullmatch(cell) for cell in cells)
    return "unknown" if mixed else "thousands"
