"""Wheels on the road: the rim turns by -V t / r about y, for a car that drives towards -x; the tyre keeps its flat."""

from __future__ import annotations

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from vehicle.drawing.rendering.motion import Motion, State
from vehicle.model.parameters.composition import PlacedWheel


class RollingWheel:
    """The shapes on a wheel, placed by its hub: the spin of a rolling wheel would turn the flat of the tyre.

    Args:
        motion: motion of the bodies.
        wheel: the wheel.
        hub: name of the part that carries it.
        speed: V [m/s]; 0 where the tyres stand.
    """

    def __init__(self, motion: Motion, wheel: PlacedWheel, hub: str, speed: float) -> None:
        model = motion.model
        self.motion, self.hub = motion, int(model.body(hub).id)
        self.centre = np.array([wheel.center])
        self.rate = -speed / (wheel.center[2] - wheel.patch[2])
        body = int(model.body(wheel.part).id)
        geoms = np.flatnonzero(model.geom_bodyid == body)
        own = motion.orientation[body]
        self.tyre, self.rim = ([int(geom) for geom in geoms if (model.geom(geom).name == wheel.part) is tyre]
                               for tyre in (True, False))  # fmt: skip
        self.arms = motion.position[body] + motion.geom_position @ own.T - self.centre
        self.frames = own @ motion.geom_orientation

    def turn(self, data: mujoco.MjData, state: State, factor: float, time: float) -> None:
        """Place the shapes; a factor exaggerates the motion of the hub, not rolling.

        Args:
            data: changed in place.
            state: motion at the time.
            factor: exaggeration of the poses.
            time: [s].
        """
        (centre,) = self.motion.moved(state, factor, self.hub, self.centre)
        frame = Rotation.from_rotvec(factor * state.rotation[self.hub]).as_matrix()
        spin = frame @ Rotation.from_euler("y", self.rate * time).as_matrix()
        for geoms, turned in ((self.tyre, frame), (self.rim, spin)):
            data.geom_xpos[geoms] = centre + self.arms[geoms] @ turned.T
            data.geom_xmat[geoms] = (turned @ self.frames[geoms]).reshape(-1, 9)
