"""The scene of a film: the car with its shapes, translucent shell, lights, floor, cameras; its off-screen picture."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.assembly.studio import add_studio
from vehicle.assembly.visuals import add_shapes, visible_shapes
from vehicle.parameters.vehicle import Vehicle
from vehicle.rendering.motion import Motion
from vehicle.rendering.recorded_run import hub_of
from vehicle.shapes import SHELL
from vehicle.simulation.car_model import CarModel

Picture = npt.NDArray[np.uint8]

MOST_GEOMS = 5000
"""Room in a scene: shapes, and nodes and members of the wireframe, the members twice."""

SAMPLES = 0
"""Multisampling of the picture: four samples take twice as long on a processor; a film halves its colours anyway."""

HIDDEN = ("body_lining",)
"""Shapes that only matter when the shell is opaque."""

OPACITY = {
    **dict.fromkeys(SHELL, 0.16),
    "body_trim": 0.10,
    "body_plates": 0.10,
    "body_front_structure": 0.30,
    "body_floor": 0.45,
    "body_seats": 0.45,
    "body_dashboard": 0.35,
    "body_exhaust": 0.6,
}
"""Opacity of the shapes that would hide suspension and wireframe; the close-up leaves them out."""


GROUND = -0.002
"""Height of the floor under a rig [m]."""

BELOW_ROAD = 0.30
"""Height of the road above the floor, which the exaggerated road does not reach [m]."""


def stage_model(car: CarModel, size: tuple[int, int], *, road: bool = False) -> mujoco.MjModel:
    """Compile the visible car: the same bodies and joints as the simulated one, plus shapes, lights and floor.

    Args:
        car: the simulated car.
        size: width and height of the largest picture [pixel].
        road: the car drives: no shakers, no plates, and the floor below the road.

    Returns:
        The model; generalised positions mean the same as in the simulated one.
    """
    spec = car.spec.copy()
    shapes = {name: shape for name, shape in visible_shapes(car.vehicle, rig=not road).items() if name not in HIDDEN}
    add_shapes(spec, shapes, car.origins, car.vehicle.composition.springs)
    for name in shapes:
        material = spec.material(name)
        material.rgba = [*material.rgba[:3], OPACITY.get(name, 1.0) * material.rgba[3]]
    patch = min(wheel.patch[2] for wheel in car.vehicle.composition.wheels)
    add_studio(spec, size, SAMPLES, patch - BELOW_ROAD if road else GROUND)
    return spec.compile()


def whole_car(vehicle: Vehicle) -> mujoco.MjvCamera:
    """Camera in front of the car at its right, as far as the car is long."""
    wheels = vehicle.composition.wheels
    standing = [wheel.patch for wheel in wheels]
    standing += [one.at for one in vehicle.composition.connections if one.ground and one.moving == "body"]
    front, rear = min(place[0] for place in standing), max(place[0] for place in standing)
    camera = mujoco.MjvCamera()
    camera.lookat = [0.5 * (front + rear), 0.05, min(wheel.patch[2] for wheel in wheels) + 0.58]
    camera.distance, camera.azimuth, camera.elevation = max(2.256 * (rear - front), 4.0), -52.0, -13.0
    return camera


def close_up(motion: Motion, vehicle: Vehicle, wheel: str) -> mujoco.MjvCamera:
    """Camera on the suspension of a wheel, from outside in front: between its hub and its highest point."""
    hub = motion.position[motion.model.body(hub_of(vehicle.composition, wheel)).id]
    top = max((place for name, place in vehicle.points.items() if name.endswith(f"_{wheel}")), key=lambda at: at[2])
    camera = mujoco.MjvCamera()
    camera.lookat = np.mean([hub, top], axis=0)
    camera.distance, camera.elevation = 2.0, -7.0
    camera.azimuth = -60.0 * np.sign(camera.lookat[1])
    return camera


class Canvas:
    """OpenGL context, scene and buffer; close it when done.

    MuJoCo's own Renderer takes the backend that MUJOCO_GL named when mujoco was imported; this takes the one it is
    told, so a notebook that has imported mujoco already can make films too.

    Args:
        model: what is drawn; its off-screen buffer must be at least as large as the picture.
        size: width and height [pixel].
        backend: "osmesa" or "egl".
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

    def render(self, viewport: tuple[int, int, int, int]) -> None:
        """Draw the scene into a part of the picture: left, bottom, width and height [pixel]."""
        mujoco.mjr_render(mujoco.MjrRect(*viewport), self.scene, self.context)

    def read(self) -> Picture:
        """The picture drawn so far, (height, width, 3), first row on top."""
        width, height = self.size
        mujoco.mjr_readPixels(self.picture, None, mujoco.MjrRect(0, 0, width, height), self.context)
        return np.asarray(self.picture[::-1])
