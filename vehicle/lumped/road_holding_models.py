"""Quarter car and half car of the damper study as linear models, and what each tyre carries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.linear.first_order import first_order
from vehicle.linear.parts import ROAD, Link, Network, masses_of, spring_damper
from vehicle.linear.response import frequency_response
from vehicle.linear.system import LinearSystem
from vehicle.parameters.axle import Axle
from vehicle.parameters.damper_choice import RoadHoldingHalfCar, RoadHoldingQuarterCar

GRAVITY = 9.81
"""[m/s2]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Tyre:
    """One tyre: the coordinate it carries, its spring and damper, its load at rest."""

    wheel: str
    """Coordinate of the unsprung mass."""
    stiffness: float
    """kt [N/m]."""
    damping: float
    """ct [N s/m]."""
    static_load: float
    """(share of the sprung mass + unsprung mass) g [N]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadHoldingModel:
    """A linear model with its tyres, in the order of its roads."""

    model: LinearSystem
    tyres: tuple[Tyre, ...]

    def response(self, frequency: npt.ArrayLike, *places: str) -> npt.NDArray[np.complex128]:
        """Motion per road height, the same road under every wheel at the same time.

        Args:
            frequency: lines [Hz], shape (m,).
            places: coordinates; all of them by default.

        Returns:
            [m/m] or [rad/m], shape (places, m).
        """
        return frequency_response(first_order(self.model), frequency, places or self.model.coordinates)


def quarter_car_model(car: RoadHoldingQuarterCar, damping: float | None = None) -> RoadHoldingModel:
    """Quarter car with the coordinates wheel, body.

    Args:
        car: parameters.
        damping: damper coefficient in place of the car's own [N s/m].
    """
    network = Network(
        coordinates=("wheel", "body"),
        masses=masses_of({"wheel": car.wheel.unsprung_mass, "body": car.sprung_mass}),
        links=(
            _suspension(car.wheel, {"body": 1.0, "wheel": -1.0}, damping),
            _tyre_spring(car.wheel, "wheel", ROAD),
        ),
    )
    return RoadHoldingModel(model=network.system(), tyres=(_tyre(car.wheel, "wheel", car.sprung_mass),))


def half_car_model(
    car: RoadHoldingHalfCar, front_damping: float | None = None, rear_damping: float | None = None
) -> RoadHoldingModel:
    """Half car with the coordinates front_wheel, rear_wheel, heave [m] and pitch [rad] (front down positive).

    Args:
        car: parameters.
        front_damping: front damper coefficient in place of the car's own [N s/m].
        rear_damping: the same at the rear.
    """
    masses = {
        "front_wheel": car.front.unsprung_mass,
        "rear_wheel": car.rear.unsprung_mass,
        "heave": car.sprung_mass,
        "pitch": car.pitch_inertia,
    }
    network = Network(
        coordinates=tuple(masses),
        masses=masses_of(masses),
        links=(
            _suspension(car.front, {"heave": 1.0, "pitch": -car.front_arm, "front_wheel": -1.0}, front_damping),
            _suspension(car.rear, {"heave": 1.0, "pitch": car.rear_arm, "rear_wheel": -1.0}, rear_damping),
            _tyre_spring(car.front, "front_wheel", "front_road"),
            _tyre_spring(car.rear, "rear_wheel", "rear_road"),
        ),
        inputs=("front_road", "rear_road"),
    )
    wheelbase = car.front_arm + car.rear_arm
    return RoadHoldingModel(
        model=network.system(),
        tyres=(
            _tyre(car.front, "front_wheel", car.sprung_mass * car.rear_arm / wheelbase),
            _tyre(car.rear, "rear_wheel", car.sprung_mass * car.front_arm / wheelbase),
        ),
    )


def _suspension(axle: Axle, travel: dict[str, float], damping: float | None) -> Link:
    chosen = axle.suspension_damping if damping is None else damping
    return spring_damper(travel, axle.suspension_stiffness, chosen)


def _tyre_spring(axle: Axle, wheel: str, road: str) -> Link:
    return spring_damper({wheel: 1.0, road: -1.0}, axle.tyre_stiffness, axle.tyre_damping)


def _tyre(axle: Axle, wheel: str, sprung_share: float) -> Tyre:
    return Tyre(
        wheel=wheel,
        stiffness=axle.tyre_stiffness,
        damping=axle.tyre_damping,
        static_load=(sprung_share + axle.unsprung_mass) * GRAVITY,
    )
