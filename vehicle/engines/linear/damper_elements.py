"""Jenkins elements of dampers, and side forces of dampers, as rows over the coordinates of the car."""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.linear.displacement_laws import BUSHING, DisplacementLaw
from vehicle.engines.simulation.rows import Rows


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SliderElements:
    """Groups of parallel Jenkins elements (`vehicle.model.laws.jenkins`) over one displacement each, g groups.

    Attributes:
        rows: displacements over the velocity coordinates; (g, n).
        dampers: index of the damper whose friction limit the limits are shares of; (g,).
        stiffness: k [N/m], padded with zeros; (g, e). limit: limits as shares [-]; (g, e).
        steepness: largest slope of the other nonlinear force of each damper [N s/m], infinite for a friction line;
            (d,).
    """

    rows: Vector
    dampers: npt.NDArray[np.int64]
    stiffness: Vector
    limit: Vector
    steepness: Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SideRows:
    """Side forces on the rods of k dampers, along two directions across the slide each: static + rows (u, u', f_b).

    Attributes:
        dampers: indices of the dampers with a side force coefficient; (k,).
        static: forces at rest [N]; (2 k,).
        displacement, velocity, branch: rows over u, u' and the forces of the Maxwell branches; (2 k, ...).
        laws: rows over the forces g of the laws over displacement; (2 k, laws).
    """

    dampers: npt.NDArray[np.int64]
    static: Vector
    displacement: Vector
    velocity: Vector
    branch: Vector
    laws: Vector


def no_side_forces() -> SideRows:
    """Return no side forces."""
    none = np.zeros((0, 0))
    return SideRows(
        dampers=np.zeros(0, dtype=np.int64),
        static=np.zeros(0),
        displacement=none,
        velocity=none,
        branch=none,
        laws=none,
    )


def no_sliders() -> SliderElements:
    """Return no groups of Jenkins elements."""
    none = np.zeros((0, 0))
    return SliderElements(
        rows=none, dampers=np.zeros(0, dtype=np.int64), stiffness=none, limit=none, steepness=np.zeros(0)
    )


def slider_elements(rows: Rows) -> SliderElements:
    """Return the Jenkins elements of the dampers with presliding friction."""
    e, p = rows.layout.dampers, rows.layout.presliding
    dampers, numbers = np.unique(p.dampers), np.bincount(p.dampers, minlength=1)
    if not dampers.size:
        return no_sliders()
    stiffness, limit = np.zeros((2, len(dampers), int(numbers.max())))
    for group, damper in enumerate(dampers):
        elements = p.dampers == damper
        stiffness[group, : numbers[damper]], limit[group, : numbers[damper]] = p.stiffness[elements], p.share[elements]
    # A friction line is vertical for the step; presliding dampers have their curve alone, halved as the mean of both
    # ends of a step. The slope of a controlled damper, or of a law by address, is known during a run only.
    steepness = np.full(len(e.dofs), np.inf)
    for damper in dampers:
        steepness[damper] = 0.5 * np.max(e.pieces[e.valves[:, 1] == damper, 0], initial=0.0)
    steepness[rows.layout.controls.dampers] = np.inf
    steepness[rows.layout.own.dampers] = np.inf
    return SliderElements(
        rows=np.eye(rows.model.nv)[e.dofs[dampers]],
        dampers=dampers,
        stiffness=stiffness,
        limit=limit,
        steepness=steepness,
    )


def side_rows(rows: Rows, jacobian: Vector, preload: Vector, laws: Sequence[DisplacementLaw]) -> SideRows:
    """Return the side forces of the dampers with a side force coefficient.

    The turn of the static force along the slide with the rod is neglected: it is the weight of the rod, and the
    force of its gas.

    Args:
        rows, jacobian, preload: see `vehicle.engines.linear.car_matrices.law_matrices`.
        laws: nonlinear laws over displacement.
    """
    e, b, model = rows.layout, rows.layout.bushings, rows.model
    dampers = np.flatnonzero(e.dampers.laws["side_force"] > 0.0)
    if not dampers.size:
        return no_side_forces()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    # (element, axis) to the number of its Maxwell branch, among those that exist.
    branches = np.cumsum(b.branch_stiffness.ravel() > 0.0).reshape(b.rows.shape) - 1
    count = int(np.count_nonzero(b.branch_stiffness > 0.0))
    static, branch = np.zeros((len(dampers), 2)), np.zeros((len(dampers), 2, count))
    displacement, velocity = np.zeros((2, len(dampers), 2, jacobian.shape[1]))
    by_law = np.zeros((len(dampers), 2, len(laws)))
    for side, damper in enumerate(dampers):
        # Two directions at right angles to the slide: the rows of V' beyond the first are its null space; (2, 3).
        across = np.linalg.svd(data.xaxis[model.dof_jntid[e.dampers.dofs[damper]]][None])[2][1:]
        for k in np.flatnonzero(e.sides.dampers == damper):
            n = e.sides.elements[k]
            # The rod takes the forces of its bushings: f = p - K r - B r' - f2 - g along the directions of each law.
            way = rows.directions.get(int(n), np.eye(3))
            along = e.sides.signs[k] * across @ data.xmat[b.carriers[n]].reshape(3, 3) @ way.T
            static[side] += along @ preload[b.rows[n]]
            displacement[side] -= along @ (b.stiffness[n][:, None] * jacobian[b.rows[n]])
            velocity[side] -= along @ (b.damping[n][:, None] * jacobian[b.rows[n]])
            for axis in np.flatnonzero(b.branch_stiffness[n] > 0.0):
                branch[side, :, branches[n, axis]] -= along[:, axis]
            for index, law in enumerate(laws):
                if law.element[:2] == (BUSHING, int(n)):
                    by_law[side, :, index] -= along[:, law.element[2]]
    return SideRows(
        dampers=dampers.astype(np.int64),
        static=static.ravel(),
        displacement=displacement.reshape(2 * len(dampers), -1),
        velocity=velocity.reshape(2 * len(dampers), -1),
        branch=branch.reshape(2 * len(dampers), -1),
        laws=by_law.reshape(2 * len(dampers), -1),
    )
