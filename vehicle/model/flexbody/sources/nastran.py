"""Bulk data of Nastran in text: matrices as DMIG (a punch file `.pch`), and the nodes as GRID.

An entry is a line of eight fields of 8 columns, of four of 16 where its name ends in *, or of fields between commas;
lines that begin with a blank, + or * continue it. Columns behind the 72nd are sequence numbers. A real number may leave
out the E of its exponent. Source: MSC Nastran Quick Reference Guide, Bulk Data: DMIG, GRID, format of entries.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import IntArray
from vehicle.model.flexbody.sources.text_matrices import whole
from vehicle.model.parameters.hardpoints import Point

_BARE_EXPONENT = re.compile(r"(?<=[\d.])([+-]\d+)$")
_SYMMETRIC, _SQUARE = 6, 1


@dataclass(frozen=True, kw_only=True, slots=True)
class BulkData:
    """What a file holds.

    Attributes:
        matrices: name to its entries (node, component, node, component) -> value, as they are stored.
        places: of the nodes, in the unit of the file.
    """

    matrices: dict[str, dict[tuple[int, int, int, int], float]]
    places: dict[int, Point]


def entries(path: Path) -> Iterator[tuple[int, str, list[str]]]:
    """Entries of a file: number of the first line, name, fields; each line of an entry is filled to its full width.

    Raises:
        DataError: unreadable.
    """
    try:
        lines = path.read_text(encoding="ascii", errors="replace").splitlines()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error}).") from error
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
    """The DMIG matrices and GRID points of a file.

    Raises:
        DataError: a damaged entry, a complex matrix, a scalar point, a place in a coordinate system of its own.
    """
    matrices: dict[str, dict[tuple[int, int, int, int], float]] = {}
    places: dict[int, Point] = {}
    for number, name, fields in entries(path):
        try:
            if name == "DMIG":
                _dmig(matrices, fields)
            elif name == "GRID":
                if fields[1] not in ("", "0"):
                    raise ValueError(f"its place is in coordinate system {fields[1]}; write GRID in the basic one")
                if fields[5] not in ("", "0"):
                    raise ValueError(f"it moves along the axes of system {fields[5]}; let it move along the basic ones")
                x, y, z = (_real(field) if field else 0.0 for field in fields[2:5])
                places[int(fields[0])] = (x, y, z)
        except (ValueError, IndexError) as error:
            raise DataError(f"{path}, line {number}: {name} {fields[0]}: {error}.") from error
    return BulkData(matrices=matrices, places=places)


def is_bulk_data(path: Path) -> bool:
    """Whether a file, "FILE:MATRIX" too, is named as bulk data of Nastran."""
    return path.with_name(path.name.partition(":")[0]).suffix.lower() in (".pch", ".bdf", ".nas")


def dmig_pair(path: Path, data: BulkData, names: tuple[str, str]) -> tuple[Any, Any, IntArray, IntArray]:
    """K and M of a file, and what their rows are.

    Args:
        path: named in messages.
        data: of it.
        names: of the stiffness and the mass; the only ones that begin with K and with M where they are empty.

    Returns:
        Two sparse matrices, the number of the node and the direction, 0 to 5, of each row.

    Raises:
        DataError: no such matrix, or several.
    """
    chosen = []
    for letter, name in zip("KM", names, strict=True):
        found = [name.upper()] if name else [own for own in data.matrices if own.startswith(letter)]
        if len(found) != 1 or found[0] not in data.matrices:
            raise DataError(
                f"{path}: DMIG matrices {', '.join(data.matrices) or 'none'}; needed are one whose name begins with K "
                f"and one with M, or {path.name}:NAME with --mass {path.name}:NAME."
            )
        chosen.append(data.matrices[found[0]])
    rows = sorted({pair for matrix in chosen for key in matrix for pair in (key[:2], key[2:])})
    index = {pair: i for i, pair in enumerate(rows)}
    pair = []
    for matrix in chosen:
        place = np.array([(index[key[2:]], index[key[:2]]) for key in matrix]).reshape(-1, 2)
        values = list(matrix.values())
        pair.append(whole(scipy.sparse.coo_matrix((values, place.T), shape=(len(rows), len(rows))).tocsc()))
    node, component = np.array(rows).reshape(-1, 2).T
    return pair[0], pair[1], node, component - 1


def _dmig(matrices: dict[str, dict[tuple[int, int, int, int], float]], fields: list[str]) -> None:
    name = fields[0].upper()
    if fields[1] == "0":  # the head of a matrix: form, type
        if int(fields[2]) not in (_SQUARE, _SYMMETRIC):
            raise ValueError(f"form {fields[2]}; needed is 6, symmetric, or 1, square")
        if int(fields[3]) not in (1, 2):
            raise ValueError(f"type {fields[3]}; needed is 1 or 2, real")
        matrices.setdefault(name, {})
        return
    if name not in matrices:
        raise ValueError("a column before the head of the matrix, DMIG NAME 0 ...")
    column = int(fields[1]), int(fields[2] or 0)
    for i in range(4, len(fields), 4):
        if not any(fields[i : i + 4]):
            continue
        row = int(fields[i]), int(fields[i + 1] or 0)
        for node, component in (row, column):
            if not 1 <= component <= 6:
                raise ValueError(
                    f"component {component} of {node}; allowed are 1 to 6. Scalar points are coordinates of a "
                    "reduction: punch the matrices of all nodes, or of a static reduction without modes"
                )
        if (*column, *row) in matrices[name]:
            raise ValueError(f"row {row[0]}, {row[1]} of column {column[0]}, {column[1]} is given twice")
        matrices[name][(*column, *row)] = _real(fields[i + 2])


def _real(text: str) -> float:
    """A real number of Nastran: 1.5, 1.5+3, 1.5D+03."""
    value = float(_BARE_EXPONENT.sub(r"E\1", text.upper().replace("D", "E")))
    if not np.isfinite(value):
        raise ValueError(f"{text} is not finite")
    return value
