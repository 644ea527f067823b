"""The element laws as constraint rows: what `mjcb_control` writes before MuJoCo solves.

MuJoCo answers a quadratic row with f = D (aref - J a). The callback rewrites each row of an element so that, with
the explicit part f0 given to the generalised forces,

    f = f0 - D J a,    f0 = preload - K r - B r' - f2,    D = B h/2 + beta K h2 + branch,

r' being the rate at the middle of the past step: B (r' + h a/2) is the damping at the present time (centred, second
order), and beta = 1/12 makes the step of a linear system fourth order in its frequencies (Fox and Goodwin, Numerov);
stiff local springs take up to beta = 1/4, which is stable at any step (Newmark; see `step_weights`). The friction
row of a damper is f = -clamp(c (v + h a)): D = c h, aref = -v/h, its limit the friction force: set-valued in effect,
sticking is exact. With c = (2/pi) Fd eps it is a line through zero, clamped at the limit Fd: the slope at rest of the
published Fd (2/pi) atan(eps v), without its tail.
The second row of a degressive damper, F = D v + clamp((Ddeg - D) v) with the limit (Ddeg - D) Vdeg, is a friction row
too; its law is smooth, so that it is centred like the viscous one: D = (Ddeg - D) h/2, aref = -2 v/h, second order.
The two forces of a bushing are opposite and act each at the point of its own part, in the axes of the carrier; the
moment r x f of their distance r is left out, which changes no frequency by more than 0.05 %.
Rotations need no rows: K_rot is soft against every inertia and undamped, so its torque is given explicitly,
T = -K_rot sin(angle) n from the frames of both sites.

Modal coordinates q of the flexible body move node n by d = R Phi_n q, R being the rotation of the body. They enter a
row there as r -> r +- d, and its derivative by the coordinates as J -> J +- (R Phi_n, -[d]x on what turns the body):
without the second part the body would miss the torque d x F of every force at a node. The line of a main spring goes
through the displaced seat: n = (x_up + d - x_low) / length, r = length - L0, J = n' (J_up + R Phi - [d]x - J_low).
Without d in n, the transverse stiffness F / length of a loaded spring would not act on the modes.
"""

from __future__ import annotations

import copy

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.simulation.elements import modal_joints, read_elements
from vehicle.simulation.step_weights import FITTED_PHASE, FOURTH_ORDER, average, implicit_share

Vector = npt.NDArray[np.float64]

EMPTY_ROW = 1e-9
"""Impedance [kg] of a row without damping and stiffness: small against every mass, and not zero."""


def prepare_model(model: mujoco.MjModel) -> None:
    """Give springs and dampers inside joints the same centred treatment as the rows, through the armature.

    (M + B h/2 + K h2/12) a = ... - K q - B q' for the modal coordinates and the stabilizer torsion.

    Args:
        model: compiled car, as generated; changed in place, once.
    """
    model.dof_armature += joint_weights(model)
    model.dof_damping *= np.reshape(damping_factors(model), (-1, *[1] * (model.dof_damping.ndim - 1)))
    # Bodies with a single slide take their mass from constants that are derived here.
    mujoco.mj_setConst(model, mujoco.MjData(model))


def damping_factors(model: mujoco.MjModel) -> Vector:
    """Factor 1 + K h2/12 of the damping inside joints, per velocity coordinate; (nv,).

    A centred damping is weaker by w2 h2/12 than the average of all else. That of a mode counts at its resonance, where
    w2 = K, its mass being 1.
    """
    stiffness = np.ravel(model.jnt_stiffness.reshape(model.njnt, -1)[:, 0])
    factors = np.ones(model.nv)
    factors[model.jnt_dofadr] += FOURTH_ORDER * stiffness * model.opt.timestep**2
    return factors


def joint_weights(model: mujoco.MjModel) -> Vector:
    """Weight B h/2 + K h2/12 [kg or kg m2] of the springs and dampers inside joints of a model as generated; (nv,)."""
    step = model.opt.timestep
    weights, factors = np.zeros(model.nv), damping_factors(model)
    for joint in range(model.njnt):
        dof = model.jnt_dofadr[joint]
        damping = float(np.ravel(model.dof_damping[dof])[0])
        stiffness = float(np.ravel(model.jnt_stiffness[joint])[0])
        weights[dof] = factors[dof] * damping * step / 2 + FOURTH_ORDER * stiffness * step**2
    return weights


