"""Motion of the plates as arrays, one row a step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.excitation.signal import Signal
from vehicle.simulation.acceleration import continued
from vehicle.simulation.step_weights import FOURTH_ORDER

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlateArrays:
    """Displacement [m], velocity [m/s] and acceleration [m/s2] of the plates; (steps, w).

    `row_velocity` (1 - delta2/12) velocity is what the tyre rows are given: averaged over three steps like the rest of
    their force, where the central difference alone would be weaker by w2 h2/12, 3 % of the damping at 100 Hz and 1 ms.
    """

    displacement: Vector
    velocity: Vector
    acceleration: Vector
    row_velocity: Vector

    @classmethod
    def of(cls, signal: Signal, times: Vector, wheels: Sequence[str], beyond: int = 0) -> PlateArrays:
        """Evaluate a signal on the plates of wheels at the times of the steps [s], and for some steps beyond them.

        Velocity and acceleration are the central differences that the step itself makes of every coordinate of the
        car: then the power that the plate puts in is exactly the power that the tyre takes up. (The derivatives of
        the spline differ from them by a share w2 h2/6, which at 28 Hz and 1 ms is 0.5 % of the power.)
        """
        motion = signal.plate_motion(times, wheels)
        step = times[1] - times[0]
        displacement = np.stack([motion.displacement[wheel] for wheel in wheels], axis=1)
        velocity, acceleration = np.zeros_like(displacement), np.zeros_like(displacement)
        velocity[1:-1] = (displacement[2:] - displacement[:-2]) / (2.0 * step)
        acceleration[1:-1] = (displacement[2:] - 2.0 * displacement[1:-1] + displacement[:-2]) / step**2
        for end in (0, -1):
            velocity[end] = [motion.velocity[wheel][end] for wheel in wheels]
            acceleration[end] = [motion.acceleration[wheel][end] for wheel in wheels]
        if beyond:
            after, ends = (
                step * np.arange(1.0, beyond + 1.0),
                zip(displacement[-1], velocity[-1], acceleration[-1], strict=True),
            )
            further = np.stack([continued(*end, after) for end in ends], axis=1)
            displacement = np.vstack([displacement, further])
            velocity = np.vstack([velocity, velocity[-1] + acceleration[-1] * after[:, None]])
            acceleration = np.vstack([acceleration, np.tile(acceleration[-1], (beyond, 1))])
        row_velocity = velocity.copy()
        row_velocity[1:-1] -= FOURTH_ORDER * np.diff(velocity, 2, axis=0)
        return cls(displacement=displacement, velocity=velocity, acceleration=acceleration, row_velocity=row_velocity)
