"""Shapes that are not in the model and are appended to a scene during drawing."""

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.samples import Vector

UPRIGHT = np.eye(3).ravel()


def add_geom(
    scene: mujoco.MjvScene,
    geom_type: mujoco.mjtGeom,
    size: npt.ArrayLike,
    position: npt.ArrayLike,
    colour: npt.NDArray[np.float32],
    frame: Vector = UPRIGHT,
) -> mujoco.MjvGeom:
    """Append a shape to an updated scene, which must have space for it, and return it.

    Args:
        size: half lengths or radii in the convention of MuJoCo [m], (3,).
        position: centre of the shape [m], (3,).
        colour: red, green, blue, opacity, (4,).
        frame: axes of the shape as the columns of a matrix, (9,).
    """
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, geom_type, size, position, frame, colour)
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    scene.ngeom += 1
    return geom
