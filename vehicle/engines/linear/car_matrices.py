"""Mass, damping and stiffness matrices of the assembled car in its design position, read from its MuJoCo model.

u are the velocity coordinates of MuJoCo as small displacements. K is the derivative of the forces that the time
simulation applies, so it contains the geometric stiffness of gravity and preloads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import mujoco
import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.engines.linear.damper_elements import (
    SideRows,
    SliderElements,
    no_side_forces,
    no_sliders,
    side_rows,
    slider_elements,
)
from vehicle.engines.linear.displacement_laws import DisplacementLaw, displacement_laws
from vehicle.engines.linear.rolling_terms import following_stiffness, rolling_terms
from vehicle.engines.linear.system import LinearSystem
from vehicle.engines.simulation.applied_forces import force_lines, force_rows, tyre_inputs
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.element_records import Modes
from vehicle.engines.simulation.force_differences import differences
from vehicle.engines.simulation.law_arrays import fluid_coordinates, model_numbers
from vehicle.engines.simulation.row_layout import numeric, places_of, wheels_of
from vehicle.engines.simulation.rows import Rows, joint_dampers
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.engines.simulation.tyre_variation import RunOut
from vehicle.model.assembly.element_numbers import DECOUPLER, FLUID
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.names import AXES
from vehicle.signals.excitation.force_lines import ForceLines

COORDINATES = ("mode_", FLUID, DECOUPLER)
"""Beginnings of the names of coordinates that are not parts: modes of the body, fluids of hydromounts, decouplers."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarMatrices:
    """Linear car: a system with the plates as inputs and the dampers as sliding pairs, and data of its parts.

    Attributes:
        system: matrices of `vehicle.engines.linear.system`; C contains the viscous part of the dampers, inputs are the
            wheels, outputs map u'' to the acceleration channels.
        dampers: velocity coordinates of the damper joints; (d,).
        damper_names: names of the dampers, "damper_" and the wheel at a corner; an axle may have none.
        viscous: damping constants of the dampers [N s/m], softest settings of controlled ones; (d,).
        strokes: extensions of the dampers at rest [m]; None for the design position, zero.
        sensors: rows that map u' to the velocities along controlled dampers, on the wheel and on the body; (2 k, n).
        laws: nonlinear laws over displacement; their difference from the tangent is not in the matrices.
        tyre_stiffness, tyre_damping: vertical stiffness [N/m] and damping [N s/m] of the tyres; (w,).
        body_rows: rows that map u' to velocity of the centre of gravity and angular velocity of each body;
            body name to (6, n).
        body_masses: mass [kg] and inertia tensor [kg m2] of each body, as a (6, 6) matrix.
        body_centres: centre of gravity of each body in the design position [m]; (3,).
        tyre_rows: rows that map u to the height of the tyres over their plates; (w, n).
        one_sided: wheels whose tyres cannot pull.
        spinning: bodies that rotate with a rolling wheel; their angle is not a state.
        carried_by: body to which each body is fixed; the body itself if it can move on its parent.
        sliders: Jenkins elements of the dampers; their forces are not in the matrices.
        sides: side forces of the dampers whose friction depends on them.
        slope: generalised forces per velocity of a plate, due to the static load of a rolling tyre on the slope of
            the road, a part of the inputs of `system`; (n, w), (n, 0) for standing tyres.
        modal: velocity coordinates of the flexible modes.
        fluids: velocity coordinates of fluids and decouplers of hydromounts, by names as "fluid of hydromount".
        force_rows: generalised force of a unit of each applied force, zero for those that change a tyre; (f, n).
        force_slips: velocity of each Maxwell branch by a unit of each, that of the slip of a tread; (f, b).
        force_heights: height of each plate by a unit of each, the run-out of a tyre; (f, w).
        lines, coefficients: frequencies of these forces, and their coefficients on the histories; (f, lines).
    """

    system: LinearSystem
    dampers: Indices
    damper_names: tuple[str, ...]
    viscous: Vector
    strokes: Vector | None = None
    sensors: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    laws: tuple[DisplacementLaw, ...] = ()
    one_sided: frozenset[str] = frozenset()
    tyre_stiffness: Vector
    tyre_damping: Vector
    tyre_rows: Vector
    spinning: frozenset[str] = frozenset()
    body_rows: dict[str, Vector]
    body_masses: dict[str, Vector]
    body_centres: dict[str, Vector]
    carried_by: dict[str, str]
    modal: slice
    fluids: dict[str, int] = field(default_factory=dict)
    sliders: SliderElements = field(default_factory=no_sliders)
    sides: SideRows = field(default_factory=no_side_forces)
    slope: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    force_rows: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    force_slips: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    force_heights: Vector = field(default_factory=lambda: np.zeros((0, 0)))
    lines: ForceLines = field(default_factory=ForceLines)
    coefficients: Vector = field(default_factory=lambda: np.zeros((0, 0)))

    def without_forces(self) -> CarMatrices:
        """Return the matrices without applied forces."""
        none = {name: getattr(self, name)[:0] for name in ("force_rows", "force_slips", "force_heights")}
        return replace(self, **none, lines=ForceLines(), coefficients=np.zeros((0, 0)))

    def with_unit_forces(self, forces: Sequence[int]) -> CarMatrices:
        """Return the matrices whose histories are some of the forces themselves, without those of the car.

        Args:
            forces: indices of the forces on parts and joints.
        """
        return replace(self, lines=ForceLines(), coefficients=np.eye(len(self.force_rows))[:, list(forces)])

    @property
    def applied(self) -> Vector:
        """Generalised forces per unit of each history of the applied forces; (n, lines)."""
        # Columns: cos and sin of each frequency, then the recorded histories.
        return self.force_rows.T.reshape(self.system.size, -1) @ self.coefficients

    @property
    def slips(self) -> Vector:
        """Rates of the forces of the Maxwell branches per unit of each history [N/s]; (b, lines)."""
        return self.system.branch_stiffness[:, None] * (self.force_slips.T @ self.coefficients)

    @property
    def level_damping(self) -> Vector:
        """Bc of plates without a slope: the damping of the tyres alone; (n, w)."""
        return self.system.input_damping - self.slope if self.slope.size else self.system.input_damping

    @property
    def run_out(self) -> RunOut:
        """Run-outs of the tyres, see `with_run_out`."""
        run_outs = []
        constant = self.coefficients[:, : 2 * len(self.lines.frequencies)]
        # (wheels, 2 frequencies), reshaped to pairs of cos and sin.
        for wheel, of in zip(self.system.inputs, self.force_heights.T @ constant, strict=False):
            lines = zip(self.lines.frequencies, of.reshape(-1, 2).tolist(), strict=True)
            acting = {frequency: pair for frequency, pair in lines if any(pair)}
            if acting:
                run_outs.append((wheel, tuple(acting), tuple(value for pair in acting.values() for value in pair)))
        return tuple(run_outs)

    @property
    def forced(self) -> bool:
        """True if forces or tyres of the car shake it on a level road too."""
        return bool(self.coefficients.shape[1] or self.run_out)

    def __repr__(self) -> str:
        """One line."""
        return f"CarMatrices({len(self.system.mass)} coordinates, {len(self.dampers)} dampers)"


