"""Curves and slopes of an axle on a kinematics rig: over wheel travel, in the design position, under load."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from vehicle.engines.simulation.axle_statics import AxleStatics, Vector, WheelPose

SMALL = 1e-3
"""Travel [m] to both sides for the central differences of the slopes in the design position."""

SLOPES = {
    "load_n": "wheel_rate_n_per_m",
    "camber_deg": "camber_deg_per_m",
    "toe_deg": "toe_deg_per_m",
    "lateral_m": "lateral_per_m",
    "patch_lateral_m": "patch_lateral_per_m",
    "strut_length_m": "spring_ratio",
}
"""Names of the slopes over the wheel travel, by the field of `WheelPose`."""


def travel_curve(
    axle: AxleStatics, travels: Sequence[float], *, opposite: bool = False, load: Vector | None = None
) -> list[WheelPose]:
    """Compute the poses of the right wheel over its travel.

    Args:
        axle: axle with two wheels, right and left.
        travels: ascending travels of the right wheel [m], upwards positive.
        opposite: True to move the left wheel by the negative travel and to reverse its load.
        load: force [N] and moment [N m] on each wheel at its contact point, in the axes of the car, (6,).

    Raises:
        SimulationError: the axle has no equilibrium at a travel; see `AxleStatics.solve`.
    """
    other = -1.0 if opposite else 1.0
    loads = None if load is None else np.array([load, other * load])
    # Start at the design position, so that every solution begins at a neighbouring one.
    poses = {}
    for part in ([z for z in travels[::-1] if z < 0.0], [z for z in travels if z >= 0.0]):
        for z in part:
            poses[z] = axle.solve([z, other * z], loads)[0]
    return [poses[z] for z in travels]


def design_slopes(axle: AxleStatics, *, opposite: bool = False, load: Vector | None = None) -> dict[str, float | None]:
    """Compute slopes over the wheel travel in the design position, by central differences over 1 mm.

    Args:
        axle, opposite, load: see `travel_curve`.

    Returns:
        Slope by the names in `SLOPES`; None for a quantity that is not defined with ideal joints.
    """
    other = -1.0 if opposite else 1.0
    loads = None if load is None else np.array([load, other * load])
    down, up = (axle.solve([z, other * z], loads)[0] for z in (-SMALL, SMALL))
    slopes = {name: (getattr(up, key) - getattr(down, key)) / (2.0 * SMALL) for key, name in SLOPES.items()}
    return {name: None if math.isnan(value) else value for name, value in slopes.items()}
