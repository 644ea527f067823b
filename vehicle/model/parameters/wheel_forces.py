"""What turns with a wheel and shakes it: imbalance, non-uniformity of its tyre, variation of its brake torque.

A wheel of a car that drives along -x turns at -V/R about y. A mark on it at (x, z) = r (cos theta, sin theta) has
theta' = V/R. Harmonics are A cos(order theta + phase) with theta = 0 at t = 0. Sources: Genta, Dynamics of Rotating
Systems, 2005, chapter 1 (imbalance); Pacejka, Tire and Vehicle Dynamics, 3rd ed., chapter 8.
"""

from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.applied_force import Harmonics, require_harmonics
from vehicle.model.parameters.quantity import Validated, quantity

LARGEST_RUNOUT = 5e-3
"""Largest amplitude of a radius [m]: 0.3 mm is typical, and above 5 mm no tyre is round."""

LARGEST_VARIATION = 1000.0
"""Largest amplitude of a force [N] of a tyre, and of a torque [N m] of a brake; good tyres have 40 to 80 N."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Imbalance(Validated):
    """Mass on the rim that turns with the wheel: a force of m r (V/R)^2 from the axle to the mass.

    The mass is the imbalance alone: it is no part of the mass of the wheel, and its weight, 0.3 % of the force
    at 80 km/h, is left out.
    """

    mass: float = quantity(
        "kg", "mass of the imbalance", at_least=0.0, at_most=0.5, why="20 g is 0.02; balanced wheels have 5 to 10 g"
    )
    radius: float = quantity("m", "distance of the mass from the axle", above=0.0, at_most=1.0)
    angle: float = quantity("deg", "position of the mass at t = 0: 0 to the rear, 90 at the top", default=0.0)
    offset: float = quantity(
        "m", "distance of the mass from the middle of the wheel, outwards", at_least=-0.5, at_most=0.5, default=0.0
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class Nonuniformity:
    """Deviations of a tyre from a uniform one, as harmonics of its angle at the contact with the road.

    The run-out r lifts the wheel like a road of this height without slope: the tyre takes z + r. A radial force
    variation F at a locked axle is the run-out F/k of the tyre with the vertical stiffness k. The lateral force acts on
    the wheel at the contact patch. A deviation d of the rolling radius gives the tread the velocity d V/R along x, a
    part of the slip.
    """

    runout: Harmonics = ()
    """lists of order [-], amplitude of the radius at the road [m] and phase [deg]"""
    rfv: Harmonics = ()
    """lists of order [-], amplitude of the radial force at a locked axle [N] and phase [deg], in place of runout"""
    lfv: Harmonics = ()
    """lists of order [-], amplitude of the lateral force at a locked axle [N], outwards, and phase [deg]"""
    rolling_runout: Harmonics = ()
    """lists of order [-], amplitude of the effective rolling radius [m] and phase [deg]: tangential force variation"""

    def __post_init__(self) -> None:
        if self.runout and self.rfv:
            raise ConfigurationError(
                "Nonuniformity.rfv: found together with runout; remove one of them, because a radial force "
                "variation contains the run-out"
            )
        for name, largest, unit in (
            ("runout", LARGEST_RUNOUT, "m"),
            ("rfv", LARGEST_VARIATION, "N"),
            ("lfv", LARGEST_VARIATION, "N"),
            ("rolling_runout", LARGEST_RUNOUT, "m"),
        ):
            _require_turning(f"Nonuniformity.{name}", getattr(self, name), largest, unit)


@dataclass(frozen=True, kw_only=True, slots=True)
class BrakeVariation:
    """Variation of the brake torque over the angle of a wheel, by the thickness of its disc: wheel against knuckle.

    The mean torque is left out: a car that brakes is not at a constant speed.
    """

    torque: Harmonics = ()
    """lists of order [-], amplitude of the torque [N m], positive where it brakes more, and phase [deg]"""

    def __post_init__(self) -> None:
        _require_turning("BrakeVariation.torque", self.torque, LARGEST_VARIATION, "N m")


def _require_turning(path: str, harmonics: Harmonics, largest: float, unit: str) -> None:
    """Check harmonics of a wheel, and their amplitudes."""
    require_harmonics(path, harmonics, "a constant part shakes nothing; leave it out", of_wheel=True)
    for _, amplitude, _ in harmonics:
        if amplitude > largest:
            raise ConfigurationError(
                f"{path}: found an amplitude of {amplitude:g} {unit}, must be at most {largest:g} {unit}"
                + ("; 0.3 mm is 0.3e-3" if unit == "m" else "")
            )


WHEEL_FORCES: dict[str, type] = {
    "imbalance": Imbalance,
    "nonuniformity": Nonuniformity,
    "brake_variation": BrakeVariation,
}
"""Tables of an axle for what turns with its wheels, and their parameter classes."""
