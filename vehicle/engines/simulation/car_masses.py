"""Mass properties of the parts of a compiled car in its design position."""

import mujoco
import numpy as np

from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.parameters.rigid_part import Load


def car_masses(car: CarModel, *, body: bool = True, loads: bool = False) -> MassProperties:
    """Return mass, centre of gravity and inertia of a car.

    Args:
        car: compiled car.
        body: False to leave out the body.
        loads: True to include the loads of the vehicle file.
    """
    model, data = car.model, mujoco.MjData(car.model)
    mujoco.mj_forward(model, data)
    skipped = {part.name for part in car.vehicle.composition.parts if isinstance(part.numbers, Load) and not loads}
    if not body:
        skipped.add("body")
    bodies = [
        number
        for number in range(1, model.nbody)
        if model.body_mocapid[number] < 0 and str(model.body(number).name) not in skipped
    ]
    points = MassProperties.of_points(model.body_mass[bodies], data.xipos[bodies])
    frames = data.ximat[bodies].reshape(-1, 3, 3)
    # Sum of R diag(I) R' over the bodies, to the moments of their masses as points.
    inertia = np.einsum("bij,bj,bkj->ik", frames, model.body_inertia[bodies], frames)
    return MassProperties(mass=points.mass, cog=points.cog, inertia=points.inertia + inertia)
