"""K and M of CalculiX, written next to the input deck by `*FREQUENCY, SOLVER=MATRIXSTORAGE`."""

from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Indices
from vehicle.errors import DataError
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices, rounding_of
from vehicle.model.flexbody.sources.deck import Deck, read_deck
from vehicle.model.flexbody.sources.text_matrices import coordinate_matrix, nodes_and_directions, rows_of_numbers

INSIDE = 3
"""Number of nodes that CalculiX adds to a brick C3D8I: their displacements are the amplitudes of its nine incompatible
modes, with mass, along the global axes (CalculiX CrunchiX user's manual, section "Eight-node brick element with
incompatible modes")."""


def read_calculix(path: Path) -> BodyMatrices:
    """Read the matrices of a job, in the units of its deck.

    Args:
        path: `JOB.sti`, in a folder with `JOB.mas`, `JOB.dof` (a line "node.direction" for each row) and `JOB.inp`
            (nodes).

    Raises:
        DataError: a file is missing or damaged, or the files are inconsistent.
    """
    files = {suffix: path.with_suffix(f".{suffix}") for suffix in ("sti", "mas", "dof", "inp")}
    for suffix, file in files.items():
        if not file.is_file():
            raise DataError(
                f"{file}: {suffix} is missing. CalculiX writes .sti, .mas and .dof with "
                "*FREQUENCY,SOLVER=MATRIXSTORAGE; the node positions are in the input deck .inp."
            )
    numbers = rows_of_numbers(files["dof"], 2, separator=".")
    identity, direction = nodes_and_directions(files["dof"], numbers)
    deck = read_deck(files["inp"])
    size = len(identity)
    stiffness, mass = (coordinate_matrix(files[suffix], size) for suffix in ("sti", "mas"))
    return assembled(path, stiffness, mass, identity, direction, deck, "CalculiX")


def assembled(
    path: Path, stiffness: Any, mass: Any, identity: Indices, direction: Indices, deck: Deck, program: str
) -> BodyMatrices:
    """Combine matrices, degrees of freedom and nodes to `BodyMatrices`.

    Args:
        path: file named in messages and as the source.
        stiffness, mass: sparse matrices, shape (dofs, dofs).
        identity: node number of each degree of freedom, shape (dofs,).
        direction: direction of each degree of freedom, 0 to 5, shape (dofs,).
        deck: node positions and elements.
        program: program that wrote the matrices.

    Raises:
        DataError: a node has no position, or the matrices are invalid; see `BodyMatrices`.
    """
    numbers = np.unique(identity)
    missing = [int(number) for number in numbers if int(number) not in deck.positions]
    positions = dict(deck.positions)
    if missing and program == "CalculiX" and len(missing) == INSIDE * deck.incompatible:
        # Amplitudes of incompatible modes have no position; the mean node position keeps the extent of the body.
        middle = np.mean([positions[int(number)] for number in numbers if int(number) in positions], axis=0)
        positions |= dict.fromkeys(missing, (float(middle[0]), float(middle[1]), float(middle[2])))
        direction = np.where(np.isin(identity, missing), direction + 6, direction)
        missing = []
    if missing:
        raise DataError(
            f"{path}: {len(missing)} nodes of the matrices have no position in the list of nodes; the first is "
            f"{missing[0]}. Give the list of all nodes; CalculiX expands shells and beams to solids with "
            "additional nodes and constraints, so only matrices of solid elements describe a free body."
        )
    index = {int(number): i for i, number in enumerate(numbers)}
    edges = sorted({(index[a], index[b]) for a, b in deck.edges if a in index and b in index})
    try:
        return BodyMatrices(
            stiffness=stiffness,
            mass=mass,
            rounding=rounding_of(stiffness),
            nodes=tuple(str(number) for number in numbers),
            positions=np.array([positions[int(number)] for number in numbers]),
            node=np.array([index[int(number)] for number in identity]),
            direction=direction,
            edges=np.array(edges, dtype=int).reshape(-1, 2),
            source=f"{program}, K and M of {path.name}",
        )
    except DataError as error:
        raise DataError(f"{path}: {error}") from error
