"""Gyroscopic and centrifugal forces of a step at its own time.

MuJoCo's velocity v is that of the time t - h/2, half a step before the positions. Its forces c(q, v), a quadratic form
in v, are then late by half a step: an error (h/2) dc/dv a of first order, a product of motions, which is different for
a part that is a root of the tree of bodies and for its mirror image that is a child. The predicted velocity
v + (h/2) a, with a of the step before, makes c of second order; position and everything linear have that order anyway.
"""

from __future__ import annotations

import mujoco
import numpy as np


def centre_bias(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Evaluate the bias forces of a step, `qfrc_bias`, at the predicted velocity v + (h/2) a of its time.

    Afterwards `cvel` and `cdof_dot` of the state belong to this velocity, `qvel` is unchanged.

    Args:
        model: model of a run.
        data: state in `mjcb_control` of a step; `qacc` is a, the acceleration of the step before.
    """
    velocity, bias = data.qvel.copy(), np.zeros(model.nv)
    data.qvel += 0.5 * model.opt.timestep * data.qacc
    mujoco.mj_comVel(model, data)
    mujoco.mj_rne(model, data, 0, bias)
    data.qfrc_bias[:] = bias
    data.qvel[:] = velocity
