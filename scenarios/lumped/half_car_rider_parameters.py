"""Parameters of the half car with seat and rider, its bump and its semi-active dampers."""

from dataclasses import dataclass
from pathlib import Path

from scenarios.lumped.axle import Axle
from vehicle.model.parameters.quantity import Validated, quantity
from vehicle.model.parameters.semi_active_damper import SemiActiveDamper
from vehicle.model.parameters.toml_file import build, read_table

PUBLISHED = Path(__file__).with_name("half_car_rider.toml")


@dataclass(frozen=True, kw_only=True, slots=True)
class RiderBody(Validated):
    """Sprung mass in heave and pitch; arms are measured from its centre of gravity."""

    mass: float = quantity("kg", "sprung mass mb", above=0.0)
    pitch_inertia: float = quantity("kg m2", "moment of inertia J about the pitch axis", above=0.0)
    front_arm: float = quantity("m", "centre of gravity to front suspension a1", above=0.0)
    rear_arm: float = quantity("m", "centre of gravity to rear suspension a2", above=0.0)
    seat_arm: float = quantity("m", "centre of gravity to seat a3, forward positive")


@dataclass(frozen=True, kw_only=True, slots=True)
class Limb(Validated):
    """Mass on a spring and a damper: the seat on the body, or one half of the rider on the seat."""

    mass: float = quantity("kg", "mass", above=0.0)
    stiffness: float = quantity("N/m", "stiffness of its support", above=0.0)
    damping: float = quantity("N s/m", "damper coefficient of its support", at_least=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class BumpShape(Validated):
    """Half-sine bump."""

    height: float = quantity("m", "bump height h0; negative is a dip")
    length: float = quantity("m", "bump length wb", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class HalfCarRiderParameters:
    """Half car with seat and rider (7 coordinates)."""

    body: RiderBody
    front: Axle
    rear: Axle
    seat: Limb
    lower_limb: Limb
    upper_limb: Limb
    bump: BumpShape
    semi_active: SemiActiveDamper


def half_car_rider_parameters(path: Path = PUBLISHED) -> HalfCarRiderParameters:
    """Read the parameters of a half car with rider; by default the published set.

    Raises:
        ConfigurationError: the file, a name or a value is wrong.
    """
    return build(HalfCarRiderParameters, read_table(path))
