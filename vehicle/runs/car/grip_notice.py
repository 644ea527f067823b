"""Notice on a ride in steady acceleration during which a tyre has less load than its horizontal force needs."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number


def grip_notice(car: Any, channels: Mapping[str, Vector]) -> tuple[str, ...]:
    """Return text on the tyre that would slide longest, because its steady force exceeds friction times its load.

    Args:
        car: the car.
        channels: its run, with the loads of the tyres.
    """
    friction, short = car.vehicle.driving.friction, dict[str, tuple[float, float]]()
    for wheel, held in car.static.tyre_grip.items():
        if (load := channels.get(f"tyre_{wheel}_force_z")) is not None:
            short[wheel] = float(np.mean(friction * load < held)), float(np.min(load))
    wheel = max(short, key=lambda name: short[name][0], default="")
    if not wheel or not short[wheel][0]:
        return ()
    share, lowest = short[wheel]
    return (
        f"tyre {wheel} would slide for {number(100.0 * share, 2)} % of the time: its steady force of "
        f"{number(car.static.tyre_grip[wheel])} N needs at least {number(car.static.tyre_grip[wheel] / friction)} N of "
        f"load at driving.friction {friction:g}, and its lowest load is {number(lowest)} N; the run keeps the force",
    )
