"""K and M in separate files: Matrix Market, MATLAB, Abaqus and others, with tables of degrees of freedom and nodes."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Indices
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices
from vehicle.model.flexbody.sources.calculix import assembled
from vehicle.model.flexbody.sources.deck import Deck, read_deck
from vehicle.model.flexbody.sources.harwell_boeing import is_harwell_boeing, read_harwell_boeing
from vehicle.model.flexbody.sources.nastran import dmig_pair, is_bulk_data, read_bulk_data
from vehicle.model.flexbody.sources.text_matrices import (
    coordinate_matrix,
    nodes_and_directions,
    rows_of_numbers,
    text_of,
    whole,
    whole_numbers,
)

_FIVE = re.compile(r"\s*(\d+[\s,]+){4}[-+.\d]")
"""Row "node, direction, node, direction, value"."""
_LABELS = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")
"""Directions in a mapping file of ANSYS."""


def read_matrices(stiffness: Path, mass: Path | None, dofs: Path | None, nodes: Path | None) -> BodyMatrices:
    """Read stiffness and mass matrix of a body, in the units of the source.

    Args:
        stiffness, mass: Matrix Market (`*EXPORT,...,MMF` of ANSYS); Harwell-Boeing (`HBMAT` of ANSYS); `.mat` of
            MATLAB, "FILE.mat:NAME" to select one of several matrices; `.mtx` or text of `*MATRIX OUTPUT` of Abaqus,
            rows "node, direction, node, direction, value", which need no list of degrees of freedom; text "row column
            value"; DMIG of Nastran, both matrices in one file.
        dofs: list of degrees of freedom of the rows; see `read_dofs`.
        nodes: table "node,x,y,z" or input deck; by default, GRID in the file of the matrices.

    Raises:
        ConfigurationError: the mass matrix, nodes or list of degrees of freedom are required but missing.
        DataError: a file is missing or damaged, or the files are inconsistent.
    """
    if is_bulk_data(stiffness):
        return _of_bulk_data(stiffness, mass, nodes)
    if mass is None or nodes is None:
        raise ConfigurationError(
            f"{stiffness.name}: a stiffness matrix also needs --mass and, for the node positions, --nodes"
        )
    deck = _nodes(nodes)
    by_node = _is_by_node(stiffness)
    if by_node:
        table, other = rows_of_numbers(stiffness, 5), rows_of_numbers(mass, 5)
        named = [whole_numbers(file, rows[:, :4]) for file, rows in ((stiffness, table), (mass, other))]
        pairs = np.unique(np.vstack(named).reshape(-1, 2), axis=0)
        index = {(int(node), int(direction)): i for i, (node, direction) in enumerate(pairs)}
        matrices = [_of_pairs(rows, index) for rows in (table, other)]
        identity, direction = nodes_and_directions(stiffness, pairs)
    else:
        if dofs is None:
            raise ConfigurationError(
                f"{stiffness.name}: the degrees of freedom are missing; give --dofs FILE, a table node,direction "
                "(1 to 3 displacements, 4 to 6 rotations) with a line for each row of the matrices"
            )
        identity, direction = read_dofs(dofs)
        matrices = [_matrix(file, len(identity)) for file in (stiffness, mass)]
    return assembled(stiffness, matrices[0], matrices[1], identity, direction, deck, "finite elements")


def read_dofs(path: Path) -> tuple[Indices, Indices]:
    """Read the node numbers and the directions, 0 to 5, of the rows of the matrices, in their order.

    Args:
        path: rows "node,direction", direction 1 to 3 displacements along x, y, z, 4 to 6 rotations about x, y, z; or
            rows "equation node label" with labels UX to ROTZ, written to JOB.mapping by `HBMAT,...,YES` of ANSYS.

    Raises:
        DataError: a row is invalid, a direction or label unknown, or the equations are not numbered 1, 2, 3, ...
    """
    table = [line.replace(",", " ").split() for line in text_of(path).splitlines()]
    labelled = [i for i, row in enumerate(table) if len(row) in (2, 3) and row[-1].upper() in _LABELS]
    if not labelled:
        return nodes_and_directions(path, rows_of_numbers(path, 2))
    rows = [row for row in table[labelled[0] :] if row]
    try:
        directions = [{label: i for i, label in enumerate(_LABELS)}[row[-1].upper()] for row in rows]
        nodes = [int(row[-2]) for row in rows]
        equations = [int(row[0]) for row in rows if len(row) == 3]
    except (KeyError, ValueError, IndexError) as error:
        raise DataError(
            f"{path}: found {error}; a row must be equation, node and one of {', '.join(_LABELS)}. Temperatures, "
            "pressures and other degrees of freedom are not supported."
        ) from error
    if equations and equations != list(range(1, len(rows) + 1)):
        raise DataError(
            f"{path}: the equations must be 1 to {len(rows)} in this order. Give the complete mapping file."
        )
    return np.array(nodes), np.array(directions)


def _of_bulk_data(stiffness: Path, mass: Path | None, nodes: Path | None) -> BodyMatrices:
    """Read K and M from a punch file of Nastran; "FILE:NAME" selects one of several matrices."""
    file, _, name = stiffness.name.partition(":")
    path, other = stiffness.with_name(file), "" if mass is None else mass.name.partition(":")[2]
    data = read_bulk_data(path)
    first, second, identity, direction = dmig_pair(path, data, (name, other))
    deck = _nodes(nodes) if nodes else Deck(positions=data.positions, edges=frozenset())
    return assembled(path, first, second, identity, direction, deck, "Nastran")


def _nodes(path: Path) -> Deck:
    """Read node positions from a table, a deck of Abaqus or CalculiX, or bulk data of Nastran."""
    if is_bulk_data(path):
        return Deck(positions=read_bulk_data(path).positions, edges=frozenset())
    return read_deck(path)


def _is_by_node(path: Path) -> bool:
    """Return True if a file contains rows of five numbers, as written by Abaqus."""
    if path.suffix == ".mat" or ":" in path.name:
        return False
    try:
        with path.open(encoding="ascii") as file:
            for line in file:
                if line.strip() and not line.startswith(("%", "*", "#")):
                    return bool(_FIVE.match(line))
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read as text ({error}).") from error
    return False


def _of_pairs(table: Any, index: dict[tuple[int, int], int]) -> Any:
    row = [index[int(node), int(direction)] for node, direction in table[:, :2]]
    column = [index[int(node), int(direction)] for node, direction in table[:, 2:4]]
    return whole(scipy.sparse.coo_matrix((table[:, 4], (row, column)), shape=(len(index), len(index))).tocsc())


def _matrix(path: Path, size: int) -> Any:
    """Read a symmetric sparse matrix in any of the supported formats."""
    name, _, variable = path.name.partition(":")
    file = path.with_name(name)
    if file.suffix == ".mat":
        return _of_matlab(file, variable)
    try:
        with file.open("rb") as stream:
            market = stream.read(14) == b"%%MatrixMarket"
        if not market and is_harwell_boeing(file):
            return _real(file, read_harwell_boeing(file))
        if not market:
            return coordinate_matrix(file, size)
        return _real(file, scipy.io.mmread(file))
    except (OSError, ValueError, OverflowError, TypeError) as error:
        raise DataError(f"{file}: the matrix cannot be read ({error}).") from error


def _of_matlab(file: Path, variable: str) -> Any:
    try:
        content = {key: value for key, value in scipy.io.loadmat(file).items() if not key.startswith("__")}
    except (OSError, ValueError, NotImplementedError, TypeError) as error:
        raise DataError(f"{file}: is not a MAT file of version 5 ({error}); save it with -v7.") from error
    square = {
        key: value for key, value in content.items() if getattr(value, "ndim", 0) == 2 and len(set(value.shape)) == 1
    }
    if variable and variable not in content:
        raise DataError(f"{file}: has no variable {variable!r}; choose from {', '.join(content)}.")
    if not variable and len(square) != 1:
        raise DataError(
            f"{file}: contains {len(square)} square matrices ({', '.join(square)}); choose one of them with "
            f"{file.name}:NAME."
        )
    return _real(file, content[variable] if variable else next(iter(square.values())))


def _real(file: Path, matrix: Any) -> Any:
    """Convert a matrix to a complete symmetric sparse matrix of real numbers."""
    if getattr(matrix, "ndim", 0) != 2 or matrix.dtype.kind not in "iuf":
        raise DataError(f"{file}: found {getattr(matrix, 'dtype', type(matrix))}, must be a matrix of real numbers.")
    return whole(scipy.sparse.csc_matrix(matrix, dtype=float))
