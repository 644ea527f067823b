"""Curves and slopes of an axle on its rig: over wheel travel, in the design position, under load."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from vehicle.engines.simulation.axle_statics import AxleStatics, Vector, WheelPose

SMALL = 1e-3
"""Travel [m] to both sides over which slopes in the design position are taken."""

SLOPES = {
    "load_n": "wheel_rate_n_per_m",
    "camber_deg": "camber_deg_per_m",
    "toe_deg": "toe_deg_per_m",
    "lateral_m": "lateral_per_m",
    "patch_lateral_m": "patch_lateral_per_m",
    "strut_length_m": "spring_ratio",
}
"""Quantity of a pose to the name of its slope over the wheel travel."""


def travel_curve(
    axle: AxleStatics, travels: Sequence[float], *, opposite: bool = False, load: Vector | None = None
) -> list[WheelPose]:
    """Poses of the right wheel over its travel.

    Args:
        axle: with two wheels, right and left.
        travels: of the right wheel [m], upwards; ascending.
        opposite: the left wheel goes down where the right one goes up, and its load is turned round.
        load: force [N] and moment [N m] on each wheel at its contact point, in the axes of the car, (6,).

    Raises:
        SimulationError: as of `AxleStatics.solve`.
    """
    other = -1.0 if opposite else 1.0
    loads = None if load is None else np.array([load, other * load])
    # From the design position outwards, so that every solution begins at its neighbour.
    found = {}
    for part in ([z for z in travels[::-1] if z < 0.0], [z for z in travels if z >= 0.0]):
        for z in part:
            found[z] = axle.solve([z, other * z], loads)[0]
    return [found[z] for z in travels]


def design_slopes(axle: AxleStatics, *, opposite: bool = False, load: Vector | None = None) -> dict[str, float | None]:
    """Slopes over the wheel travel in the design position, by central differences over 1 mm.

    Args:
        axle, opposite, load: as of `travel_curve`.

    Returns:
        By the names in `SLOPES`; None for what ideal joints do not have.
    """
    other = -1.0 if opposite else 1.0
    loads = None if load is None else np.array([load, other * load])
    down, up = (axle.solve([z, other * z], loads)[0] for z in (-SMALL, SMALL))
    slopes = {name: (getattr(up, key) - getattr(down, key)) / (2.0 * SMALL) for key, name in SLOPES.items()}
    return {name: None if math.isnan(value) else value for name, value in slopes.items()}
