"""Check the data elements of version 5 MAT files before SciPy reads them: a damaged tag could crash the process.

Source: MathWorks, MAT-File Format, chapter 1.
"""

import math
import struct
from pathlib import Path

from vehicle.errors import DataError

MATRIX, COMPRESSED = 14, 15
"""Data types of elements of MAT-file level 5: array, compressed element."""

WIDTHS = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
"""Data type to size of a number [bytes]."""

NUMERIC = range(6, 16)
"""Classes of numeric arrays."""

OBJECT = 17
"""Class of objects: table, timetable, datetime, string."""

DEEPEST = 40
"""Maximum depth of nested structures; nesting in a damaged file may be unlimited."""


def check_matrix(path: Path, data: bytes, order: str, where: str, depth: int = 0) -> None:
    """Check that the parts of a matrix element are consistent.

    Args:
        data: bytes of the element without its tag.
        order: byte order, "<" or ">".
    """
    if not data:
        return  # an empty cell
    parts = _parts(path, data, order, where)
    data_types = [data_type for data_type, _ in parts[:3]]
    if len(parts) < 3 or data_types[0] != 6 or len(parts[0][1]) != 8 or depth > DEEPEST:
        raise _damaged(path, where)
    flags, sizes = parts[0][1], parts[1][1]
    if flags[0 if order == "<" else 3] in (16, OBJECT):
        return  # a function or an object: other parts, without numbers
    dimensions = struct.unpack(f"{order}{len(sizes) // 4}i", sizes[: len(sizes) // 4 * 4])
    word = struct.unpack(f"{order}I", flags[:4])[0]
    if data_types[1] != 5 or len(sizes) % 4 or (word & 255) not in (*NUMERIC, 1, 2, 3, 4, 5) or len(dimensions) < 2:
        raise _damaged(path, where)
    if min(dimensions) < 0 or data_types[2] not in (1, 16):
        raise _damaged(path, where)
    count = math.prod(dimensions)
    for data_type, content in parts[3:]:
        if data_type == MATRIX:
            check_matrix(path, content, order, where, depth + 1)
        elif (word & 255) in NUMERIC and len(content) != count * WIDTHS.get(data_type, 0):
            raise _damaged(path, where)
    if (word & 255) in NUMERIC and len(parts) != (5 if word & 0x800 else 4) and count:
        raise _damaged(path, where)


def object_name(path: Path, data: bytes, order: str) -> tuple[str, str] | None:
    """Return name and class of a MATLAB object, for example a table; None for other matrices.

    Args:
        data: bytes of the element without its tag.
        order: byte order, "<" or ">".
    """
    if len(data) < 16 or data[8 if order == "<" else 11] != OBJECT:
        return None
    parts = _parts(path, data, order, "an object")
    texts = [content.decode("latin-1") for data_type, content in parts[1:4] if data_type == 1]
    return (texts[0], texts[2]) if len(texts) == 3 else ("?", "object")


def _parts(path: Path, data: bytes, order: str, where: str) -> list[tuple[int, bytes]]:
    """Split an element into its parts: data type and bytes."""
    parts, position = [], 0
    while position + 8 <= len(data):
        data_type, size = struct.unpack(f"{order}II", data[position : position + 8])
        start = position + 8
        if data_type >> 16:  # a small element: both numbers in one word
            data_type, size, start = data_type & 0xFFFF, data_type >> 16, position + 4
            if size > 4:
                raise _damaged(path, where)
        if (data_type not in WIDTHS and data_type != MATRIX) or start + size > len(data):
            raise _damaged(path, where)
        parts.append((data_type, data[start : start + size]))
        position = position + 8 if start == position + 4 else start + size + -size % 8
    return parts


def _damaged(path: Path, where: str) -> DataError:
    return DataError(f"{path}: {where} is an inconsistent matrix; the file is damaged; save it again")
