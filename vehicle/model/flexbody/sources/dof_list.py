"""Which node and direction each row of K and M is: a table of numbers, or the mapping file of ANSYS."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import IntArray
from vehicle.model.flexbody.sources.text_matrices import rows_of_numbers, whole_numbers

LABELS = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")


def read_dofs(path: Path) -> tuple[IntArray, IntArray]:
    """The degrees of freedom in the order of the matrices.

    Args:
        path: rows "node,direction", direction 1 to 3 displacements along x, y, z, 4 to 6 rotations about them; or rows
            "equation node label" with labels UX to ROTZ, as `HBMAT,...,YES` of ANSYS writes to JOB.mapping.

    Returns:
        Number of the node; direction, 0 to 5; both of shape (dofs,).

    Raises:
        DataError: a row that is none, a direction that no body has, or equations that are not 1, 2, 3, ...
    """
    try:
        words = [line.replace(",", " ").split() for line in path.read_text(encoding="ascii").splitlines()]
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read as text ({error}).") from error
    named = [i for i, row in enumerate(words) if len(row) in (2, 3) and row[-1].upper() in LABELS]
    if not named:
        listed = rows_of_numbers(path, 1, columns=2)
        node, direction = (whole_numbers(path, listed[:, i]) - i for i in (0, 1))
        if direction.min() < 0 or direction.max() > 5:
            raise DataError(f"{path}: directions {direction.min() + 1} to {direction.max() + 1}; allowed are 1 to 6.")
        return node, direction
    rows = [row for row in words[named[0] :] if row]
    try:
        directions = [{label: i for i, label in enumerate(LABELS)}[row[-1].upper()] for row in rows]
        nodes = [int(row[-2]) for row in rows]
        equations = [int(row[0]) for row in rows if len(row) == 3]
    except (KeyError, ValueError, IndexError) as error:
        raise DataError(
            f"{path}: found {error}; rows are equation, node and one of {', '.join(LABELS)}. A body has no other "
            "degrees of freedom, as temperatures or pressures."
        ) from error
    if equations and equations != list(range(1, len(rows) + 1)):
        raise DataError(f"{path}: equations are not 1 to {len(rows)} in this order. Give the whole mapping file.")
    return np.array(nodes), np.array(directions)
