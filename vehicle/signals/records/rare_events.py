"""Distinguish rare events of the road from a wrong unit, for samples above a plausible level."""

import numpy as np

from vehicle.arrays import Vector

RARE_SHARE = 0.01
"""Maximum share of samples [-] of rare events, such as potholes. A wrong unit makes a record at least 9.8 times larger:
then 65 % of the samples of a Gaussian record exceed the level of 4.5 sigma of the true record."""

LARGEST_EVENT = 10.0
"""Maximum level of a rare event over the plausible level [-]; larger samples are faults of the logger."""


def rare_events(values: Vector, limit: float, largest: float = LARGEST_EVENT) -> bool:
    """Return True if at most `RARE_SHARE` of the samples exceed a plausible level, by at most a factor `largest`.

    Args:
        values: samples about zero, shape (n,).
        limit: plausible level, in the unit of the samples.
        largest: maximum level of a rare event over the plausible level [-].
    """
    size = np.abs(values)
    return bool(np.mean(size > limit) <= RARE_SHARE and float(size.max()) <= largest * limit)
