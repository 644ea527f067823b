"""The main spring in the film: its coil follows both seats, though each of them moves as a rigid part."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.rendering.exaggeration import Motion, State

Vector = npt.NDArray[np.float64]


class Coil:
    """Coil between the lower seat on the damper tube and the upper seat on the damper rod.

    A vertex at the share s of the way up moves by (1 - s) times what the lower seat would move it, and s times what
    the upper one would.

    Args:
        motion: motion of the bodies.
        wheel: its side.
    """

    def __init__(self, motion: Motion, wheel: str) -> None:
        model = motion.model
        self.motion = motion
        self.lower, self.upper = (int(model.body(f"{part}_{wheel}").id) for part in ("damper_bottom", "damper_top"))
        self.geom = int(model.geom(f"main_spring_{wheel}").id)
        self.mesh = int(model.geom_dataid[self.geom])
        first = int(model.mesh_vertadr[self.mesh])
        self.rows = slice(first, first + int(model.mesh_vertnum[self.mesh]))
        body = int(model.geom_bodyid[self.geom])
        self.origin = motion.position[body] + motion.orientation[body] @ motion.geom_position[self.geom]
        self.frame = motion.orientation[body] @ motion.geom_orientation[self.geom]
        self.rest = model.mesh_vert[self.rows] @ self.frame.T + self.origin
        axis = motion.position[self.upper] - motion.position[self.lower]
        height = self.rest @ (axis / np.linalg.norm(axis))
        self.share = ((height - height.min()) / np.ptp(height))[:, None]

    def places(self, state: State, factor: float) -> Vector:
        """Exaggerated places of the vertices [m], (n, 3)."""
        low = self.motion.moved(state, factor, self.lower, self.rest)
        high = self.motion.moved(state, factor, self.upper, self.rest)
        return np.asarray((1.0 - self.share) * low + self.share * high)

    def write(self, data: mujoco.MjData, places: Vector) -> None:
        """Put the vertices into the model and the geom back to its design pose; OpenGL needs the mesh again."""
        self.motion.model.mesh_vert[self.rows] = (places - self.origin) @ self.frame
        data.geom_xpos[self.geom] = self.origin
        data.geom_xmat[self.geom] = self.frame.ravel()
