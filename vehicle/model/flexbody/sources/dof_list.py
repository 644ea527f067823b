"""Node and direction of each row of K and M, from a table of numbers or the mapping file of ANSYS."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import IntArray
from vehicle.model.flexbody.sources.text_matrices import rows_of_numbers, whole_numbers

LABELS = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")


def read_dofs(path: Path) -> tuple[IntArray, IntArray]:
    """Read the list of degrees of freedom, in the order of the rows of the matrices.

    Args:
        path: rows "node,direction", direction 1 to 3 displacements along x, y, z, 4 to 6 rotations about x, y, z; or
            rows "equation node label" with labels UX to ROTZ, written to JOB.mapping by `HBMAT,...,YES` of ANSYS.

    Returns:
        Node numbers; directions, 0 to 5; both of shape (dofs,).

    Raises:
        DataError: a row is invalid, a direction or label unknown, or the equations are not numbered 1, 2, 3, ...
    """
    try:
        table = [line.replace(",", " ").split() for line in path.read_text(encoding="ascii").splitlines()]
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read as text ({error}).") from error
    labelled = [i for i, row in enumerate(table) if len(row) in (2, 3) and row[-1].upper() in LABELS]
    if not labelled:
        listed = rows_of_numbers(path, 1, columns=2)
        node, direction = (whole_numbers(path, listed[:, i]) - i for i in (0, 1))
        if direction.min() < 0 or direction.max() > 5:
            raise DataError(f"{path}: found directions {direction.min() + 1} to {direction.max() + 1}, must be 1 to 6.")
        return node, direction
    rows = [row for row in table[labelled[0] :] if row]
    try:
        directions = [{label: i for i, label in enumerate(LABELS)}[row[-1].upper()] for row in rows]
        nodes = [int(row[-2]) for row in rows]
        equations = [int(row[0]) for row in rows if len(row) == 3]
    except (KeyError, ValueError, IndexError) as error:
        raise DataError(
            f"{path}: found {error}; a row must be equation, node and one of {', '.join(LABELS)}. Temperatures, "
            "pressures and other degrees of freedom are not supported."
        ) from error
    if equations and equations != list(range(1, len(rows) + 1)):
        raise DataError(
            f"{path}: the equations must be 1 to {len(rows)} in this order. Give the complete mapping file."
        )
    return np.array(nodes), np.array(directions)
