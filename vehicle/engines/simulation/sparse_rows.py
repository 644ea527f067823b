"""Constraint Jacobian of a run in MuJoCo's sparse format, with the columns of the body modes.

The Newton solver factorises H = M + J' D J in every step. Each suspension acts on few coordinates: its own and those of
the body. So most of H is zero, and MuJoCo's sparse solver, which eliminates the last coordinate first and the body
last, hardly fills it: 2 500 of 12 800 numbers with four wheels. Its time grows with the number of parts, that of the
dense solver with the third power.

MuJoCo's own sparse rows contain the coordinates above the two bodies of a connection and no modes, which are bodies of
their own. The compiled callback therefore copies these rows into a full matrix, writes the laws there as in the dense
format, and gives MuJoCo the nonzero columns of this car, modes included, in arrays of its own. MuJoCo sets the pointers
anew in every step. The equations and the tolerance of the solver are those of the dense format.
"""

from __future__ import annotations

import mujoco
import numpy as np

from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import SparseRows
from vehicle.engines.simulation.structures import SPARSE, Offsets

SPARSE_FROM = 64
"""Number of velocity coordinates above which the sparse solver is faster than the dense one."""


def dense_rows(model: mujoco.MjModel) -> SparseRows:
    """Return the record of a state whose rows MuJoCo stores in the dense format."""
    none = np.zeros(0, dtype=np.int64)
    return SparseRows(np.zeros((0, model.nv)), np.zeros(0), none, none, none, 0)


def sparse_rows(model: mujoco.MjModel, layout: Layout, offsets: Offsets) -> tuple[SparseRows, tuple[object, ...]]:
    """Return the sparse Jacobian of a model.

    Args:
        model: model with the sparse format.
        layout: its elements.
        offsets: offsets in MuJoCo's structures.

    Returns:
        The record, and the arrays of the pattern, to which it contains only addresses.
    """
    data = mujoco.MjData(model)
    mujoco.mj_fwdPosition(model, data)
    nonzero = np.zeros((layout.row_count, model.nv), dtype=np.bool_)
    rows = np.repeat(np.arange(layout.row_count), data.efc_J_rownnz)
    nonzero[rows, data.efc_J_colind] = True
    for row, count, first, last in layout.reach:
        nonzero[row : row + count, first:last] = True
    counts = np.count_nonzero(nonzero, axis=1).astype(np.int32)
    starts = np.cumsum([0, *counts[:-1]], dtype=np.int32)
    # Number of following rows with the same columns.
    following = np.zeros(layout.row_count, dtype=np.int32)
    for row in range(layout.row_count - 2, -1, -1):
        following[row] = following[row + 1] + 1 if np.array_equal(nonzero[row], nonzero[row + 1]) else 0
    places = np.flatnonzero(nonzero)
    columns = (places % model.nv).astype(np.int32)
    values = np.zeros(places.size)
    pattern = (counts, starts, following, columns, values)
    record = SparseRows(
        jacobian=np.zeros(nonzero.shape),
        values=values,
        places=places.astype(np.int64),
        offsets=np.array([offsets.pointers[name] for name in SPARSE], dtype=np.int64),
        addresses=np.array([array.ctypes.data for array in pattern], dtype=np.int64),
        size=offsets.nonzeros,
    )
    return record, pattern
