"""Bulk data of Nastran as text: matrices as DMIG (punch file `.pch`) and nodes as GRID.

An entry is a line of eight fields of 8 columns, four fields of 16 columns if its name ends in *, or fields separated by
commas. Lines that begin with a blank, + or * continue an entry. Columns after the 72nd are sequence numbers. A real
number may omit the E of its exponent. Source: MSC Nastran Quick Reference Guide, Bulk Data: DMIG, GRID, format of
entries.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Indices
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.text_matrices import text_of, whole
from vehicle.model.parameters.hardpoints import Point

_BARE_EXPONENT = re.compile(r"(?<=[\d.])([+-]\d+)$")
_SYMMETRIC, _SQUARE = 6, 1


@dataclass(frozen=True, kw_only=True, slots=True)
class BulkData:
    """DMIG matrices and GRID points of a bulk data file.

    Attributes:
        matrices: matrix name -> stored entries, (node, component, node, component) -> value.
        others: name of a matrix of another form or type, such as a load vector -> why it is neither K nor M.
        positions: node number -> position, in the unit of the file.
    """

    matrices: dict[str, dict[tuple[int, int, int, int], float]]
    others: dict[str, str]
    positions: dict[int, Point]


def entries(path: Path) -> Iterator[tuple[int, str, list[str]]]:
    """Yield the entries of a file: number of the first line, name, fields with empty fields up to the line width.

    Raises:
        DataError: the file is unreadable.
    """
    lines = text_of(path, errors="replace").splitlines()
    started: tuple[int, str, list[str]] | None = None
    for number, line in enumerate(lines, 1):
        text = line.split("$")[0].rstrip()
        if not text:
            continue
        if "," in text:
            head, *fields = (word.strip() for word in text.split(","))
            width = 4 if head.endswith("*") else 8
        else:
            text = text.expandtabs(8)
            head = text[:8].strip()
            size, width = (16, 4) if "*" in head else (8, 8)
            fields = [text[i : i + size].strip() for i in range(8, len(text), size)]
        fields = (fields + [""] * width)[:width]
        if head[:1] in ("", "+", "*"):
            if started is not None:
                started[2].extend(fields)
            continue
        if started is not None:
            yield started
        started = (number, head.rstrip("* ").upper(), fields)
    if started is not None:
        yield started


def read_bulk_data(path: Path) -> BulkData:
    """Read the DMIG matrices and GRID points of a file.

    Raises:
        DataError: an entry is damaged, a point scalar, or a position in a local coordinate system.
    """
    matrices: dict[str, dict[tuple[int, int, int, int], float]] = {}
    others: dict[str, str] = {}
    positions: dict[int, Point] = {}
    for number, name, fields in entries(path):
        try:
            if name == "DMIG":
                _dmig(matrices, others, fields)
            elif name == "GRID":
                if fields[1] not in ("", "0"):
                    raise ValueError(f"the position is in coordinate system {fields[1]}; use the basic system for GRID")
                if fields[5] not in ("", "0"):
                    raise ValueError(f"displacements are in coordinate system {fields[5]}; use the basic system")
                x, y, z = (_real(field) if field else 0.0 for field in fields[2:5])
                positions[int(fields[0])] = (x, y, z)
        except (ValueError, IndexError) as error:
            raise DataError(f"{path}, line {number}: {name} {fields[0]}: {error}.") from error
    return BulkData(matrices=matrices, others=others, positions=positions)


def is_bulk_data(path: Path) -> bool:
    """Return True if the suffix of a file, also in "FILE:MATRIX", is one of Nastran bulk data."""
    return path.with_name(path.name.partition(":")[0]).suffix.lower() in (".pch", ".bdf", ".nas")


def dmig_pair(path: Path, data: BulkData, names: tuple[str, str]) -> tuple[Any, Any, Indices, Indices]:
    """Return K and M of a file, with the node and direction of their rows.

    Args:
        path: file named in messages.
        data: content of the file.
        names: names of the stiffness and mass matrix; an empty name selects the only matrix that begins with K or M.

    Returns:
        Two sparse matrices; node number and direction, 0 to 5, of each row.

    Raises:
        DataError: a matrix is missing or ambiguous.
    """
    chosen = []
    for letter, name in zip("KM", names, strict=True):
        candidates = [name.upper()] if name else [key for key in data.matrices if key.startswith(letter)]
        if len(candidates) != 1 or candidates[0] not in data.matrices:
            others = "".join(f"{other} is another matrix: {fault}. " for other, fault in data.others.items())
            raise DataError(
                f"{path}: found DMIG matrices {', '.join(data.matrices) or 'none'}, must be two, with names that "
                f"begin with K and M. {others}For other names give {path.name}:NAME and --mass {path.name}:NAME."
            )
        chosen.append(data.matrices[candidates[0]])
    rows = sorted({matrices for matrix in chosen for key in matrix for matrices in (key[:2], key[2:])})
    index = {matrices: i for i, matrices in enumerate(rows)}
    matrices = []
    for matrix in chosen:
        indices = np.array([(index[key[2:]], index[key[:2]]) for key in matrix]).reshape(-1, 2)
        values = list(matrix.values())
        matrices.append(whole(scipy.sparse.coo_matrix((values, indices.T), shape=(len(rows), len(rows))).tocsc()))
    node, component = np.array(rows).reshape(-1, 2).T
    return matrices[0], matrices[1], node, component - 1


def _dmig(
    matrices: dict[str, dict[tuple[int, int, int, int], float]], others: dict[str, str], fields: list[str]
) -> None:
    name = fields[0].upper()
    if fields[1] == "0":  # the head of a matrix: form, type
        if int(fields[2]) not in (_SQUARE, _SYMMETRIC):
            others[name] = f"the matrix form is {fields[2]} but must be 6 (symmetric) or 1 (square)"
        elif int(fields[3]) not in (1, 2):
            others[name] = f"the number type is {fields[3]} but must be 1 or 2 (real)"
        else:
            matrices.setdefault(name, {})
        return
    if name in others:
        return
    if name not in matrices:
        raise ValueError(
            "a matrix column comes before the header line of its matrix (DMIG NAME 0 ...); put the header first"
        )
    column = int(fields[1]), int(fields[2] or 0)
    for i in range(4, len(fields), 4):
        if not any(fields[i : i + 4]):
            continue
        row = int(fields[i]), int(fields[i + 1] or 0)
        for node, component in (row, column):
            if not 1 <= component <= 6:
                raise ValueError(
                    f"found component {component} of {node}, must be 1 to 6. Component 0 is a scalar point, a "
                    "coordinate of a reduction: punch the matrices of all nodes, or of a static reduction "
                    "without modes"
                )
        if (*column, *row) in matrices[name]:
            raise ValueError(
                f"row {row[0]}, {row[1]} of column {column[0]}, {column[1]} occurs twice; remove one of them"
            )
        matrices[name][(*column, *row)] = _real(fields[i + 2])


def _real(text: str) -> float:
    """Parse a real number of Nastran: 1.5, 1.5+3, 1.5D+03."""
    value = float(_BARE_EXPONENT.sub(r"E\1", text.upper().replace("D", "E")))
    if not np.isfinite(value):
        raise ValueError(f"{text} is not finite")
    return value
