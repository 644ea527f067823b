"""Off-screen rendering of a scene."""

from importlib import import_module
from typing import Any

import mujoco
import numpy as np

from vehicle.drawing.rendering.added_geom import add_geom
from vehicle.drawing.rendering.layout import Picture

MOST_GEOMS = 5000
"""Maximum number of geoms in a scene: shapes, nodes and members of the wireframe, pieces of a road."""

WHITE = np.ones(4, dtype=np.float32)


class Canvas:
    """OpenGL context, scene and buffer; close it when done.

    The Renderer of MuJoCo uses the backend that MUJOCO_GL named when mujoco was imported. This canvas uses the given
    backend, so a notebook that has already imported mujoco can make films too.

    Args:
        model: model to draw; its off-screen buffer must be at least as large as the picture.
        size: width and height [pixel].
        backend: OpenGL backend, one of `BACKENDS`.
    """

    def __init__(self, model: mujoco.MjModel, size: tuple[int, int], backend: str) -> None:
        self.model, self.size = model, size
        self.gl: Any = import_module(f"mujoco.{backend}").GLContext(*size)
        self.gl.make_current()
        self.context: mujoco.MjrContext | None = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self.context)
        self.scene = mujoco.MjvScene(model, maxgeom=MOST_GEOMS)
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self.scene.flags[flag] = False
        self.option = mujoco.MjvOption()
        # Springs are drawn as coils instead of tendons.
        self.option.flags[mujoco.mjtVisFlag.mjVIS_TENDON] = False
        self.floor = int(model.geom("floor").id)
        self.picture = np.zeros((size[1], size[0], 3), dtype=np.uint8)

    def close(self) -> None:
        """Release all OpenGL resources; repeated calls are harmless."""
        if self.context is not None:
            self.gl.make_current()
            self.context.free()
            self.context = None
            self.gl.free()

    def upload(self, mesh: int) -> None:
        """Upload the changed vertices of a mesh to OpenGL."""
        mujoco.mjr_uploadMesh(self.model, self.context, mesh)

    def update(self, data: mujoco.MjData, camera: mujoco.MjvCamera) -> None:
        """Fill the scene with the geoms in their poses, for a camera; further geoms may be appended."""
        everything = mujoco.mjtCatBit.mjCAT_ALL
        # MuJoCo sets the headlight before the camera, so a picture would depend on the previous picture.
        mujoco.mjv_updateCamera(self.model, data, camera, self.scene)
        mujoco.mjv_updateScene(self.model, data, self.option, None, camera, everything, self.scene)
        # Haze is only visible at the horizon of an infinite plane.
        add_geom(self.scene, mujoco.mjtGeom.mjGEOM_PLANE, np.zeros(3), data.geom_xpos[self.floor], WHITE)

    def render(self, viewport: tuple[int, int, int, int]) -> None:
        """Render the scene to a part of the picture: left, bottom, width and height [pixel]."""
        mujoco.mjr_render(mujoco.MjrRect(*viewport), self.scene, self.context)

    def read(self) -> Picture:
        """Return the rendered picture, (height, width, 3), first row on top."""
        width, height = self.size
        mujoco.mjr_readPixels(self.picture, None, mujoco.MjrRect(0, 0, width, height), self.context)
        return np.asarray(self.picture[::-1])
