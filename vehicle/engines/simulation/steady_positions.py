"""Positions of body and wheels of a car in steady acceleration."""

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.rows import Rows


def steady_positions(car: CarModel) -> tuple[Vector, dict[str, tuple[float, float, float, float]]]:
    """Return the axes of the body as columns, (3, 3), and by wheel its travel [m] and the force of the road [N].

    Travel is the rise of the wheel centre in axes of the body; forces are along the axes of the hardpoints.
    """
    data, layout = mujoco.MjData(car.model), Rows(car.model, car.static.preload).layout
    mujoco.mj_kinematics(car.model, data)
    body, positions = data.body("body"), dict[str, tuple[float, float, float, float]]()
    frame, wheels = body.xmat.reshape(3, 3).copy(), {wheel.name: wheel for wheel in car.vehicle.composition.wheels}
    forces = car.static.preload[layout.bushings.rows[layout.tyres]]
    # Loads and tyres are in the order of the plates.
    for name, (x, y, z) in zip(car.static.tyre_load, forces.tolist(), strict=True):
        part, centre = data.body(wheels[name].part), np.array(wheels[name].center)
        now = part.xpos + part.xmat.reshape(3, 3) @ (centre - car.origins[wheels[name].part])
        travel = frame[:, 2] @ (now - body.xpos) - (centre - car.origins["body"])[2]
        positions[name] = float(travel), x, y, z
    return frame, positions
