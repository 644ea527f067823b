"""Forces that a vehicle file applies to parts of the car: numbers of their histories."""

import cmath
import math
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import quantity, validate

CRANK = "crank"
"""Name of the angle of the crankshaft."""

HIGHEST_ORDER = 100.0
"""Largest order of a harmonic."""

Harmonics = tuple[tuple[float, ...], ...]
"""Lists of order [-], amplitude and phase [deg]: the sum of A cos(order angle + phase)."""


def require_harmonics(
    path: str, harmonics: Harmonics, remedy: str = "for the constant part set mean", *, of_wheel: bool = False
) -> None:
    """Check the harmonics of a history.

    Args:
        path: their path, for messages.
        harmonics: lists of order, amplitude and phase [deg].
        remedy: what to do in place of order 0.
        of_wheel: whole orders only.

    Raises:
        ConfigurationError: a list is no harmonic, or an order is wrong or twice there.
    """
    orders = []
    for harmonic in harmonics:
        message = f"{path}: found {list(harmonic)}"
        if len(harmonic) != 3 or not all(map(math.isfinite, harmonic)):
            raise ConfigurationError(f"{message}, must be three finite numbers: order, amplitude, phase [deg]")
        order, amplitude, _ = harmonic
        if order == 0.0:
            raise ConfigurationError(f"{message}, of order 0; {remedy}")
        if not 0.0 < order <= HIGHEST_ORDER:
            raise ConfigurationError(f"{message}; the order must be above 0 and at most {HIGHEST_ORDER:g}")
        if of_wheel and order % 1.0:
            raise ConfigurationError(
                f'{path}: found a half order, but a wheel has whole orders only; use whole orders, or angle = "crank"'
            )
        if amplitude < 0.0:
            raise ConfigurationError(
                f"{message}; the amplitude must be at least 0; for the opposite sign add 180 degrees to the phase"
            )
        if order in orders:
            raise ConfigurationError(f"{message} repeats order {order:g}; give each order once")
        orders.append(order)


@dataclass(frozen=True, kw_only=True, slots=True)
class AppliedForce:
    """History of a force or a moment: F(t) = mean + factor g sum of A cos(order angle + phase), or of a file.

    g is 1, or the square of the frequency of the angle over `reference_frequency`. Harmonics rise from rest within the
    first second, like a road; the mean acts always, also in the equilibrium from which the car starts. A file of a
    measured history takes the place of the harmonics: F(t) = mean + factor times its channel.
    """

    harmonics: Harmonics = ()
    """lists of order [-], amplitude A [N or N m] and phase [deg]"""
    angle: str | None = quantity(
        "-",
        "rotating part whose angle the orders refer to: crank, or a wheel, for example wheel_fr; leave it "
        "out if frequency is set",
        default=None,
    )
    frequency: float | None = quantity(
        "Hz", "frequency of order 1, instead of a rotating part", above=0.0, at_most=500.0, default=None
    )
    reference_frequency: float | None = quantity(
        "Hz",
        "frequency of the given amplitudes, which grow with its square; default: constant amplitudes",
        above=0.0, at_most=500.0, default=None,
    )  # fmt: skip
    mean: float = quantity(
        "N", "constant part [N or N m]; the car starts in equilibrium with it", at_least=-1e5, at_most=1e5, default=0.0
    )
    factor: float = quantity(
        "-", "factor on all harmonics, or on the history from the file", at_least=-1e3, at_most=1e3, default=1.0
    )
    file: str | None = quantity("-", "file with a measured history, instead of harmonics", is_file=True, default=None)
    channel: str | None = quantity(
        "-",
        "channel of the file by number, name or pattern; default: the only channel in N or N m",
        is_file=True,
        default=None,
    )
    unit: str | None = quantity(
        "-", "unit of the channel, replaces the unit in the file, for example lbf", is_file=True, default=None
    )
    ends_at_zero: bool = False
    """true for a file that is shorter than the run: the force is zero after its end"""
    enabled: bool = True
    """false leaves the force out"""

    def __post_init__(self) -> None:
        validate(self)
        if self.file is None and (self.channel, self.unit, self.ends_at_zero) != (None, None, False):
            raise ConfigurationError(
                "AppliedForce.file: missing, but channel, unit or ends_at_zero is set; set file, or remove them"
            )
        if self.file is not None and self.harmonics:
            raise ConfigurationError("AppliedForce.file: found together with harmonics; keep one, or define two forces")
        require_harmonics("AppliedForce.harmonics", self.harmonics)
        if self.harmonics and (self.angle is None) == (self.frequency is None):
            raise ConfigurationError(
                "AppliedForce.angle: set either angle (crank, or a wheel, for example wheel_fr) or frequency [Hz]"
            )

    def amplitudes(self, speed: float) -> dict[float, complex]:
        """Return the harmonics: angular frequency [rad/s] to complex amplitude Z of Re(Z exp(i W t)).

        Args:
            speed: angular speed of the angle [rad/s]; 0 for an angle at rest, whose harmonics are constant: left out.
        """
        if not self.enabled or speed == 0.0:
            return {}
        growth = 1.0
        if self.reference_frequency is not None:
            growth = (speed / (2.0 * math.pi * self.reference_frequency)) ** 2
        return {
            order * speed: cmath.rect(self.factor * growth * amplitude, math.radians(phase))
            for order, amplitude, phase in self.harmonics
        }
