"""Motion of a recording about the design position, and its exaggeration.

Every body has a design pose (p0, R0) and, at each stored pose, a displacement u and a rotation vector theta. Shown is

    p = p0 + k u,    R = exp(k [theta]) R0,

and a node of the flexible body at r from its origin, with modal coordinates q,

    x = p + exp(k [theta]) (r + k Phi q).

With k = 1 this is MuJoCo's own kinematics plus the modal displacement.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from vehicle.rendering.recorded_run import wheels_of
from vehicle.simulation.recording import Recording

Vector = npt.NDArray[np.float64]


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
    """Motion of every body over a stretch of a recording, smooth between the stored poses.

    Args:
        model: the model, or one with the same joints.
        recording: what is replayed.
        start, end: stretch [s].

    Attributes:
        time: times of the stored poses of the stretch [s], (f,).
        position, orientation: design pose of every body, (bodies, 3) [m] and (bodies, 3, 3).
        geom_position, geom_orientation: the same for the geoms inside their bodies.
    """

    def __init__(self, model: mujoco.MjModel, recording: Recording, start: float, end: float) -> None:
        self.model = model
        # One pose more on each side keeps the ends of the interpolation out of sight.
        first = max(int(np.searchsorted(recording.pose_time, start, side="right")) - 2, 0)
        last = min(int(np.searchsorted(recording.pose_time, end)) + 2, len(recording.pose_time))
        self.time = recording.pose_time[first:last]
        modal = [joint for joint in range(model.njnt) if model.joint(joint).name.startswith("mode_")]
        columns = [int(model.jnt_qposadr[joint]) for joint in modal]
        self.modes = len(columns)
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)
        self.position = data.xpos.copy()
        self.orientation = data.xmat.reshape(-1, 3, 3).copy()
        self.geom_position = model.geom_pos.copy()
        self.geom_orientation = Rotation.from_quat(model.geom_quat, scalar_first=True).as_matrix()
        plates = {wheel: int(model.body_mocapid[model.body(f"plate_{wheel}").id]) for wheel in wheels_of(recording)}
        rest, rows = data.mocap_pos.copy(), []
        for index in range(first, last):
            data.qpos[:] = recording.poses[index]
            for wheel, plate in plates.items():
                lift = np.interp(recording.pose_time[index], recording.time, recording[f"plate_{wheel}_displacement"])
                data.mocap_pos[plate] = rest[plate] + np.array([0.0, 0.0, lift])
            mujoco.mj_kinematics(model, data)
            turned = data.xmat.reshape(-1, 3, 3) @ self.orientation.transpose(0, 2, 1)
            rotation = Rotation.from_matrix(turned).as_rotvec()
            rows.append(np.concatenate([(data.xpos - self.position).ravel(), rotation.ravel(), data.qpos[columns]]))
        self.curve = CubicSpline(self.time, np.array(rows), axis=0)
        self.integral = self.curve.antiderivative()

    def at(self, time: float, exposure: float = 0.0) -> State:
        """Motion at a time, or its mean over an exposure about that time.

        A film of 30 pictures per second cannot show 28 Hz: sampled, it would look like 2 Hz. As in a camera with an
        open shutter, the mean over the time between two pictures takes that away.

        Args:
            time: [s].
            exposure: [s]; 0 for the instant.

        Returns:
            The motion.
        """
        first, last = float(self.time[0]), float(self.time[-1])
        begin, end = (float(np.clip(time + half * exposure, first, last)) for half in (-0.5, 0.5))
        if end > begin:
            values = (self.integral(end) - self.integral(begin)) / (end - begin)
        else:
            values = self.curve(begin)
        bodies = 3 * self.model.nbody
        return State(
            translation=values[:bodies].reshape(-1, 3),
            rotation=values[bodies : 2 * bodies].reshape(-1, 3),
            modal=values[2 * bodies :],
        )

    def poses(self, state: State, factor: float) -> tuple[Vector, Vector]:
        """Exaggerated poses of all bodies: positions [m], (bodies, 3), and orientations, (bodies, 3, 3)."""
        turned = Rotation.from_rotvec(factor * state.rotation).as_matrix()
        return self.position + factor * state.translation, turned @ self.orientation

    def geoms(self, state: State, factor: float) -> tuple[Vector, Vector]:
        """Exaggerated poses of all geoms: positions [m], (geoms, 3), and orientations, (geoms, 9)."""
        position, orientation = self.poses(state, factor)
        body = self.model.geom_bodyid
        where = position[body] + np.einsum("gij,gj->gi", orientation[body], self.geom_position)
        return where, (orientation[body] @ self.geom_orientation).reshape(-1, 9)

    def moved(self, state: State, factor: float, body: int, points: Vector) -> Vector:
        """Exaggerated places [m] of points that sit at `points` [m] in the design position, both (n, 3)."""
        turned = Rotation.from_rotvec(factor * state.rotation[body]).as_matrix()
        arm = points - self.position[body]
        return np.asarray(self.position[body] + factor * state.translation[body] + arm @ turned.T)
