"""Static trim: preloads for static equilibrium of the car in its design position under gravity.

A car whose elements were stress-free in the design position would settle by u under gravity:
K u + Jc' lambda = g, Jc u = 0, with K = sum of J' K_e J over all elements. The forces that the elements then carry,
f_e = -K_e J u, become their preloads, and the reaction -lambda that of the ideal joints: in the design position these
forces and gravity are in exact equilibrium, distributed over the elements by stiffness. Tyres and rubber blocks slide
while the car settles, so that they carry no horizontal force; wheels do not rotate meanwhile.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import scipy

from vehicle.arrays import Indices, Vector
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.force_curves import curve_of, standing_on
from vehicle.engines.simulation.row_layout import wheels_of
from vehicle.engines.simulation.rows import Rows, joint_springs
from vehicle.errors import ConfigurationError, SimulationError

SLIDING_SHARE = 1e-5
"""Factor of the horizontal stiffness of the ground contacts while the car settles; with zero it would drift.

Ground contacts are the elements on the world or on a plate: tyres, and blocks. In a run they act in all three
directions without sliding. Two-sided contacts can pull, which is a warning of the run."""


LEAST_CONDITION = 1e-14
"""Minimum reciprocal condition number (2-norm) of a car without free motion."""

CONDITION_SURE = 1e-11
"""Reciprocal condition number (1-norm, LAPACK estimate) above which the 2-norm is not computed."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StaticTrim:
    """Result of the trim.

    Attributes:
        preload: static force of every constraint row in the axes of its element [N], followed by the static
            torques of the rotations [N m], (rows + 3 m,).
        tyre_load: vertical load of each tyre [N], by wheel.
        support_load: vertical load of each other ground contact with a vertical stiffness [N], by name.
        residual: maximum displacement due to the remaining forces [m].
        tyre_grip: horizontal force of each tyre in steady acceleration [N], by wheel; empty without.
    """

    preload: Vector
    tyre_load: dict[str, float]
    support_load: dict[str, float]
    residual: float
    tyre_grip: dict[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        """One line."""
        return f"StaticTrim({', '.join(f'tyre {name} {load:.0f} N' for name, load in self.tyre_load.items())})"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AtRest:
    """Car in its design position, independent of law parameters; n velocity coordinates.

    Attributes:
        jacobian: Jacobian of the displacements of all rows; (rows, n).
        turned: Jacobian of the rotations of the elements with a rotational stiffness; (m, 3, n).
        weight: generalised force of gravity, with element forces from the round-off of positions; (n,).
    """

    jacobian: Vector
    turned: Vector
    weight: Vector


def at_rest(rows: Rows) -> AtRest:
    """Read the design position of a compiled car; `rows`: its rows, without static forces."""
    dampers, data = rows.layout.dampers, standing_data(rows)
    # Remove the constant forces of the dampers and of the springs inside joints.
    weight = data.qfrc_smooth - data.qfrc_passive - unsolved(rows.layout, np.zeros(rows.model.nv))
    weight[dampers.dofs] += dampers.laws["shift"] - dampers.laws["rest_force"]
    return AtRest(
        jacobian=data.efc_J.reshape(rows.layout.row_count, rows.model.nv).copy(),
        turned=rows.rotation_jacobian(data),
        weight=weight,
    )


def trim(rows: Rows) -> StaticTrim:
    """Compute the preloads of a car, and write the unstrained positions of joint springs into its model.

    Args:
        rows: rows of a compiled car, without static forces; the operating points of its curves and `qpos_spring` of its
            model are set in place.

    Raises:
        SimulationError: the car can move without resistance.
        ConfigurationError: a static force is outside the range of the curve of its element.
    """
    model = rows.model
    model.qpos_spring[:] = model.qpos0
    design, joint_stiffness = at_rest(rows), joint_springs(model)
    settled = settle(rows, design, joint_stiffness)
    # A spring in a joint carries -k u in the design position if its unstrained position is -u.
    sprung = joint_stiffness[model.jnt_dofadr] > 0.0
    places, dofs = model.jnt_qposadr[sprung], model.jnt_dofadr[sprung]
    model.qpos_spring[places] = model.qpos0[places] - settled.displacement[dofs]
    left = standing_data(rows.anew(settled.preload)).qfrc_smooth.copy()
    left[rows.layout.dampers.dofs] += rows.layout.dampers.laws["shift"] - rows.layout.dampers.laws["rest_force"]
    return static_loads(rows, settled, left)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Settled:
    """Equilibrium of a car under gravity from its design position.

    Attributes:
        preload: see `StaticTrim`.
        displacement: static displacement; (n,).
        give: function from a generalised force to displacement and joint reactions.
    """

    preload: Vector
    displacement: Vector
    give: Callable[[Vector], tuple[Vector, Vector]]


MOST_TRIMS = 50
"""Maximum number of iterations for the operating points of the curves; usually two are enough."""


def settle(rows: Rows, design: AtRest, joint_stiffness: Vector) -> Settled:
    """Trim with the tangents of nonlinear laws, iterated to their operating points; raises like `trim`.

    Args:
        rows: rows without static forces; the operating points of their curves are set in place.
        design: design position of the car.
        joint_stiffness: stiffness of the springs inside joints; (n,).
    """
    settled = _settled(rows, design, joint_stiffness)
    t = rows.layout.tables
    air = rows.air.elements
    if not len(t.at) and not len(air):
        return settled
    for _ in range(MOST_TRIMS):
        last, rows.layout = rows.layout, standing_on(rows.layout, rows.air, settled.preload)
        settled = _settled(rows, design, joint_stiffness)
        now = rows.layout
        same = ((layout.bushings.stiffness, layout.springs.stiffness, layout.tables.at) for layout in (now, last))
        if all(map(np.allclose, *same)):
            break
    for element in air:
        load = -float(settled.preload[rows.layout.bushings.rows[element, 2]])
        if load <= 0.0:
            raise ConfigurationError(
                f"the air spring {rows.names[element]}: carries {load:.4g} N in the design position, must be above 0: "
                "its moving part must be below its carrier, and pressed against it"
            )
    t = rows.layout.tables
    for index, (law_type, element, axis, at) in enumerate(zip(t.kinds, t.elements, t.axes, t.at, strict=True)):
        if law_type < 2:
            row = rows.layout.bushings.rows[element, axis] if law_type == 0 else rows.layout.springs.rows[element]
            needed, carried = -settled.preload[row], float(curve_of(t, index).force(at))
            if abs(carried - needed) > 1e-6 * max(abs(needed), 1.0):
                name = rows.names[element] if law_type == 0 else rows.laws.springs[element]
                raise ConfigurationError(
                    f"the table of {name}: reaches {carried:.4g} N but must carry {needed:.4g} N in the design "
                    "position; extend it to that force"
                )
    return settled


def _settled(rows: Rows, design: AtRest, joint_stiffness: Vector) -> Settled:
    """Compute the equilibrium with the present tangents of all laws."""
    e, twist, jacobian, turned = rows.layout, rows.layout.rotations.stiffness, design.jacobian, design.turned
    row_stiffness, spins = _row_stiffness(rows), rows.layout.rolling.spins
    if len(spins):
        jacobian = jacobian.copy()
        # A wheel does not roll while the car settles; the unit stiffness keeps the matrix regular.
        jacobian[:, spins] = 0.0
    stiffness = jacobian.T @ (row_stiffness @ jacobian)
    stiffness[spins, spins] = 1.0
    # T' K_rot T, three rows for each element.
    flat = turned.reshape(-1, turned.shape[2])
    stiffness += flat.T @ (np.repeat(twist, 3)[:, None] * flat)
    stiffness[np.diag_indices(len(stiffness))] += joint_stiffness
    give = _factored(stiffness, jacobian[e.joints.ravel()])
    displacement, reaction = give(unsolved(e, design.weight))
    # f_e = -K_e J u, and -lambda of the joints.
    preload = -row_stiffness @ (jacobian @ displacement)
    preload[e.joints.ravel()] = -reaction
    torque = -twist[:, None] * (turned @ displacement)
    return Settled(preload=np.concatenate([preload, torque.ravel()]), displacement=displacement, give=give)


def _row_stiffness(rows: Rows) -> Vector:
    """Return the stiffness of all rows [N/m], diagonal except for oblique ground contacts."""
    e, b = rows.layout, rows.layout.bushings
    ground = ground_contacts(rows)
    diagonal, elastic = np.zeros(e.row_count), elastic_stiffness(e)
    diagonal[b.rows] = elastic
    rolling = e.rolling.tyres
    # Along the road a rolling tyre has no stiffness but that of its carcass, the spring of its branch.
    diagonal[b.rows[rolling, :2]] = b.branch_stiffness[rolling, :2]
    diagonal[b.rows[ground, :2]] *= SLIDING_SHARE
    diagonal[e.springs.rows] = e.springs.stiffness
    whole = np.diag(diagonal)
    # K in vehicle axes is P' diag(k) P; with its level part reduced, back to the rows r = P x.
    slide = np.diag(np.sqrt([SLIDING_SHARE, SLIDING_SHARE, 1.0]))
    for index, way in rows.directions.items():
        if index in ground:
            element_rows, back = b.rows[index], np.linalg.inv(way)
            level = slide @ (way.T * elastic[index]) @ way @ slide
            whole[np.ix_(element_rows, element_rows)] = back.T @ level @ back
    return whole


def elastic_stiffness(layout: Layout) -> Vector:
    """Return the stiffness of the bushings under a static load, for which rubber relaxes its friction; (n, 3)."""
    elastic = layout.bushings.stiffness.copy()
    np.subtract.at(elastic, (layout.rubber.elements, layout.rubber.axes), layout.rubber.stiffness)
    return elastic


def unsolved(layout: Layout, weight: Vector) -> Vector:
    """Return the generalised force at rest without the implicit rows: gravity, dampers and bump stops.

    Args:
        layout: layout of the elements.
        weight: generalised force of gravity; (n,).
    """
    dampers, t, force = layout.dampers, layout.tables, weight.copy()
    force[dampers.dofs] -= dampers.laws["rest_force"]
    for index in np.flatnonzero(t.kinds == 2):
        force[dampers.dofs[t.elements[index]]] -= curve_of(t, int(index)).force(0.0)
    return force


def ground_contacts(rows: Rows) -> Indices:
    """Return the indices of the ground contacts among the bushings; (k,)."""
    model, carriers = rows.model, rows.layout.bushings.carriers
    return np.flatnonzero((carriers == 0) | (model.body_mocapid[carriers] >= 0))


def _factored(stiffness: Vector, hard: Vector) -> Callable[[Vector], tuple[Vector, Vector]]:
    """Return a solver of K u + Jc' lambda = f, Jc u = 0 for displacement and joint reactions."""
    size, count = len(stiffness), len(hard)
    # Scaled to equal diagonals: rotations, modes and translations have different units.
    system = np.block([[stiffness, hard.T], [hard, np.zeros((count, count))]])
    scale = np.ones(size + count)
    scale[:size] = 1.0 / np.sqrt(np.maximum(np.diag(stiffness), 1.0))
    scaled = system * scale[:, None] * scale[None, :]
    factors, pivots, singular = scipy.linalg.lapack.dgetrf(scaled)
    near, _ = scipy.linalg.lapack.dgecon(factors, np.abs(scaled).sum(axis=0).max())
    # The estimate is inaccurate by a factor; near the limit, compute the exact condition number.
    if (singular or not near > CONDITION_SURE) and not np.linalg.cond(scaled) <= 1.0 / LEAST_CONDITION:
        raise SimulationError(
            "static trim: the car can move without resistance; check that every bushing has a stiffness in each "
            "direction without another support"
        )

    def give(force: Vector) -> tuple[Vector, Vector]:
        scaled_solution, _ = scipy.linalg.lapack.dgetrs(
            factors, pivots, scale * np.concatenate([force, np.zeros(count)])
        )
        solution = scale * scaled_solution
        return solution[:size], solution[size:]

    return give


def static_loads(rows: Rows, settled: Settled, left: Vector) -> StaticTrim:
    """Compute the static loads of a car.

    Args:
        rows: rows of the car.
        settled: equilibrium of the car.
        left: generalised force that remains with the preloads in place; (n,).
    """
    preload, tyres = settled.preload, rows.layout.tyres
    remaining, _ = settled.give(left)
    force = preload[rows.layout.bushings.rows]
    for index, way in rows.directions.items():
        # From directions to vehicle axes.
        force[index] = way.T @ force[index]
    vertical = force[:, 2]
    # A guide on the world without vertical stiffness carries nothing.
    carries = rows.layout.bushings.stiffness[:, 2] > 0.0
    others = [index for index in ground_contacts(rows) if index not in tyres and carries[index]]
    return StaticTrim(
        preload=preload,
        tyre_load=dict(zip(wheels_of(rows.model), map(float, vertical[tyres]), strict=True)),
        support_load={rows.names[index].partition("/")[2]: float(vertical[index]) for index in others},
        residual=float(np.max(np.abs(remaining))),
    )
