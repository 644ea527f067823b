"""The scene of a film: the generated car with its shapes, translucent shell, lights and floor."""

from __future__ import annotations

import mujoco
import numpy as np

from vehicle.assembly.studio import add_studio
from vehicle.assembly.visuals import add_shapes
from vehicle.rendering.exaggeration import Motion
from vehicle.shapes import SHELL, car_shapes
from vehicle.simulation.car_model import CarModel

SAMPLES = 4
"""Multisampling of the picture."""

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
"""Opacity of the shapes that would hide suspension and wireframe."""


def stage_model(car: CarModel, size: tuple[int, int]) -> mujoco.MjModel:
    """Compile the visible car: the same bodies and joints as the simulated one, plus shapes, lights and floor.

    Args:
        car: the simulated car.
        size: width and height of the largest picture [pixel].

    Returns:
        The model; generalised positions mean the same as in the simulated one.
    """
    spec = car.spec.copy()
    points = {name: np.array(point) for name, point in car.vehicle.points.items()}
    shapes = {name: shape for name, shape in car_shapes(points).items() if name not in HIDDEN}
    add_shapes(spec, shapes, car.origins)
    for name, opacity in OPACITY.items():
        material = spec.material(name)
        material.rgba = [*material.rgba[:3], opacity * material.rgba[3]]
    add_studio(spec, size, SAMPLES)
    return spec.compile()


def whole_car() -> mujoco.MjvCamera:
    """Camera in front of the car at its right."""
    camera = mujoco.MjvCamera()
    camera.lookat = [2.15, 0.05, 0.98]
    camera.distance, camera.azimuth, camera.elevation = 5.9, -52.0, -13.0
    return camera


def close_up(motion: Motion, wheel: str) -> mujoco.MjvCamera:
    """Camera on the strut of a wheel, from outside in front."""
    model = motion.model
    ends = motion.position[[model.body(f"{part}_{wheel}").id for part in ("knuckle", "suspension_mount")]]
    camera = mujoco.MjvCamera()
    camera.lookat = ends.mean(axis=0)
    camera.distance, camera.elevation = 2.0, -7.0
    camera.azimuth = -60.0 * np.sign(camera.lookat[1])
    return camera
