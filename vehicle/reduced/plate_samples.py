"""Height and velocity of the driven plates at the ends of the steps, once per signal."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from vehicle.excitation.signal import Signal
from vehicle.names import WHEELS

Vector = npt.NDArray[np.float64]


# A sweep runs hundreds of cars over the same few signals.
@lru_cache(maxsize=4)
def plate_samples(signal: Signal, step: float, steps: int) -> Vector:
    """(z, z') of each driven plate [m, m/s], from the spline of the signal; (steps + 1, 2 per driven plate).

    Args:
        signal: displacement of the plates.
        step: time step [s].
        steps: number of steps.
    """
    motion = signal.plate_motion(step * np.arange(steps + 1))
    columns = []
    for wheel in WHEELS:
        if wheel in signal.wheels:
            columns += [motion.displacement[wheel], motion.velocity[wheel]]
    table = np.stack(columns, axis=1)
    table.setflags(write=False)
    return table
