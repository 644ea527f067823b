"""A car whose motion grows by itself does not stand on its wheels: it is refused by what moves."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.linear.matrices import CarMatrices
from vehicle.linear.modes import car_modes, grows
from vehicle.linear.strained_part import holding_parameter
from vehicle.simulation.car_model import CarModel


def require_stable(car: CarModel, matrices: CarMatrices, poles: npt.NDArray[np.complex128]) -> None:
    """Refuse a car with a growing pole.

    The poles with sliding dampers tell: what buckles while the friction holds buckles all the more without it, for
    a stiffness that is indefinite in a part of the motions is so in all of them.

    Args:
        car: the car.
        matrices: its matrices.
        poles: its poles with sliding dampers [rad/s].

    Raises:
        ConfigurationError: what moves, how fast it grows, and what could be wrong.
    """
    if not np.any(grows(poles)):
        return
    growing = [mode for mode in car_modes(matrices, stuck=False) if mode.grows]
    worst = max(growing, key=lambda mode: mode.growth)
    vehicle = car.vehicle
    raise ConfigurationError(
        f"this car does not stand: {worst.description.removeprefix('grows: ')} grows by itself, e-fold in "
        f"{1.0 / worst.growth:.3g} s. Its weight and preloads are more than its springs hold: what works most there is "
        f"{holding_parameter(car, matrices, worst.growth + 0j, worst.shape)}; check it against "
        f"body.mass ({vehicle.body.mass:g} kg), body.cog and gravity ({vehicle.gravity:g} m/s2), or look at "
        "python -m vehicle.modes"
    )
