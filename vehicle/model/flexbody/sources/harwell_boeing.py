"""Harwell-Boeing files of assembled real matrices, as HBMAT of ANSYS writes them.

Four lines of head (five with right-hand sides) give the Fortran formats of the three blocks that follow: where each
column begins, the row of each entry, its value. Source: Duff, Grimes and Lewis, Users' Guide for the Harwell-Boeing
Sparse Matrix Collection, 1992.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.errors import DataError

_TYPE = re.compile(r"[RCP][SUHZR][AE] ", re.IGNORECASE)
_FORMAT = re.compile(r"\((?:\d*P,?)?(\d*)[IEDFG](\d+)", re.IGNORECASE)


def is_harwell_boeing(path: Path) -> bool:
    """Whether the third line of a file names a type of matrix."""
    with path.open(encoding="ascii", errors="replace") as file:
        head = [file.readline() for _ in range(3)]
    return bool(_TYPE.match(head[2]))


def read_harwell_boeing(path: Path) -> Any:
    """The matrix as it is stored, one triangle of a symmetric one; sparse.

    Raises:
        DataError: not assembled, not real, or damaged.
    """
    lines = path.read_text(encoding="ascii", errors="replace").splitlines()
    try:
        counts = [int(word) for word in lines[1].split()]
        kind, shape = lines[2][:3].upper(), [int(word) for word in lines[2][3:].split()]
        if kind not in ("RSA", "RUA"):
            raise ValueError(f"of type {kind}; needed is RSA or RUA, real and assembled")
        rows, columns, entries = shape[:3]
        formats = [lines[3][i:j].replace(" ", "") for i, j in ((0, 16), (16, 32), (32, 52))]
        first = 4 + (len(counts) > 4 and counts[4] > 0)
        blocks = []
        for written, count, size in zip(formats, counts[1:4], (columns + 1, entries, entries), strict=True):
            found = _FORMAT.match(written)
            if found is None:
                raise ValueError(f"format {written!r} is none of Fortran's for numbers")
            width = int(found[2])
            words = [
                line[i : i + width]
                for line in lines[first : first + count]
                for i in range(0, len(line.rstrip()), width)
            ]
            if len(words) != size:
                raise ValueError(f"{len(words)} numbers where {size} belong; the file is cut off")
            blocks.append(np.array([float(word.upper().replace("D", "E")) for word in words]))
            first += count
        start, row = blocks[0].astype(int) - 1, blocks[1].astype(int) - 1
        if (
            start[0] != 0
            or start[-1] != entries
            or np.any(np.diff(start) < 0)
            or not 0 <= row.min() <= row.max() < rows
        ):
            raise ValueError("its pointers or rows lead out of the matrix")
    except (ValueError, IndexError) as error:
        raise DataError(f"{path}: no Harwell-Boeing file of a matrix: {error}.") from error
    return scipy.sparse.csc_matrix((blocks[2], row, start), shape=(rows, columns))
