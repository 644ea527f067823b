"""Equations of motion of a car at any position, velocity and acceleration, beyond their linear part.

R(u, u', u'', f_b, l, z, z') = 0 in MuJoCo's velocity coordinates as small displacements u, with rotations as rotation
vectors, forces f_b of the Maxwell branches and l of the ideal joints. MuJoCo supplies kinematics and inertia, the
core the laws; neither its solver nor its integrator takes part.
"""

import copy

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.displacement_laws import BUSHING, SPRING
from vehicle.engines.linear.first_order import free_basis
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.element_records import RubberFriction
from vehicle.engines.simulation.row_layout import numeric, places_of
from vehicle.engines.simulation.rows import Rows

SHORT = 1e-7
"""Time step of the laws [s], so short that all forces of the rows are explicit."""


class Equations:
    """Equations of motion of a car, evaluated in MuJoCo at any position, velocity and acceleration."""

    def __init__(self, car: CarModel, matrices: CarMatrices) -> None:
        self.model, self.basis, self.slope = copy.copy(car.model), free_basis(matrices.system), matrices.slope
        # D J a of the rows vanishes with the step: f = f0.
        self.model.opt.timestep = SHORT
        self.rows = Rows(self.model, car.static.preload)
        # What laws over displacement and lifting tyres exceed their tangents by are forces of the linear motion, which
        # act along the displaced elements like preloads; those on a coordinate of their own have no second order.
        layout = self.rows.layout
        # Without tables, lift-off and rubber friction every law is its tangent.
        tables = layout.tables._replace(kinds=layout.tables.kinds[:0])
        bushings = layout.bushings._replace(one_sided=layout.bushings.one_sided[:0])
        rubber = layout.rubber
        rubber = RubberFriction(rubber.elements[:0], rubber.axes[:0], rubber.stiffness[:0], rubber.limit[:0])
        self.rows.layout = layout._replace(tables=tables, bushings=bushings, rubber=rubber)
        self.preload = self.rows.weights.preload.copy()
        self.rows.weights = self.rows.weights._replace(preload=self.preload.copy())
        elements = [law.element for law in matrices.laws]
        self.laws = np.array([k for k, (kind, _, _) in enumerate(elements) if kind in (BUSHING, SPRING)], dtype=int)
        self.law_rows = np.array(
            [
                layout.springs.rows[index] if kind == SPRING else bushings.rows[index, axis]
                for kind, index, axis in (elements[k] for k in self.laws)
            ],
            dtype=int,
        )
        # Elements of the laws, whose displacement is that of their own coordinate where it is neither of both.
        self.bushings, self.springs = (
            np.array([[k, index, axis] for k, (kind, index, axis) in enumerate(elements) if kind == wanted], dtype=int)
            .reshape(-1, 3)
            .T
            for wanted in (BUSHING, SPRING)
        )
        self.strained = len(elements)
        self.data = mujoco.MjData(self.model)
        model, layout = self.model, self.rows.layout
        self.start, self.level = self.data.qpos.copy(), self.data.mocap_pos[:, 2].copy()
        self.joints, self.present = layout.joints.ravel(), layout.bushings.branch_stiffness > 0.0
        # First of the three rotations of each free or ball joint.
        kinds = {mujoco.mjtJoint.mjJNT_FREE: 3, mujoco.mjtJoint.mjJNT_BALL: 0}
        first = [int(model.jnt_dofadr[k]) + kinds[t] for k, t in enumerate(model.jnt_type.tolist()) if t in kinds]
        self.turning = np.array(first)[:, None] + np.arange(3)
        points = places_of(model)
        self.sites = np.array([model.site(f"place/{point}").id for point in points])
        shapes = [numeric(model, f"shape/place/{point}") for point in points]
        self.flexible = [k for k, shape in enumerate(shapes) if shape is not None]
        self.shapes = np.array([np.reshape(shape, (3, -1)) for shape in shapes if shape is not None])

    def at(self, motions: tuple[Vector, ...]) -> Vector:
        """Return forces, gaps, branch rates, positions, tyre deflections, displacements of laws; (rows, motions).

        Args:
            motions: u, u', u'', f_b, z, z', V tan(beta), forces of laws, l; (..., motions) each.
        """
        u, v, a, branch, height, rate, slope, laws, joints = (part.T.copy() for part in motions)
        x, y, z = (u[:, self.turning[:, axis]] for axis in range(3))
        for vector in (v, a):
            # Angular velocity of the rotation exp(theta) in axes of the body: theta' - theta x theta'/2 + ...
            p, q, r = (vector[:, self.turning[:, axis]] for axis in range(3))
            vector[:, self.turning] -= 0.5 * np.stack([y * r - z * q, z * p - x * r, x * q - y * p], axis=2)
        model, data, state, size = self.model, self.data, self.rows.state, len(u)
        position, level = np.tile(self.start, (size, 1)), self.level + height
        # From lists of existing branches and joints to arrays over all elements and rows.
        branches = np.zeros((size, *self.present.shape))
        branches[:, self.present] = branch
        pulls = np.zeros((size, self.rows.layout.row_count))
        pulls[:, self.joints] = joints
        force, pull = np.zeros((2, size, model.nv))
        gaps, points = np.zeros((size, len(self.joints))), np.zeros((size, *data.site_xpos.shape))
        rates, turns = np.zeros((size, *state.rate.shape)), np.zeros((size, *data.xmat.shape))
        deflections, headings = np.zeros((size, len(level[0]))), np.zeros((size, *state.heading[0].shape))
        strains, ends = np.zeros((size, self.strained)), np.zeros((size, *state.ends.shape))
        changes, rolling = np.zeros(slope.shape), self.rows.layout.rolling
        static = self.preload[self.rows.layout.bushings.rows[rolling.tyres, 2]]
        preload, preloads = self.rows.weights.preload, np.tile(self.preload, (size, 1))
        # Forces g of laws act along their elements like preloads, with the opposite sign.
        np.subtract.at(preloads.T, self.law_rows, laws.T[self.laws])
        # Views of MuJoCo's arrays: creating one takes as long as filling it.
        qpos, qvel, mocap, sites, matrices = data.qpos, data.qvel, data.mocap_pos, data.site_xpos, data.xmat
        spatial = data.cvel
        passive, bias, applied, tyres = data.qfrc_passive, data.qfrc_bias, data.qfrc_applied, self.rows.layout.tyres
        data.time = 0.0
        for k in range(size):
            # Position at u from the design position, rotations by their vectors.
            mujoco.mj_integratePos(model, position[k], u[k], 1.0)
            qpos[:], qvel[:], mocap[:, 2] = position[k], v[k], level[k]
            # -1: no step before this, so that no branch or friction element advances.
            state.plate_velocity[:, 2], state.last_time[0] = rate[k], -1.0
            state.branch_past[:] = state.branch_force[:] = branches[k]
            state.slope_velocity[:], preload[:] = slope[k], preloads[k]
            mujoco.mj_fwdPosition(model, data)
            mujoco.mj_fwdVelocity(model, data)
            # Gyroscopic moments take the angular velocity of the last time, too.
            state.turning[:, :3] = spatial[rolling.hubs, :3]
            self.rows(model, data)
            gaps[k] = data.efc_pos[self.joints]
            # R = M u'' + bias - passive - applied - J' l.
            mujoco.mj_mulJacTVec(model, data, pull[k], pulls[k])
            mujoco.mj_mulM(model, data, force[k], a[k])
            force[k] += bias
            force[k] -= passive
            force[k] -= applied
            rates[k], headings[k], deflections[k] = state.rate, state.heading[0], state.residual[tyres, 2]
            strains[k, self.bushings[0]], ends[k] = state.residual[self.bushings[1], self.bushings[2]], state.ends
            points[k], turns[k] = sites, matrices
            changes[k, rolling.plates] = state.force[rolling.tyres, 2] / static - 1.0
        modes = self.rows.layout.modes
        # At t = 0 the laws leave out the heading of rolling wheels.
        rates[:, rolling.tyres, 1] += rolling.speeds * headings
        points = points[:, self.sites]
        if self.flexible:
            turn = turns[:, modes.body].reshape(size, 1, 3, 3)
            # x + R Phi q at points of the flexible body.
            points[:, self.flexible] += (
                turn @ (self.shapes @ position[:, modes.positions].T).transpose(2, 0, 1)[..., None]
            )[..., 0]
        if self.slope.size:
            # Takes the change of the loads on slopes out of R again: the linear motion contains it.
            force += (changes * slope) @ self.slope.T
        force = (force - pull) @ self.basis
        # The displacement of a spring is the distance of its ends; lower and upper ends alternate.
        strains[:, self.springs[0]] = np.linalg.norm(ends[:, 1::2] - ends[:, ::2], axis=2)[:, self.springs[1]]
        return np.hstack([force, gaps, rates[:, self.present], points.reshape(size, -1), deflections, strains]).T
