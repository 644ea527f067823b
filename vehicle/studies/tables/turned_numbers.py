"""Numbers in columns, in a matrix or two in a cell, turned into rows of name, value and unit.

Axle,Track [mm],Spring rate [N/mm]    Parameter,Front,,Rear,    Inertia [kg m2],x,y,z    Track F/R,1540/1530,mm
Front,1540,25                         ,Value,Unit,Value,Unit    x,500,0,-30              Distribution,55/45
Rear,1530,28                          Track,1540,mm,1.53,m      y,0,2000,0               v [mm/s],Rebound,Compression
"""

import itertools
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

from vehicle.errors import DataError
from vehicle.studies.tables.cell_units import name_and_unit
from vehicle.studies.tables.cells import NUMBER, WITH_UNIT, Row
from vehicle.studies.tables.headers import KINDS, VELOCITY, axle_of
from vehicle.studies.tables.name_words import AXLES, SIDES, name_words, words_of
from vehicle.studies.tables.number_names import QUALIFIERS, STROKES, number_of
from vehicle.studies.tables.unit_factor import unit_factor

TYRE_SIZE = re.compile(r"P?\d{3} */ *\d{2} *Z?R *\d{2}.*", re.IGNORECASE)
_BOTH = re.compile(r"[(\[ ,]*\b(f|v|va|fr|front|vorn|vorne|r|h|ha|rear|hinten)\b *(?:[/:|&-]|and|und) *"
                   r"\b(f|v|va|front|vorn|vorne|r|rr|h|ha|rear|hinten)\b[)\] ]*", re.IGNORECASE)  # fmt: skip
"""Words of both axles in one name: "Track (F/R)"."""
_PART = re.compile(r"(?P<value>[+-]?[\d.,]+)\s*(?P<unit>%|[a-zA-Z][^\s/:]*(?:/[a-zA-Z]+)?)?\s*(?P<axle>[a-zA-Z]+)?\.?")
_FRONT = frozenset({"f", "v", "va", "fr", "front", "vorn", "vorne"})


def turned_numbers(rows: Sequence[Row], guessed: list[tuple[str, str]]) -> tuple[Row, ...]:
    """Return the rows of a table with one number of one axle in each row; enter guesses with their places.

    Raises:
        DataError: a matrix of inertia is not symmetric, or a damper has several columns of force.
    """
    result: list[Row] = []
    rows = _without_counts(rows)
    index = 0
    while index < len(rows):
        row, block = rows[index], rows[index + 1 : index + 4]
        after = rows[index + 1 :]
        ends = (n for n, other in enumerate(after) if not any(other.cells) or other.sheet != row.sheet)
        length = next(ends, len(after))
        below = rows[index + 1 : index + 1 + length]
        if matrix := _inertia(row, block):
            result += matrix
            index += 4
        elif turned := _paired(row, below) or _quantities(row, below) or _damper(row, below):
            result += turned
            index += 1 + length
        else:
            result += _both_axles(row, guessed)
            index += 1
    return tuple(result)


def _row(row: Row, *cells: str) -> Row:
    return Row(where=row.where, sheet=row.sheet, cells=cells)


def _is_number(cell: str) -> bool:
    return bool(NUMBER.fullmatch(cell) or WITH_UNIT.fullmatch(cell))


def _without_counts(rows: Sequence[Row]) -> Sequence[Row]:
    """Return the rows without a first column that counts them, 1, 2, 3, ..."""
    counted = [row for row in rows if any(row.cells)]
    counts = [row.cells[0] for row in counted if row.cells[0].isdigit()]
    if len(counts) < 3 or counts != [str(n) for n in range(1, len(counts) + 1)] or len(counted) - len(counts) > 1:
        return rows
    return [replace(row, cells=row.cells[1:]) for row in rows]


def _inertia(head: Row, block: Sequence[Row]) -> list[Row]:
    """Return a row of each moment of a matrix below a title with the word inertia."""
    title, unit = name_and_unit(head.cells[0]) if head.cells else ("", "")
    values = [[cell for cell in row.cells if NUMBER.fullmatch(cell)] for row in block]
    named = [row.cells[0].lower() if row.cells else "" for row in block]
    if "inertia" not in words_of(title) or [len(row) for row in values] != [3, 3, 3]:
        return []
    if named not in (["x", "y", "z"], ["ixx", "iyy", "izz"]) and not all(NUMBER.fullmatch(name) for name in named):
        return []
    if any(values[i][j] != values[j][i] for i, j in ((0, 1), (0, 2), (1, 2))):
        raise DataError(f"{head.where}: the matrix of inertia is not symmetric; correct it")
    prefix = "sprung " if {"body", "sprung"} & set(words_of(title)) else ""
    entries = [(f"{prefix}I{'xyz'[i]}{'xyz'[j]}", values[i][j]) for i in range(3) for j in range(i, 3)]
    shown = [entry for entry in entries if entry[0][-1] == entry[0][-2] or float(entry[1].replace(",", "."))]
    return [_row(head, "name", "value", "unit"), *(_row(head, name, value, unit) for name, value in shown), _row(head)]


