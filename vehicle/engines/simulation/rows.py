"""Elements of a compiled car with the weights of its time step and the state of their laws."""

from __future__ import annotations

import copy

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.core.records import Packed
from vehicle.engines.simulation.element_records import Layout, ModalSpace
from vehicle.engines.simulation.force_curves import standing_on
from vehicle.engines.simulation.law_arrays import Numbers, air_springs, law_names, model_numbers, with_numbers
from vehicle.engines.simulation.row_layout import read_layout
from vehicle.engines.simulation.simulation_record import functions, packed_simulation
from vehicle.engines.simulation.step_records import State, Weights
from vehicle.engines.simulation.step_weights import FITTED_PHASE, FOURTH_ORDER, average, implicit_share
from vehicle.errors import SimulationError
from vehicle.model.laws.control_laws import RING

EMPTY_ROW = 1e-9
"""Impedance [kg] of a row without damping and stiffness: nonzero, and small against every mass."""


def prepare_model(model: mujoco.MjModel) -> None:
    """Integrate springs and dampers inside joints centred like the rows, by means of the armature.

    (M + B h/2 + K h2/12) a = ... - K q - B q' for the modal coordinates and the stabilizer torsion.

    Args:
        model: compiled car as generated; modified in place, so call this once.
    """
    model.dof_armature += joint_weights(model)
    model.dof_damping *= np.reshape(damping_factors(model), (-1, *[1] * (model.dof_damping.ndim - 1)))
    # This updates the derived constants of bodies with a single slide.
    mujoco.mj_setConst(model, mujoco.MjData(model))


def joint_springs(model: mujoco.MjModel) -> Vector:
    """Return the stiffness of the springs inside joints, per velocity coordinate; (nv,)."""
    stiffness = np.zeros(model.nv)
    # Versions of MuJoCo with polynomial springs have a row of coefficients for each joint; the first is the linear one.
    stiffness[model.jnt_dofadr] = model.jnt_stiffness.reshape(model.njnt, -1)[:, 0]
    return stiffness


def joint_dampers(model: mujoco.MjModel) -> Vector:
    """Return the damping inside joints, per velocity coordinate; (nv,)."""
    return np.ravel(model.dof_damping.reshape(model.nv, -1)[:, 0])


def damping_factors(model: mujoco.MjModel) -> Vector:
    """Return the factor 1 + w2 h2/12 of the damping inside joints, per velocity coordinate; (nv,).

    Centred damping is lower by w2 h2/12 than the averaged other forces. The damping of a mode matters at its resonance
    w2 = K / M, M being the diagonal of the mass matrix in the design position, which is 1 for a mode.
    """
    squares = joint_springs(model) / model.dof_M0
    return np.asarray(1.0 + FOURTH_ORDER * squares * model.opt.timestep**2)


def joint_weights(model: mujoco.MjModel) -> Vector:
    """Return the weight B h/2 + K h2/12 [kg or kg m2] of springs and dampers inside joints, before `prepare_model`."""
    step = model.opt.timestep
    damping = np.zeros(model.nv)
    damping[model.jnt_dofadr] = joint_dampers(model)[model.jnt_dofadr]
    return np.asarray(damping_factors(model) * damping * step / 2 + FOURTH_ORDER * joint_springs(model) * step**2)


