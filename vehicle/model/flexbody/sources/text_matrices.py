"""Matrices and lists of numbers in text files."""

import io
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Indices, Vector
from vehicle.errors import DataError

_NAMES = re.compile(r"(?!nan|inf)[a-z_]\w*([\s,]+[a-z_]\w*)*", re.IGNORECASE)
"""Header line of column names, for example "node,direction". Headers with units in brackets do not match."""


def text_of(path: Path, advice: str = "", *, encoding: str = "ascii", errors: str = "strict") -> str:
    """Read a text file.

    Args:
        path: text file.
        advice: end of the message of an error.
        encoding: encoding of the file.
        errors: "replace" for a file whose comments may have letters of another encoding.

    Raises:
        DataError: the file is unreadable or not text.
    """
    try:
        return path.read_text(encoding=encoding, errors=errors)
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read as text ({error}){advice}.") from error


def rows_of_numbers(path: Path, columns: int, *, separator: str = ",") -> Vector:
    """Read a text file with rows of numbers of equal length, shape (rows, columns); skip a header line of names.

    Raises:
        DataError: the file is unreadable, empty or truncated, or has entries
            other than numbers or rows of unequal length.
    """
    text = text_of(path)
    if _NAMES.fullmatch(text[: (end := text.find("\n"))].strip()):
        text = text[end + 1 :]
    text = text.replace(separator, " ").replace("D", "E").replace("d", "e")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # no rows: raised below
            numbers = np.loadtxt(io.StringIO(text), ndmin=2, comments=("#", "%", "**"))
    except ValueError as error:
        raise DataError(
            f"{path}: cannot be read as rows of numbers, or is truncated: {error}. The file must contain only "
            "numbers, with at most one line of names at the top."
        ) from error
    if not np.all(np.isfinite(numbers)):
        raise DataError(
            f"{path}: row {int(np.argwhere(~np.isfinite(numbers))[0, 0]) + 1} contains a number that is not finite."
        )
    if not len(numbers) or numbers.shape[1] != columns:
        raise DataError(
            f"{path}: found {numbers.shape[1]} numbers in each of {numbers.shape[0]} rows, must be {columns}."
        )
    return np.asarray(numbers)


def coordinate_matrix(path: Path, size: int) -> Any:
    """Read a symmetric sparse matrix from lines "row column value", counted from 1: one triangle or both.

    Args:
        path: text file.
        size: number of rows and columns of the matrix.

    Raises:
        DataError: an entry is outside the matrix, or the file is invalid; see `rows_of_numbers`.
    """
    table = rows_of_numbers(path, 3)
    row, column = (whole_numbers(path, table[:, i]) - 1 for i in (0, 1))
    if min(row.min(), column.min()) < 0 or max(row.max(), column.max()) >= size:
        raise DataError(
            f"{path}: found rows {row.min() + 1} to {row.max() + 1} and columns {column.min() + 1} to "
            f"{column.max() + 1}; must be 1 to {size}, the number of degrees of freedom. Use matrix and list of "
            "degrees of freedom of the same job."
        )
    matrix = scipy.sparse.coo_matrix((table[:, 2], (row, column)), shape=(size, size)).tocsc()
    return whole(matrix)


def whole_numbers(path: Path, values: npt.NDArray[Any]) -> Indices:
    """Convert numbers of nodes, directions or rows to integers.

    Raises:
        DataError: a number is not whole.
    """
    integers = values.astype(int)
    if np.any(integers != values):
        raise DataError(
            f"{path}: must contain only whole numbers (node, direction, row), not {values[integers != values][0]:g}."
        )
    return integers


def nodes_and_directions(path: Path, rows: npt.NDArray[Any]) -> tuple[Indices, Indices]:
    """Return the node numbers, and the directions as 0 to 5, of rows "node, direction 1 to 6".

    Raises:
        DataError: a number is not whole, or a direction is not 1 to 6.
    """
    node, direction = whole_numbers(path, rows).T
    if direction.min() < 1 or direction.max() > 6:
        raise DataError(f"{path}: found directions {direction.min()} to {direction.max()}, must be 1 to 6.")
    return node, direction - 1


def whole(matrix: Any) -> Any:
    """Complete a symmetric matrix stored as one triangle, and convert it to csc."""
    upper, lower = scipy.sparse.triu(matrix, 1), scipy.sparse.tril(matrix, -1)
    if upper.nnz and lower.nnz:
        return matrix.tocsc()
    return (matrix + (upper + lower).T).tocsc()