def _paired(head: Row, below: Sequence[Row]) -> list[Row]:
    """Return the rows below two headers, the axles above pairs of value and unit, or above left and right."""
    if not below:
        return []
    if len(sides := [words_of(cell) for cell in below[0].cells if cell]) > 2 and all(
        len(plain) == 1 and plain[0] in SIDES for plain in sides
    ):
        # The axles above left and right, each in the first of its columns.
        titles: list[str] = []
        for cell in head.cells[1:]:
            titles.append(cell or (titles[-1] if titles else ""))
        joined = [f"{title} {side}".strip() for title, side in zip(titles, below[0].cells[1:], strict=False)]
        return [_row(head, head.cells[0] or "name", *joined), *below[1:]]
    sorts = [KINDS.get(cell.lower(), "") for cell in below[0].cells]
    pairs = [index for index in range(len(sorts) - 1) if sorts[index : index + 2] == ["value", "unit"]]
    titles = [head.cells[index] if index < len(head.cells) else "" for index in pairs]
    if len(pairs) < 2 or not all(titles):
        return []
    result = [_row(head, "name", "value", "unit")]
    for row in below[1:]:
        for index, title in zip(pairs, titles, strict=True):
            if index + 1 < len(row.cells) and row.cells[index]:
                result.append(_row(row, f"{title} {row.cells[0]}", *row.cells[index : index + 2]))
    return result


def _quantities(head: Row, below: Sequence[Row]) -> list[Row]:
    """Return a row of each number below a header of quantities; the first cell of a row may name an axle or a wheel."""
    if not below or any(map(_is_number, head.cells)):
        return []
    names = [name_and_unit(cell) for cell in head.cells]
    # "Weight distribution front/rear" and a remark on both axles have two places.
    plain_names = [name_words(_BOTH.sub(" ", text), right_letter="", where=head.where) for text, _ in names]
    if sum(bool(name.terms) and number_of(name) is not None for name in plain_names) < 2:
        # An axle load has no axle in its name here.
        plain_names = [name_words(f"front {text}", right_letter="") for text, _ in names]
        if sum(len(name.terms) > 0 and number_of(name) is not None for name in plain_names) < 2:
            return []
    units = [unit for _, unit in names]
    if not any(map(_is_number, below[0].cells)):
        units = [unit or cell for unit, cell in zip(units, (*below[0].cells, *[""] * len(units)), strict=False)]
        below = below[1:]
    labels = [next((cell for cell in row.cells if cell and not _is_number(cell)), "") for row in below]
    columns = [
        index for index, (text, _) in enumerate(names)
        if text and any(index < len(row.cells) and _is_number(row.cells[index]) for row in below)
    ]  # fmt: skip
    if len(columns) < 2:
        return []
    result, used = [_row(head, "name", "value", "unit")], False
    for row, label in zip(below, labels, strict=True):
        of_axle = axle_of(words_of(label)) is not None if label else False
        if (used and not of_axle) or QUALIFIERS & set(words_of(label)):
            result.append(row)
            continue
        used = used or not of_axle
        for index in columns:
            if index < len(row.cells) and row.cells[index]:
                title = f"{label} {names[index][0]}" if of_axle else names[index][0]
                result.append(_row(row, title, row.cells[index], units[index]))
    return [*result, _row(head)]


