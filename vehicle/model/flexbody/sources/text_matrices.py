"""Matrices and lists of numbers in text files."""

from __future__ import annotations

import io
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray

IntArray = npt.NDArray[np.intp]


_NAMES = re.compile(r"(?!nan|inf)[a-z_]\w*([\s,]+[a-z_]\w*)*", re.IGNORECASE)
"""A line of names above the numbers, as node,direction. With units in brackets it is none: those are options."""


def rows_of_numbers(path: Path, least: int, *, separator: str | None = None, columns: int | None = None) -> FloatArray:
    """The numbers of a file of equal rows, shape (rows, columns); a first line of names is passed over.

    Args:
        path: the file.
        least: fewest rows.
        separator: between numbers; blanks or commas by default.
        columns: how many are wanted.

    Raises:
        DataError: unreadable, not of numbers, of unequal rows, or cut off.
    """
    try:
        text = path.read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read as text ({error}).") from error
    if _NAMES.fullmatch(text[: (end := text.find("\n"))].strip()):
        text = text[end + 1 :]
    text = text.replace(separator or ",", " ").replace("D", "E").replace("d", "e")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of no rows, which is said below
            found = np.loadtxt(io.StringIO(text), ndmin=2, comments=("#", "%", "**"))
    except ValueError as error:
        raise DataError(
            f"{path}: not rows of numbers, or cut off: {error}; needed are numbers alone, below one line "
            "of names at most"
        ) from error
    if not np.all(np.isfinite(found)):
        raise DataError(f"{path}: row {int(np.argwhere(~np.isfinite(found))[0, 0]) + 1} holds a number not finite.")
    if len(found) < least or (columns is not None and found.shape[1] != columns):
        raise DataError(f"{path}: {found.shape[0]} rows of {found.shape[1]} numbers; needed are {columns} in each.")
    return np.asarray(found)


def coordinate_matrix(path: Path, size: int) -> Any:
    """A symmetric sparse matrix from rows "row column value", counted from 1: one triangle of it, or both.

    Args:
        path: the file.
        size: number of rows and columns.

    Raises:
        DataError: a place outside the matrix; or as of `rows_of_numbers`.
    """
    table = rows_of_numbers(path, 1, columns=3)
    row, column = (whole_numbers(path, table[:, i]) - 1 for i in (0, 1))
    if min(row.min(), column.min()) < 0 or max(row.max(), column.max()) >= size:
        raise DataError(
            f"{path}: rows {row.min() + 1} to {row.max() + 1} and columns {column.min() + 1} to {column.max() + 1}; "
            f"allowed are 1 to {size}, the degrees of freedom given. The files do not belong together."
        )
    matrix = scipy.sparse.coo_matrix((table[:, 2], (row, column)), shape=(size, size)).tocsc()
    return whole(matrix)


def whole_numbers(path: Path, values: FloatArray) -> IntArray:
    """Numbers of nodes, directions, rows.

    Raises:
        DataError: one is not whole.
    """
    found = values.astype(int)
    if np.any(found != values):
        raise DataError(f"{path}: {values[found != values][0]:g} is no whole number, as of a node, direction or row.")
    return found


def whole(matrix: Any) -> Any:
    """The symmetric matrix of which one triangle may be given, as csc."""
    upper, lower = scipy.sparse.triu(matrix, 1), scipy.sparse.tril(matrix, -1)
    if upper.nnz and lower.nnz:
        return matrix.tocsc()
    return (matrix + (upper + lower).T).tocsc()
