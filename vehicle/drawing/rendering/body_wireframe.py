"""Wireframe of the body: a point at r from its origin, with modal coordinates q, is shown at

    x = p + exp(k [theta]) (r + k Phi q),

with the exaggerated position p and the rotation theta of the body from `motion`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.added_geom import add_geom
from vehicle.drawing.rendering.body_outline import drawn_body
from vehicle.drawing.rendering.motion import Motion, State
from vehicle.signals.analysis.samples import Vector

if TYPE_CHECKING:  # processes that draw a film need no compiler of models
    from vehicle.engines.simulation.car_model import CarModel

NODE_RADIUS = 0.020
MEMBER_RADIUS = 0.0085
"""Drawn sizes [m] of a frame of beams."""

FRAME_LINES = 200
"""Maximum number of lines of a body drawn as a frame of beams; thick members would hide a dense mesh."""

EMISSION = 0.35
"""Emission of the members: share of their colour without light."""


def thickness(lines: int) -> float:
    """Return the factor on the thickness of a number of lines."""
    return min(1.0, float(np.cbrt(FRAME_LINES / max(lines, 1))))


class Wireframe:
    """Points and lines of the body, coloured by displacement."""

    def __init__(self, car: CarModel, motion: Motion) -> None:
        drawn = drawn_body(car)
        self.motion = motion
        self.body = int(motion.model.body("body").id)
        self.rest, self.edges, self.slim = drawn.points, drawn.lines, thickness(len(drawn.lines))
        self.shapes = drawn.shapes[: len(motion.modal)]  # (modes, n, 3); no mode for a rigid body

    def positions(self, state: State, factor: float) -> Vector:
        """Return exaggerated positions of the nodes [m], (n, 3)."""
        elastic = np.einsum("m,mni->ni", state.modal, self.shapes)
        return self.motion.moved(state, factor, self.body, self.rest + factor * elastic)

    def displacement(self, state: State) -> Vector:
        """Return the true distance of each node from its design position [m], (n,)."""
        return np.asarray(np.linalg.norm(self.positions(state, 1.0) - self.rest, axis=1))

    def draw(self, scene: mujoco.MjvScene, positions: Vector, colours: npt.NDArray[np.float32]) -> None:
        """Append spheres and capsules to a scene.

        Args:
            positions: node positions [m], (n, 3).
            colours: red, green, blue, opacity of the nodes, (n, 4); a member takes the mean of its ends.
        """
        for position, colour in zip(positions, colours, strict=True):
            _glowing(scene, mujoco.mjtGeom.mjGEOM_SPHERE, self.slim * NODE_RADIUS, position, colour)
        middle = 0.5 * (colours[self.edges[:, 0]] + colours[self.edges[:, 1]])
        radius = self.slim * MEMBER_RADIUS
        for (first, second), colour in zip(self.edges, middle, strict=True):
            capsule = _glowing(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, positions[first], colour)
            mujoco.mjv_connector(capsule, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, positions[first], positions[second])


def _glowing(
    scene: mujoco.MjvScene, geom_type: mujoco.mjtGeom, radius: float, position: Vector, colour: npt.NDArray[np.float32]
) -> mujoco.MjvGeom:
    geom = add_geom(scene, geom_type, np.full(3, radius), position, colour)
    geom.emission, geom.specular = EMISSION, 0.1
    return geom
