"""What deforms in the film: the flexible body as a wireframe, and the coil of a main spring."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

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
    """Nodes and members of the superelement, coloured by how far each node moves.

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
        self.shapes = np.asarray(element.shapes)[: motion.modes]  # (modes, n, 3); none where the body is rigid

    def places(self, state: State, factor: float) -> Vector:
        """Exaggerated positions of the nodes [m], (n, 3)."""
        elastic = np.einsum("m,mni->ni", state.modal, self.shapes)
        return self.motion.moved(state, factor, self.body, self.rest + factor * elastic)

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
        for place, colour in zip(places, colours, strict=True):
            _append(scene, mujoco.mjtGeom.mjGEOM_SPHERE, NODE_RADIUS, place, colour)
        middle = 0.5 * (colours[self.edges[:, 0]] + colours[self.edges[:, 1]])
        shadow = np.broadcast_to(SHADOW_COLOUR, middle.shape)
        for radius, at, shades in ((MEMBER_RADIUS, places, middle), (SHADOW_RADIUS, self.rest, shadow)):
            for (first, second), colour in zip(self.edges, shades, strict=True):
                capsule = _append(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, at[first], colour)
                mujoco.mjv_connector(capsule, mujoco.mjtGeom.mjGEOM_CAPSULE, radius, at[first], at[second])


def _append(
    scene: mujoco.MjvScene, kind: mujoco.mjtGeom, radius: float, place: Vector, colour: npt.NDArray[np.float32]
) -> mujoco.MjvGeom:
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, np.full(3, radius), place, np.eye(3).ravel(), colour)
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    geom.emission = 0.35
    geom.specular = 0.1
    scene.ngeom += 1
    return geom


class Coil:
    """Coil between the lower seat on the damper tube and the upper seat on the damper rod.

    A vertex at the share s of the way up moves by (1 - s) times what the lower seat would move it, and s times what
    the upper one would.

    Args:
        motion: motion of the bodies.
        wheel: its wheel.
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
        low, high = (self.motion.moved(state, factor, seat, self.rest) for seat in (self.lower, self.upper))
        return np.asarray((1.0 - self.share) * low + self.share * high)

    def write(self, data: mujoco.MjData, places: Vector) -> None:
        """Put the vertices into the model and the geom back to its design pose; OpenGL needs the mesh again."""
        self.motion.model.mesh_vert[self.rows] = (places - self.origin) @ self.frame
        data.geom_xpos[self.geom] = self.origin
        data.geom_xmat[self.geom] = self.frame.ravel()
