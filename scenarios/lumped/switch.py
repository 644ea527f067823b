"""Switch model of set-valued Coulomb friction: a stick band in which two vector fields are mixed."""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Mask, Vector
from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class Switch:
    """F = (2 alpha - 1) Fd; alpha is 1 in positive slip, 0 in negative slip and mixes both inside the stick band.

    With h the relative velocity and f+, f- its rates under +Fd and -Fd:

    - |h| > eta: slip, alpha = 1 for h > 0 and 0 for h < 0;
    - |h| <= eta and f+ < 0 < f-: stick, alpha = (f- + h/tau) / (f- - f+), so that h' = -h/tau;
    - |h| <= eta otherwise: transition, alpha = 0 where both rates are negative, else 1.

    Source: Bommer 2006, appendix A, equations A.1 to A.5; Leine and Nijmeijer's switch model.
    """

    limit: Numbers = quantity("N", "Coulomb friction force Fd", at_least=0.0)
    band: Numbers = quantity("m/s", "half width eta of the stick band", above=0.0)
    return_time: Numbers = quantity("s", "time constant tau of the return to zero velocity", above=0.0)

    def __post_init__(self) -> None:
        validate(self)

    def mixing(self, velocity: Numbers, rate_plus: Numbers, rate_minus: Numbers) -> Vector:
        """Return the share alpha of the field with positive friction.

        Args:
            velocity: relative velocity h [m/s].
            rate_plus: its rate f+ [m/s2] with the friction +Fd acting against a positive velocity.
            rate_minus: its rate f- [m/s2] with the friction -Fd.

        Returns:
            alpha [-], in the broadcast shape of all arguments. In stick it exceeds [0, 1] by the small force
            that returns the velocity to zero.
        """
        h, plus, minus = np.broadcast_arrays(velocity, rate_plus, rate_minus)
        sticking = self.sticks(h, plus, minus)
        gap = np.where(sticking, minus - plus, 1.0)
        mixed = (minus + h / self.return_time) / gap
        slip = np.where(np.abs(h) > self.band, h > 0.0, ~((plus < 0.0) & (minus < 0.0)))
        return np.where(sticking, mixed, slip.astype(float))

    def sticks(self, velocity: Numbers, rate_plus: Numbers, rate_minus: Numbers) -> Mask:
        """Return True at elements in the attractive sliding mode (stick); arguments: see `mixing`."""
        h, plus, minus = np.broadcast_arrays(velocity, rate_plus, rate_minus)
        return np.asarray((np.abs(h) <= self.band) & (plus < 0.0) & (minus > 0.0))

    def force(self, velocity: Numbers, rate_plus: Numbers, rate_minus: Numbers) -> Vector:
        """Return the friction force [N] against a positive velocity; arguments: see `mixing`."""
        return np.asarray((2.0 * self.mixing(velocity, rate_plus, rate_minus) - 1.0) * self.limit)
