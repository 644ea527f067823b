"""Parameters of the quarter-car family: one set of parts for all models of the family."""

from dataclasses import dataclass
from pathlib import Path

from vehicle.model.parameters.quantity import Validated, quantity
from vehicle.model.parameters.toml_file import build, read_table

PUBLISHED = Path(__file__).with_name("quarter_car.toml")


@dataclass(frozen=True, kw_only=True, slots=True)
class Body(Validated):
    """Quarter of the body."""

    mass: float = quantity("kg", "body mass Mb", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Wheel(Validated):
    """Unsprung mass and vertical tyre stiffness."""

    mass: float = quantity("kg", "unsprung mass Mt", above=0.0)
    tyre_stiffness: float = quantity("N/m", "vertical tyre stiffness Kt", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Spring(Validated):
    """Main spring between body and wheel."""

    stiffness: float = quantity("N/m", "main spring stiffness Km", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Mount(Validated):
    """Suspension mount: the spring in series with the damper."""

    stiffness: float = quantity("N/m", "suspension mount stiffness Kd", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Damper(Validated):
    """Shock absorber without friction."""

    mass: float = quantity("kg", "damper mass Md between damper and mount", above=0.0)
    damping: float = quantity("N s/m", "viscous damping constant D", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Friction(Validated):
    """Friction of the shock absorber, smoothed by an arc tangent; names as in the laws of `vehicle.model.laws`.

    Defaults of the parameters that only the Stribeck law needs are those of the complete car (Bommer 2006, 3.4).
    """

    limit: float = quantity("N", "Coulomb friction force Fd", at_least=0.0)
    steepness: float = quantity("s/m", "smoothing parameter eps", above=0.0)
    static_limit: float = quantity("N", "friction force Fs at rest", at_least=0.0, default=125.0)
    stribeck_velocity: float = quantity("m/s", "velocity vs of the transition", above=0.0, default=0.03)
    stribeck_exponent: float = quantity("-", "exponent delta of the transition", above=0.0, at_most=20.0, default=3.5)


@dataclass(frozen=True, kw_only=True, slots=True)
class Engine(Validated):
    """Half of the engine."""

    mass: float = quantity("kg", "engine mass Me", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class EngineMount(Validated):
    """Linear engine mount."""

    stiffness: float = quantity("N/m", "engine mount stiffness Ke", above=0.0)
    damping: float = quantity("N s/m", "engine mount damping De", at_least=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Elastomer(Validated):
    """Engine mount with a Maxwell branch."""

    stiffness: float = quantity("N/m", "static stiffness Ke1", above=0.0)
    branch_stiffness: float = quantity("N/m", "stiffness Ke2 of the Maxwell branch", above=0.0)
    branch_damping: float = quantity("N s/m", "damping constant De of the Maxwell branch", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Degressive(Validated):
    """Degressive characteristic: a larger damping constant at small velocities."""

    low_damping: float = quantity("N s/m", "damping constant Ddeg below the knee", at_least=0.0)
    knee_velocity: float = quantity("m/s", "velocity Vdeg of the knee", at_least=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Strut(Validated):
    """Inclined strut and longitudinal bedding of the wheel."""

    angle: float = quantity("deg", "angle of the strut axis from the vertical", at_least=0.0, at_most=45.0)
    longitudinal_stiffness: float = quantity("N/m", "longitudinal stiffness Kh of the wheel", above=0.0)
    longitudinal_damping: float = quantity("N s/m", "longitudinal damping Dh of the wheel", at_least=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class SmallMass(Validated):
    """Small mass on the body that represents the highest flexible mode."""

    mass: float = quantity("kg", "small mass", above=0.0)
    frequency: float = quantity("Hz", "natural frequency on the body", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class MassOnDamper(Validated):
    """Single mass on a damper with friction, driven by a sine force."""

    mass: float = quantity("kg", "mass m", above=0.0)
    damping: float = quantity("N s/m", "viscous damping constant D", at_least=0.0)
    friction_limit: float = quantity("N", "Coulomb friction force Fd", at_least=0.0)
    steepness: float = quantity("s/m", "smoothing parameter eps", above=0.0)
    stick_band: float = quantity("m/s", "half width eta of the stick band", above=0.0)
    return_time: float = quantity("s", "time constant tau of the return to zero velocity", above=0.0)
    force_amplitude: float = quantity("N", "amplitude A of the force", at_least=0.0)
    force_frequency: float = quantity("Hz", "frequency f of the force", above=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class QuarterCar:
    """Every part of the quarter-car family.

    Source: Bommer 2006, chapter 2 and appendices A to D.
    """

    body: Body
    wheel: Wheel
    spring: Spring
    mount: Mount
    damper: Damper
    friction: Friction
    engine: Engine
    engine_mount: EngineMount
    elastomer: Elastomer
    degressive: Degressive
    strut: Strut
    small_mass: SmallMass
    mass_on_damper: MassOnDamper


def load_quarter_car(path: Path = PUBLISHED) -> QuarterCar:
    """Read the quarter car of a parameter file; by default the published one.

    Raises:
        ConfigurationError: a missing file, an unknown or missing name, a value out of range.
    """
    return build(QuarterCar, read_table(path))