class Rows:
    """Constraint rows of a simulation: records of the laws, their weights and their state between steps.

    Args:
        model: compiled car.
        preload: static forces, see `Weights`; zeros by default.
        space: modes that the rows integrate; None if the model contains them.

    Attributes:
        laws: names of all elements. names: names in the order of `layout.bushings`.
        air: air springs among them.
        layout, weights, state: elements, step weights and state.
    """

    def __init__(self, model: mujoco.MjModel, preload: Vector | None = None, space: ModalSpace | None = None) -> None:
        self.model, self.laws, layout = model, law_names(model), read_layout(model)
        self.names, self.air = self.laws.bushings, air_springs(self.laws, model_numbers(model))
        layout = layout if space is None else layout._replace(space=space)
        force = np.zeros(layout.row_count + 3 * len(layout.rotations.sites)) if preload is None else preload
        self.layout = standing_on(layout, self.air, preload)
        self._masses = _row_masses(model, layout)
        self.weights = weights(model, self.layout, force, self._masses)
        self.state = _at_rest(self.layout)
        # Loaded here: MuJoCo cannot be asked for its layout inside a callback.
        self._core = functions()
        self._packed: tuple[tuple[object, ...], Packed] | None = None

    @property
    def directions(self) -> dict[int, Vector]:
        """Return the direction matrix P of the oblique elements, by index; (3, 3)."""
        b = self.layout.bushings
        return {int(index): way.reshape(3, 3) for index, way in zip(b.oblique, b.directions, strict=True)}

    def anew(self, preload: Vector | None = None) -> Rows:
        """Return a copy at rest with a new state, under these static forces or unchanged ones."""
        other = copy.copy(self)
        if preload is not None:
            other.layout = standing_on(self.layout, self.air, preload)
            other.weights = weights(self.model, other.layout, preload, self._masses)
        other.state = _at_rest(self.layout)
        return other

    def with_laws(self, numbers: Numbers) -> Rows:
        """Return rows with other law parameters for a linearisation; weights and state remain unchanged."""
        other = copy.copy(self)
        timestep = float(self.model.opt.timestep)
        other.air = air_springs(self.laws, numbers)
        other.layout = standing_on(with_numbers(self.layout, self.laws, numbers, timestep), other.air, None)
        return other

    def reset(self) -> None:
        """Reset the state to rest: zero branch forces, zero rates."""
        for present, fresh in zip(self.state, _at_rest(self.layout), strict=True):
            present[...] = fresh

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of a state in MuJoCo's dense format, as `mjcb_control`.

        Raises:
            SimulationError: the state has other constraint rows than the car.
        """
        if data.nefc != self.layout.row_count or data.nJ != data.nefc * model.nv:
            raise SimulationError(
                f"the state has {data.nefc} constraint rows with {data.nJ} numbers, the car has "
                f"{self.layout.row_count} dense ones; leave its equalities and the format of its rows as they are"
            )
        # The caller detects nonfinite states.
        self._core.core_rewrite_d(self._record(data).address, data._address)

    def actuator_bias(self, model: mujoco.MjModel, data: mujoco.MjData, index: int) -> float:
        """Return the viscous force of a damper [N], as `mjcb_act_bias`."""
        return float(self._core.core_damper_force_d(self._record(data).address, index))

    def _record(self, data: mujoco.MjData) -> Packed:
        """Return the record of a state for the core, packed anew only if one of its parts is another one."""
        parts = (data, self.layout, self.weights, self.state)
        if self._packed is None or any(one is not other for one, other in zip(self._packed[0], parts, strict=True)):
            self._packed = parts, packed_simulation(self, data)
        return self._packed[1]

    @staticmethod
    def actuator_gain(model: mujoco.MjModel, data: mujoco.MjData, index: int) -> float:
        """Return 0 N, as `mjcb_act_gain`: dampers have no control input."""
        return 0.0

    def whole(self, held: Vector, modal: Vector) -> Vector:
        """Return positions or velocities of the model with all modal coordinates of the body.

        Args:
            held: positions (nq,) or velocities (nv,) of the compiled model, which holds some of the modes.
            modal: all modal coordinates [kg^1/2 m], or their rates; (modes,).
        """
        modes = self.layout.modes
        modal_range = modes.positions if held.size == self.model.nq else modes.velocities
        return np.concatenate([held[: modal_range.start], modal, held[modal_range.stop :]])

    def modal_positions(self, data: mujoco.MjData) -> Vector:
        """Return the modal coordinates after a step, before the rows are evaluated; (modes,)."""
        space, modes, (q, v) = self.layout.space, self.layout.modes, self.state.modal
        if not space.mass.size:
            return np.array(data.qpos[modes.positions])
        h = self.weights.timestep
        # eta'' - S' (-k q - b q') over the completed step; then v+ = v + h q'', q+ = q + h v+ (`modes.h` of the core).
        pull = (data.qvel[modes.velocities] - self.state.modal_rate) / h - self.state.modal_force
        elastic = space.stiffness * (space.rest - q) - space.damping * v
        return np.asarray(q + h * (v + h * (elastic / space.mass + space.spread @ pull)))

    def element_jacobian(self, data: mujoco.MjData) -> Vector:
        """Return the Jacobian of all rows, of an element along the axes of its law; (rows, nv)."""
        jacobian, b = data.efc_J.reshape(self.layout.row_count, self.model.nv).copy(), self.layout.bushings
        oblique = set(b.oblique.tolist())
        for index, carrier in enumerate(b.carriers):
            frame = data.xmat[carrier].reshape(3, 3)
            # In the design position carriers are parallel to the vehicle frame; oblique rows are along their laws.
            if index not in oblique and not np.array_equal(frame, np.eye(3)):
                jacobian[b.rows[index]] = frame.T @ jacobian[b.rows[index]]
        return np.asarray(jacobian)

    def rotation(self, data: mujoco.MjData) -> tuple[Vector, Vector]:
        """Return sin(angle) n of each moving part relative to its carrier, world axes, (m, 3), and carrier frames."""
        elements, modes = self.layout.rotations, self.layout.modes
        frames = data.site_xmat[elements.sites].reshape(-1, 2, 3, 3)
        for (element, side), psi in zip(elements.nodes, self._node_rotations(data), strict=True):
            # c + theta x c for each axis c of the frame, theta = R Psi q.
            frames[element, side] += np.cross(psi @ data.qpos[modes.positions], frames[element, side], axisb=0, axisc=0)
        moving, carrier = frames[:, 0], frames[:, 1]
        # Half the sum of c_k x m_k over the axes k of both frames.
        return 0.5 * np.sum(np.cross(carrier, moving, axis=1), axis=2), carrier

    def rotation_jacobian(self, data: mujoco.MjData) -> Vector:
        """Return the Jacobian of the angular velocity of each moving part relative to its carrier; (m, 3, nv)."""
        jacobian = np.zeros((len(self.layout.rotations.sites), 3, self.model.nv))
        element, dof, sign = self.layout.rotations.turning.T
        jacobian[element, :, dof] = sign[:, None] * data.cdof[dof, :3]
        for (index, side), psi in zip(self.layout.rotations.nodes, self._node_rotations(data), strict=True):
            jacobian[index, :, self.layout.modes.velocities] += (1 - 2 * side) * psi
        return jacobian

    def _node_rotations(self, data: mujoco.MjData) -> Vector:
        """Return R Psi of the nodes with rotational mode shapes; (k, 3, modes)."""
        elements, turn = self.layout.rotations, data.xmat[self.layout.modes.body].reshape(3, 3)
        return np.asarray(turn @ elements.shapes.reshape(len(elements.nodes), 3, self.layout.modes.size))


def weights(model: mujoco.MjModel, layout: Layout, preload: Vector, masses: Vector) -> Weights:
    """Compute the weights of the rows for the time step of a model.

    Args:
        model: model with its time step.
        layout: elements of the model.
        preload: static forces of the rows [N], then the torques of the rotations [N m]; see `StaticTrim`.
        masses: effective mass of each element row [kg]; (n, 3).
    """
    b, h = layout.bushings, float(model.opt.timestep)
    # A step that is stable for the steepest segment of a curve is stable for all.
    stiffness, springs = b.stiffness.copy(), layout.springs.stiffness.copy()
    t = layout.tables
    for law_type, element, axis, steepest in zip(t.kinds, t.elements, t.axes, t.slopes.max(axis=1), strict=True):
        if law_type == 0:
            stiffness[element, axis] = steepest
        elif law_type == 1:
            springs[element] = steepest
    # beta of each row: larger than 1/12 where K h^2/m would be unstable.
    averaged = np.where(b.averaged[:, None] > 0, average(stiffness * h**2 / masses), FOURTH_ORDER)
    present = b.branch_time > 0.0
    tau = np.where(present, b.branch_time, 1.0)
    # E = exp(-h/tau).
    decay = np.where(present, np.exp(-h / tau), 0.0)
    # A branch may be as stiff as the sheet metal of a mount; then its force is averaged over three steps too.
    phase = (stiffness + b.branch_stiffness) * h**2 / masses
    branch_average = average(phase)
    # Exact response of the branch to a rate that is linear over the step: mean rate and its slope.
    # Over a step f2+ = E f2 + K2 tau (1 - E) v + s a, s = 2 theta K2 tau (h (1 + E)/2 - tau (1 - E)).
    gain = np.where(present, b.branch_stiffness * tau * -np.expm1(-h / tau), 0.0)
    series = tau * (0.5 * h * (1.0 + np.exp(-h / tau)) + tau * np.expm1(-h / tau))
    # Avoid ringing of a low-mass part with strong branch damping.
    share = np.where(phase > FITTED_PHASE**2, 0.5, implicit_share(gain * h / masses))
    slope = np.where(present, b.branch_stiffness * series * 2.0 * share, 0.0)
    # Impedance of the branch, D_b = s + beta_b ((E - 1) s + K2 tau (1 - E) h).
    rise = branch_average * ((decay - 1.0) * slope + gain * h)
    branch = np.where(present, slope + rise, 0.0)
    laws, inertial = layout.dampers.laws, averaged[layout.tyres] * stiffness[layout.tyres] * h**2
    # A tread that moves along x is a known part of the rate of the slip, and of its change in a step.
    inertial[:, 0] += branch[layout.tyres, 0]
    return Weights(
        timestep=h,
        preload=preload,
        decay=decay,
        gain=gain,
        slope=slope,
        average=branch_average,
        # D = B h/2 + beta K h^2 + D_b.
        impedance=np.maximum(b.damping * h / 2 + averaged * stiffness * h**2 + branch, EMPTY_ROW),
        inertial=inertial,
        spring_impedance=np.maximum(FOURTH_ORDER * springs * h**2, EMPTY_ROW),
        damper_impedance=np.maximum(laws["viscous_damping"] * h / 2, EMPTY_ROW),
        valve_impedance=np.maximum(layout.dampers.pieces[:, 0] * h / 2, EMPTY_ROW),
    )


def _row_masses(model: mujoco.MjModel, layout: Layout) -> Vector:
    """Return the effective mass 1 / (j M^-1 j') [kg] of each element row in the design position; (n, 3)."""
    data = mujoco.MjData(model)
    mujoco.mj_fwdPosition(model, data)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    rows = data.efc_J.reshape(-1, model.nv)[layout.bushings.rows.ravel()]
    for index, way in zip(layout.bushings.oblique, layout.bushings.directions, strict=True):
        element_rows = slice(3 * index, 3 * index + 3)
        # The rows of an oblique element are along its directions.
        rows[element_rows] = way.reshape(3, 3) @ rows[element_rows]
    # Diagonal of J M^-1 J'.
    inverse = np.einsum("ij,ji->i", rows, np.linalg.solve(mass, rows.T))
    # The effective mass of an immovable row is infinite.
    moved = np.divide(1.0, inverse, out=np.full_like(inverse, np.inf), where=inverse > 0.0)
    return np.asarray(moved).reshape(layout.bushings.rows.shape)


def _at_rest(layout: Layout) -> State:
    """Return a state at rest."""
    elements, tyres, springs = layout.bushings.rows.shape, len(layout.tyres), len(layout.springs.rows)
    shapes: dict[str, tuple[int, ...]] = dict.fromkeys(State._fields, elements)
    shapes |= dict.fromkeys(("plate_velocity", "plate_acceleration"), (tyres, 3))
    shapes |= {"slope_velocity": (tyres,), "last_time": (1,), "explicit": (layout.row_count,)}
    shapes |= {"torque": (len(layout.rotations.sites), 3), "ends": (2 * springs, 3), "line": (springs, 3)}
    shapes |= {"frame": (len(layout.rotations.nodes), 9)}
    longest = RING + 1 + int(np.max(layout.controls.laws["lag"], initial=0.0))
    controls, dampers = len(layout.controls.dampers), len(layout.dampers.dofs)
    shapes |= {"coefficient": (dampers,), "sensed": (2 * controls, 2), "past": (controls, longest), "steps": (1,)}
    shapes |= {"speeds": (len(layout.own.dampers), 2)}
    shapes |= {"rubber": (4, len(layout.rubber.elements))}
    shapes |= {"slider": (2, len(layout.presliding.rows)), "stroke": (dampers,), "limit": (dampers,)}
    shapes |= {"stretch": layout.tables.at.shape, "deflection": (2, layout.modes.mode_shapes.shape[1])}
    rolling = len(layout.rolling.tyres)
    shapes |= {"heading": (2, rolling), "turning": (rolling, 6), "slope": (rolling, 4)}
    applied = [len(layout.applied.forces), len(layout.applied.torques)]
    shapes |= {"push": (layout.velocity_count if rolling or any(applied) else 0,)}
    shapes |= {"applied": layout.applied.means.shape}
    shapes |= {"contact": (2, len(layout.bushings.one_sided)), "modal": (2, layout.modes.size)}
    if layout.space.mass.size:
        shapes["modal"] = (2, layout.space.mass.size)
    shapes |= dict.fromkeys(("modal_force", "modal_rate", "modal_pull"), (layout.space.spread.shape[1],))
    state = State(**{name: np.zeros(shapes[name]) for name in State._fields})
    state.last_time[0] = -1.0
    state.applied[:] = layout.applied.means
    state.coefficient[:] = layout.dampers.laws["viscous_damping"]
    state.past[:] = layout.controls.laws["softest"][:, None]
    return state