def car_matrices(model: mujoco.MjModel, static: StaticTrim, forces: Sequence[PlacedForce] = ()) -> CarMatrices:
    """Read the matrices of a trimmed car from its model.

    Args:
        model: compiled and trimmed car (not yet prepared for stepping).
        static: preloads of the car.
        forces: applied forces of the car, in the order of the model.
    """
    rows = Rows(model, static.preload)
    e, soft = rows.layout, rows
    if e.rubber.elements.size:
        # The tangent has rubber friction without its limits.
        soft = rows.anew()
        soft.layout = e._replace(rubber=e.rubber._replace(limit=np.full_like(e.rubber.limit, np.inf)))
    # K = -dF/du of what acts at rest: passive forces, gravity in the bias, and the explicit forces of the rows.
    stiffness = -differences(soft, lambda data: data.qfrc_passive - data.qfrc_bias + data.qfrc_applied)
    data = standing_data(rows)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    jacobian = rows.element_jacobian(data)
    dofs, still = e.dampers.dofs, np.zeros(len(e.tyres))
    # Rows of velocity and angular velocity, and masses with inertia tensors, of the bodies that are parts.
    rows_of_bodies, masses = dict[str, Vector](), dict[str, Vector]()
    for body in range(1, model.nbody):
        name = str(model.body(body).name)
        if model.body_mocapid[body] < 0 and not name.startswith(COORDINATES):
            rows_of_bodies[name], masses[name] = np.zeros((6, model.nv)), np.zeros((6, 6))
            mujoco.mj_jacBodyCom(model, data, rows_of_bodies[name][:3], rows_of_bodies[name][3:], body)
            masses[name][:3, :3] = model.body_mass[body] * np.eye(3)
            frame = data.ximat[body].reshape(3, 3)
            # Principal moments in the axes of the car: R diag(I) R'.
            masses[name][3:, 3:] = frame @ np.diag(model.body_inertia[body]) @ frame.T
    system_of_laws, car_of_laws = law_matrices(rows, jacobian, joint_dampers(model), static.preload)
    if len(e.rolling.tyres):
        stiffness += following_stiffness(rows, jacobian, system_of_laws["branch_drifts"])
    lines, coefficients = force_lines(forces)
    slips, plate_heights = tyre_inputs(forces, e, wheels_of(model))
    rolling_bodies = set(model.dof_bodyid[e.rolling.spins].tolist())
    return CarMatrices(
        system=LinearSystem(
            coordinates=(),
            inputs=wheels_of(model),
            mass=mass,
            stiffness=stiffness,
            slide_rows=np.eye(model.nv)[dofs],
            slide_inputs=np.zeros((len(dofs), len(e.tyres))),
            constraints=jacobian[e.joints.ravel()],
            load=np.zeros(model.nv),
            cyclic=tuple(e.rolling.spins.tolist()),
            outputs={name: np.concatenate([row, still]) for name, row in _outputs(model, data, e.modes).items()},
            **system_of_laws,
        ),
        dampers=dofs,
        damper_names=rows.laws.dampers,
        strokes=model.qpos0[e.dampers.places],
        **car_of_laws,
        sensors=_sensors(rows, data),
        one_sided=frozenset(
            wheel for wheel, tyre in zip(wheels_of(model), e.tyres, strict=True) if tyre in e.bushings.one_sided
        ),
        spinning=frozenset(
            str(model.body(i).name) for i, root in enumerate(model.body_weldid) if int(root) in rolling_bodies
        ),
        body_rows=rows_of_bodies,
        body_masses=masses,
        body_centres={name: data.xipos[model.body(name).id].copy() for name in rows_of_bodies},
        carried_by={
            str(model.body(i).name): str(model.body(int(root)).name) for i, root in enumerate(model.body_weldid)
        },
        modal=e.modes.velocities,
        fluids={
            name.replace("/", " of ", 1): int(model.joint(name).dofadr[0])
            for name in fluid_coordinates(rows.laws, model_numbers(model))
        },
        # Forces that change a tyre come last and have no row.
        force_rows=np.vstack([force_rows(model, data, e), np.zeros((len(forces) - len(e.applied.means), model.nv))]),
        force_slips=slips,
        force_heights=plate_heights,
        lines=lines,
        coefficients=coefficients,
    )


