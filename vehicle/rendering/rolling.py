"""Rims that turn on the road: phi = -V t / r about y for a car that drives towards -x; the tyre keeps its flat."""

from __future__ import annotations

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from vehicle.parameters.composition import PlacedWheel
from vehicle.rendering.motion import Motion, State


class RollingRim:
    """The shapes on a wheel beside its tyre.

    Args:
        motion: motion of the bodies.
        wheel: the wheel.
        speed: V [m/s].
    """

    def __init__(self, motion: Motion, wheel: PlacedWheel, speed: float) -> None:
        model = motion.model
        self.motion, self.body = motion, int(model.body(wheel.part).id)
        self.centre = np.array([wheel.center])
        self.rate = -speed / (wheel.center[2] - wheel.patch[2])
        on_wheel = np.flatnonzero(model.geom_bodyid == self.body)
        self.geoms = [int(geom) for geom in on_wheel if model.geom(geom).name != wheel.part]

    def turn(self, data: mujoco.MjData, state: State, factor: float, time: float) -> None:
        """Turn the shapes that are placed already; a factor exaggerates motion, not rolling.

        Args:
            data: with all shapes placed; changed in place.
            state: motion at the time.
            factor: exaggeration of the poses.
            time: [s].
        """
        (centre,) = self.motion.moved(state, factor, self.body, self.centre)
        frame = Rotation.from_rotvec(factor * state.rotation[self.body]).as_matrix()
        spin = frame @ Rotation.from_euler("y", self.rate * time).as_matrix() @ frame.T
        data.geom_xpos[self.geoms] = centre + (data.geom_xpos[self.geoms] - centre) @ spin.T
        data.geom_xmat[self.geoms] = (spin @ data.geom_xmat[self.geoms].reshape(-1, 3, 3)).reshape(-1, 9)
