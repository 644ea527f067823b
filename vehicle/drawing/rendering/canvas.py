"""The off-screen picture of a scene."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import mujoco
import numpy as np

from vehicle.drawing.rendering.added_geom import add_geom
from vehicle.drawing.rendering.layout import Picture

MOST_GEOMS = 5000
"""Room in a scene: shapes, nodes and members of the wireframe, pieces of a road."""

WHITE = np.ones(4, dtype=np.float32)


class Canvas:
    """OpenGL context, scene and buffer; close it when done.

    MuJoCo's own Renderer takes the backend that MUJOCO_GL named when mujoco was imported; this takes the one it is
    told, so a notebook that has imported mujoco already can make films too.

    Args:
        model: what is drawn; its off-screen buffer must be at least as large as the picture.
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
        # Springs are drawn as coils, not as tendons.
        self.option.flags[mujoco.mjtVisFlag.mjVIS_TENDON] = False
        self.floor = int(model.geom("floor").id)
        self.picture = np.zeros((size[1], size[0], 3), dtype=np.uint8)

    def close(self) -> None:
        """Give all of OpenGL back; harmless a second time."""
        if self.context is not None:
            self.gl.make_current()
            self.context.free()
            self.context = None
            self.gl.free()

    def upload(self, mesh: int) -> None:
        """Pass the changed vertices of a mesh on to OpenGL."""
        mujoco.mjr_uploadMesh(self.model, self.context, mesh)

    def update(self, data: mujoco.MjData, camera: mujoco.MjvCamera) -> None:
        """Fill the scene with the geoms as they are placed, seen by a camera; more may be appended to it then."""
        everything = mujoco.mjtCatBit.mjCAT_ALL
        # The headlight is placed before the camera is: a picture would depend on the one before.
        mujoco.mjv_updateCamera(self.model, data, camera, self.scene)
        mujoco.mjv_updateScene(self.model, data, self.option, None, camera, everything, self.scene)
        # Haze is drawn at the horizon of an infinite plane alone; this one is nothing but that.
        add_geom(self.scene, mujoco.mjtGeom.mjGEOM_PLANE, np.zeros(3), data.geom_xpos[self.floor], WHITE)

    def render(self, viewport: tuple[int, int, int, int]) -> None:
        """Draw the scene into a part of the picture: left, bottom, width and height [pixel]."""
        mujoco.mjr_render(mujoco.MjrRect(*viewport), self.scene, self.context)

    def read(self) -> Picture:
        """The picture drawn so far, (height, width, 3), first row on top."""
        width, height = self.size
        mujoco.mjr_readPixels(self.picture, None, mujoco.MjrRect(0, 0, width, height), self.context)
        return np.asarray(self.picture[::-1])
