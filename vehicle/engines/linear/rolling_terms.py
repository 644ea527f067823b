"""Terms of rolling tyres and of the course hold in the matrices of a car.

The side slip of a rolling tyre drifts with the heading of its hub, g = V t_z. By its trail, the side force also acts on
the heading, h = e + trail t_z. The rows t are the rotations of the hub over the coordinates. The moment H e_y x omega
of the wheel, H = -I V/R, is -C u' with C = -H t' [e_y]x t, skew. The slope of the road z'/V exerts a force on the wheel
centre along x, proportional to the static load.
"""

from typing import Any

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.rows import Rows

ACROSS = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
"""Matrix of the cross product e_y x a."""


def rolling_terms(rows: Rows, preload: Vector, branch_rows: Vector) -> tuple[Vector, Vector, dict[str, Any]]:
    """Return the terms that r rolling wheels add to the linear car in its design position.

    Args:
        rows: constraint rows of all elements of the car, with its rolling tyres.
        preload: static forces of the rows [N].
        branch_rows: rows e_b of the Maxwell branches; (b, n).

    Returns:
        Damping by gyroscopic moments and the course hold, (n, n); generalised forces per velocity of a plate, (n, w);
        drifts and effects of the branches, as fields of `LinearSystem`.
    """
    model, e, rolling = rows.model, rows.layout, rows.layout.rolling
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    rotations, centres = np.zeros((len(rolling.hubs), 3, model.nv)), np.zeros((len(rolling.hubs), 3, model.nv))
    for rotation, centre, hub, site, arm in zip(
        rotations, centres, rolling.hubs, rolling.sites, rolling.arms, strict=True
    ):
        mujoco.mj_jac(model, data, centre, rotation, data.site_xpos[site] + arm, int(hub))
    damping = np.zeros((model.nv, model.nv))
    for rotation, momentum in zip(rotations, -rolling.inertias * rolling.speeds / rolling.arms[:, 2], strict=True):
        # -H t' [e_y]x t.
        damping -= momentum * rotation.T @ ACROSS @ rotation
    course = rolling.course_rows(model.nv)
    damping += course.T @ (rolling.hold[3:6, None] * course)
    slope = np.zeros((model.nv, len(e.tyres)))
    # F_0/V along x at each wheel centre.
    slope[:, rolling.plates] = (
        centres[:, 0] * (preload[e.bushings.rows[rolling.tyres, 2]] / rolling.speeds)[:, None]
    ).T
    # The branches of the side slip; `branch_rows` has a row for each axis with a branch.
    numbers = np.cumsum(e.bushings.branch_stiffness > 0.0).reshape(-1, 3)[rolling.tyres, 1] - 1
    drifts, effects = np.zeros_like(branch_rows), branch_rows.copy()
    # g = V t_z and h = e + trail t_z.
    drifts[numbers] = rolling.speeds[:, None] * rotations[:, 2]
    effects[numbers] += rolling.trails[:, None] * rotations[:, 2]
    return damping, slope, {"branch_drifts": drifts, "branch_effects": effects}
