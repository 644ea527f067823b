"""The matrices of the half car with rider as the source prints them, typing errors included: to show what they do.

Neither is symmetric: [C] row 1 has -cse where -c3 belongs, [C] row 7 a negative pitch damping, and [K] row 4
couples through -kur. Nothing else in this package uses them.

Source: "Parametric study of rider's comfort ...", matrices below equation 16.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from vehicle.linear.first_order import first_order
from vehicle.lumped.half_car_rider import half_car_rider
from vehicle.parameters.half_car_rider import HalfCarRiderParameters

Array = npt.NDArray[np.float64]


def printed_damping(parameters: HalfCarRiderParameters) -> Array:
    """[C] as printed, coordinates upper limb, lower limb, seat, heave, front wheel, rear wheel, pitch; (7, 7)."""
    a1, a2, a3 = parameters.body.front_arm, parameters.body.rear_arm, parameters.body.seat_arm
    c3, c2, cse = parameters.upper_limb.damping, parameters.lower_limb.damping, parameters.seat.damping
    csf, csr = parameters.front.suspension_damping, parameters.rear.suspension_damping
    cuf, cur = parameters.front.tyre_damping, parameters.rear.tyre_damping
    pitch = -(csr * a2**2 + csf * a1**2 + cse * a3**2)
    return np.array(
        [
            [c3, 0.0, -cse, 0.0, 0.0, 0.0, 0.0],
            [0.0, c2, -cse, 0.0, 0.0, 0.0, 0.0],
            [-c3, -c2, cse + c2 + c3, -cse, 0.0, 0.0, cse * a3],
            [0.0, 0.0, cse, csf + csr + cse, -csf, -csr, csr * a2 - csf * a1 - cse * a3],
            [0.0, 0.0, 0.0, -csf, cuf + csf, 0.0, csf * a1],
            [0.0, 0.0, 0.0, -csr, 0.0, cur + csr, -csr * a2],
            [0.0, 0.0, cse * a3, csf * a1 - csr * a2 + cse * a3, -csf * a1, csr * a2, pitch],
        ]
    )


def printed_stiffness(parameters: HalfCarRiderParameters) -> Array:
    """[K] as printed, same coordinates; (7, 7)."""
    a1, a2, a3 = parameters.body.front_arm, parameters.body.rear_arm, parameters.body.seat_arm
    k3, k2, kse = parameters.upper_limb.stiffness, parameters.lower_limb.stiffness, parameters.seat.stiffness
    ksf, ksr = parameters.front.suspension_stiffness, parameters.rear.suspension_stiffness
    kuf, kur = parameters.front.tyre_stiffness, parameters.rear.tyre_stiffness
    pitch = ksf * a1**2 + ksr * a2**2 + kse * a3**2
    return np.array(
        [
            [k3, 0.0, -k3, 0.0, 0.0, 0.0, 0.0],
            [0.0, k2, -k2, 0.0, 0.0, 0.0, 0.0],
            [-k3, -k2, kse + k2 + k3, kse, 0.0, 0.0, kse * a3],
            [0.0, 0.0, -kse, ksf + ksr + kse, -ksf, -kur, ksr * a2 - ksf * a1 - kse * a3],
            [0.0, 0.0, 0.0, -ksf, kuf + ksf, 0.0, ksf * a1],
            [0.0, 0.0, 0.0, -ksr, 0.0, ksr + kur, ksr * a2],
            [0.0, 0.0, kse * a3, ksr * a2 - ksf * a1 + kse * a3, ksf * a1, -ksr * a2, pitch],
        ]
    )


def growth_rate(parameters: HalfCarRiderParameters, *, printed: bool) -> float:
    """Largest real part of the poles of M x'' + C x' + K x = 0 [1/s]; above zero the motion grows for ever.

    Args:
        parameters: the car.
        printed: with the printed matrices; else with those of `half_car_rider`.
    """
    model = half_car_rider(parameters)
    if printed:
        model = replace(model, stiffness=printed_stiffness(parameters), damping=printed_damping(parameters))
    return float(np.linalg.eigvals(first_order(model).state).real.max())