class ElementRows:
    """State of the element laws of one simulation: the callback and what it remembers between steps.

    Args:
        model: compiled car; its armatures are changed by `prepare_model`.
        preload: static force of every row in element axes [N], and behind them the static torques of the rotations
            in the axes of their carriers [N m], (rows + 3 m,); zeros by default.
    """

    def __init__(self, model: mujoco.MjModel, preload: Vector | None = None) -> None:
        self.model = model
        self.elements = read_elements(model)
        e = self.elements
        joints = modal_joints(model)
        first = int(model.jnt_qposadr[joints[0]]) if joints else 0
        self.modal_positions = slice(first, first + len(joints))
        self._read_dampers(model)
        self._set_step(model.opt.timestep)
        self._begin(np.zeros(e.row_count + 3 * len(e.rotation_stiffness)) if preload is None else preload)

    def anew(self, preload: Vector | None = None) -> ElementRows:
        """The same rows at rest with a state of their own, under these static forces; under the same by default."""
        other = copy.copy(self)
        other._begin(self.preload if preload is None else preload)
        return other

    def _begin(self, preload: Vector) -> None:
        """Take static forces and a state of rest."""
        e = self.elements
        self.preload = preload
        self.element_preload = preload[e.rows]
        self.hard_preload = preload[e.hard_rows]
        self.rotation_preload = preload[e.row_count :].reshape(-1, 3)
        self.spring_preload = preload[e.springs]
        self.plate_velocity = np.zeros((len(e.tyres), 3))
        self.plate_acceleration = np.zeros((len(e.tyres), 3))
        self.reset()

    def _read_dampers(self, model: mujoco.MjModel) -> None:
        """Laws of the dampers, owned by their actuators."""
        actuators = [index for index in range(model.nu) if model.actuator_biastype[index] == mujoco.mjtBias.mjBIAS_USER]
        parameters = model.actuator_biasprm[actuators, :8].T.copy()
        self.viscous, self.smoothing, self.sliding_limit, self.static_limit = parameters[:4]
        self.stribeck_velocity, self.exponent, valve_damping, valve_limit = parameters[4:]
        # A valve row of its own exists only where the law is degressive.
        self.valve_damping, self.valve_limit = valve_damping[valve_limit > 0.0], valve_limit[valve_limit > 0.0]
        self.stribeck = bool(np.any(self.static_limit != self.sliding_limit))

    def _set_step(self, step: float) -> None:
        """Constants that depend on the time step."""
        e, h = self.elements, step
        self.step = h
        masses = self._row_masses()
        self.average = np.where(e.averaged[:, None], average(e.stiffness * h**2 / masses), FOURTH_ORDER)
        present = e.branch_time > 0.0
        tau = np.where(present, e.branch_time, 1.0)
        self.decay = np.where(present, np.exp(-h / tau), 0.0)
        # A branch may be as stiff as the sheet metal behind a mount; then its force is averaged over three steps too.
        phase = (e.stiffness + e.branch_stiffness) * h**2 / masses
        self.branch_average = average(phase)
        # Exact response of the branch to a rate that is linear over the step: mean rate and its slope.
        self.branch_gain = np.where(present, e.branch_stiffness * tau * -np.expm1(-h / tau), 0.0)
        series = tau * (0.5 * h * (1.0 + np.exp(-h / tau)) + tau * np.expm1(-h / tau))
        # A light part that the branch damps strongly must not ring.
        share = np.where(phase > FITTED_PHASE**2, 0.5, implicit_share(self.branch_gain * h / masses))
        self.branch_slope = np.where(present, e.branch_stiffness * series * 2.0 * share, 0.0)
        rise = self.branch_average * ((self.decay - 1.0) * self.branch_slope + self.branch_gain * h)
        branch = np.where(present, self.branch_slope + rise, 0.0)
        self.impedance = np.maximum(e.damping * h / 2 + self.average * e.stiffness * h**2 + branch, EMPTY_ROW)
        self.inertial = self.average[e.tyres] * e.stiffness[e.tyres] * h**2
        self.spring_impedance = np.maximum(FOURTH_ORDER * e.spring_stiffness * h**2, EMPTY_ROW)
        self.damper_impedance = np.maximum(self.viscous * h / 2, EMPTY_ROW)
        self.valve_impedance = np.maximum(self.valve_damping * h / 2, EMPTY_ROW)

    def _row_masses(self) -> Vector:
        """Mass 1 / (j M^-1 j') [kg] that each element row moves in the design position; (n, 3)."""
        model = self.model
        data = mujoco.MjData(model)
        mujoco.mj_fwdPosition(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        rows = data.efc_J.reshape(-1, model.nv)[self.elements.rows.ravel()]
        inverse = np.einsum("ij,ji->i", rows, np.linalg.solve(mass, rows.T))
        # A row that nothing can move moves an infinite mass.
        moved = np.divide(1.0, inverse, out=np.full_like(inverse, np.inf), where=inverse > 0.0)
        return np.asarray(moved).reshape(self.elements.rows.shape)

    def reset(self) -> None:
        """Forget the past: no branch forces, no rates."""
        shape = self.elements.rows.shape
        self.branch_past = np.zeros(shape)  # part of f2 known before the acceleration of the step is
        self.branch_force = np.zeros(shape)  # f2 at the last completed step
        self.last_rate = np.zeros(shape)
        self.last_time = -1.0
        self.residual = np.zeros(shape)
        self.rate = np.zeros(shape)
        self.explicit = np.zeros(self.elements.row_count)
        self.limits = self.static_limit.copy()

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Rewrite the rows of `data`; installed as `mjcb_control`."""
        e = self.elements
        jacobian = data.efc_J.reshape(e.row_count, model.nv)
        position, velocity = data.efc_pos, data.efc_vel
        impedance, regulariser, reference = data.efc_D, data.efc_R, data.efc_aref
        orientation = data.xmat
        q_columns = e.modal_columns
        turned_rows = e.node_rows
        residual, rate = position[e.rows], velocity[e.rows]
        ends = data.site_xpos[e.spring_sites]
        if q_columns.stop:
            turn = orientation[e.body].reshape(3, 3)
            modes = q_columns.stop - q_columns.start
            shapes = (turn @ e.node_shapes).reshape(3, -1, modes)
            jacobian[turned_rows, q_columns] = shapes
            q = data.qpos[self.modal_positions]
            qd = data.qvel[q_columns]
            displaced = shapes @ q
            lever = np.cross(data.cdof[e.body_turns, :3][:, None], displaced.T).T
            jacobian[turned_rows[..., None], e.body_turns] += lever
            position[turned_rows] += displaced
            velocity[turned_rows] += shapes @ qd + lever @ data.qvel[e.body_turns]
            residual, rate = position[e.rows], velocity[e.rows]
            ends[:, 1] += (e.spring_shapes @ q) @ turn.T
        line = ends[:, 1] - ends[:, 0]
        length = np.sqrt(np.einsum("ij,ij->i", line, line))
        line /= length[:, None]
        self._spring_rows(data, jacobian, ends, line)
        if q_columns.stop:
            jacobian[e.springs, q_columns] = np.einsum("ij,ijk->ik", line @ turn, e.spring_shapes)
        rate[e.tyres] -= self.plate_velocity
        frames = orientation[e.carriers].reshape(-1, 3, 3)
        residual = np.einsum("nji,nj->ni", frames, residual)
        rate = np.einsum("nji,nj->ni", frames, rate)
        self._advance_branches(data.time, rate)
        self.residual, self.rate = residual, rate
        force = self.element_preload - e.stiffness * residual - e.damping * rate - self._branches(rate)
        force[e.tyres] += self.inertial * self.plate_acceleration
        explicit = self.explicit
        explicit[e.rows] = np.einsum("nij,nj->ni", frames, force)
        explicit[e.springs] = self.spring_preload - e.spring_stiffness * (length - e.spring_lengths)
        explicit[e.hard_rows] = self.hard_preload
        # MuJoCo made the reference of the ideal joints before it knew of the modal coordinates.
        law = data.efc_KBIP[e.hard_rows]
        reference[e.hard_rows] = (
            -law[..., 1] * velocity[e.hard_rows] - law[..., 0] * law[..., 2] * position[e.hard_rows]
        )
        impedance[e.rows] = self.impedance
        impedance[e.springs] = self.spring_impedance
        impedance[e.dampers] = self.damper_impedance
        reference[e.rows] = 0.0
        reference[e.springs] = 0.0
        reference[e.dampers] = 0.0
        sliding = data.qvel[e.damper_dofs]
        self._friction(sliding)
        slope = (2.0 / np.pi) * self.limits * self.smoothing
        impedance[e.frictions] = np.maximum(slope * self.step, EMPTY_ROW)
        reference[e.frictions] = -sliding / self.step
        data.efc_frictionloss[e.frictions] = self.limits
        if len(e.valves):
            impedance[e.valves] = self.valve_impedance
            reference[e.valves] = -2.0 * sliding / self.step
            data.efc_frictionloss[e.valves] = self.valve_limit
        np.divide(1.0, impedance, out=regulariser)
        turned, frames = self.rotation(data)
        torque = np.einsum("nij,nj->ni", frames, self.rotation_preload) - e.rotation_stiffness * turned
        turning = np.einsum("ij,ij->i", data.cdof[:, :3], e.rotation_dofs.T @ torque)
        data.qfrc_applied[:] = explicit @ jacobian + turning

    def _spring_rows(self, data: mujoco.MjData, jacobian: Vector, ends: Vector, line: Vector) -> None:
        """n' (J_up - J_low) of the springs, for the coordinates that move their `ends` (2, 2, 3)."""
        e = self.elements
        spring, end, dof, tree = e.spring_dofs.T
        # MuJoCo refers the motion of a tree to its centre of mass.
        turning, moving = data.cdof[dof, :3], data.cdof[dof, 3:]
        velocity = moving + np.cross(turning, ends[spring, end] - data.subtree_com[tree])
        jacobian[e.springs] = 0.0
        np.add.at(jacobian, (e.springs[spring], dof), (2 * end - 1) * np.einsum("ij,ij->i", line[spring], velocity))

    def rotation(self, data: mujoco.MjData) -> tuple[Vector, Vector]:
        """sin(angle) n of each moving part against its carrier in world axes (m, 3), and the carrier's frame."""
        frames = data.site_xmat[self.elements.rotation_sites].reshape(-1, 2, 3, 3)
        moving, carrier = frames[:, 0], frames[:, 1]
        # Half the sum of c_k x m_k over the axes.
        product = np.einsum("nik,njk->nij", carrier, moving)
        halves = [product[:, i, j] - product[:, j, i] for i, j in ((1, 2), (2, 0), (0, 1))]
        return 0.5 * np.stack(halves, axis=1), carrier

    def rotation_jacobian(self, data: mujoco.MjData) -> Vector:
        """Angular velocity of each moving part against its carrier over the velocity coordinates; (m, 3, nv)."""
        return np.asarray(self.elements.rotation_dofs[:, None, :] * data.cdof[:, :3].T[None])

    def _friction(self, velocity: Vector) -> None:
        """Friction limits at the present velocity."""
        if self.stribeck:
            weight = np.exp(-(np.abs(velocity / self.stribeck_velocity) ** self.exponent))
            self.limits = self.sliding_limit + (self.static_limit - self.sliding_limit) * weight

    def _advance_branches(self, time: float, rate: Vector) -> None:
        """Carry the Maxwell branches over the step that has just been completed."""
        if time == self.last_time:
            return
        if self.last_time >= 0.0:
            acceleration = (rate - self.last_rate) / self.step
            self.branch_force = self.branch_past + self.branch_slope * acceleration
            self.branch_past = self.decay * self.branch_force + self.branch_gain * rate
        self.last_rate = rate
        self.last_time = time

    def _branches(self, rate: Vector) -> Vector:
        """Known part of the branch forces: f2 + beta (f2(+h) - 2 f2 + f2(-h)) without what the acceleration adds."""
        curvature = (self.decay - 2.0) * self.branch_past + self.branch_gain * rate + self.branch_force
        return np.asarray(self.branch_past + self.branch_average * curvature)

    def actuator_bias(self, model: mujoco.MjModel, data: mujoco.MjData, index: int) -> float:
        """Smooth part of the damper force at the present velocity; installed as `mjcb_act_bias`."""
        return float(-self.viscous[index] * data.actuator_velocity[index])

    @staticmethod
    def actuator_gain(model: mujoco.MjModel, data: mujoco.MjData, index: int) -> float:
        """No control acts on a damper; installed as `mjcb_act_gain`."""
        return 0.0
