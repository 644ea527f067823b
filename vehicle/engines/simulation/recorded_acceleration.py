"""Accelerations of recorded places, from their positions at the samples: the same definition in both engines.

The second difference of a position over the sampling interval T is the mean of the true acceleration under a triangle
two intervals wide: it holds all that happened between the samples, whatever the step of the engine, and weakens high
frequencies before they are sampled, by sinc^2(f T). The series of the second derivative undoes that in the band of use,

    a T^2 = (1 + u/12 + u^2/90 + u^3/560 - c u^4) delta^2 x,   u = -delta^2,   delta^2 x = x(t + T) - 2 x(t) + x(t - T)

(Fornberg, Math. Comp. 51, 1988, table 1, to order eight). The last term, c = 0.0063, takes the gain to zero at half
the sampling rate, where a record at the step of the engine holds nothing true. At 1 kHz it is 0.0001 % low at
50 Hz, 0.014 % at 100 Hz, 0.3 % at 150 Hz, 2.4 % at 200 Hz. Short impacts of a light part that breaks away reach up
to the step of the engine: what sampling would fold of them to below 100 Hz is weakened by 38 dB and more. The filter is
symmetric, so it has no delay. Before the record the car rests; the engines run five samples beyond its end, with plates
that keep their last acceleration. Positions on the body hold its modal displacement d turned with it, so that their
differences hold the terms of second order, 2 w x d' and w x (w x d), too, which a sum of accelerations would leave out.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

SERIES = (1.0, 1.0 / 12.0, 1.0 / 90.0, 1.0 / 560.0)
"""Factors of the powers of u."""

AHEAD = len(SERIES) + 1
"""Samples beyond the end of a record that its last acceleration needs."""

BLOCK = 65_536
"""Samples that are worked on at once."""


def _weights() -> Vector:
    """Weights of the 2 AHEAD + 1 samples around one, for T = 1."""
    difference = np.array([1.0, -2.0, 1.0])
    # u is 4 at half the sampling rate.
    closing = -sum(factor * 4.0**power for power, factor in enumerate(SERIES)) / 4.0 ** len(SERIES)
    found, term = np.zeros(2 * AHEAD + 1), difference
    for factor in (*SERIES, closing):
        margin = (found.size - term.size) // 2
        found[margin : found.size - margin] += factor * term
        term = -np.convolve(term, difference)
    return found


WEIGHTS = _weights()


def acceleration(position: Vector, interval: float) -> Vector:
    """Second time derivative of a record, in its place: a long record stands in memory once.

    Args:
        position: at the n samples of the record and AHEAD more, in any unit, overwritten; (n + AHEAD,).
        interval: sampling interval T [s].

    Returns:
        Its first n values, per s2; (n,).
    """
    count, rest, past = position.size - AHEAD, position[0], np.zeros(AHEAD)
    for first in range(0, count, BLOCK):
        size = min(BLOCK, count - first)
        moved = np.concatenate([past, position[first : first + size + AHEAD] - rest])
        past = moved[size : size + AHEAD]
        position[first : first + size] = np.convolve(moved, WEIGHTS / interval**2, "valid")
    return position[:count]


def continued(displacement: float, velocity: float, acceleration: float, t: Vector) -> Vector:
    """A plate that keeps its last acceleration over times t [s]: z + z' t + z'' t^2 / 2."""
    return displacement + velocity * t + 0.5 * acceleration * t**2
