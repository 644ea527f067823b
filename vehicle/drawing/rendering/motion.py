"""Motion about the design position, exaggerated; coil of a spring.

Every body has a design pose (p0, R0) and, in a state of motion, a displacement u and a rotation vector theta. Shown is

    p = p0 + k u,    R = exp(k [theta]) R0.

With k = 1 this is MuJoCo's own kinematics.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
import scipy

from vehicle.drawing.rendering.recorded_run import wheels_of
from vehicle.engines.simulation.recording import Recording
from vehicle.model.parameters.composition import Composition, PlacedSpring
from vehicle.signals.analysis.samples import Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class State:
    """Motion at one instant.

    Attributes:
        translation: displacement of each body's origin from the design position [m], (bodies, 3).
        rotation: rotation vector of each body from the design position [rad], (bodies, 3).
        modal: modal coordinates of the flexible body [kg^1/2 m], (modes,).
    """

    translation: Vector
    rotation: Vector
    modal: Vector


class Motion:
    """Positions and orientations of bodies, geoms and points in a state of motion.

    Args:
        model: the model, or a model with the same joints.

    Attributes:
        modal: indices of the joints that are modal coordinates of the flexible body.
        position, orientation: design pose of every body, (bodies, 3) [m] and (bodies, 3, 3).
        geom_position, geom_orientation: the same for the geoms inside their bodies.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.modal = [joint for joint in range(model.njnt) if model.joint(joint).name.startswith("mode_")]
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.position = data.xpos.copy()
        self.orientation = data.xmat.reshape(-1, 3, 3).copy()
        self.geom_position = model.geom_pos.copy()
        self.geom_orientation = scipy.spatial.transform.Rotation.from_quat(
            model.geom_quat, scalar_first=True
        ).as_matrix()

    def poses(self, state: State, factor: float) -> tuple[Vector, Vector]:
        """Return exaggerated poses of all bodies: positions [m], (bodies, 3), and orientations, (bodies, 3, 3)."""
        rotation_matrix = scipy.spatial.transform.Rotation.from_rotvec(factor * state.rotation).as_matrix()
        return self.position + factor * state.translation, rotation_matrix @ self.orientation

    def geoms(self, state: State, factor: float) -> tuple[Vector, Vector]:
        """Return exaggerated poses of all geoms: positions [m], (geoms, 3), and orientations, (geoms, 9)."""
        position, orientation = self.poses(state, factor)
        body = self.model.geom_bodyid
        # p = p_body + R_body p_local of each geom.
        geom_position = position[body] + np.einsum("gij,gj->gi", orientation[body], self.geom_position)
        return geom_position, (orientation[body] @ self.geom_orientation).reshape(-1, 9)

    def moved(self, state: State, factor: float, body: int, points: Vector) -> Vector:
        """Return exaggerated positions [m] of points of a body, given in the design position [m], both (n, 3)."""
        rotation_matrix = scipy.spatial.transform.Rotation.from_rotvec(factor * state.rotation[body]).as_matrix()
        arm = points - self.position[body]
        return np.asarray(self.position[body] + factor * state.translation[body] + arm @ rotation_matrix.T)


