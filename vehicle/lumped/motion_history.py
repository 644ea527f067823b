"""Motion of a lumped model over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MotionHistory:
    """Coordinates of a model at uniform times, road included."""

    coordinates: tuple[str, ...]
    time: Array
    """[s], shape (m,)."""
    displacement: Array
    """x [m or rad], shape (n, m)."""
    velocity: Array
    """x' [m/s or rad/s], shape (n, m)."""
    acceleration: Array
    """x'' [m/s2 or rad/s2], shape (n, m)."""
    road: Array
    """z [m], shape (w, m)."""
    road_rate: Array
    """z' [m/s], shape (w, m)."""
    suspension_damping: Array | None = None
    """Damper coefficient of each end where it was controlled [N s/m], shape (w, m)."""

    def of(self, form: Mapping[str, float], quantity: str = "displacement") -> Array:
        """Time history of a linear form of the coordinates, shape (m,).

        Args:
            form: coordinate -> coefficient.
            quantity: "displacement", "velocity" or "acceleration".
        """
        motion: Array = getattr(self, quantity)
        total = np.zeros_like(self.time)
        for name, coefficient in form.items():
            total += coefficient * motion[self.coordinates.index(name)]
        return total
