"""Elements of MAT files of version 5, walked before the library reads them: a damaged tag could end the process.

Source: MathWorks, MAT-File Format, chapter 1.
"""

from __future__ import annotations

import math
import struct
from pathlib import Path

from vehicle.errors import DataError

MATRIX, COMPRESSED = 14, 15
"""Kinds of data elements of MAT-file level 5: an array, and one that is compressed."""
WIDTHS = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
"""Kind of data to bytes of a number."""
NUMERIC = range(6, 16)
"""Classes of arrays of numbers."""
OBJECT = 17
"""Class of an array that holds an object: a table, a timetable, a datetime, a string."""
DEEPEST = 40
"""Structures within structures that are followed; a damaged file may nest without end."""


def check_matrix(path: Path, data: bytes, order: str, where: str, depth: int = 0) -> None:
    """Refuse a matrix whose parts do not fit together.

    Args:
        path: the file.
        data: of the element, without its tag.
        order: "<" or ">".
        where: the element in words.
        depth: of matrices within matrices.

    Raises:
        DataError: a part of unknown kind or size, or dimensions that are not those of the numbers.
    """
    if not data:
        return  # an empty cell
    parts = _parts(path, data, order, where)
    kinds = [kind for kind, _ in parts[:3]]
    if len(parts) < 3 or kinds[0] != 6 or len(parts[0][1]) != 8 or depth > DEEPEST:
        raise _damaged(path, where)
    flags, sizes = parts[0][1], parts[1][1]
    if flags[0 if order == "<" else 3] in (16, OBJECT):
        return  # a function or an object: other parts, and no numbers
    dimensions = struct.unpack(f"{order}{len(sizes) // 4}i", sizes[: len(sizes) // 4 * 4])
    word = struct.unpack(f"{order}I", flags[:4])[0]
    if kinds[1] != 5 or len(sizes) % 4 or (word & 255) not in (*NUMERIC, 1, 2, 3, 4, 5) or len(dimensions) < 2:
        raise _damaged(path, where)
    if min(dimensions) < 0 or kinds[2] not in (1, 16):
        raise _damaged(path, where)
    count = math.prod(dimensions)
    for kind, held in parts[3:]:
        if kind == MATRIX:
            check_matrix(path, held, order, where, depth + 1)
        elif (word & 255) in NUMERIC and len(held) != count * WIDTHS.get(kind, 0):
            raise _damaged(path, where)
    if (word & 255) in NUMERIC and len(parts) != (5 if word & 0x800 else 4) and count:
        raise _damaged(path, where)


def object_name(path: Path, data: bytes, order: str) -> tuple[str, str] | None:
    """Return name and class of an object of MATLAB, as of a table; None of any other matrix.

    Args:
        path: the file.
        data: of the element, without its tag.
        order: "<" or ">".

    Raises:
        DataError: parts that do not fit together.
    """
    if len(data) < 16 or data[8 if order == "<" else 11] != OBJECT:
        return None
    parts = _parts(path, data, order, "an object")
    texts = [held.decode("latin-1") for kind, held in parts[1:4] if kind == 1]
    return (texts[0], texts[2]) if len(texts) == 3 else ("?", "object")


def _parts(path: Path, data: bytes, order: str, where: str) -> list[tuple[int, bytes]]:
    """Kinds and bytes of the elements within an element."""
    found, position = [], 0
    while position + 8 <= len(data):
        kind, size = struct.unpack(f"{order}II", data[position : position + 8])
        start = position + 8
        if kind >> 16:  # a small element: both numbers in one word
            kind, size, start = kind & 0xFFFF, kind >> 16, position + 4
            if size > 4:
                raise _damaged(path, where)
        if (kind not in WIDTHS and kind != MATRIX) or start + size > len(data):
            raise _damaged(path, where)
        found.append((kind, data[start : start + size]))
        position = position + 8 if start == position + 4 else start + size + -size % 8
    return found


def _damaged(path: Path, where: str) -> DataError:
    return DataError(f"{path}: {where} is no matrix whose parts fit together; it was damaged; save it again")
