"""Fill up the rows of a table whose last cells, remarks of single rows, are missing in other rows."""

from collections.abc import Sequence

from vehicle.signals.formats.heads import cells_of
from vehicle.signals.formats.text_table import Kind, TextTable, kinds_of


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
