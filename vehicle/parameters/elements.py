"""Force elements: bushings, hydromount, main spring, stabilizer, damper."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.parameters.hardpoints import Point
from vehicle.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class Bushing:
    """Linear bushing: f = -K r - D r' in the axes of the body that carries it, torque = -K_rot angle."""

    stiffness: Point = quantity("N/m", "Kx, Ky, Kz", at_least=0.0, length=3)
    damping: Point = quantity("N s/m", "Dx, Dy, Dz", at_least=0.0, length=3)
    rotational_stiffness: float = quantity("N m/rad", "stiffness about each axis", at_least=0.0)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True, kw_only=True, slots=True)
class Hydromount:
    """Bushing whose z axis is an elastomer: K(s) = Kz1 + Kz2 Dz2 s / (Dz2 s + Kz2), plus Dz1 s."""

    stiffness: Point = quantity("N/m", "Kx, Ky, Kz1", at_least=0.0, length=3)
    damping: Point = quantity("N s/m", "Dx, Dy, Dz1", at_least=0.0, length=3)
    rotational_stiffness: float = quantity("N m/rad", "stiffness about each axis", at_least=0.0)
    maxwell_stiffness: float = quantity("N/m", "Kz2, spring of the Maxwell branch; 0 takes it out", at_least=0.0)
    maxwell_damping: float = quantity(
        "N s/m", "Dz2, dashpot of the Maxwell branch; 0 takes the branch out", at_least=0.0
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True, kw_only=True, slots=True)
class Bushings:
    """All bushings of the car."""

    tyre: Bushing
    suspension_mount: Bushing
    arm_rear: Bushing
    rear_support: Bushing
    linear_mount: Bushing
    torque_arm_body: Bushing
    torque_arm_engine: Bushing
    hydromount: Hydromount


@dataclass(frozen=True, kw_only=True, slots=True)
class MainSpring:
    """Linear spring between the lower spring seat and the strut top, along its own line."""

    stiffness: float = quantity("N/m", "stiffness", above=0.0)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True, kw_only=True, slots=True)
class Stabilizer:
    """Torsion spring between the two halves of the stabilizer bar."""

    torsional_stiffness: float = quantity("N m/rad", "torque over relative angle of the halves", at_least=0.0)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True, kw_only=True, slots=True)
class Damper:
    """F = D v + limit(v) (2/pi) atan(eps v), plus (Ddeg - D) v up to Vdeg and (Ddeg - D) Vdeg above, if degressive.

    The limit is Fd for the Coulomb law and Fd + (Fs - Fd) exp(-|v/vs|^delta) for the Stribeck law.
    """

    viscous: float = quantity("N s/m", "D, damping constant", at_least=0.0)
    viscous_law: str = quantity("-", "law of the damping", choices=("linear", "degressive"))
    degressive_viscous: float = quantity("N s/m", "Ddeg, slope of the degressive law below Vdeg", at_least=0.0)
    degressive_velocity: float = quantity("m/s", "Vdeg, where the degressive law turns flatter", above=0.0)
    friction_law: str = quantity("-", "friction law", choices=("coulomb", "stribeck"))
    coulomb_friction: float = quantity("N", "Fd, Coulomb friction", at_least=0.0)
    smoothing: float = quantity("s/m", "eps, slope of the smooth friction law", above=0.0)
    stribeck_friction: float = quantity("N", "Fs, friction at rest of the Stribeck law", at_least=0.0)
    stribeck_velocity: float = quantity("m/s", "vs, critical velocity of the Stribeck law", above=0.0)
    stribeck_exponent: float = quantity("-", "delta, exponent of the Stribeck law", above=0.0)
    slip_velocity: float = quantity("m/s", "velocity above which the damper counts as slipping", above=0.0)

    def __post_init__(self) -> None:
        validate(self)
        if self.friction_law == "stribeck" and self.stribeck_friction < self.coulomb_friction:
            raise ConfigurationError(
                f"Damper.stribeck_friction: found {self.stribeck_friction!r} N, must be at least "
                f"coulomb_friction ({self.coulomb_friction!r} N)"
            )
        if self.viscous_law == "degressive" and self.degressive_viscous < self.viscous:
            raise ConfigurationError(
                f"Damper.degressive_viscous: found {self.degressive_viscous!r} N s/m, must be at least "
                f"viscous ({self.viscous!r} N s/m)"
            )
