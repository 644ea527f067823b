"""The flexible body as a deforming wireframe: nodes and members, coloured by how far each node moves."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from vehicle.rendering.exaggeration import Motion, State
from vehicle.simulation.car_model import CarModel

Vector = npt.NDArray[np.float64]

NODE_RADIUS = 0.020
MEMBER_RADIUS = 0.0085
SHADOW_RADIUS = 0.005
"""Drawn sizes [m]."""

SHADOW_COLOUR = np.array([0.35, 0.38, 0.42, 0.8], dtype=np.float32)
"""Colour of the members in the design position, against which the motion is seen."""


class Wireframe:
    """Nodes and members of the superelement.

    Args:
        car: the car.
        motion: its motion.
    """

    def __init__(self, car: CarModel, motion: Motion) -> None:
        element = car.superelement
        self.motion = motion
        self.body = int(motion.model.body("body").id)
        self.rest = np.asarray(element.positions)
        self.edges = np.asarray(element.edges, dtype=int)
        self.arm = self.rest - motion.position[self.body]
        modes = motion.modes
        self.shapes = np.asarray(element.shapes)[:modes]  # (modes, n, 3); none where the body is rigid

    def places(self, state: State, factor: float) -> Vector:
        """Exaggerated positions of the nodes [m], (n, 3)."""
        elastic = np.einsum("m,mni->ni", state.modal, self.shapes)
        turned = Rotation.from_rotvec(factor * state.rotation[self.body]).as_matrix()
        origin = self.motion.position[self.body] + factor * state.translation[self.body]
        return np.asarray(origin + (self.arm + factor * elastic) @ turned.T)

    def displacement(self, state: State) -> Vector:
        """True distance of each node from its design position [m], (n,)."""
        return np.asarray(np.linalg.norm(self.places(state, 1.0) - self.rest, axis=1))

    def draw(self, scene: mujoco.MjvScene, places: Vector, colours: npt.NDArray[np.float32]) -> None:
        """Append spheres and capsules to a scene.

        Args:
            scene: scene that has been updated; must have room.
            places: node positions [m], (n, 3).
            colours: red, green, blue, opacity of the nodes, (n, 4); a member takes the mean of its ends.
        """
        kind = mujoco.mjtGeom
        for place, colour in zip(places, colours, strict=True):
            _append(scene, kind.mjGEOM_SPHERE, np.full(3, NODE_RADIUS), place, colour)
        middle = 0.5 * (colours[self.edges[:, 0]] + colours[self.edges[:, 1]])
        for (first, second), colour in zip(self.edges, middle, strict=True):
            _connect(scene, MEMBER_RADIUS, places[first], places[second], colour)
        for first, second in self.edges:
            _connect(scene, SHADOW_RADIUS, self.rest[first], self.rest[second], SHADOW_COLOUR)


def _connect(
    scene: mujoco.MjvScene, radius: float, first: Vector, second: Vector, colour: npt.NDArray[np.float32]
) -> None:
    kind = mujoco.mjtGeom.mjGEOM_CAPSULE
    mujoco.mjv_connector(_append(scene, kind, np.full(3, radius), first, colour), kind, radius, first, second)


def _append(
    scene: mujoco.MjvScene, kind: mujoco.mjtGeom, size: Vector, place: Vector, colour: npt.NDArray[np.float32]
) -> mujoco.MjvGeom:
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, size, place, np.eye(3).ravel(), colour)
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    geom.emission = 0.35
    geom.specular = 0.1
    scene.ngeom += 1
    return geom
