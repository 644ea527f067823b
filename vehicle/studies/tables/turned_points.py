"""Points as the columns of a table, with rows x, y and z, turned into rows of points."""

import re
from collections.abc import Sequence

from vehicle.studies.tables.cell_units import name_and_unit
from vehicle.studies.tables.cells import NUMBER, Row


def turned_points(rows: Sequence[Row]) -> tuple[Row, ...]:
    """Return the rows of a table; a row of names above three rows x, y, z becomes a header and a row of each point."""
    result: list[Row] = []
    index = 0
    while index < len(rows):
        block = rows[index + 1 : index + 4]
        heads = [name_and_unit(row.cells[0]) if row.cells else ("", "") for row in block]
        names, text = rows[index].cells, " ".join(rows[index].cells[1:])
        if [name.lower() for name, _ in heads] != ["x", "y", "z"] or not re.search(r"[^\W\d]", text):
            result.append(rows[index])
            index += 1
            continue
        where, sheet = rows[index].where, rows[index].sheet
        result.append(Row(where=where, sheet=sheet, cells=("point", *(row.cells[0] for row in block))))
        for column in range(1, len(names)):
            values = [row.cells[column] if column < len(row.cells) else "" for row in block]
            if names[column] and any(map(NUMBER.fullmatch, values)):
                result.append(Row(where=where, sheet=sheet, cells=(names[column], *values)))
        index += 4
    return tuple(result)
