"""Matrices of the half car with rider as printed, including typing errors, to show the effect of the errors.

Source: "Parametric study of rider's comfort ...", matrices below equation 16.
"""

from dataclasses import replace

import numpy as np

from scenarios.lumped.half_car_rider_model import half_car_rider
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.system import LinearSystem


def printed_system(parameters: HalfCarRiderParameters) -> LinearSystem:
    """Return the derived system with the printed [C] and [K], which differ in the entries below and are asymmetric.

    Coordinates upper limb, lower limb, seat, heave, front wheel, rear wheel, pitch.
    """
    system, seat, arm = half_car_rider(parameters), parameters.seat, parameters.body.seat_arm
    damping, stiffness = system.damping.copy(), system.stiffness.copy()
    damping[:2, 2] = -seat.damping  # of the seat, but the limbs belong here
    damping[3, 2] = seat.damping  # the wrong sign
    damping[6, 3:] *= -1.0  # the wrong sign, of the damping of pitch itself too
    stiffness[2, 3] = seat.stiffness  # the wrong sign
    stiffness[3, 5] = -parameters.rear.tyre_stiffness  # of the tyre, but the suspension belongs here
    stiffness[5, 6] *= -1.0  # the wrong sign
    stiffness[6, 3] += 2.0 * arm * seat.stiffness  # the wrong sign of the part of the seat
    return replace(system, stiffness=stiffness, damping=damping)


def growth_rate(system: LinearSystem) -> float:
    """Return the largest real part of the poles of M x'' + C x' + K x = 0 [1/s]; positive for an unstable system."""
    return float(np.linalg.eigvals(first_order(system).state).real.max())
