"""Quarter car and half car of the damper study as linear models, and what each tyre carries."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.lumped.energy_matrices import LinearModel, SpringDamper, energy_matrices
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

    model: LinearModel
    tyres: tuple[Tyre, ...]


def quarter_car_model(car: RoadHoldingQuarterCar, damping: float | None = None) -> RoadHoldingModel:
    """Quarter car with the coordinates wheel, body.

    Args:
        car: parameters.
        damping: damper coefficient in place of the car's own [N s/m].
    """
    model = energy_matrices(
        {"wheel": car.wheel.unsprung_mass, "body": car.sprung_mass},
        (
            _suspension(car.wheel, {"body": 1.0, "wheel": -1.0}, damping),
            _tyre_spring(car.wheel, "wheel", "road"),
        ),
        ("road",),
    )
    return RoadHoldingModel(model=model, tyres=(_tyre(car.wheel, "wheel", car.sprung_mass),))


def half_car_model(
    car: RoadHoldingHalfCar, front_damping: float | None = None, rear_damping: float | None = None
) -> RoadHoldingModel:
    """Half car with the coordinates front_wheel, rear_wheel, heave [m] and pitch [rad] (front down positive).

    Args:
        car: parameters.
        front_damping: front damper coefficient in place of the car's own [N s/m].
        rear_damping: the same at the rear.
    """
    model = energy_matrices(
        {
            "front_wheel": car.front.unsprung_mass,
            "rear_wheel": car.rear.unsprung_mass,
            "heave": car.sprung_mass,
            "pitch": car.pitch_inertia,
        },
        (
            _suspension(car.front, {"heave": 1.0, "pitch": -car.front_arm, "front_wheel": -1.0}, front_damping),
            _suspension(car.rear, {"heave": 1.0, "pitch": car.rear_arm, "rear_wheel": -1.0}, rear_damping),
            _tyre_spring(car.front, "front_wheel", "front_road"),
            _tyre_spring(car.rear, "rear_wheel", "rear_road"),
        ),
        ("front_road", "rear_road"),
    )
    wheelbase = car.front_arm + car.rear_arm
    return RoadHoldingModel(
        model=model,
        tyres=(
            _tyre(car.front, "front_wheel", car.sprung_mass * car.rear_arm / wheelbase),
            _tyre(car.rear, "rear_wheel", car.sprung_mass * car.front_arm / wheelbase),
        ),
    )


def _suspension(axle: Axle, travel: dict[str, float], damping: float | None) -> SpringDamper:
    chosen = axle.suspension_damping if damping is None else damping
    return SpringDamper(extension=travel, stiffness=axle.suspension_stiffness, damping=chosen)


def _tyre_spring(axle: Axle, wheel: str, road: str) -> SpringDamper:
    return SpringDamper(extension={wheel: 1.0, road: -1.0}, stiffness=axle.tyre_stiffness, damping=axle.tyre_damping)


def _tyre(axle: Axle, wheel: str, sprung_share: float) -> Tyre:
    return Tyre(
        wheel=wheel,
        stiffness=axle.tyre_stiffness,
        damping=axle.tyre_damping,
        static_load=(sprung_share + axle.unsprung_mass) * GRAVITY,
    )
