"""Motion of both plates as arrays, one row a step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.excitation.signal import Signal
from vehicle.names import WHEELS

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlateArrays:
    """Displacement [m], velocity [m/s] and acceleration [m/s2] of the plates; (steps, 2) in the order of WHEELS."""

    displacement: Vector
    velocity: Vector
    acceleration: Vector

    @classmethod
    def of(cls, signal: Signal, times: Vector) -> PlateArrays:
        """Evaluate a signal at the times of the steps [s]."""
        motion = signal.plate_motion(times)
        displacement, velocity, acceleration = (
            np.stack([values[wheel] for wheel in WHEELS], axis=1)
            for values in (motion.displacement, motion.velocity, motion.acceleration)
        )
        return cls(displacement=displacement, velocity=velocity, acceleration=acceleration)