def law_matrices(
    rows: Rows, jacobian: Vector, joint_damping: Vector, preload: Vector
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the fields of `LinearSystem` and of `CarMatrices` that follow from the laws, except the stiffness matrix.

    Args:
        rows: rows of the car at rest.
        jacobian: Jacobian of the rows along the axes of the laws; (rows, n).
        joint_damping: damping inside joints; (n,).
        preload: static forces of the rows.
    """
    e, bushings, dofs = rows.layout, rows.layout.bushings, rows.layout.dampers.dofs
    viscous = e.dampers.laws["viscous_damping"]
    row_damping = np.zeros(e.row_count)
    row_damping[bushings.rows] = bushings.damping
    # C = J' B J, then what acts in single coordinates.
    damping = jacobian.T @ (row_damping[:, None] * jacobian)
    damping[np.diag_indices(len(damping))] += joint_damping
    damping[dofs, dofs] += viscous
    present = bushings.branch_stiffness > 0.0
    vertical = jacobian[bushings.rows[e.tyres][:, 2]]
    tyres = {"stiffness": bushings.stiffness[e.tyres, 2], "damping": bushings.damping[e.tyres, 2]}
    # A tyre pushes its wheel by k z + c z' along its row; (n, w).
    inputs = {f"input_{term}": vertical.T * values for term, values in tyres.items()}
    branch_rows = jacobian[bushings.rows[present]]
    over_displacement = displacement_laws(rows, jacobian, preload)
    slope, drifting = np.zeros((len(damping), 0)), dict[str, Any]()
    if len(e.rolling.tyres):
        more, slope, drifting = rolling_terms(rows, preload, branch_rows)
        damping += more
        # The static load on the slope z'/V.
        inputs["input_damping"] = inputs["input_damping"] + slope
    return (
        {
            "damping": damping,
            "branch_rows": branch_rows,
            **drifting,
            "branch_inputs": np.zeros((int(np.count_nonzero(present)), len(e.tyres))),
            "branch_stiffness": bushings.branch_stiffness[present],
            "branch_time": bushings.branch_time[present],
            **inputs,
        },
        {
            "viscous": viscous,
            "laws": over_displacement,
            "sliders": slider_elements(rows),
            "sides": side_rows(rows, jacobian, preload, over_displacement),
            "tyre_rows": vertical,
            **{f"tyre_{term}": values for term, values in tyres.items()},
            "slope": slope,
        },
    )


def _sensors(rows: Rows, data: mujoco.MjData) -> Vector:
    """Return the rows of the velocities that the sensors of controlled dampers measure."""
    model, controls = rows.model, rows.layout.controls
    sensor_rows = np.zeros((2 * len(controls.dampers), model.nv))
    turn = data.xmat[rows.layout.modes.body].reshape(3, 3)
    for row, (site, shape) in enumerate(zip(controls.sites.ravel(), controls.shapes, strict=True)):
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, jacobian, None, int(site))
        # A point of the flexible body moves with its modes, too.
        jacobian[:, rows.layout.modes.velocities] += turn @ shape.reshape(3, -1)
        damper = rows.layout.dampers.dofs[controls.dampers[row // 2]]
        sensor_rows[row] = data.xaxis[model.dof_jntid[damper]] @ jacobian
    return sensor_rows


def _outputs(model: mujoco.MjModel, data: mujoco.MjData, modes: Modes) -> dict[str, Vector]:
    """Return the rows of all acceleration channels."""
    outputs, turn = {}, data.xmat[modes.body].reshape(3, 3)
    for point in places_of(model):
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jacSite(model, data, jacobian, None, model.site(f"place/{point}").id)
        shape = numeric(model, f"shape/place/{point}")
        if shape is not None:
            jacobian[:, modes.velocities] = turn @ shape.reshape(3, -1)
        for axis, row in zip(AXES, jacobian, strict=True):
            outputs[f"{point}_acc_{axis}"] = row
    return outputs
