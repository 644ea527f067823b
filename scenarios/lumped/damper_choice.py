"""Parameters of the choice of dampers for road holding: quarter car, half car, roads and frequency bands."""

from dataclasses import dataclass
from pathlib import Path

from scenarios.lumped.axle import Axle
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import Validated, quantity, validate
from vehicle.model.parameters.toml_file import build, read_table

FITTED = Path(__file__).with_name("damper_choice.toml")


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadHoldingQuarterCar(Validated):
    """Sprung mass and wheel of a quarter car."""

    sprung_mass: float = quantity("kg", "sprung mass Ms", above=0.0)
    wheel: Axle


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadHoldingHalfCar(Validated):
    """Body in heave and pitch on a front and a rear axle."""

    sprung_mass: float = quantity("kg", "sprung mass Ms", above=0.0)
    pitch_inertia: float = quantity("kg m2", "moment of inertia J about the pitch axis", above=0.0)
    front_arm: float = quantity("m", "centre of gravity to front axle a", above=0.0)
    rear_arm: float = quantity("m", "centre of gravity to rear axle b", above=0.0)
    front: Axle
    rear: Axle


@dataclass(frozen=True, kw_only=True, slots=True)
class ExponentialRoad(Validated):
    """Road displacement density G(f) = a exp(-b f) at one speed."""

    roughness: float = quantity("m2/Hz", "a", above=0.0)
    decay: float = quantity("s", "b", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class FrequencyBands:
    """Bands of equal width from 0 to the highest frequency."""

    width: float = quantity("Hz", "width h of one band", above=0.0)
    highest: float = quantity("Hz", "upper edge of the last band", above=0.0)

    def __post_init__(self) -> None:
        validate(self)
        if self.highest < self.width:
            raise ConfigurationError(
                f"FrequencyBands.highest: found {self.highest!r} Hz, must be at least one band of {self.width!r} Hz"
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class DamperChoiceParameters:
    """Parameters of the damper study."""

    quarter_car: RoadHoldingQuarterCar
    half_car: RoadHoldingHalfCar
    highway: ExponentialRoad
    city: ExponentialRoad
    bands: FrequencyBands


def damper_choice_parameters(path: Path = FITTED) -> DamperChoiceParameters:
    """Read the parameters of the damper study; by default the set fitted to the published results.

    Raises:
        ConfigurationError: the file, a name or a value is wrong.
    """
    return build(DamperChoiceParameters, read_table(path))
