"""Kinematics rig of an axle of a car, and its position in the car."""

from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.kinematics.axle_statics import AxleStatics
from vehicle.errors import ConfigurationError


def axle_names(car: Any) -> list[str]:
    """Return the names of the axles with wheels, in the order of the vehicle file."""
    return list(dict.fromkeys(wheel.axle for wheel in car.vehicle.composition.wheels))


def car_at_rest(car: Any) -> Any:
    """Return the car with standing tyres and without acceleration: on its rig an axle neither drives nor brakes."""
    driving = car.vehicle.driving
    changes = ["driving.speed=0"] if driving.rolling else []
    changes += [f"driving.{name}=0" for name in ("acceleration", "lateral") if getattr(driving, name)]
    return car.with_(changes) if changes else car


def axle_statics(car: Any, name: str, *, ideal: bool, standing: bool = False) -> AxleStatics:
    """Return the kinematics model of an axle.

    Args:
        car: the car, with standing tyres.
        name: table of the axle in the vehicle file.
        ideal: True replaces all bushings by ideal ball joints.
        standing: True for tyres that stand, see `AxleStatics`.

    Raises:
        ConfigurationError: the table has no wheel.
    """
    wheels = [wheel for wheel in car.vehicle.composition.wheels if wheel.axle == name]
    if not wheels:
        axles = ", ".join(axle_names(car))
        raise ConfigurationError(
            f"--axle {name!r}: is not an axle with wheels; choose from {axles} of {car.vehicle.name}"
        )
    return AxleStatics(car.model.model, car.model.static.preload, wheels=wheels, ideal=ideal, standing=standing)


def mass_and_cog(car: Any) -> tuple[float, Vector]:
    """Return the mass of the whole car [kg] and its centre of gravity [m], (3,), in the frame of the hardpoints."""
    matrices = car.matrices
    masses = np.array([matrices.body_masses[body][0, 0] for body in matrices.body_centres])
    return float(masses.sum()), masses @ np.array(list(matrices.body_centres.values())) / masses.sum()


def direction_to_middle(car: Any, name: str) -> float:
    """Return +1 for an axle ahead of the centre of gravity of the car, otherwise -1."""
    wheel = next(wheel for wheel in car.vehicle.composition.wheels if wheel.axle == name)
    return 1.0 if wheel.center[0] < mass_and_cog(car)[1][0] else -1.0
