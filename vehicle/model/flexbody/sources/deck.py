"""Nodes and elements of an input deck of Abaqus or CalculiX, or of a table of nodes."""

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.sources.text_matrices import text_of
from vehicle.model.parameters.hardpoints import Point

_CORNERS = {"C3D20": 8, "C3D20R": 8, "C3D8": 8, "C3D8R": 8, "C3D8I": 8, "C3D10": 4, "C3D4": 4, "C3D15": 6, "C3D6": 6}
_BOX = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
_WEDGE = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
LINES = {8: _BOX, 6: _WEDGE, 4: tuple(itertools.combinations(range(4), 2))}


@dataclass(frozen=True, kw_only=True, slots=True)
class Deck:
    """Nodes and elements of a deck.

    Attributes:
        positions: node number -> position, in the unit of the deck.
        edges: element edges as pairs of node numbers.
        incompatible: number of C3D8I elements, for each of which CalculiX adds three nodes.
    """

    positions: dict[int, Point]
    edges: frozenset[tuple[int, int]]
    incompatible: int = 0


def read_deck(path: Path) -> Deck:
    """Read `*NODE` and `*ELEMENT` of a deck, or a CSV of nodes "node,x,y,z".

    Raises:
        DataError: the file is unreadable, or a line of nodes or elements is invalid.
    """
    lines = text_of(path, encoding="utf-8", errors="replace").splitlines()
    positions: dict[int, Point] = {}
    edges: set[tuple[int, int]] = set()
    block, corners, element_type, incompatible = "*node" if path.suffix == ".csv" else "", 0, "", 0
    pending: list[int] = []
    for number, line in enumerate(lines, 1):
        text = line.strip()
        if not text or text.startswith(("**", "#")) or (path.suffix == ".csv" and number == 1 and text[:1].isalpha()):
            continue
        if text.startswith("*"):
            keywords = [keyword.strip().lower() for keyword in text.split(",")]
            block, pending = keywords[0], []
            element_type = next(
                (keyword.split("=")[1].strip().upper() for keyword in keywords if keyword.startswith("type")), ""
            )
            corners = _CORNERS.get(element_type, 0)
            continue
        fields = [field for field in text.split(",") if field.strip()]
        try:
            if block == "*node":
                # A deck may omit coordinates of zero at the end of a line, a table may not.
                zeros = ["0"] * 3 if path.suffix != ".csv" and len(fields) > 1 else []
                x, y, z = (float(field) for field in [*fields[1:4], *zeros][:3])
                if not np.isfinite([x, y, z]).all():
                    raise ValueError("a coordinate is not finite")
                if positions.setdefault(int(fields[0]), (x, y, z)) != (x, y, z):
                    raise ValueError(f"node {fields[0].strip()} is also at {list(positions[int(fields[0])])}")
            elif block == "*element" and corners:
                pending += [int(field) for field in fields]
                if not text.endswith(","):
                    corner_nodes = pending[1 : 1 + corners]
                    edges |= {
                        (min(corner_nodes[a], corner_nodes[b]), max(corner_nodes[a], corner_nodes[b]))
                        for a, b in LINES[corners]
                    }
                    pending = []
                    incompatible += element_type == "C3D8I"
        except (ValueError, IndexError) as error:
            raise DataError(f"{path}, line {number}: {text[:60]!r} is not a line of {block} ({error}).") from error
    if not positions:
        raise DataError(f"{path}: contains no nodes. Give the input deck with *NODE, or a CSV node,x,y,z.")
    return Deck(positions=positions, edges=frozenset(edges), incompatible=incompatible)
