"""Accelerations of output points from their sampled positions, by a definition common to both engines.

The second difference of a position over the sampling interval T is the mean of the true acceleration under a triangle
two intervals wide: it contains all motion between the samples, for any step of the engine, and attenuates
high frequencies before sampling by sinc^2(f T). The series of the second derivative compensates this,

    a T^2 = (1 + u/12 + u^2/90 + u^3/560 - c u^4) delta^2 x,   u = -delta^2,   delta^2 x = x(t + T) - 2 x(t) + x(t - T)

(Fornberg, Math. Comp. 51, 1988, table 1, to order eight). The last term, c = 0.0063, takes the gain to zero at half
the sampling rate, where a record at the step of the engine has no valid content. At 1 kHz it is 0.0001 % low at
50 Hz, 0.014 % at 100 Hz, 0.3 % at 150 Hz, 2.4 % at 200 Hz. Short impacts of a low-mass part after stick-slip reach
frequencies up to the step of the engine: their aliases below 100 Hz are attenuated by 38 dB and more. The filter is
symmetric, so it has no delay. Before the record the car is at rest; the engines continue for five samples after its
end, with constant acceleration of the plates. Positions on the body include the rotated modal displacement d, so that
their differences include the second-order terms 2 w x d' and w x (w x d), which a sum of accelerations would omit.
"""

import numpy as np

from vehicle.arrays import Vector

SERIES = (1.0, 1.0 / 12.0, 1.0 / 90.0, 1.0 / 560.0)
"""Coefficients of the powers of u."""

AHEAD = len(SERIES) + 1
"""Number of samples after the end of a record that its last acceleration needs."""

BLOCK = 65_536
"""Number of samples in a block of the convolution."""


def _weights() -> Vector:
    """Return the filter weights of the 2 AHEAD + 1 samples around a sample, for T = 1."""
    difference = np.array([1.0, -2.0, 1.0])
    # u is 4 at half the sampling rate.
    closing = -sum(factor * 4.0**power for power, factor in enumerate(SERIES)) / 4.0 ** len(SERIES)
    weights, term = np.zeros(2 * AHEAD + 1), difference
    for factor in (*SERIES, closing):
        margin = (weights.size - term.size) // 2
        weights[margin : weights.size - margin] += factor * term
        # The next power of u = -delta^2; each is two samples wider.
        term = -np.convolve(term, difference)
    return weights


WEIGHTS = _weights()


def acceleration(position: Vector, interval: float) -> Vector:
    """Compute the second time derivative [unit/s2] of a record in place, a view of its first n values; (n,).

    Args:
        position: positions at the n samples of the record and AHEAD more, in any unit, overwritten; (n + AHEAD,).
        interval: sampling interval T [s].
    """
    count, initial, past = position.size - AHEAD, position[0], np.zeros(AHEAD)
    for first in range(0, count, BLOCK):
        size = min(BLOCK, count - first)
        moved = np.concatenate([past, position[first : first + size + AHEAD] - initial])
        past = moved[size : size + AHEAD]
        position[first : first + size] = np.convolve(moved, WEIGHTS / interval**2, "valid")
    return position[:count]


def continued(displacement: float, velocity: float, acceleration: float, t: Vector) -> Vector:
    """Extrapolate a plate displacement with constant acceleration over times t [s]: z + z' t + z'' t^2 / 2."""
    return displacement + velocity * t + 0.5 * acceleration * t**2


def acceleration_gain(angle: Vector) -> Vector:
    """Return the gain of a recorded acceleration over its displacement, times the square of the sampling interval.

    Args:
        angle: angular frequency times sampling interval; (m,).
    """
    return np.asarray(WEIGHTS @ np.cos(np.arange(-AHEAD, AHEAD + 1)[:, None] * angle))
