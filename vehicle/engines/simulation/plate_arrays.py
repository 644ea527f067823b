"""Motion of the plates as arrays with a row for each step.

Displacements are from the first sample of the signal: the car stands in equilibrium on plates at that height.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.recorded_acceleration import continued
from vehicle.engines.simulation.step_weights import FOURTH_ORDER
from vehicle.engines.simulation.tyre_variation import tread_motion
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.signals.excitation.signal import Signal

BLOCK = 2**18
"""Maximum number of rows in memory: two minutes at 0.5 ms."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PlateArrays:
    """Displacement [m], velocity [m/s] and acceleration [m/s2] of the plates; (steps, w).

    `row_velocity` is (1 - delta2/12) velocity, for the tyre rows: averaged over three steps like the other parts of
    their force. The central difference would be lower by w2 h2/12, 3 % of the damping at 100 Hz and 1 ms.
    `slope_velocity` is speed times slope of the road [m/s], averaged likewise: that of the signal, or `row_velocity`.
    `tread` and `tread_change` are the velocity of the treads along x [m/s] and its change [m/s2], see `tread_motion`.
    """

    displacement: Vector
    velocity: Vector
    acceleration: Vector
    row_velocity: Vector
    slope_velocity: Vector
    tread: Vector
    tread_change: Vector

    @classmethod
    def of(
        cls,
        signal: Signal,
        step: float,
        count: int,
        wheels: Sequence[str],
        beyond: int = 0,
        rows: slice = slice(None),
        forces: Sequence[PlacedForce] = (),
    ) -> PlateArrays:
        """Evaluate a signal on the plates of wheels at the ends of the steps, and for some steps beyond them.

        Velocity and acceleration are central differences, like those of the coordinates of the car in the integration:
        then the power of the plate is exactly the power into the tyre. (The derivatives of
        the spline differ from them by a share w2 h2/6, which at 28 Hz and 1 ms is 0.5 % of the power.)

        Args:
            signal: displacement of the plates.
            step: time step [s].
            count: number of steps; the arrays have count + 1 rows, the first at t = 0.
            wheels: names of the wheels.
            beyond: number of further rows, with constant acceleration of the plates.
            rows: slice of the rows; all by default.
            forces: applied forces, for the treads.
        """
        first, last, _ = rows.indices(count + 1 + beyond)
        # Averages need two rows on each side.
        begin, end = max(min(first - 2, count - 1), 0), min(last + 2, count + 1 + beyond)
        index = np.arange(begin, min(end, count + 1))
        motion = signal.plate_motion(step * index, wheels)
        level = [signal.displacement[wheel][0] if wheel in signal.wheels else 0.0 for wheel in wheels]
        displacement = np.stack([motion.displacement[wheel] for wheel in wheels], axis=1) - level
        velocity, acceleration = np.zeros_like(displacement), np.zeros_like(displacement)
        velocity[1:-1] = (displacement[2:] - displacement[:-2]) / (2.0 * step)
        acceleration[1:-1] = (displacement[2:] - 2.0 * displacement[1:-1] + displacement[:-2]) / step**2
        # A central difference lacks a neighbour at the ends of the signal: there the derivatives of the spline.
        for edge in (0, -1):
            if index[edge] in (0, count):
                velocity[edge] = [motion.velocity[wheel][edge] for wheel in wheels]
                acceleration[edge] = [motion.acceleration[wheel][edge] for wheel in wheels]
        further_rows = end - count - 1
        if further_rows > 0:
            after = step * np.arange(1.0, further_rows + 1.0)
            ends = zip(displacement[-1], velocity[-1], acceleration[-1], strict=True)
            further = np.stack([continued(*end, after) for end in ends], axis=1)
            displacement = np.vstack([displacement, further])
            velocity = np.vstack([velocity, velocity[-1] + acceleration[-1] * after[:, None]])
            acceleration = np.vstack([acceleration, np.tile(acceleration[-1], (further_rows, 1))])
        row_velocity = velocity.copy()
        row_velocity[1:-1] -= FOURTH_ORDER * np.diff(velocity, 2, axis=0)
        slope_velocity = row_velocity
        if signal.slope_velocity:
            slope_velocity = np.zeros_like(velocity)
            inside = step * index
            for column, wheel in enumerate(wheels):
                if wheel in signal.slope_velocity:
                    values = signal.slope_spline(wheel, inside[0], inside[-1])(np.minimum(inside, signal.duration))
                    slope_velocity[: len(index), column] = values
            # After the end the slope stays.
            slope_velocity[len(index) :] = slope_velocity[len(index) - 1]
            slope_velocity[1:-1] += FOURTH_ORDER * np.diff(slope_velocity, 2, axis=0)
        requested = slice(first - begin, last - begin)
        tread, tread_change = tread_motion(forces, wheels, step, first, last - first)
        return cls(
            displacement=displacement[requested],
            velocity=velocity[requested],
            acceleration=acceleration[requested],
            row_velocity=row_velocity[requested],
            slope_velocity=slope_velocity[requested],
            tread=tread,
            tread_change=tread_change,
        )


class PlateBlock:
    """Block of the rows of `PlateArrays` around the present step, in arrays with fixed addresses.

    Args:
        of: function that evaluates a slice of the rows.
        rows: total number of rows.
        level: height of the plates at rest [m]; (w,).
        unit: divisor of the first row of each block.
        minimum: minimum number of rows of a block.
        forces: function that returns the applied forces of a slice of the rows, (rows, f).

    Attributes:
        motion: rows of the block.
        offset: index of the first row of the block.
        height, velocity, acceleration, slope: values for the plates and for the tyre rows; (block, w).
        tread, tread_change: likewise; (block, w) or (block, 0).
        force: applied forces; (block, f).
    """

    def __init__(
        self,
        of: Callable[[slice], PlateArrays],
        rows: int,
        level: Vector,
        *,
        unit: int,
        minimum: int,
        forces: Callable[[slice], Vector],
    ) -> None:
        self.of, self.rows, self.level, self.unit, self.forces = of, rows, level, unit, forces
        shape = min(max(BLOCK, minimum), rows), len(level)
        self.height, self.velocity, self.acceleration, self.slope = np.zeros((4, *shape))
        self.force = np.zeros((shape[0], forces(slice(0, 1)).shape[1]))
        self.tread, self.tread_change = np.zeros((2, shape[0], of(slice(0, 1)).tread.shape[1]))
        self._load(0)

    def _load(self, offset: int) -> None:
        """Evaluate the block that starts at a row."""
        self.offset, self.end = offset, min(offset + len(self.height), self.rows)
        self.motion = self.of(slice(offset, self.end))
        size = self.end - offset
        self.height[:size] = self.level + self.motion.displacement
        self.velocity[:size], self.acceleration[:size] = self.motion.row_velocity, self.motion.acceleration
        self.slope[:size] = self.motion.slope_velocity
        self.tread[:size], self.tread_change[:size] = self.motion.tread, self.motion.tread_change
        self.force[:size] = self.forces(slice(offset, self.end))

    def reach(self, first: int, last: int) -> int:
        """Make the block contain the rows first to last, at most `minimum` - `unit` rows, and return its offset."""
        if not self.offset <= first <= last < self.end:
            self._load(first // self.unit * self.unit)
        return self.offset
