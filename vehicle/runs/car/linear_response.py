"""Linear FRFs of a car to its plates and to its applied forces, from its matrices."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.forced_response import unit_response
from vehicle.engines.linear.response import frequency_response
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.placed_force import force_named


def is_stuck(damper: str) -> bool:
    """Return True for "stuck", False for "sliding" dampers."""
    if damper not in ("stuck", "sliding"):
        raise ConfigurationError(f"damper: must be stuck or sliding, not {damper!r}")
    return damper == "stuck"


def plate_frf(car: Any, channels: Sequence[str], frequency: npt.ArrayLike, stuck: bool, wheel: str) -> Complex:
    """Return the FRFs to the plate of a wheel [m/s2 per m]; see `Car.matrix_frf`."""
    car.vehicle.require_wheels((wheel,))
    car.vehicle.require_channels(channels, car.vehicle.acceleration_channels)
    form = first_order(car.matrices.system, stuck=stuck)
    driven = [float(name == wheel) for name in car.vehicle.wheels]
    return np.asarray(frequency_response(form, frequency, channels, "acceleration", driven=driven))


def force_frf(car: Any, channels: Sequence[str], frequency: npt.ArrayLike, stuck: bool, force: str) -> Complex:
    """Return the FRFs to an applied force [m/s2 per N or N m]; see `Car.force_frf`."""
    car.vehicle.require_channels(channels, car.vehicle.acceleration_channels)
    lines = np.atleast_1d(np.asarray(frequency, dtype=float))
    if not (np.isfinite(lines) & (lines >= 0.0)).all():
        raise ConfigurationError("frequency: must be finite numbers of at least 0.0 Hz")
    index = np.array([force_named(force, car.vehicle.composition.forces)])
    speeds = (2.0 * np.pi * lines).tolist()
    return np.asarray(unit_response(car.matrices, channels, speeds, index, stuck=stuck)[0])
