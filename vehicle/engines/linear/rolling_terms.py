"""Terms of rolling tyres and of the course hold in the matrices of a car.

The side slip of a rolling tyre drifts with the heading psi = atan2(-a_x, a_y) of its axle a,

    g = V (a_x a_y' - a_y a_x') / (a_x^2 + a_y^2),    a' = t x a,

V t_z in the design position, where a = e_y. The rows t are the rotations of the hub over the coordinates. By its
trail, the side force also acts about the vertical, h = e + trail t_z. The moment H a x omega of the wheel, H = -I V/R,
is -C u' with C = -H t' [a]x t, skew. The slope of the road z'/V exerts a force on the wheel centre along x,
proportional to the static load.
"""

from typing import Any

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.rows import Rows


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
    frames = data.xmat.reshape(-1, 3, 3)
    axles = frames[rolling.hubs][:, :, 1]
    rotations, centres = np.zeros((len(rolling.hubs), 3, model.nv)), np.zeros((len(rolling.hubs), 3, model.nv))
    for rotation, centre, hub, site, arm in zip(
        rotations, centres, rolling.hubs, rolling.sites, rolling.arms, strict=True
    ):
        mujoco.mj_jac(model, data, centre, rotation, data.site_xpos[site] + frames[int(hub)] @ arm, int(hub))
    damping = np.zeros((model.nv, model.nv))
    for rotation, axle, momentum in zip(
        rotations, axles, -rolling.inertias * rolling.speeds / rolling.arms[:, 2], strict=True
    ):
        # -H t' [a]x t.
        damping -= momentum * rotation.T @ np.cross(axle, rotation.T).T
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
    # g, and h = e + trail t_z.
    # a' = t x a.
    turned = np.cross(rotations, axles[:, :, None], axis=1)
    level = rolling.speeds / (axles[:, 0] ** 2 + axles[:, 1] ** 2)
    drifts[numbers] = level[:, None] * (axles[:, :1] * turned[:, 1] - axles[:, 1:2] * turned[:, 0])
    effects[numbers] += rolling.trails[:, None] * rotations[:, 2]
    return damping, slope, {"branch_drifts": drifts, "branch_effects": effects}


def following_stiffness(rows: Rows, jacobian: Vector, drifts: Vector) -> Vector:
    """Return the stiffness by steady forces (X, Y) of rolling tyres, which turn with the headings psi; (n, n).

    The force psi (-Y, X) at the contact, on the hub alone, is -K u with K = -(X j_y' - Y j_x') psi_u.

    Args:
        rows: rows of the car at rest.
        jacobian: Jacobian of the rows; (rows, n).
        drifts: V psi_u of the branches of the side slip, see `rolling_terms`; (b, n).
    """
    e, rolling = rows.layout, rows.layout.rolling
    numbers = np.cumsum(e.bushings.branch_stiffness > 0.0).reshape(-1, 3)[rolling.tyres, 1] - 1
    steady = rolling.rest[2 + len(rolling.tyres) :].reshape(-1, 2)
    stiffness = np.zeros((jacobian.shape[1], jacobian.shape[1]))
    for tyre, branch, speed, (along, across) in zip(rolling.tyres, numbers, rolling.speeds, steady, strict=True):
        x, y = jacobian[e.bushings.rows[tyre, :2]]
        turned = along * y - across * x
        turned[rolling.spins] = 0.0
        stiffness -= np.outer(turned, drifts[branch] / speed)
    return stiffness