class RecordedMotion(Motion):
    """Motion of every body in a time window of a recording, interpolated between the stored poses.

    Args:
        model: the model, or a model with the same joints.
        start, end: time window [s].

    Attributes:
        time: times of the stored poses in the window [s], (f,).
    """

    def __init__(self, model: mujoco.MjModel, recording: Recording, start: float, end: float) -> None:
        super().__init__(model)
        # One more pose on each side keeps the ends of the spline outside the window.
        first = max(int(np.searchsorted(recording.pose_time, start, side="right")) - 2, 0)
        last = min(int(np.searchsorted(recording.pose_time, end)) + 2, len(recording.pose_time))
        self.time = recording.pose_time[first:last]
        columns = model.jnt_qposadr[self.modal]
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        plates = {wheel: int(model.body_mocapid[model.body(f"plate_{wheel}").id]) for wheel in wheels_of(recording)}
        design_plates, rows = data.mocap_pos.copy(), []
        for index in range(first, last):
            data.qpos[:] = recording.poses[index]
            for wheel, plate in plates.items():
                lift = np.interp(recording.pose_time[index], recording.time, recording[f"plate_{wheel}_displacement"])
                data.mocap_pos[plate] = design_plates[plate] + np.array([0.0, 0.0, lift])
            mujoco.mj_kinematics(model, data)
            # R R0' is the rotation from the design pose.
            rotation_matrix = data.xmat.reshape(-1, 3, 3) @ self.orientation.transpose(0, 2, 1)
            rotation = scipy.spatial.transform.Rotation.from_matrix(rotation_matrix).as_rotvec()
            rows.append(np.concatenate([(data.xpos - self.position).ravel(), rotation.ravel(), data.qpos[columns]]))
        self.curve = scipy.interpolate.CubicSpline(self.time, np.array(rows), axis=0)
        self.integral = self.curve.antiderivative()

    def at(self, time: float, exposure: float = 0.0) -> State:
        """Return the motion at a time, or its mean over an exposure about that time.

        A film with 30 frames per second cannot show 28 Hz: aliasing would make it 2 Hz. As in a camera with an open
        shutter, the mean over the time between two frames removes the alias.

        Args:
            time: time [s].
            exposure: exposure time [s]; 0 for the instant.
        """
        first, last = float(self.time[0]), float(self.time[-1])
        begin, end = (float(np.clip(time + half * exposure, first, last)) for half in (-0.5, 0.5))
        if end > begin:
            # Mean of the spline by its antiderivative, exact.
            values = (self.integral(end) - self.integral(begin)) / (end - begin)
        else:
            values = self.curve(begin)
        bodies = 3 * self.model.nbody
        return State(
            translation=values[:bodies].reshape(-1, 3),
            rotation=values[bodies : 2 * bodies].reshape(-1, 3),
            modal=values[2 * bodies :],
        )


def coil_seats(composition: Composition, spring: PlacedSpring) -> list[str]:
    """Return the bodies of the lower and the upper seat: parts drawn at its ends, else the parts of the spring."""
    drawn = [part for part in composition.parts if part.shape != "none"]
    return [
        next((part.name for part in drawn if end in part.points.values()), body)
        for body, end in zip(spring.parts, spring.at, strict=True)
    ]


class Coil:
    """Deforming mesh of a coil spring between its two seats.

    A vertex at the relative height s moves by (1 - s) times the motion of the lower seat plus s times that of the upper
    seat.
    """

    def __init__(self, motion: Motion, composition: Composition, spring: PlacedSpring) -> None:
        model = motion.model
        self.motion = motion
        self.lower, self.upper = (int(model.body(seat).id) for seat in coil_seats(composition, spring))
        self.geom = int(model.geom(spring.name).id)
        self.mesh = int(model.geom_dataid[self.geom])
        first = int(model.mesh_vertadr[self.mesh])
        self.rows = slice(first, first + int(model.mesh_vertnum[self.mesh]))
        body = int(model.geom_bodyid[self.geom])
        self.origin = motion.position[body] + motion.orientation[body] @ motion.geom_position[self.geom]
        self.frame = motion.orientation[body] @ motion.geom_orientation[self.geom]
        self.rest = model.mesh_vert[self.rows] @ self.frame.T + self.origin
        axis = np.subtract(spring.at[1], spring.at[0])
        height = self.rest @ (axis / np.linalg.norm(axis))
        # s of each vertex, along the axis of the spring.
        self.share = ((height - height.min()) / np.ptp(height))[:, None]

    def positions(self, state: State, factor: float) -> Vector:
        """Return the exaggerated positions of the vertices [m], (n, 3)."""
        low, high = (self.motion.moved(state, factor, seat, self.rest) for seat in (self.lower, self.upper))
        return np.asarray((1.0 - self.share) * low + self.share * high)

    def write(self, data: mujoco.MjData, positions: Vector) -> None:
        """Write the vertices to the model and reset the geom to its design pose; OpenGL must then reload the mesh."""
        # The renderer adds pose of the geom to its vertices: take the design pose out.
        self.motion.model.mesh_vert[self.rows] = (positions - self.origin) @ self.frame
        data.geom_xpos[self.geom] = self.origin
        data.geom_xmat[self.geom] = self.frame.ravel()
