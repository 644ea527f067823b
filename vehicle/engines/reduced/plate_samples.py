"""Displacement and velocity of the driven plates at the ends of the steps, and the same of applied forces.

An applied force F is an input like the velocity z' of a plate that exerts no other force: its "displacement" is the
integral of F, of which only the difference over a step counts.

Displacements are from the first sample of the signal: the car stands in equilibrium on plates at that height.

A road whose slope is not the derivative of its height exerts the force of V tan(beta) - z' in addition. It is constant
over a step: d - delta2(d)/24 with d in the middle of the step, so that the error of a held value, (w h)^2/24, cancels.
"""

from functools import lru_cache

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.recorded_acceleration import continued
from vehicle.signals.excitation.force_lines import ForceLines
from vehicle.signals.excitation.signal import Signal

LARGEST_TABLE = 64_000_000
"""Maximum size of a cached table [byte]: 80 s of both plates at 8 kHz. Longer tables are computed in slices, so
that memory does not grow with the steps of a long record."""


class LongPlateSamples:
    """Rows of `plate_samples`, computed on access; same arguments."""

    def __init__(self, signal: Signal, step: float, steps: int, beyond: int) -> None:
        self.signal, self.step, self.steps, self.rows = signal, step, steps, steps + 1 + beyond

    def __getitem__(self, part: slice) -> Vector:
        """Return the rows of a slice: (z, z', V tan(beta) - z' of the step that begins there) of each driven plate."""
        index, signal = np.arange(*part.indices(self.rows)), self.signal
        inside, last = index <= self.steps, min(self.step * self.steps, signal.duration)
        at = np.clip(self.step * index[inside], 0.0, signal.duration)
        after = np.asarray(self.step * (index[~inside] - self.steps), dtype=np.float64)
        begin, end = float(at[0]) if at.size else last, last if after.size else float(at[-1])
        columns = []
        # Middles of the steps, with those before and after.
        # One middle before the first step and one after the last, for the second difference.
        around = np.append(index, index[-1] + 1 + np.arange(2)) - 0.5
        middle = np.clip(self.step * around, 0.0, last)
        for wheel in signal.wheels:
            spline = signal.spline(wheel, begin, end)
            z, velocity, acceleration = (float(spline(last, order)) for order in range(3))
            displacement = np.append(spline(at), continued(z, velocity, acceleration, after))
            # From the last sample on the plate goes on with constant acceleration, so that no jump enters the last
            # second difference.
            columns.append(displacement - signal.displacement[wheel][0])
            columns.append(np.append(spline(at, 1), velocity + acceleration * after))
            excess = np.zeros(len(index))
            if signal.slope_velocity and len(index):
                slope = signal.slope_spline(wheel, float(middle[0]), float(middle[-1]))
                values = slope(middle) - spline(middle, 1)
                # Delta2/24: see above.
                excess = values[1:-1] - np.diff(values, 2) / 24.0
            columns.append(excess)
        return np.stack(columns, axis=1)


class InputSamples:
    """Rows of `plate_samples`, followed by (integral of h, h, 0) of each history h of applied forces.

    Args:
        plates: rows of the plates.
        lines: frequencies of the forces.
        step: time step [s].
    """

    def __init__(self, plates: Vector | LongPlateSamples, lines: ForceLines, step: float) -> None:
        self.plates, self.lines, self.step = plates, lines, step

    def __getitem__(self, part: slice) -> Vector:
        """Return consecutive rows; the integrals begin at zero in each slice."""
        plates = self.plates[part]
        time = self.step * (part.start + np.arange(len(plates)))
        columns = np.zeros((len(time), len(self.lines), 3))
        columns[:, :, 1], means = self.lines.sampled(time, self.step)
        # The integral of h, whose difference over a step is h times the mean force: the mean "velocity" of this input.
        columns[1:, :, 0] = self.step * np.cumsum(means, axis=0)
        return np.hstack([plates, columns.reshape(len(time), 3 * len(self.lines))])


def plate_samples(signal: Signal, step: float, steps: int, beyond: int) -> Vector | LongPlateSamples:
    """Return (z, z', excess of V tan(beta)) of each driven plate [m, m/s]; (steps + 1 + beyond, 3 per plate).

    Args:
        signal: displacement of the plates.
        step: time step [s].
        steps: number of steps.
        beyond: number of further steps after the end, with the last acceleration.
    """
    long = 24 * (steps + 1 + beyond) * len(signal.wheels) > LARGEST_TABLE
    return (LongPlateSamples if long else _table)(signal, step, steps, beyond)


# A sweep runs hundreds of cars over the same few signals.
@lru_cache(maxsize=4)
def _table(signal: Signal, step: float, steps: int, beyond: int) -> Vector:
    """Return all rows as a read-only table."""
    table = LongPlateSamples(signal, step, steps, beyond)[:]
    table.setflags(write=False)
    return table
