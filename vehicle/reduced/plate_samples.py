"""Height and velocity of the driven plates at the ends of the steps, once per signal."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from vehicle.excitation.signal import Signal
from vehicle.simulation.acceleration import continued

Vector = npt.NDArray[np.float64]


# A sweep runs hundreds of cars over the same few signals.
@lru_cache(maxsize=4)
def plate_samples(signal: Signal, step: float, steps: int, beyond: int) -> Vector:
    """(z, z') of each driven plate [m, m/s], from the spline of the signal; (steps + 1 + beyond, 2 per driven plate).

    Args:
        signal: displacement of the plates.
        step: time step [s].
        steps: number of steps.
        beyond: further steps with the last acceleration.
    """
    motion = signal.plate_motion(step * np.arange(steps + 1))
    after, columns = step * np.arange(1.0, beyond + 1.0), []
    for wheel in signal.wheels:
        z, velocity, last = (values[wheel] for values in (motion.displacement, motion.velocity, motion.acceleration))
        columns.append(np.append(z, continued(z[-1], velocity[-1], last[-1], after)))
        columns.append(np.append(velocity, velocity[-1] + last[-1] * after))
    table = np.stack(columns, axis=1)
    table.setflags(write=False)
    return table
