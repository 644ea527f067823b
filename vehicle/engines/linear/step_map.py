"""One-step (discrete) map of the linear part of a time step, whose eigenvalues are the discrete poles of the car.

The force of the rows in a step is f = f0 - D J a (`vehicle/core/source/rows.h`), in MuJoCo's Euler integration.
In the motions u = N y that the ideal joints allow, with v the velocity at the middle of the past step, F the branch
forces,

    (M + J' D J) a = -(K y + C v + j' f2) + load,   v+ = v + h a,   y+ = y + h v+,
    p = e F + g j v,   f2 = p + beta ((e - 2) p + g j v + F),   F+ = p + s j a,

with decay e, gain g and slope s of a branch over the step. An eigenvalue z of this map corresponds to the pole ln(z)/h
of the run. A branch that drifts with d y is driven by d (y - v h/2) in addition to j v, and its rate changes by
d (v + a h/2) h in a step. Gyroscopic forces are evaluated in the middle of two steps, like their extrapolation in the
run.
"""

import copy
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.rows import Rows, damping_factors, joint_dampers, joint_weights


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepMap:
    """One-step map x+ = matrix x + load f with x = (y, v, F).

    Attributes:
        matrix: matrix of the map; (2 m + b, 2 m + b).
        load: columns of the nonlinear forces of the w dampers; (2 m + b, w).
    """

    matrix: Vector
    load: Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepRows:
    """Terms of the rows of a car in a step of a given length.

    Attributes:
        timestep: h [s].
        mass: M + J' D J, with the viscous part of the dampers; (n, n).
        damping: C with the effective damping of joints over a step; (n, n).
        decay, gain, slope, average: e, g, s and beta of the branches; (b,).
    """

    timestep: float
    mass: Vector
    damping: Vector
    decay: Vector
    gain: Vector
    slope: Vector
    average: Vector


def step_rows(
    car: CarModel, matrices: CarMatrices, timestep: float, softened: Sequence[int] = (), share: float = 1.0
) -> StepRows:
    """Return the terms that a MuJoCo step adds to the matrices of a car: inertia of rows and joints, branches.

    Args:
        car: compiled and trimmed car.
        matrices: matrices of the same car.
        timestep: time step h [s].
        softened: constraint rows of elements that `matrices` has softer than `car`.
        share: what is left of these elements [-].
    """
    model = copy.copy(car.model)
    model.opt.timestep = timestep
    rows = Rows(model, car.static.preload)
    e, weights_of_step = rows.layout, rows.weights
    jacobian = standing_data(rows).efc_J.reshape(e.row_count, model.nv)
    weights = np.zeros(e.row_count)
    weights[e.bushings.rows] = weights_of_step.impedance
    weights[e.springs.rows] = weights_of_step.spring_impedance
    weights[list(softened)] *= share
    present = e.bushings.branch_stiffness > 0.0
    # M_h = M + J' D J and the armatures of joints: the step solves M_h a = force.
    mass = matrices.system.mass + jacobian.T @ (weights[:, None] * jacobian) + np.diag(joint_weights(model))
    mass[matrices.dampers, matrices.dampers] += weights_of_step.damper_impedance
    if matrices.system.cyclic:
        # Gyroscopic moments, the skew part (C - C')/2, act half a step later: u' + h a/2.
        mass += 0.25 * timestep * (matrices.system.damping - matrices.system.damping.T)
    return StepRows(
        timestep=timestep,
        mass=mass,
        damping=matrices.system.damping + np.diag((damping_factors(model) - 1.0) * joint_dampers(model)),
        decay=weights_of_step.decay[present],
        gain=weights_of_step.gain[present],
        slope=weights_of_step.slope[present],
        average=weights_of_step.average[present],
    )


def step_map(rows: StepRows, form: FirstOrder) -> StepMap:
    """Return the one-step map of a car."""
    h, basis, system = rows.timestep, form.basis, form.system
    branch, size, position_count = system.branch_rows @ basis, basis.shape[1], form.placed
    drift = np.zeros_like(branch) if system.branch_drifts is None else system.branch_drifts @ basis
    effect, past_branch = system.effects @ basis, branch - 0.5 * h * drift
    e, beta = rows.decay, rows.average
    # f2 of p = e F + g j v: the weights of F and of g j v, collected.
    force, rate = e + beta * ((e - 2.0) * e + 1.0), (1.0 + beta * (e - 1.0)) * rows.gain
    # Columns over y, v, F and the damper forces.
    forces = np.hstack(
        [
            (-basis.T @ system.stiffness @ basis - effect.T @ (rate[:, None] * drift))[:, :position_count],
            -basis.T @ rows.damping @ basis - effect.T @ (rate[:, None] * past_branch),
            -effect.T * force,
            (system.slide_rows @ basis).T,
        ]
    )
    acceleration = np.linalg.solve(basis.T @ rows.mass @ basis, forces)
    v, f, states = form.velocities, form.branches, form.branches.stop
    matrix = np.zeros((states, states + len(system.slide_rows)))
    # v+ = v + h a, then y+ = y + h v+, then F+ = e F + g (j v + d (y - v h/2)) + s (j a + d (v + a h/2)).
    matrix[v] = h * acceleration
    matrix[v, v] += np.eye(size)
    matrix[:position_count] = h * matrix[v][:position_count]
    matrix[:position_count, :position_count] += np.eye(position_count)
    matrix[f] = rows.slope[:, None] * ((branch + 0.5 * h * drift) @ acceleration)
    matrix[f, v] += rows.gain[:, None] * past_branch + rows.slope[:, None] * drift
    matrix[f, :position_count] += rows.gain[:, None] * drift[:, :position_count]
    matrix[f, f] += np.diag(e)
    return StepMap(matrix=matrix[:, :states], load=matrix[:, states:])
