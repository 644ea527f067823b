"""Pattern of the rows of a run in MuJoCo's sparse format, with the columns of the body modes, and of their equations.

A suspension moves few coordinates: its own and those of the body. So most of J and of H = M + J' D J is zero. With
the body eliminated last the factor of H has hardly more numbers than H: 2 500 of 6 400 with four wheels. The cost of a
step then is proportional to the number of parts, that of a dense factor to its third power.

MuJoCo's own sparse rows contain the coordinates above the two bodies of a connection and no modes, which are bodies of
their own. The compiled callback copies these rows into a full matrix, writes the laws there as in the dense format, and
gives MuJoCo the nonzero columns, modes included, in arrays of its own; MuJoCo resets its pointers in every step.
Equations and tolerance of the solver are those of the dense format.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.arrays import Mask
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.structures import SPARSE, Offsets

TILE = 4
"""Rows and columns of a tile, as in `vehicle/core/source/prediction.h`."""


class Pattern(NamedTuple):
    """Nonzero numbers of the rows of a model with the sparse format.

    Attributes:
        nonzero: where the rows may be nonzero, modal columns included; (rows, nv).
        rows, columns: row and column of each of MuJoCo's own values, in its order.
    """

    nonzero: Mask
    rows: npt.NDArray[np.integer[Any]]
    columns: npt.NDArray[np.integer[Any]]

    @classmethod
    def of(cls, model: mujoco.MjModel, layout: Layout) -> Pattern:
        """Read the pattern of a model, which does not depend on its state."""
        data = mujoco.MjData(model)
        mujoco.mj_fwdPosition(model, data)
        rows, columns = np.repeat(np.arange(layout.row_count), data.efc_J_rownnz), data.efc_J_colind.copy()
        nonzero = np.zeros((layout.row_count, model.nv), dtype=np.bool_)
        nonzero[rows, columns] = True
        for row, count, first, last in layout.reach:
            nonzero[row : row + count, first:last] = True
        return cls(nonzero, rows, columns)


def sparse_rows(pattern: Pattern | None, offsets: Offsets) -> tuple[dict[str, Any], tuple[object, ...]]:
    """Return the sparse Jacobian of a run.

    Args:
        pattern: nonzero numbers of the rows; None for a state in the dense format.
        offsets: offsets in MuJoCo's structures.

    Returns:
        The record SparseRows, and the arrays of the pattern, to which it contains only addresses.
    """
    none: dict[str, Any] = dict.fromkeys(("places", "own", "offsets", "addresses", "replaced"), np.zeros(0, dtype=int))
    if pattern is None:
        return none | {"jacobian": np.zeros((0, 0)), "values": np.zeros(0), "size": 0}, ()
    nonzero = pattern.nonzero
    counts = np.count_nonzero(nonzero, axis=1).astype(np.int32)
    starts = np.cumsum([0, *counts[:-1]], dtype=np.int32)
    # Number of following rows with the same columns.
    following = np.zeros(len(nonzero), dtype=np.int32)
    for row in range(len(nonzero) - 2, -1, -1):
        following[row] = following[row + 1] + 1 if np.array_equal(nonzero[row], nonzero[row + 1]) else 0
    rows, columns = np.nonzero(nonzero)
    jacobian, values = np.zeros((len(nonzero), TILE * -(-nonzero.shape[1] // TILE))), np.zeros(rows.size)
    arrays = (counts, starts, following, columns.astype(np.int32), values)
    record = {
        "jacobian": jacobian,  # all columns of the rows, as the laws write them; (rows, nv)
        "values": values,  # nonzero values, row by row; (nJ,)
        # Index in the flat `jacobian` of each value, and of each of MuJoCo's own, without columns of the body modes.
        "places": rows * jacobian.shape[1] + columns,
        "own": np.asarray(pattern.rows * jacobian.shape[1] + pattern.columns, dtype=np.int64),
        # Byte offsets in mjData of the pointers to counts, starts, supernodes, columns and values, and the addresses of
        # the arrays of this car in that order; MuJoCo's own addresses of the present step and its `nJ`; offset of `nJ`.
        "offsets": np.array([offsets.pointers[name] for name in SPARSE], dtype=np.int64),
        "addresses": np.array([array.ctypes.data for array in arrays], dtype=np.int64),
        "replaced": np.zeros(len(SPARSE) + 1, dtype=np.int64),
        "size": offsets.nonzeros,
    }
    return record, arrays


def solution_of(model: mujoco.MjModel, layout: Layout, pattern_of_rows: Pattern | None) -> dict[str, Any]:
    """Return the record Solution, the equations of a step, with the pattern of H = M + J' D J and of its factor.

    Args:
        model: model of the run.
        layout: its elements.
        pattern_of_rows: nonzero numbers of the rows; None for a state in the dense format: an empty record.
    """
    if pattern_of_rows is None:
        empty: dict[str, Any] = dict.fromkeys(("inertia", "singles", "frictions"), np.zeros((0, 2), dtype=np.int64))
        empty |= dict.fromkeys(("columns", "starts", "tiles"), np.zeros(0, dtype=np.int64))
        empty |= dict.fromkeys(("right", "acceleration", "weight", "limited"), np.zeros(0))
        return empty | {"size": 0, "groups": np.zeros((0, 4), dtype=np.int64), "matrix": np.zeros((0, 0))}
    nonzero, count = pattern_of_rows.nonzero, -(-model.nv // TILE)
    # Row and column of each number of the lower triangle of M in MuJoCo's compressed rows.
    inertia = np.column_stack([np.repeat(np.arange(model.nv), model.M_rownnz), model.M_colind]).astype(np.int64)
    pattern = np.eye(count, dtype=np.bool_)
    pattern[inertia[:, 0] // TILE, inertia[:, 1] // TILE] = True
    groups, columns, grouped = [], list[int](), set[int]()
    for row, number in np.unique(layout.reach[:, :2], axis=0):
        tiles = np.unique(np.flatnonzero(nonzero[row : row + number].any(axis=0)) // TILE)
        groups.append((row, number, len(columns), len(columns) + len(tiles)))
        columns += [int(tile) for tile in tiles]
        grouped |= set(range(row, row + number))
        # J' D J of these rows couples all tiles that they touch.
        pattern[np.ix_(tiles, tiles)] = True
    # Elimination of a row of tiles, the last one first, couples all its columns.
    for block in range(count - 1, -1, -1):
        filled = np.flatnonzero(pattern[block, :block])
        pattern[np.ix_(filled, filled)] = True
    rows_of_tiles = [np.flatnonzero(pattern[block, : block + 1]) for block in range(count)]
    single = [(row, int(np.argmax(nonzero[row]))) for row in range(len(nonzero)) if row not in grouped]
    singles = np.array(single, dtype=np.int64).reshape(-1, 2)
    # Friction rows come after the equality rows.
    frictions = singles[singles[:, 0] >= np.min(layout.dampers.frictions, initial=len(nonzero))]
    return {
        "size": int(model.nv),  # nv; the tiles of 4 x 4 fill it up to n
        "inertia": inertia,  # row and column of each number of the mass matrix; (m, 2)
        # Rows with the same columns: first row, number of rows (3 or 1), first and end index in the tile columns.
        "groups": np.array(groups, dtype=np.int64).reshape(-1, 4),
        "columns": np.array(columns, dtype=np.int64),
        # Rows with a single column, and that column; the friction rows among them.
        "singles": singles,
        "frictions": frictions,
        # Tile columns of each row of tiles, ascending, the last on the diagonal.
        "starts": np.cumsum([0, *map(len, rows_of_tiles)], dtype=np.int64),
        "tiles": np.concatenate(rows_of_tiles).astype(np.int64),
        "matrix": np.zeros((TILE * count, TILE * count)),  # H, factorised after the solution
        "right": np.zeros(TILE * count),  # right-hand side without friction rows
        "acceleration": np.zeros(TILE * count),
        "weight": np.zeros(len(nonzero)),  # D of the rows within their limits, else zero
        "limited": np.zeros(len(frictions)),  # sign of the force of each friction row at its limit, else zero
    }
