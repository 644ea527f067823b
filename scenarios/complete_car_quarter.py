"""Front quarter of the complete car as a quarter car, from the very parameters of the complete car."""

from __future__ import annotations

import numpy as np

from vehicle.parameters.axle import Axle
from vehicle.parameters.damper_choice import RoadHoldingQuarterCar
from vehicle.parameters.vehicle import Vehicle

WHEEL_PARTS = (
    "knuckle",
    "tyre",
    "brake_disc",
    "caliper",
    "damper_bottom",
    "main_spring_lower",
    "stabilizer_rod",
)
"""Parts that move with the wheel."""

LINK_PARTS = ("a_arm", "steering_rod")
"""Parts between body and wheel: half of their mass moves with the wheel."""


def complete_car_quarter(vehicle: Vehicle) -> RoadHoldingQuarterCar:
    """Quarter car that stands for the front right corner of the complete car.

    The sprung mass is the share of body and engine on one front wheel between front wheels and rear supports; spring
    and damper act along the strut, at the wheel with the square of the cosine of its angle. Left out: the flexible
    body, the engine on its mounts, the friction of the damper, the suspension mount and the stabilizer.

    Args:
        vehicle: the complete car.

    Returns:
        Its equivalent quarter car.
    """
    points = vehicle.hardpoints
    rear = points.rear_support[0]
    base = rear - points.wheel_center[0]
    front_share = (
        vehicle.body.mass * (rear - vehicle.body.cog[0]) + vehicle.parts["engine"].mass * (rear - points.engine_cog[0])
    ) / base
    strut = np.subtract(points.strut_top, points.damper_bottom)
    slope = float(strut[2] / np.linalg.norm(strut)) ** 2
    unsprung = sum(vehicle.parts[name].mass for name in WHEEL_PARTS)
    unsprung += 0.5 * sum(vehicle.parts[name].mass for name in LINK_PARTS)
    return RoadHoldingQuarterCar(
        sprung_mass=0.5 * front_share,
        wheel=Axle(
            unsprung_mass=unsprung,
            suspension_stiffness=slope * vehicle.main_spring.stiffness,
            suspension_damping=slope * vehicle.damper.viscous,
            tyre_stiffness=vehicle.bushings.tyre.stiffness[2],
            tyre_damping=vehicle.bushings.tyre.damping[2],
        ),
    )
