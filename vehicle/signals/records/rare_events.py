"""Samples beyond a plausible level: rare events of the road, or a wrong unit."""

from __future__ import annotations

import numpy as np

from vehicle.signals.records.table import Vector

RARE_SHARE = 0.01
"""Largest share of samples [-] of rare events, such as potholes. A wrong unit makes a record at least 9.8 times larger:
then 65 % of the samples of a Gaussian record are beyond a level that the true record would just reach at 4.5 sigma."""

LARGEST_EVENT = 10.0
"""Largest level of a rare event, as a multiple of the plausible level [-]; a sample above it is a logger's fault."""


def rare_events(values: Vector, limit: float, largest: float = LARGEST_EVENT) -> bool:
    """Return True if few samples exceed a plausible level, and none by far.

    Args:
        values: samples about zero, shape (n,).
        limit: plausible level, in the unit of the samples.
        largest: largest level of a rare event, as a multiple of the plausible level.
    """
    size = np.abs(values)
    return bool(np.mean(size > limit) <= RARE_SHARE and float(size.max()) <= largest * limit)
