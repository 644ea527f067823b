"""Static trim: preloads with which the car stands in its design position under gravity.

A car whose elements were stress-free in the design position would settle by u under gravity:
K u + Jc' lambda = g, Jc u = 0, with K = sum of J' K_e J over all elements. The forces that the elements then carry,
f_e = -K_e J u, are given to them as preloads, and the reaction -lambda to the ideal joints: in the design position
these forces and gravity are in equilibrium exactly, and the share of each element is that of its stiffness. Tyres and
rubber blocks are set down without horizontal force: while the car settles, they slide; wheels do not turn meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.force_curves import curve_of, standing_on
from vehicle.engines.simulation.row_layout import wheels_of
from vehicle.engines.simulation.rows import Rows, joint_springs
from vehicle.errors import ConfigurationError, SimulationError

Vector = npt.NDArray[np.float64]


SLIDING_SHARE = 1e-5
"""Share of the horizontal stiffness of the ground contacts left while the car settles; zero would let it drift.

Ground contacts are the elements on the world or on a plate: tyres, and blocks. They hold in all three directions, and
pull as well as push: there is no lift-off and no sliding in a run. A tyre that would pull is a warning of the run."""


LEAST_CONDITION = 1e-14
"""Reciprocal condition below which a car counts as not held, in the norm of the largest singular value."""

CONDITION_SURE = 1e-11
"""Reciprocal condition in the norm of sums, as LAPACK estimates it, above which that cannot be."""


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AtRest:
    """A car in its design position, whatever the numbers of its laws; n velocity coordinates.

    Attributes:
        jacobian: displacement of all rows over the coordinates; (rows, n).
        turned: rotations of the elements that resist them; (m, 3, n).
        weight: generalised force of gravity, with what the elements answer to the round-off of their places; (n,).
    """

    jacobian: Vector
    turned: Vector
    weight: Vector


def at_rest(rows: Rows) -> AtRest:
    """Read the design position of a compiled car.

    Args:
        rows: of its elements, without static forces.
    """
    data, own = mujoco.MjData(rows.model), rows.layout.dampers
    with installed(rows):
        mujoco.mj_forward(rows.model, data)
    # What is there besides is constant in the dampers, and in the springs inside joints.
    weight = data.qfrc_smooth - data.qfrc_passive - unsolved(rows.layout, np.zeros(rows.model.nv))
    weight[own.dofs] += own.laws["shift"] - own.laws["rest_force"]
    return AtRest(
        jacobian=data.efc_J.reshape(rows.layout.row_count, rows.model.nv).copy(),
        turned=rows.rotation_jacobian(data),
        weight=weight,
    )


def trim(rows: Rows) -> StaticTrim:
    """Find the preloads of a car and write those of its joint springs into the model.

    Args:
        rows: element rows of a compiled car, without static forces; their curves are left at their operating points,
            and in their model `qpos_spring` of the modal coordinates and of the stabilizer is set in place.

    Returns:
        The preloads of the rows, and the static loads.

    Raises:
        SimulationError: the car is not held in all directions by its elements.
        ConfigurationError: a curve that no point of carries its static force.
    """
    model = rows.model
    model.qpos_spring[:] = model.qpos0
    rest, joint_stiffness = at_rest(rows), joint_springs(model)
    settled = settle(rows, rest, joint_stiffness)
    for joint in range(model.njnt):
        dof = model.jnt_dofadr[joint]
        if joint_stiffness[dof] > 0.0:
            position = model.jnt_qposadr[joint]
            model.qpos_spring[position] = model.qpos0[position] - settled.displacement[dof]
    standing = rows.anew(settled.preload)
    data = mujoco.MjData(model)
    with installed(standing):
        mujoco.mj_forward(model, data)
    left = data.qfrc_smooth.copy()
    left[rows.layout.dampers.dofs] += rows.layout.dampers.laws["shift"] - rows.layout.dampers.laws["rest_force"]
    return static_loads(rows, settled, left)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Settled:
    """A car that has settled under gravity.

    Attributes:
        preload: as of `StaticTrim`.
        displacement: by which it has settled; (n,).
        give: displacement and joint reactions under a force on the coordinates.
    """

    preload: Vector
    displacement: Vector
    give: Callable[[Vector], tuple[Vector, Vector]]


MOST_TRIMS = 50
"""Trims in which the operating points of the curves settle; two, as a rule."""


def settle(rows: Rows, rest: AtRest, joint_stiffness: Vector) -> Settled:
    """Trim with every law over displacement as its tangent at the force that it carries; errors as of `trim`.

    Args:
        rows: element rows without static forces; their curves are left at their operating points.
        rest: design position of the car.
        joint_stiffness: of the springs inside joints; (n,).
    """
    found = _settled(rows, rest, joint_stiffness)
    t = rows.layout.tables
    if not len(t.at):
        return found
    for _ in range(MOST_TRIMS):
        last, rows.layout = rows.layout, standing_on(rows.layout, found.preload)
        found = _settled(rows, rest, joint_stiffness)
        now = rows.layout
        same = ((one.bushings.stiffness, one.springs.stiffness, one.tables.at) for one in (now, last))
        if all(map(np.allclose, *same)):
            break
    t = rows.layout.tables
    for index, (kind, element, axis, at) in enumerate(zip(t.kinds, t.elements, t.axes, t.at, strict=True)):
        if kind < 2:
            row = rows.layout.bushings.rows[element, axis] if kind == 0 else rows.layout.springs.rows[element]
            needed, carried = -found.preload[row], float(curve_of(t, index).force(at))
            if abs(carried - needed) > 1e-6 * max(abs(needed), 1.0):
                name = rows.names[element] if kind == 0 else rows.laws.springs[element]
                raise ConfigurationError(
                    f"the table of {name}: carries {carried:.4g} N nearest to the {needed:.4g} N "
                    "with which the car stands in its design position; give it points up to that force"
                )
    return found


def _settled(rows: Rows, rest: AtRest, joint_stiffness: Vector) -> Settled:
    """Trim of a car whose laws are linear."""
    e, twist, jacobian, turned = rows.layout, rows.layout.rotations.stiffness, rest.jacobian, rest.turned
    row_stiffness, spins = _row_stiffness(rows), rows.layout.rolling.spins
    if len(spins):
        jacobian = jacobian.copy()
        jacobian[:, spins] = 0.0
    stiffness = jacobian.T @ (row_stiffness @ jacobian)
    stiffness[spins, spins] = 1.0
    flat = turned.reshape(-1, turned.shape[2])
    stiffness += flat.T @ (np.repeat(twist, 3)[:, None] * flat)
    stiffness[np.diag_indices(len(stiffness))] += joint_stiffness
    give = _factored(stiffness, jacobian[e.joints.ravel()])
    displacement, reaction = give(unsolved(e, rest.weight))
    preload = -row_stiffness @ (jacobian @ displacement)
    preload[e.joints.ravel()] = -reaction
    torque = -twist[:, None] * (turned @ displacement)
    return Settled(preload=np.concatenate([preload, torque.ravel()]), displacement=displacement, give=give)


def _row_stiffness(rows: Rows) -> Vector:
    """Stiffness of all rows [N/m], diagonal but for contacts with the ground along directions of their own."""
    e, b = rows.layout, rows.layout.bushings
    ground = ground_contacts(rows)
    found = np.zeros(e.row_count)
    found[b.rows] = b.stiffness
    rolling = e.rolling.tyres
    found[b.rows[rolling, :2]] = b.branch_stiffness[rolling, :2]
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


def unsolved(layout: Layout, weight: Vector) -> Vector:
    """Forces on the coordinates at rest, but those of the implicit rows; of these, what the curves of dampers have.

    Args:
        layout: of the elements.
        weight: force of gravity; (n,).
    """
    own, t, force = layout.dampers, layout.tables, weight.copy()
    force[own.dofs] -= own.laws["rest_force"]
    for index in np.flatnonzero(t.kinds == 2):
        force[own.dofs[t.elements[index]]] -= curve_of(t, int(index)).force(0.0)
    return force


def ground_contacts(rows: Rows) -> npt.NDArray[np.intp]:
    """Positions of the elements between car and ground among the bushings; (k,)."""
    model, carriers = rows.model, rows.layout.bushings.carriers
    return np.flatnonzero((carriers == 0) | (model.body_mocapid[carriers] >= 0))


def _factored(stiffness: Vector, hard: Vector) -> Callable[[Vector], tuple[Vector, Vector]]:
    """What gives displacement and joint reactions under a force: K u + Jc' lambda = f, Jc u = 0."""
    size, count = len(stiffness), len(hard)
    system = np.block([[stiffness, hard.T], [hard, np.zeros((count, count))]])
    scale = np.ones(size + count)
    scale[:size] = 1.0 / np.sqrt(np.maximum(np.diag(stiffness), 1.0))
    scaled = system * scale[:, None] * scale[None, :]
    factors, pivots, singular = scipy.linalg.lapack.dgetrf(scaled)
    near, _ = scipy.linalg.lapack.dgecon(factors, np.abs(scaled).sum(axis=0).max())
    # The estimate is off by a factor; near the limit the condition itself is worth its singular values.
    if (singular or not near > CONDITION_SURE) and not np.linalg.cond(scaled) <= 1.0 / LEAST_CONDITION:
        raise SimulationError(
            "static trim: the car can move without resistance; check that every bushing has a stiffness in each "
            "direction that nothing else holds"
        )

    def give(force: Vector) -> tuple[Vector, Vector]:
        found, _ = scipy.linalg.lapack.dgetrs(factors, pivots, scale * np.concatenate([force, np.zeros(count)]))
        solution = scale * found
        return solution[:size], solution[size:]

    return give


def static_loads(rows: Rows, settled: Settled, left: Vector) -> StaticTrim:
    """Static loads of a car.

    Args:
        rows: of its elements.
        settled: the car.
        left: forces on the coordinates that are left with the preloads in place; (n,).
    """
    preload, tyres = settled.preload, rows.layout.tyres
    remaining, _ = settled.give(left)
    force = preload[rows.layout.bushings.rows]
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
