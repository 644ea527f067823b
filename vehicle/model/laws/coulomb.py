"""Coulomb friction: the same limit at every velocity.

The set-valued form is computed by a switch (`scenarios.lumped.switch`).
"""

from dataclasses import dataclass
from typing import Any

from vehicle.model.laws.friction import Friction


@dataclass(frozen=True, kw_only=True, slots=True)
class Coulomb(Friction):
    """L = Fd.

    Source: Bommer 2006, equation 2.4.
    """

    @staticmethod
    def limit_at(velocity: Any, numbers: Any) -> Any:
        """Return Fd [N]."""
        return numbers["friction_limit"]

    @staticmethod
    def fall_at(velocity: Any, numbers: Any) -> Any:
        """Return v dL/dv = 0 [N]."""
        return 0.0
