"""The linear part of one step of the time integration as a matrix: what a step makes of every pole of the car.

The rows answer with f = f0 - D J a (`vehicle.engines.simulation.kernel`), and MuJoCo's Euler steps with it. In the
motions u = N y that the ideal joints allow, with v the velocity at the middle of the past step, F the branch forces,

    (M + J' D J) a = -(K y + C v + j' f2) + load,   v+ = v + h a,   y+ = y + h v+,
    p = e F + g j v,   f2 = p + beta ((e - 2) p + g j v + F),   F+ = p + s j a,

e, g, s being decay, gain and slope of a branch over the step. An eigenvalue z of this map stands for the pole
ln(z)/h that the run has, where the matrices have s. A branch that drifts with d y is driven by d (y - v h/2) beside
j v, and its rate changes by d (v + a h/2) h in a step. Gyroscopic forces are taken in the middle of two steps, as
their extrapolation is meant to be.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.rows import Rows, damping_factors, joint_dampers, joint_weights

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepMap:
    """x+ = matrix x + load f with x = (y, v, F).

    Attributes:
        matrix: (2 m + b, 2 m + b).
        load: columns of the nonlinear forces of the w dampers; (2 m + b, w).
    """

    matrix: Vector
    load: Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepRows:
    """What the rows of a car add to a step, at one length of it.

    Attributes:
        timestep: h [s].
        mass: M + J' D J, with the viscous part of the dampers; (n, n).
        damping: C, with what a step makes of the damping inside joints; (n, n).
        decay, gain, slope, average: e, g, s and beta of the branches; (b,).
    """

    timestep: float
    mass: Vector
    damping: Vector
    decay: Vector
    gain: Vector
    slope: Vector
    average: Vector


def step_rows(car: CarModel, matrices: CarMatrices, timestep: float) -> StepRows:
    """Weights of the rows of a car for a step [s]; `matrices` are those of the same car."""
    model = copy.copy(car.model)
    model.opt.timestep = timestep
    rows = Rows(model, car.static.preload)
    data = mujoco.MjData(model)
    with installed(rows):
        mujoco.mj_forward(model, data)
    e, own = rows.layout, rows.weights
    jacobian = data.efc_J.reshape(e.row_count, model.nv)
    weights = np.zeros(e.row_count)
    weights[e.bushings.rows] = own.impedance
    weights[e.springs.rows] = own.spring_impedance
    present = e.bushings.branch_stiffness > 0.0
    mass = matrices.system.mass + jacobian.T @ (weights[:, None] * jacobian) + np.diag(joint_weights(model))
    mass[matrices.dampers, matrices.dampers] += own.damper_impedance
    if matrices.system.cyclic:
        mass += 0.25 * timestep * (matrices.system.damping - matrices.system.damping.T)
    return StepRows(
        timestep=timestep,
        mass=mass,
        damping=matrices.system.damping + np.diag((damping_factors(model) - 1.0) * joint_dampers(model)),
        decay=own.decay[present],
        gain=own.gain[present],
        slope=own.slope[present],
        average=own.average[present],
    )


def step_map(rows: StepRows, form: FirstOrder) -> StepMap:
    """Map of one step of a car.

    Args:
        rows: of the step.
        form: of the car, with its dampers stuck or sliding.

    Returns:
        The map.
    """
    h, basis, system = rows.timestep, form.basis, form.system
    branch, size, placed = system.branch_rows @ basis, basis.shape[1], form.placed
    drift = np.zeros_like(branch) if system.branch_drifts is None else system.branch_drifts @ basis
    effect, late = system.effects @ basis, branch - 0.5 * h * drift
    e, beta = rows.decay, rows.average
    force, rate = e + beta * ((e - 2.0) * e + 1.0), (1.0 + beta * (e - 1.0)) * rows.gain
    forces = np.hstack(
        [
            (-basis.T @ system.stiffness @ basis - effect.T @ (rate[:, None] * drift))[:, :placed],
            -basis.T @ rows.damping @ basis - effect.T @ (rate[:, None] * late),
            -effect.T * force,
            (system.slide_rows @ basis).T,
        ]
    )
    acceleration = np.linalg.solve(basis.T @ rows.mass @ basis, forces)
    v, f, states = form.velocities, form.branches, form.branches.stop
    whole = np.zeros((states, states + len(system.slide_rows)))
    whole[v] = h * acceleration
    whole[v, v] += np.eye(size)
    whole[:placed] = h * whole[v][:placed]
    whole[:placed, :placed] += np.eye(placed)
    whole[f] = rows.slope[:, None] * ((branch + 0.5 * h * drift) @ acceleration)
    whole[f, v] += rows.gain[:, None] * late + rows.slope[:, None] * drift
    whole[f, :placed] += rows.gain[:, None] * drift[:, :placed]
    whole[f, f] += np.diag(e)
    return StepMap(matrix=whole[:, :states], load=whole[:, states:])
