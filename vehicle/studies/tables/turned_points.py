"""Points in columns, or in groups for axles or sides, turned into rows of one point each.

Point,LCA front,LCA rear       ,Front,,,Rear,,             Point,Front x,Front y,Front z,Rear x,Rear y,Rear z
x [mm],-150,160                Point,x,y,z,x,y,z           LCA front,-150,380,180,2450,380,180
"""

import re
from collections.abc import Sequence

from vehicle.studies.tables.cell_units import name_and_unit
from vehicle.studies.tables.cells import NUMBER, Row

_HEAD = re.compile(r"(?:(front|rear|left|right|fl|fr|rl|rr|vorn|hinten|links|rechts)[ _]+)?([xyz])", re.IGNORECASE)


def turned_points(rows: Sequence[Row]) -> tuple[Row, ...]:
    """Return the rows of a table with one point in each row of coordinates."""
    result: list[Row] = []
    index = 0
    while index < len(rows):
        block = rows[index + 1 : index + 4]
        heads = [name_and_unit(row.cells[0])[0].lower() if row.cells else "" for row in block]
        text = " ".join(rows[index].cells[1:])
        if heads == ["x", "y", "z"] and re.search(r"[^\W\d]", text):
            result += _columns(rows[index], block)
            index += 4
        elif groups := _groups(rows[index], rows[index - 1] if index else None):
            length = next((n for n, row in enumerate(rows[index + 1 :]) if not any(row.cells)), len(rows) - index - 1)
            result += _beside(rows[index], rows[index + 1 : index + 1 + length], groups)
            index += 1 + length
        else:
            result.append(rows[index])
            index += 1
    return tuple(result)


def _columns(names: Row, block: Sequence[Row]) -> list[Row]:
    """Return a header and a row of each point below a row of names."""
    where, sheet = names.where, names.sheet
    result = [Row(where=where, sheet=sheet, cells=("point", *(row.cells[0] for row in block)))]
    for column in range(1, len(names.cells)):
        values = [row.cells[column] if column < len(row.cells) else "" for row in block]
        if names.cells[column] and any(map(NUMBER.fullmatch, values)):
            result.append(Row(where=where, sheet=sheet, cells=(names.cells[column], *values)))
    return result


def _groups(head: Row, above: Row | None) -> list[tuple[int, str]]:
    """Return first column and title of each group x, y, z of a header."""
    matches = [_HEAD.fullmatch(name_and_unit(cell)[0]) for cell in head.cells]
    starts = [
        start for start in range(1, len(matches) - 2)
        if [match and match[2].lower() for match in matches[start : start + 3]] == ["x", "y", "z"]
    ]  # fmt: skip
    titles = [(matches[start] or {1: ""})[1] or "" for start in starts]
    if above is not None and not any(titles):
        titles = [above.cells[start] if start < len(above.cells) else "" for start in starts]
        titles = [title if re.search(r"[^\W\d]", title) else "" for title in titles]
    return (
        list(zip(starts, titles, strict=True))
        if len(starts) > 1 or any(match and match[1] for match in matches)
        else []
    )


def _beside(head: Row, block: Sequence[Row], groups: Sequence[tuple[int, str]]) -> list[Row]:
    """Return one row for each point of all groups, with the title in the name."""
    names = tuple(re.sub(r"^\w+[ _]+(?=[xyz]\b)", "", cell, flags=re.IGNORECASE) for cell in head.cells)
    result = [Row(where=head.where, sheet=head.sheet, cells=(names[0], *names[groups[0][0] : groups[0][0] + 3]))]
    for row in block:
        if not any(map(NUMBER.fullmatch, row.cells[1:])):
            result.append(row)
            continue
        for start, title in groups:
            values = row.cells[start : start + 3]
            if any(values):
                result.append(Row(where=row.where, sheet=row.sheet, cells=(f"{title} {row.cells[0]}".strip(), *values)))
    return result
