"""Rolling wheels: the rim rotates by -V t / r about y for a car that drives towards -x; the tyre keeps its flat."""

import mujoco
import numpy as np
import scipy

from vehicle.drawing.rendering.motion import Motion, State
from vehicle.model.parameters.composition import PlacedWheel


class RollingWheel:
    """Shapes of a wheel, positioned by its hub, because the spin of the wheel would rotate the flat of the tyre.

    Args:
        speed: V [m/s]; 0 for standing tyres.
    """

    def __init__(self, motion: Motion, wheel: PlacedWheel, hub: str, speed: float) -> None:
        model = motion.model
        self.motion, self.hub = motion, int(model.body(hub).id)
        self.centre = np.array([wheel.center])
        self.rate = -speed / (wheel.center[2] - wheel.patch[2])
        body = int(model.body(wheel.part).id)
        geoms = np.flatnonzero(model.geom_bodyid == body)
        orientation = motion.orientation[body]
        self.tyre, self.rim = ([int(geom) for geom in geoms if (model.geom(geom).name == wheel.part) is tyre]
                               for tyre in (True, False))  # fmt: skip
        # Position of each shape from the wheel centre, in the axes of the car.
        self.arms = motion.position[body] + motion.geom_position @ orientation.T - self.centre
        self.frames = orientation @ motion.geom_orientation

    def turn(self, data: mujoco.MjData, state: State, factor: float, time: float) -> None:
        """Set the poses of the shapes; the factor exaggerates the motion of the hub, not the rolling."""
        (centre,) = self.motion.moved(state, factor, self.hub, self.centre)
        turn = scipy.spatial.transform.Rotation
        frame = turn.from_rotvec(factor * state.rotation[self.hub]).as_matrix()
        # The rim spins in the axes of the hub; the tyre follows the hub alone.
        spin = frame @ turn.from_euler("y", self.rate * time).as_matrix()
        for geoms, rotation in ((self.tyre, frame), (self.rim, spin)):
            data.geom_xpos[geoms] = centre + self.arms[geoms] @ rotation.T
            data.geom_xmat[geoms] = (rotation @ self.frames[geoms]).reshape(-1, 9)
