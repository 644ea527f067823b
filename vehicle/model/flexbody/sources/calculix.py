"""K and M of CalculiX: what `*FREQUENCY, SOLVER=MATRIXSTORAGE` writes beside its input deck."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices, IntArray
from vehicle.model.flexbody.sources.deck import Deck, read_deck
from vehicle.model.flexbody.sources.text_matrices import coordinate_matrix, rows_of_numbers, whole_numbers

INSIDE = 3
"""Nodes that CalculiX adds to a brick C3D8I: their displacements are the amplitudes of its nine incompatible modes,
with mass, along the global axes (CalculiX CrunchiX user's manual, section "Eight-node brick element with
incompatible modes")."""


def read_calculix(path: Path) -> BodyMatrices:
    """The matrices of a job, in the units of its deck.

    Args:
        path: `JOB.sti`; `JOB.mas` and `JOB.dof` (a line "node.direction" for each row), and `JOB.inp` with the nodes
            lie beside it.

    Raises:
        DataError: a file is missing or damaged, or the three do not belong together.
    """
    files = {suffix: path.with_suffix(f".{suffix}") for suffix in ("sti", "mas", "dof", "inp")}
    for suffix, file in files.items():
        if not file.is_file():
            raise DataError(
                f"{file}: no such file. CalculiX writes .sti, .mas and .dof with *FREQUENCY,SOLVER=MATRIXSTORAGE; the "
                f"input deck .inp has the places of the nodes ({suffix} is missing)."
            )
    numbers = rows_of_numbers(files["dof"], 1, separator=".", columns=2)
    identity, direction = (whole_numbers(files["dof"], numbers[:, i]) - i for i in (0, 1))
    if direction.min() < 0 or direction.max() > 5:
        raise DataError(
            f"{files['dof']}: directions {direction.min() + 1} to {direction.max() + 1}; allowed are 1 to 6."
        )
    deck = read_deck(files["inp"])
    size = len(identity)
    stiffness, mass = (coordinate_matrix(files[suffix], size) for suffix in ("sti", "mas"))
    return assembled(path, stiffness, mass, identity, direction, deck, "CalculiX")


def assembled(
    path: Path, stiffness: Any, mass: Any, identity: IntArray, direction: IntArray, deck: Deck, program: str
) -> BodyMatrices:
    """Matrices, degrees of freedom and nodes put together.

    Args:
        path: named in the source.
        stiffness, mass: sparse, shape (dofs, dofs).
        identity: number of the node of each degree of freedom; shape (dofs,).
        direction: of each, 0 to 5; shape (dofs,).
        deck: places of the nodes, and elements.
        program: that wrote them.

    Raises:
        DataError: a node without a place; or as of `BodyMatrices`.
    """
    numbers = np.unique(identity)
    missing = [int(number) for number in numbers if int(number) not in deck.places]
    places = dict(deck.places)
    if missing and program == "CalculiX" and len(missing) == INSIDE * deck.incompatible:
        # Amplitudes of incompatible modes have no place; that of the mean node keeps the extent of the body.
        middle = np.mean([places[int(number)] for number in numbers if int(number) in places], axis=0)
        places |= dict.fromkeys(missing, (float(middle[0]), float(middle[1]), float(middle[2])))
        direction = np.where(np.isin(identity, missing), direction + 6, direction)
        missing = []
    if missing:
        raise DataError(
            f"{path}: node {missing[0]} of the matrices has no place in the list of nodes ({len(missing)} so). Give "
            "the list of all nodes; CalculiX expands shells and beams to solids with nodes and constraints of its own, "
            "so that only matrices of solid elements are those of a free body."
        )
    index = {int(number): i for i, number in enumerate(numbers)}
    edges = sorted({(index[a], index[b]) for a, b in deck.edges if a in index and b in index})
    try:
        return BodyMatrices(
            stiffness=stiffness,
            mass=mass,
            nodes=tuple(str(number) for number in numbers),
            positions=np.array([places[int(number)] for number in numbers]),
            node=np.array([index[int(number)] for number in identity]),
            direction=direction,
            edges=np.array(edges, dtype=int).reshape(-1, 2),
            source=f"{program}, K and M of {path.name}",
        )
    except DataError as error:
        raise DataError(f"{path}: {error}") from error
