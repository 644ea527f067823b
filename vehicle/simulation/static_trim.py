"""Static trim: preloads with which the car stands in its design position under gravity.

A car whose elements were stress-free in the design position would settle by u under gravity:
K u + Jc' lambda = g, Jc u = 0, with K = sum of J' K_e J over all elements. The forces that the elements then carry,
f_e = -K_e J u, are given to them as preloads, and the reaction -lambda to the ideal joints: in the design position
these forces and gravity are in equilibrium exactly, and the share of each element is that of its stiffness. Tyres and
rubber blocks are set down without horizontal force: while the car settles, they slide.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.errors import SimulationError
from vehicle.simulation.callbacks import installed
from vehicle.simulation.layout import wheels_of
from vehicle.simulation.rows import Rows, joint_springs

Vector = npt.NDArray[np.float64]


SLIDING_SHARE = 1e-5
"""Share of the horizontal stiffness of the ground contacts left while the car settles; zero would let it drift.

Ground contacts are the elements on the world or on a plate: tyres, and blocks. They hold in all three directions, and
pull as well as push: there is no lift-off and no sliding in a run. A tyre that would pull is a warning of the run."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StaticTrim:
    """Result of the trim.

    Attributes:
        preload: static force of every constraint row in the axes of its element [N], and behind them the static
            torques of the rotations [N m], (rows + 3 m,).
        tyre_load: vertical load of each tyre [N], by wheel.
        support_load: vertical load of each other ground contact [N], by its name.
        residual: largest displacement by which the trimmed car would still move [m].
    """

    preload: Vector
    tyre_load: dict[str, float]
    support_load: dict[str, float]
    residual: float


def trim(rows: Rows) -> StaticTrim:
    """Find the preloads of a car and write those of its joint springs into the model.

    Args:
        rows: element rows of a compiled car, without static forces; in its model `qpos_spring` of the modal
            coordinates and of the stabilizer is set in place.

    Returns:
        The preloads of the rows, and the static loads.

    Raises:
        SimulationError: the car is not held in all directions by its elements.
    """
    model = rows.model
    model.qpos_spring[:] = model.qpos0
    data = mujoco.MjData(model)
    with installed(rows):
        mujoco.mj_forward(model, data)
    e, twist = rows.layout, rows.layout.rotations.stiffness
    jacobian = data.efc_J.reshape(e.row_count, model.nv).copy()
    gravity = _unsolved(rows, data)
    row_stiffness = _row_stiffness(rows)
    turned = rows.rotation_jacobian(data)
    stiffness = jacobian.T @ (row_stiffness @ jacobian)
    stiffness += np.einsum("n,nij,nik->jk", twist, turned, turned)
    joint_stiffness = joint_springs(model)
    stiffness[np.diag_indices(model.nv)] += joint_stiffness
    hard = jacobian[e.joints.ravel()]
    displacement, reaction = _settle(stiffness, hard, gravity)
    preload = -row_stiffness @ (jacobian @ displacement)
    preload[e.joints.ravel()] = -reaction
    torque = -twist[:, None] * (turned @ displacement)
    preload = np.concatenate([preload, torque.ravel()])
    for joint in range(model.njnt):
        dof = model.jnt_dofadr[joint]
        if joint_stiffness[dof] > 0.0:
            position = model.jnt_qposadr[joint]
            model.qpos_spring[position] = model.qpos0[position] - displacement[dof]
    return _loads(rows.anew(preload), stiffness, hard)


def _row_stiffness(rows: Rows) -> Vector:
    """Stiffness of all rows [N/m], diagonal but for contacts with the ground along directions of their own."""
    e, b = rows.layout, rows.layout.bushings
    ground = ground_contacts(rows)
    found = np.zeros(e.row_count)
    found[b.rows] = b.stiffness
    found[b.rows[ground, :2]] *= SLIDING_SHARE
    found[e.springs.rows] = e.springs.stiffness
    whole = np.diag(found)
    slide = np.diag(np.sqrt([SLIDING_SHARE, SLIDING_SHARE, 1.0]))
    for index, way in rows.directions.items():
        if index in ground:
            own, back = b.rows[index], np.linalg.inv(way)
            level = slide @ (way.T * b.stiffness[index]) @ way @ slide
            whole[np.ix_(own, own)] = back.T @ level @ back
    return whole


def _unsolved(rows: Rows, data: mujoco.MjData) -> Vector:
    """Forces on the coordinates at rest, but those of the implicit rows; of these, what the curves of dampers have."""
    own, force = rows.layout.dampers, data.qfrc_smooth.copy()
    force[own.dofs] += own.laws["shift"] - own.laws["rest_force"]
    return np.asarray(force)


def ground_contacts(rows: Rows) -> npt.NDArray[np.intp]:
    """Positions of the elements between car and ground among the bushings; (k,)."""
    model, carriers = rows.model, rows.layout.bushings.carriers
    return np.flatnonzero((carriers == 0) | (model.body_mocapid[carriers] >= 0))


def _settle(stiffness: Vector, hard: Vector, force: Vector) -> tuple[Vector, Vector]:
    """Displacement and joint reactions under a force: K u + Jc' lambda = f, Jc u = 0."""
    size, count = len(stiffness), len(hard)
    system = np.block([[stiffness, hard.T], [hard, np.zeros((count, count))]])
    scale = np.ones(size + count)
    scale[:size] = 1.0 / np.sqrt(np.maximum(np.diag(stiffness), 1.0))
    scaled = system * scale[:, None] * scale[None, :]
    if np.linalg.cond(scaled) > 1e14:
        raise SimulationError(
            "static trim: the car can move without resistance; check that every bushing has a stiffness in each "
            "direction that nothing else holds"
        )
    solution = scale * np.linalg.solve(scaled, scale * np.concatenate([force, np.zeros(count)]))
    return solution[:size], solution[size:]


def _loads(rows: Rows, stiffness: Vector, hard: Vector) -> StaticTrim:
    """Static loads with the preloads in place, and the displacement that is left."""
    data = mujoco.MjData(rows.model)
    with installed(rows):
        mujoco.mj_forward(rows.model, data)
    preload = rows.weights.preload
    remaining, _ = _settle(stiffness, hard, _unsolved(rows, data))
    force, tyres = preload[rows.layout.bushings.rows], rows.layout.tyres
    for index, way in rows.directions.items():
        force[index] = way.T @ force[index]
    vertical = force[:, 2]
    others = [index for index in ground_contacts(rows) if index not in tyres]
    return StaticTrim(
        preload=preload,
        tyre_load=dict(zip(wheels_of(rows.model), map(float, vertical[tyres]), strict=True)),
        support_load={rows.names[index].partition("/")[2]: float(vertical[index]) for index in others},
        residual=float(np.max(np.abs(remaining))),
    )
