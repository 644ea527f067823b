"""Shapes that are in no model and are put into a scene as it is drawn."""

from __future__ import annotations

import mujoco
import numpy as np
import numpy.typing as npt

UPRIGHT = np.eye(3).ravel()


def add_geom(
    scene: mujoco.MjvScene,
    kind: mujoco.mjtGeom,
    size: npt.ArrayLike,
    place: npt.ArrayLike,
    colour: npt.NDArray[np.float32],
    frame: npt.NDArray[np.float64] = UPRIGHT,
) -> mujoco.MjvGeom:
    """Append a shape to a scene that has been updated and must have room.

    Args:
        scene: the scene; changed in place.
        kind: sphere, capsule, box, plane.
        size: half lengths or radii as MuJoCo has them [m], (3,).
        place: its centre [m], (3,).
        colour: red, green, blue, opacity, (4,).
        frame: its axes as the columns of a matrix, (9,).

    Returns:
        The shape in the scene.
    """
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, size, place, frame, colour)
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    scene.ngeom += 1
    return geom
