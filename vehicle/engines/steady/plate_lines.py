"""Lines of plates that repeat: the cubic spline of their samples, continued over all periods.

The spline of a run in time has, at the frequency f in sampling rates, the lines of the samples times
sinc^4(f) 3/(2 + cos 2 pi f), and so have their images beyond half the sampling rate (Unser, IEEE Signal Processing
Magazine 16(6), 1999).
"""

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.errors import DataError
from vehicle.signals.excitation.signal import Signal

JUMP = 0.01
"""Largest jump from the end of a period to its start, over the RMS of the change between two samples: a period then
has one change more, of a hundredth of the others."""


def require_period(signal: Signal, begin: float) -> None:
    """Check that a signal from a time on is one period, whose last sample is the first of the next one.

    Raises:
        DataError: the ends of a plate differ, or no plate moves.
    """
    first = round(begin / signal.timestep)
    moving = False
    for wheel in signal.wheels:
        values = signal.displacement[wheel][first:]
        jump, usual = float(values[-1] - values[0]), float(np.sqrt(np.mean(np.diff(values) ** 2)))
        moving = moving or usual > 0.0
        if abs(jump) > JUMP * usual:
            raise DataError(
                f"{signal.source}: plate {wheel} ends {1e3 * jump:.3g} mm above its start, so it does not repeat; cut "
                "the signal to whole periods, its last sample the first of the next period, or use Car.run"
            )
    if not moving:
        raise DataError(f"{signal.source}: no plate moves; give a signal with a motion")


def plate_lines(signal: Signal, wheels: tuple[str, ...], begin: float, count: int) -> Complex:
    """Return c_k of the plates z = Re sum of c_k exp(j k w t) [m], from the first sample of the signal; (w, count).

    Args:
        signal: displacement of the plates; one period from `begin` [s] on.
        wheels: wheels of the rows; plates without a signal are at rest.
        count: number of lines, from k = 0 on.
    """
    first = round(begin / signal.timestep)
    samples, k = signal.time.size - 1 - first, np.arange(count)
    result = np.zeros((len(wheels), count), dtype=complex)
    for wheel in signal.wheels:
        values = signal.displacement[wheel]
        spectrum = np.fft.fft(values[first:-1] - values[0]) * (2.0 / samples)
        result[wheels.index(wheel)] = spectrum[k % samples] * spline_gain(k / samples)
    result[:, 0] *= 0.5
    return result


def spline_gain(frequency: Vector) -> Vector:
    """Return the gain of a cubic spline through samples; frequency in sampling rates, (m,)."""
    return np.asarray(3.0 * np.sinc(frequency) ** 4 / (2.0 + np.cos(2.0 * np.pi * frequency)))
