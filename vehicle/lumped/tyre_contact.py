"""Load of the tyres of the half car with rider over time, and the intervals in which a wheel leaves the road."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.lumped.half_car_rider import static_tyre_load
from vehicle.lumped.motion_history import MotionHistory
from vehicle.parameters.half_car_rider import HalfCarRiderParameters

Array = npt.NDArray[np.float64]


def linear_tyre_load(parameters: HalfCarRiderParameters, history: MotionHistory) -> Array:
    """Load of a tyre that is glued to the road [N]: static load + k (z - x) + c (z' - x').

    Args:
        parameters: the car.
        history: its motion.

    Returns:
        Front and rear load, shape (2, m); below zero the linear tyre pulls on the road, which no tyre can.
    """
    loads = []
    for axle, name, road, rate in zip(
        (parameters.front, parameters.rear), ("front_wheel", "rear_wheel"), history.road, history.road_rate, strict=True
    ):
        wheel = {name: 1.0}
        loads.append(
            axle.tyre_stiffness * (road - history.of(wheel))
            + axle.tyre_damping * (rate - history.of(wheel, "velocity"))
        )
    return np.asarray(static_tyre_load(parameters)[:, None] + np.stack(loads))


def lift_off(time: npt.ArrayLike, load: npt.ArrayLike) -> list[tuple[float, float]]:
    """Intervals in which a tyre load is not positive.

    Args:
        time: [s], shape (m,).
        load: [N], shape (m,).

    Returns:
        Start and end of each interval [s]: its first and last sample.
    """
    instants, off = np.asarray(time, dtype=float), np.asarray(load, dtype=float) <= 0.0
    edges = np.diff(np.concatenate(([False], off, [False])).astype(int))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return [(float(instants[a]), float(instants[b])) for a, b in zip(starts, ends, strict=True)]
