"""International roughness index (IRI) of a road: the mean motion of a standard quarter car over its height.

    x' = A x + B s,  x = (z_s', z_s'', z_u', z_u'') / V,  IRI = mean |z_s' - z_u'| / V

s is the slope of the profile after its average over 250 mm; V = 80 km/h. The quarter car ("golden car") has no
friction, and its damping is higher than that of a car: the index rates the road, not a car.

Source: Sayers, On the calculation of international roughness index from longitudinal road profile, Transportation
Research Record 1501 (1995); ASTM E1926.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.analysis.samples import checked_signals, checked_time_step

SPEED = 80.0 / 3.6
"""Speed of the quarter car [m/s]."""

TYRE, SPRING, DAMPING, MASS_RATIO = 653.0, 63.3, 6.0, 0.15
"""k_t / m_s [1/s2], k_s / m_s [1/s2], c / m_s [1/s] and m_u / m_s [-] of the quarter car (Sayers 1995, table 1)."""

AVERAGED = 0.25
"""Length of the average of the profile [m]: the contact patch of a tyre (Sayers 1995)."""

COARSEST = 0.3
"""Maximum distance of the samples [m] (ASTM E1926: longer steps lose waves to which the quarter car responds)."""

STARTED = 11.0
"""Length of road whose mean slope the quarter car has at the start [m] (Sayers 1995: 0.5 s)."""

STATE = np.array(
    [
        [0.0, 1.0, 0.0, 0.0],
        [-SPRING, -DAMPING, SPRING, DAMPING],
        [0.0, 0.0, 0.0, 1.0],
        [SPRING / MASS_RATIO, DAMPING / MASS_RATIO, -(TYRE + SPRING) / MASS_RATIO, -DAMPING / MASS_RATIO],
    ]
)
"""A of the quarter car."""
INPUT = np.array([0.0, 0.0, 0.0, TYRE / MASS_RATIO])
"""B of the quarter car."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoughnessIndex:
    """International roughness index of a track.

    Attributes:
        overall: of the whole track [m/km].
        edges: where the segments begin and end [m], (n + 1,); the last segment may be shorter.
        segments: of each segment [m/km], (n,).
    """

    overall: float
    edges: Vector
    segments: Vector


def step_matrices(step: float) -> tuple[Vector, Vector]:
    """Return S = exp(A h / V), (4, 4), and p = A^-1 (S - 1) B, (4,): the exact step over a constant slope.

    Args:
        step: distance of the samples h [m].
    """
    matrix = scipy.linalg.expm(STATE * step / SPEED)
    return matrix, np.linalg.solve(STATE, (matrix - np.eye(4)) @ INPUT)


def roughness_index(step: float, height: ArrayLike, *, segment: float = 100.0) -> RoughnessIndex:
    """Return the international roughness index of a track from its height at equal distances.

    Args:
        step: distance of the samples [m], at most `COARSEST`.
        height: height of the road [m], shape (n,).
        segment: length of a segment [m].

    Raises:
        DataError: the samples are too far apart, or the road is shorter than `STARTED`.
    """
    step = checked_time_step(step)
    (profile,) = checked_signals("height of the road", height)
    length = (profile.size - 1) * step
    if step > COARSEST:
        raise DataError(
            f"IRI: the heights are {step:g} m apart but must be at most {COARSEST:g} m, or waves to which the "
            "standard quarter car responds are lost"
        )
    if length < STARTED:
        raise DataError(f"IRI: the road is {length:.4g} m long but must be at least {STARTED:g} m")
    averaged = max(1, round(AVERAGED / step))
    # The mean slope over a length is the difference of its ends.
    slope = (profile[averaged:] - profile[:-averaged]) / (averaged * step)
    start = round(STARTED / step)
    mean_slope = (profile[start] - profile[0]) / (start * step)
    matrix, drive = step_matrices(step)
    # Each mode of the step is a recursion of the first order.
    poles, shapes = np.linalg.eig(matrix)
    to_modes, motion = np.linalg.inv(shapes), shapes[0] - shapes[2]
    # Both masses rise with the mean slope of the first metres, without relative motion.
    begin = to_modes @ (mean_slope * np.array([1.0, 0.0, 1.0, 0.0]))
    stroke = np.zeros(slope.size)
    for pole, gain, share, first in zip(poles, to_modes @ drive, motion, begin, strict=True):
        state, _ = scipy.signal.lfilter([gain], [1.0, -pole], slope.astype(complex), zi=[pole * first])
        stroke += (share * state).real
    rates = 1e3 * np.abs(stroke)
    bounds = np.arange(0, rates.size, max(1, round(segment / step)))
    counts = np.diff(np.append(bounds, rates.size))
    return RoughnessIndex(
        overall=float(rates.mean()),
        edges=np.append(bounds, rates.size) * step,
        # Sum from each bound to the next.
        segments=np.add.reduceat(rates, bounds) / counts,
    )
