"""Kinematics and compliance of an axle: fixed body, prescribed wheel travel, all other parts in equilibrium.

The position q of the parts of the axle satisfies

    sum of J_e' f_e(q) + J_g' m g + J_p' (F, M, N) + A' lambda = 0,   c(q) = 0,   z_w(q) = z_w0 + travel

with the forces f_e of bushings, springs and the stabilizer at large displacements (r and angle in the axes of the
carrier, which turn with it), forces F and moments M on the wheels at their contact points, the ideal joints c, and the
vertical loads N that hold the wheel centres at their heights. The contact point of a freely rolling tyre is the lowest
point of its wheel, which stays below the wheel centre; that of a standing tyre is fixed to the wheel, except for the
vertical load of a round tyre.
Newton's method with K = sum of J' K_e J: omitting the geometric stiffness costs iterations, not accuracy. With ideal
connections all connections are joints, and the solution is the minimum-norm motion that satisfies the constraints,
independent of forces.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Indices, Vector
from vehicle.engines.kinematics.axle_parts import Spring, Ties, axle_parts
from vehicle.errors import SimulationError
from vehicle.model.parameters.composition import PlacedWheel

ITERATIONS = 100
"""Maximum number of Newton steps for a position."""
TOLERANCE = 1e-10
"""Maximum step of a coordinate [m or rad] at convergence."""

CONDITION = 1e-12
"""Smallest singular value of the system, as a share of the largest, that counts as resistance or as a constraint."""
CONDITION_SURE = 1e-9
"""Estimated reciprocal condition above which no singular value is near `CONDITION`: the estimate is within 100."""


@dataclass(frozen=True, kw_only=True, slots=True)
class WheelPose:
    """Displacement of a wheel from its design position; left wheels are mirrored.

    Attributes:
        wheel_travel_m: displacement of the wheel centre, upwards [m].
        lateral_m, longitudinal_m: displacement of the wheel centre, outwards and to the rear [m].
        patch_lateral_m, patch_longitudinal_m: displacement of the contact point, which is fixed to the wheel [m].
        camber_deg: camber, top outwards [deg].
        toe_deg: toe, front inwards [deg].
        load_n: vertical load [N]; nan for ideal connections.
        strut_length_m: change of the distance between the seats of the nearest spring [m].
    """

    wheel_travel_m: float
    lateral_m: float
    longitudinal_m: float
    patch_lateral_m: float
    patch_longitudinal_m: float
    camber_deg: float
    toe_deg: float
    load_n: float
    strut_length_m: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AxlePosition:
    """Position of an axle; left wheels are not mirrored.

    Attributes:
        centres: wheel centres [m], (wheels, 3).
        frames: rotation matrices of the wheels, (wheels, 3, 3).
        steering_axes: lower and upper points of the steering axes [m], (wheels, 2, 3); nan for wheels without one.
        springs: lengths of the springs between two points [m], in the order of the parts.
        dampers: positions of the dampers [m], extension positive, in the order of the parts.
        mass_moment: sum of mass times height over the parts of the axle [kg m], ().
    """

    centres: Vector
    frames: Vector
    steering_axes: Vector
    springs: Vector
    dampers: Vector
    mass_moment: Vector


class AxleStatics:
    """Static equilibrium of an axle of a compiled car, over wheel travel and loads."""

    def __init__(
        self,
        model: mujoco.MjModel,
        preload: Vector,
        *,
        wheels: Sequence[PlacedWheel],
        ideal: bool = False,
        standing: bool = False,
        locked: bool = False,
    ) -> None:
        """Find the parts of the axle.

        Args:
            model: the car.
            preload: static forces of the rows; see `StaticTrim`.
            wheels: wheels of the axle.
            ideal: True to replace every connection by an ideal ball joint.
            standing: True for tyres as on plates, with the horizontal force and the torque of the tyres at rest; False
                for freely rolling contact points.
            locked: True to hold every damper at its length in the design position.
        """
        self.model, self.data, self.ideal = model, mujoco.MjData(model), ideal
        self.parts = axle_parts(model, np.asarray(preload), [wheel.part for wheel in wheels], ideal=ideal)
        if locked:
            held = [model.jnt_dofadr[strut.joint] for strut in self.parts.struts]
            self.parts = replace(self.parts, struts=(), columns=np.setdiff1d(self.parts.columns, held))
        self.wheels, self.columns = self.parts.wheels, self.parts.columns
        self.soft, self.hard = self.parts.soft, self.parts.hard
        self.standing = standing
        self.ground = self.parts.standing if standing else np.zeros_like(self.parts.standing)
        mujoco.mj_forward(model, self.data)
        self.at_rest = [(np.array(wheel.center), np.array(wheel.patch)) for wheel in wheels]
        self.offsets = [
            [self._offset(number, point) for point in points]
            for number, points in zip(self.wheels, self.at_rest, strict=True)
        ]
        self.axis_ends = [
            [(model.body(part).id, self._offset(model.body(part).id, at)) for part, at in wheel.steering_axis or ()]
            for wheel in wheels
        ]

    def _offset(self, body: int, point: npt.ArrayLike) -> Vector:
        """Return a point [m] in the frame of a body in the design position."""
        return np.asarray(self.data.xmat[body].reshape(3, 3).T @ (np.asarray(point) - self.data.xpos[body]))

    def position(self) -> AxlePosition:
        """Return the present position, after `solve`."""
        data, model = self.data, self.model
        axes = np.full((len(self.wheels), 2, 3), np.nan)
        for index, ends in enumerate(self.axis_ends):
            for end, (body, offset) in enumerate(ends):
                axes[index, end] = data.xpos[body] + data.xmat[body].reshape(3, 3) @ offset
        bodies = sorted(self.parts.bodies)
        return AxlePosition(
            centres=np.array([self.places(index)[0] for index in range(len(self.wheels))]),
            frames=np.array([data.xmat[wheel].reshape(3, 3) for wheel in self.wheels]),
            steering_axes=axes,
            springs=np.array([self._length(spring)[0] for spring in self.parts.springs]),
            dampers=np.array([data.qpos[model.jnt_qposadr[strut.joint]] for strut in self.parts.struts]),
            mass_moment=np.asarray(model.body_mass[bodies] @ data.xipos[bodies, 2]),
        )

    def solve(self, travel: Sequence[float], loads: Vector | None = None) -> list[WheelPose]:
        """Solve the equilibrium for a travel of each wheel, starting from the last solution.

        Args:
            travel: travel of each wheel [m], upwards.
            loads: force [N] and moment [N m] on each wheel at its contact point, (wheels, 6); none by default.

        Raises:
            SimulationError: the iteration does not converge, or the linkage cannot reach the travel.
        """
        model, data = self.model, self.data
        loads = self.ground if loads is None else self.ground + loads
        count, reactions = self.columns.size, np.zeros(0)
        for _ in range(ITERATIONS):
            force, stiffness = self._forces(loads)
            constraints, reacting, gaps = self._constraints(travel)
            rows = len(gaps)
            # Newton: K dq + B' lambda = f, A dq = -gaps. Joints have A = B; the load acts at the contact, its height
            # is the centre.
            system = np.block([[stiffness, reacting.T], [constraints, np.zeros((rows, rows))]])
            scale = np.ones(count + rows)
            # Equal diagonals: metres and radians differ.
            scale[:count] = 1.0 / np.sqrt(np.maximum(np.diag(stiffness), 1.0))
            solution = _solved(system * scale[:, None] * scale, scale * np.concatenate([force, -gaps]))
            step, reactions = (scale * solution)[:count], (scale * solution)[count:]
            full = np.zeros(model.nv)
            # The linear step is accurate for rotations of up to about 0.2 rad.
            full[self.columns] = step * min(1.0, 0.2 / max(np.max(np.abs(step)), 1e-300))
            mujoco.mj_integratePos(model, data.qpos, full, 1.0)
            if np.max(np.abs(step)) < TOLERANCE:
                break
        else:
            raise SimulationError(
                f"axle: found no equilibrium at wheel travels of {[round(1e3 * value, 3) for value in travel]} "
                "mm; reduce the travel or its steps"
            )
        mujoco.mj_fwdPosition(model, data)
        gaps = self._open(self._gaps(self.hard)[0], travel)
        if np.max(np.abs(gaps)) > 1e-7:
            raise SimulationError(
                f"axle: the linkage cannot reach wheel travels of {[round(1e3 * value, 3) for value in travel]} "
                f"mm (its joints open by {1e3 * np.max(np.abs(gaps)):.3g} mm); use less travel"
                + (", or elastic bushings (without --ideal)" if self.ideal else "")
            )
        # K dq + B' lambda = f: lambda opposes the force, and the load is its negative.
        loads_now = -reactions[-len(self.wheels) :]
        return [self._pose(index, float(load)) for index, load in enumerate(loads_now)]

    def _length(self, spring: Spring) -> tuple[float, Vector]:
        """Return the length of a spring [m] and its derivative by the coordinates, (columns,)."""
        positions, bodies = self.data.site_xpos, self.model.site_bodyid
        line = positions[spring.upper] - positions[spring.lower]
        length = float(np.linalg.norm(line))
        upper, lower = (self.jacobian(int(bodies[site]), positions[site])[0] for site in (spring.upper, spring.lower))
        return length, (line / length) @ (upper - lower)

    def jacobian(self, body: int, point: Vector) -> tuple[Vector, Vector]:
        """Return the Jacobians of displacement and rotation at a point of a body, (3, columns) each."""
        moved, turned = self._jacobians(np.array([body]), point[None])
        return moved[0], turned[0]

    def _jacobians(self, bodies: Indices, points: Vector) -> tuple[Vector, Vector]:
        """Return the Jacobians of displacement and rotation at a point of each body, (k, 3, columns) each."""
        both = np.empty((len(bodies), 2, 3, self.model.nv))
        for (moved, turned), body, point in zip(both, bodies.tolist(), points, strict=True):
            mujoco.mj_jac(self.model, self.data, moved, turned, point, body)
        of_axle = both[..., self.columns]
        return of_axle[:, 0], of_axle[:, 1]

    def _gaps(self, ties: Ties) -> tuple[Vector, Vector, Vector]:
        """Return displacements r [m], (k, 3), axes of the laws and of the carriers as columns, (k, 3, 3) each."""
        # Forces act along the directions of the law, torques about the axes of the carrier.
        moving, carriers = ties.sites.T
        frames = self.data.site_xmat[carriers].reshape(-1, 3, 3)
        axes = frames @ ties.ways
        away = self.data.site_xpos[moving] - self.data.site_xpos[carriers]
        return np.einsum("kij,ki->kj", axes, away), axes, frames

    def _relative(self, ties: Ties) -> tuple[Vector, Vector, Vector, Vector]:
        """Return r [m] and sin(angle) n of the moving parts in axes of the carriers, (k, 3), and their Jacobians."""
        gaps, axes, frames = self._gaps(ties)
        count, points = len(gaps), self.data.site_xpos[ties.sites[:, 0]]
        # The Jacobian of the carrier is that of its point under the moving part.
        # Bodies of the moving sites come first, carriers second: their difference is the relative motion.
        moved, turned = (
            each[:count] - each[count:] for each in self._jacobians(ties.bodies, np.concatenate([points, points]))
        )
        # Into the axes of the carriers.
        back = frames.transpose(0, 2, 1)
        relative = back @ self.data.site_xmat[ties.sites[:, 0]].reshape(-1, 3, 3)
        # sin(angle) n, the law of the runs (`vehicle/core/source/rotations.h`).
        angles = 0.5 * np.stack([relative[:, i, j] - relative[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=1)
        return gaps, angles, axes.transpose(0, 2, 1) @ moved, back @ turned

    def _forces(self, loads: Vector) -> tuple[Vector, Vector]:
        """Return the generalised force and stiffness of the elements at the present position."""
        model, data = self.model, self.data
        mujoco.mj_fwdPosition(model, data)
        count = self.columns.size
        stiffness, force = np.zeros((count, count)), np.zeros(count)
        if self.ideal:
            return force, np.eye(count)
        bodies = np.array(sorted(self.parts.bodies))
        fallen, _ = self._jacobians(bodies, data.xipos[bodies])
        # J_g' m g.
        force += np.einsum("kic,k,i->c", fallen, model.body_mass[bodies], model.opt.gravity)
        gaps, angles, moved, turned = self._relative(self.soft)
        pull, slope = self.soft.pull(gaps)
        twist, size = self.soft.twist, (3 * len(gaps), count)
        # J' f of all bushings: k bushings, i axes, c coordinates.
        force += np.einsum("kic,ki->c", moved, pull)
        force += np.einsum("kic,ki->c", turned, self.soft.torque - twist * angles)
        # J' K J with J of (3 k, coordinates), without geometric stiffness.
        stiffness += (slope[..., None] * moved).reshape(size).T @ moved.reshape(size)
        stiffness += (twist[..., None] * turned).reshape(size).T @ turned.reshape(size)
        for spring in self.parts.springs:
            length, row = self._length(spring)
            along, rate = spring.pull(length - spring.length)
            force += row * along
            stiffness += rate * np.outer(row, row)
        for strut in self.parts.struts:
            column = int(np.flatnonzero(self.columns == model.jnt_dofadr[strut.joint])[0])
            along, rate = strut.pull(float(data.qpos[model.jnt_qposadr[strut.joint]]))
            force[column] += along
            stiffness[column, column] += rate
        for joint in self.parts.joints:
            column = int(np.flatnonzero(self.columns == model.jnt_dofadr[joint])[0])
            rate = float(np.ravel(model.jnt_stiffness[joint])[0])
            position = model.jnt_qposadr[joint]
            force[column] += rate * (model.qpos_spring[position] - data.qpos[position])
            stiffness[column, column] += rate
        for index, (wheel, load) in enumerate(zip(self.wheels, loads, strict=True)):
            if not load.any():
                continue
            moved, turned = self.jacobian(wheel, self.contact(index))
            raised, _ = self.jacobian(wheel, self.vertical_contact(index))
            # Level force at the contact point, vertical force at the vertical contact point, moment on the wheel.
            force += moved[:2].T @ load[:2] + raised[2] * load[2] + turned.T @ load[3:]
        return force, stiffness

    def _constraints(self, travel: Sequence[float]) -> tuple[Vector, Vector, Vector]:
        """Return Jacobian, reaction directions and gaps of the ideal joints, then of the wheel heights.

        The height is that of the wheel centre, its reaction the load on the contact point.
        """
        gaps, _, moved, _ = self._relative(self.hard)
        rows, reacting = [moved.reshape(-1, self.columns.size)], [moved.reshape(-1, self.columns.size)]
        for index, wheel in enumerate(self.wheels):
            rows.append(self.jacobian(wheel, self.places(index)[0])[0][2:])
            reacting.append(self.jacobian(wheel, self.vertical_contact(index))[0][2:])
        return np.vstack(rows), np.vstack(reacting), self._open(gaps, travel)

    def _open(self, gaps: Vector, travel: Sequence[float]) -> Vector:
        """Return the gaps of the ideal joints, then of the wheel heights [m]."""
        raised = [self.places(index)[0][2] - begin[0][2] for index, begin in enumerate(self.at_rest)]
        return np.concatenate([gaps.ravel(), np.array(raised) - travel])

    def contact(self, index: int) -> Vector:
        """Return the point at which the horizontal force of the ground acts on a wheel, vehicle axes [m]; (3,).

        Tyres at rest: the contact patch, fixed to the wheel. Rolling tyres: the lowest point of the wheel.
        """
        return self.places(index)[1] if self.standing else self.lowest_point(index)

    def vertical_contact(self, index: int) -> Vector:
        """Return the point at which the vertical force of the ground acts on a wheel, vehicle axes [m]; (3,).

        Tyres at rest that are not round: the contact patch, fixed to the wheel. Others: the lowest point of the wheel.
        """
        fixed = self.standing and self.wheels[index] not in self.parts.round
        return self.places(index)[1] if fixed else self.lowest_point(index)

    def lowest_point(self, index: int) -> Vector:
        """Return the lowest point of a wheel [m], (3,): a thin disc with its axis along y in the design position."""
        center, _ = self.places(index)
        center_at_rest, patch = self.at_rest[index]
        spin = self.data.xmat[self.wheels[index]].reshape(3, 3)[:, 1]
        # The downward vertical without its part along the axle, a vector in the plane of the wheel.
        down = spin[2] * spin - np.array([0.0, 0.0, 1.0])
        beside = (patch - center_at_rest) * [1.0, 1.0, 0.0]
        return np.asarray(center + beside + (center_at_rest[2] - patch[2]) * down / np.linalg.norm(down))

    def places(self, index: int) -> tuple[Vector, Vector]:
        """Return the present positions of the centre of a wheel and of its patch, which is fixed to the wheel [m]."""
        position, frame = self.data.xpos[self.wheels[index]], self.data.xmat[self.wheels[index]].reshape(3, 3)
        center, patch = (position + frame @ offset for offset in self.offsets[index])
        return center, patch

    def _pose(self, index: int, load: float) -> WheelPose:
        """Return the pose of a wheel."""
        center, patch = (now - then for now, then in zip(self.places(index), self.at_rest[index], strict=True))
        side = float(np.sign(self.at_rest[index][0][1]))
        # Outwards; along y in the design position.
        axle = side * self.data.xmat[self.wheels[index]].reshape(3, 3)[:, 1]
        hub, seats = self.data.xpos[self.wheels[index]], self.data.site_xpos
        nearest = min(self.parts.springs, key=lambda spring: np.linalg.norm(seats[spring.lower] - hub), default=None)
        return WheelPose(
            wheel_travel_m=float(center[2]),
            lateral_m=float(side * center[1]),
            longitudinal_m=float(center[0]),
            patch_lateral_m=float(side * patch[1]),
            patch_longitudinal_m=float(patch[0]),
            camber_deg=float(np.degrees(np.arcsin(-axle[2]))),
            # The outer end of the axle goes down with the top outwards, and forwards with the front inwards.
            toe_deg=float(np.degrees(np.arctan2(-axle[0], side * axle[1]))),
            load_n=float("nan") if self.ideal else load,
            strut_length_m=float("nan") if nearest is None else self._length(nearest)[0] - nearest.length,
        )


def _solved(system: Vector, right: Vector) -> Vector:
    """Return the solution of a linear system, of a singular one that with the smallest norm."""
    # LU, unless it is near to singular: then the solution with the smallest norm.
    factors, pivots, singular = scipy.linalg.lapack.dgetrf(system)
    near, _ = scipy.linalg.lapack.dgecon(factors, np.abs(system).sum(axis=0).max())
    if singular or not near > CONDITION_SURE:
        return np.asarray(np.linalg.lstsq(system, right, rcond=CONDITION)[0])
    return np.asarray(scipy.linalg.lapack.dgetrs(factors, pivots, right)[0])
