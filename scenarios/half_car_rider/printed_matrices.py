"""The matrices of the half car with rider as the source prints them, typing errors included: to show what they do.

Source: "Parametric study of rider's comfort ...", matrices below equation 16.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.system import LinearSystem
from vehicle.engines.lumped.half_car_rider_model import half_car_rider
from vehicle.model.parameters.half_car_rider import HalfCarRiderParameters


def printed_system(parameters: HalfCarRiderParameters) -> LinearSystem:
    """The derived system with [C] and [K] as printed; they differ in the entries named here, and are not symmetric.

    Coordinates upper limb, lower limb, seat, heave, front wheel, rear wheel, pitch.
    """
    system, seat, arm = half_car_rider(parameters), parameters.seat, parameters.body.seat_arm
    damping, stiffness = system.damping.copy(), system.stiffness.copy()
    damping[:2, 2] = -seat.damping  # of the seat, where those of the limbs belong
    damping[3, 2] = seat.damping  # the wrong sign
    damping[6, 3:] *= -1.0  # the wrong sign, of the damping of pitch itself too
    stiffness[2, 3] = seat.stiffness  # the wrong sign
    stiffness[3, 5] = -parameters.rear.tyre_stiffness  # of the tyre, where that of the suspension belongs
    stiffness[5, 6] *= -1.0  # the wrong sign
    stiffness[6, 3] += 2.0 * arm * seat.stiffness  # the wrong sign of the part of the seat
    return replace(system, stiffness=stiffness, damping=damping)


def growth_rate(system: LinearSystem) -> float:
    """Largest real part of the poles of M x'' + C x' + K x = 0 [1/s]; above zero the motion grows for ever."""
    return float(np.linalg.eigvals(first_order(system).state).real.max())
