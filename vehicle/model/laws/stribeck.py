"""Stribeck friction: the static limit falls to the sliding limit as the velocity grows."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.laws.friction import Friction
from vehicle.model.laws.law import Numbers
from vehicle.model.parameters.quantity import quantity

FASTEST = 1e15
"""Maximum ratio v/vs, at which the limit is that of sliding; its power up to 20 does not overflow."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Stribeck(Friction):
    """L = Fd + (Fs - Fd) exp(-|v/vs|^delta).

    Source: Bommer 2006, equation 3.2; Armstrong-Helouvry 1990.
    """

    static_limit: Numbers = quantity("N", "friction limit Fs near rest (static friction)", at_least=0.0)
    stribeck_velocity: Numbers = quantity(
        "m/s", "velocity vs of the transition from static to sliding friction", above=0.0
    )
    stribeck_exponent: Numbers = quantity(
        "-", "exponent delta of the transition from static to sliding friction", above=0.0, at_most=20.0
    )

    def __post_init__(self) -> None:
        Friction.__post_init__(self)
        static, sliding = np.broadcast_arrays(self.static_limit, self.friction_limit)
        if (static < sliding).any():
            at = static < sliding
            raise ConfigurationError(
                f"Stribeck.static_limit: found {float(static[at].flat[0])!r} N, must be at least the friction limit "
                f"{float(sliding[at].flat[0])!r} N; raise static_limit or lower friction_limit"
            )

    @staticmethod
    def limit_at(velocity: Any, numbers: Any) -> Any:
        """Return Fd + (Fs - Fd) exp(-|v/vs|^delta) [N]."""
        ratio = np.minimum(np.abs(velocity / numbers["stribeck_velocity"]), FASTEST)
        weight = np.exp(-(ratio ** numbers["stribeck_exponent"]))
        return numbers["friction_limit"] + (numbers["static_limit"] - numbers["friction_limit"]) * weight

    @staticmethod
    def fall_at(velocity: Any, numbers: Any) -> Any:
        """Return v dL/dv = -(Fs - Fd) delta |v/vs|^delta exp(-|v/vs|^delta) [N]."""
        ratio = np.minimum(np.abs(velocity / numbers["stribeck_velocity"]), FASTEST)
        power = ratio ** numbers["stribeck_exponent"]
        excess = (numbers["static_limit"] - numbers["friction_limit"]) * np.exp(-power)
        return -excess * numbers["stribeck_exponent"] * power
