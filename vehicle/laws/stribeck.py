"""Stribeck friction: the static limit falls to the sliding limit as the velocity grows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.laws.law import Numbers, validate
from vehicle.parameters.quantity import quantity


@dataclass(frozen=True, kw_only=True, slots=True)
class Stribeck:
    """F = (Fd + (Fs - Fd) exp(-|v/vs|^delta)) (2/pi) atan(eps v).

    Source: Bommer 2006, equation 3.2; Armstrong-Helouvry 1990.
    """

    sliding_limit: Numbers = quantity("N", "friction force Fd in fast sliding", at_least=0.0)
    static_limit: Numbers = quantity("N", "friction force Fs near rest", at_least=0.0)
    stribeck_velocity: Numbers = quantity("m/s", "velocity vs of the transition", above=0.0)
    exponent: Numbers = quantity("-", "exponent delta of the transition", above=0.0)
    steepness: Numbers = quantity("s/m", "smoothing parameter eps", above=0.0)

    def __post_init__(self) -> None:
        validate(self)
        static, sliding = np.broadcast_arrays(self.static_limit, self.sliding_limit)
        if (static < sliding).any():
            at = static < sliding
            raise ConfigurationError(
                f"Stribeck.static_limit: found {float(static[at].flat[0])!r} N, must be at least the sliding limit "
                f"{float(sliding[at].flat[0])!r} N; raise static_limit or lower sliding_limit"
            )

    def limit(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Friction limit Fd + (Fs - Fd) exp(-|v/vs|^delta) [N] at a velocity [m/s]."""
        return np.asarray(
            self.sliding_limit + (self.static_limit - self.sliding_limit) * np.exp(-self._power(velocity))
        )

    def force(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Force [N] at a velocity [m/s]."""
        return self.limit(velocity) * (2.0 / np.pi) * np.arctan(self.steepness * np.asarray(velocity))

    def slope(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """Derivative d F / d v [N s/m]."""
        v = np.asarray(velocity, dtype=float)
        scaled = self.steepness * v
        power = self._power(v)
        excess = (self.static_limit - self.sliding_limit) * np.exp(-power)
        # d limit/d v holds |v|^delta / v, written so that v = 0 divides nothing: atan(eps v)/v tends to eps there.
        moving = v != 0.0
        ratio = np.where(moving, np.arctan(scaled) / np.where(moving, v, 1.0), self.steepness)
        falling = -excess * self.exponent * power * ratio
        rising = (self.sliding_limit + excess) * self.steepness / (1.0 + scaled * scaled)
        return np.asarray((2.0 / np.pi) * (falling + rising))

    def _power(self, velocity: Numbers) -> npt.NDArray[np.float64]:
        """|v/vs|^delta, capped where exp(-x) is zero anyway so that no velocity overflows."""
        ratio = np.abs(velocity) / self.stribeck_velocity
        return np.minimum(ratio, 700.0 ** (1.0 / np.asarray(self.exponent))) ** self.exponent
