"""Harwell-Boeing files of assembled real matrices, as written by HBMAT of ANSYS.

A header of four lines (five with right-hand sides) contains the Fortran formats of the three following blocks: start of
each column, row of each entry, value of each entry. Source: Duff, Grimes and Lewis, Users' Guide for the Harwell-Boeing
Sparse Matrix Collection, 1992.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.errors import DataError

_TYPE = re.compile(r"[RCP][SUHZR][AE] ", re.IGNORECASE)
_FORMAT = re.compile(r"\((?:\d*P,?)?(\d*)[IEDFG](\d+)", re.IGNORECASE)


def is_harwell_boeing(path: Path) -> bool:
    """Return True if the third line of a file contains a Harwell-Boeing matrix type."""
    with path.open(encoding="ascii", errors="replace") as file:
        head = [file.readline() for _ in range(3)]
    return bool(_TYPE.match(head[2]))


def read_harwell_boeing(path: Path) -> Any:
    """Read a sparse matrix as stored; of a symmetric matrix, only one triangle.

    Raises:
        DataError: the matrix is not assembled or not real, or the file is damaged.
    """
    lines = path.read_text(encoding="ascii", errors="replace").splitlines()
    try:
        counts = [int(word) for word in lines[1].split()]
        matrix_type, shape = lines[2][:3].upper(), [int(word) for word in lines[2][3:].split()]
        if matrix_type not in ("RSA", "RUA"):
            raise ValueError(f"the type is {matrix_type} but must be RSA or RUA (real, assembled)")
        rows, columns, entries = shape[:3]
        formats = [lines[3][i:j].replace(" ", "") for i, j in ((0, 16), (16, 32), (32, 52))]
        first = 4 + (len(counts) > 4 and counts[4] > 0)
        blocks = []
        for fortran_format, count, size in zip(formats, counts[1:4], (columns + 1, entries, entries), strict=True):
            layout = _FORMAT.match(fortran_format)
            if layout is None:
                raise ValueError(f"{fortran_format!r} is not a Fortran format of numbers")
            width = int(layout[2])
            fields = [
                line[i : i + width]
                for line in lines[first : first + count]
                for i in range(0, len(line.rstrip()), width)
            ]
            if len(fields) != size:
                raise ValueError(f"contains {len(fields)} numbers instead of {size}; the file is truncated")
            blocks.append(np.array([float(word.upper().replace("D", "E")) for word in fields]))
            first += count
        start, row = blocks[0].astype(int) - 1, blocks[1].astype(int) - 1
        if (
            start[0] != 0
            or start[-1] != entries
            or np.any(np.diff(start) < 0)
            or not 0 <= row.min() <= row.max() < rows
        ):
            raise ValueError("column pointers or rows are outside the matrix")
    except (ValueError, IndexError) as error:
        raise DataError(f"{path}: cannot be read as a Harwell-Boeing matrix: {error}. Export it again.") from error
    return scipy.sparse.csc_matrix((blocks[2], row, start), shape=(rows, columns))
