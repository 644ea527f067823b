"""Central differences over the velocity coordinates of a car."""

from collections.abc import Callable

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.rows import Rows

DIFFERENCE_STEP = 1e-6
"""Step [m, rad, kg^1/2 m] of the central differences of the forces: truncation and round-off are both below 1e-8."""


def differences(rows: Rows, read: Callable[[mujoco.MjData], Vector]) -> Vector:
    """Return central differences of a function over the velocity coordinates in the design position; (..., n).

    Args:
        rows: rows of the car at rest.
        read: function of a state with written rows that returns an array (...); only the solution of the step is
            missing in the state.
    """
    model = rows.model
    data = mujoco.MjData(model)
    start, direction, columns = data.qpos.copy(), np.zeros(model.nv), []
    for column in range(model.nv):
        ends = []
        for sign in (1.0, -1.0):
            data.qpos[:] = start
            direction[column] = sign
            mujoco.mj_integratePos(model, data.qpos, direction, DIFFERENCE_STEP)
            # Run a step without the solution of the rows, which would double the cost.
            mujoco.mj_fwdPosition(model, data)
            mujoco.mj_fwdVelocity(model, data)
            rows(model, data)
            ends.append(read(data))
        direction[column] = 0.0
        columns.append((ends[0] - ends[1]) / (2.0 * DIFFERENCE_STEP))
    return np.stack(columns, axis=-1)
