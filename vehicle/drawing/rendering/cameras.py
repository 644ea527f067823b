"""Cameras of a film."""

import mujoco
import numpy as np

from vehicle.drawing.rendering.motion import Motion
from vehicle.drawing.rendering.recorded_run import hub_of
from vehicle.model.parameters.vehicle import Vehicle


def whole_car(vehicle: Vehicle) -> mujoco.MjvCamera:
    """Return a camera at the front right of the car, at a distance in proportion to its wheelbase."""
    wheels = vehicle.composition.wheels
    ground_points = [wheel.patch for wheel in wheels]
    ground_points += [
        connection.at
        for connection in vehicle.composition.connections
        if connection.ground and connection.moving == "body"
    ]
    front, rear = min(point[0] for point in ground_points), max(point[0] for point in ground_points)
    camera = mujoco.MjvCamera()
    camera.lookat = [0.5 * (front + rear), 0.05, min(wheel.patch[2] for wheel in wheels) + 0.58]
    camera.distance, camera.azimuth, camera.elevation = max(2.256 * (rear - front), 4.0), -52.0, -13.0
    return camera


WHOLE_AT = 1.575
"""Width over height of a view from which the camera of the whole car has the whole car in it."""


def farther(camera: mujoco.MjvCamera, shape: float) -> mujoco.MjvCamera:
    """Move a camera back, so that a narrow view of this width over height has the whole car in it."""
    camera.distance *= max(WHOLE_AT / shape, 1.0)
    return camera


def close_up(motion: Motion, vehicle: Vehicle, wheel: str) -> mujoco.MjvCamera:
    """Return a camera on the suspension of a wheel from the front outside, aimed between hub and highest point."""
    hub = motion.position[motion.model.body(hub_of(vehicle.composition, wheel)).id]
    top = max((point for name, point in vehicle.points.items() if name.endswith(f"_{wheel}")), key=lambda at: at[2])
    camera = mujoco.MjvCamera()
    camera.lookat = np.mean([hub, top], axis=0)
    camera.distance, camera.elevation = 2.0, -7.0
    camera.azimuth = -60.0 * np.sign(camera.lookat[1])
    return camera