def _damper(head: Row, below: Sequence[Row]) -> list[Row]:
    """Return blocks of velocity and force from columns of both axles, or of rebound and compression."""
    if len(head.cells) > 2 and _is_number(head.cells[1]) and {*words_of(head.cells[0])[:1]} & {*VELOCITY}:
        # Velocities along a row, forces below them.
        turned = [replace(head, cells=cells) for cells in itertools.zip_longest(
            *(row.cells for row in (head, *below) if row.cells[0]), fillvalue="")]  # fmt: skip
        head, below = turned[0], turned[1:]
    names = [name_and_unit(cell) for cell in head.cells]
    plain_names = [words_of(text) for text, _ in names]
    velocity = next((index for index, plain in enumerate(plain_names) if plain and plain[0] in VELOCITY), -1)
    others = [index for index, plain in enumerate(plain_names) if plain and index != velocity]
    if velocity < 0 or not others or (len(others) < 2 and not {*STROKES} & set(plain_names[others[0]])) or not below:
        return []
    result: list[Row] = []
    for axle in ("", *AXLES):
        columns = [index for index in others if _axle_of_force(plain_names[index]) == axle]
        if not columns:
            continue
        strokes = [{*plain_names[index]} & {*STROKES} for index in columns]
        if len(columns) > 1 and (len(columns) > 2 or strokes[0] == strokes[1]):
            raise DataError(f"{head.where}: several columns of force of one damper; name their axle, or rebound and "
                            "compression, and remove the others")  # fmt: skip
        curve, unit = [], next((names[index][1] for index in columns if names[index][1]), "")
        for index in columns:
            signs = {"rebound": "", "compression": "-"}
            sign = next((signs[word] for word in plain_names[index] if word in signs), None)
            for row in below:
                if max(velocity, index) < len(row.cells) and row.cells[index]:
                    pair = (row.cells[velocity], row.cells[index])
                    if sign is not None:
                        pair = (sign + pair[0].lstrip("+-"), sign + pair[1].lstrip("+-"))
                    curve.append(_row(row, *pair))
        title = [_row(head, f"damper {axle}")] if axle else []
        result += [*title, _row(head, f"velocity [{names[velocity][1]}]", f"force [{unit}]"), *curve, _row(head)]
    return result


def _axle_of_force(plain: Iterable[str]) -> str:
    """Return the axle of the column of a force: "F rear" is the force of the rear axle."""
    return next((word for word in plain if word in AXLES), "")


def _both_axles(row: Row, guessed: list[tuple[str, str]]) -> list[Row]:
    """Return the rows of the front and the rear axle of a row with both in one cell: 1540/1530, 55:45, "55 % front"."""
    filled = [index for index, cell in enumerate(row.cells) if cell]
    if len(filled) < 2 or _is_number(row.cells[filled[0]]):
        return [row]
    numbers = [cell for cell in row.cells if NUMBER.fullmatch(cell)]
    if "inertia" in words_of(row.cells[filled[0]]) and len(numbers) == 3:
        prefix = "sprung " if {"body", "sprung"} & set(words_of(row.cells[filled[0]])) else ""
        units = [cell for cell in row.cells[1:] if cell and cell not in numbers][:1]
        guessed.append((row.where, f"{row.cells[filled[0]]!r}: Ixx, Iyy, Izz"))
        return [Row(where=row.where, sheet=row.sheet, cells=(f"{prefix}I{axis}{axis}", value, *units), is_loose=True)
                for axis, value in zip("xyz", numbers, strict=True)]  # fmt: skip
    name = row.cells[filled[0]]
    index = next((index for index in filled[1:] if re.match(r"[+-]?\d", row.cells[index])), 0)
    cell = row.cells[index]
    is_share = "distribution" in words_of(name)
    if not index or TYRE_SIZE.fullmatch(cell) or not (is_share or re.search(r"\d[^\d/:]*[/:] *\d", cell)):
        return [row]
    parts = [_PART.fullmatch(part.strip()) for part in re.split(r"\s*[/:](?=\s*\d)", cell)]
    if len(parts) > 2 or not all(parts) or not parts:
        return [row]
    both = _BOTH.search(name)
    plain = _BOTH.sub(" ", name).strip()
    if number_of(name_words(f"front {name_and_unit(plain)[0]}", right_letter="")) is None:
        return [row]
    stated = [axle_of(words_of(part["axle"])) if part and part["axle"] else None for part in parts]
    if len(parts) == 1 and stated[0] is None:
        return [row]
    if any(stated):
        axles = [axle[0] if axle else "" for axle in stated]
    elif both:
        axles = list(AXLES if both[1].lower() in _FRONT else AXLES[::-1])
    else:
        axles = list(AXLES)
        guessed.append((row.where, f"{name!r} = {cell}: front / rear"))
    following = row.cells[index + 1 :]
    unit = next((part["unit"] for part in parts if part and part["unit"]), "")
    rows = []
    for axle, part in zip(axles, parts, strict=True):
        assert part is not None  # fmt: skip
        of_part = part["unit"] or unit
        ends = (of_part,) if of_part and unit_factor(of_part) is not None else following
        cells = (f"{axle} {plain}", part["value"], *ends)
        rows.append(Row(where=row.where, sheet=row.sheet, cells=cells, is_loose=True))
    return rows
