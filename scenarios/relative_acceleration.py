"""Acceleration of the damper top relative to the knuckle along the strut: zero while the damper sticks."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.car import Run
from vehicle.names import AXES


def relative_acceleration(run: Run, wheel: str = "fr") -> npt.NDArray[np.float64]:
    """Acceleration of the damper top less that of the knuckle, along the strut axis.

    a = n (a_top - a_knuckle), n from the damper bottom to the strut top in the design position. In the vertical alone
    the rotation of the strut would show while it sticks.

    Args:
        run: a finished run.
        wheel: of the damper.

    Returns:
        [m/s2], shape (n,).
    """
    points = run.car.vehicle.hardpoints.all_points()
    axis = np.array(points[f"strut_top_{wheel}"]) - np.array(points[f"damper_bottom_{wheel}"])
    direction = axis / np.linalg.norm(axis)
    top, knuckle = (
        np.array([run[f"{place}_{wheel}_acc_{name}"] for name in AXES]) for place in ("damper_top", "knuckle")
    )
    return np.asarray(direction @ (top - knuckle))
