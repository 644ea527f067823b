"""What a constant offset of a record (a sensor's zero, gravity) does to its evaluation, and taking it away."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.evaluation import application
from vehicle.analysis.exposure import weighted_rms
from vehicle.analysis.samples import checked_signals, is_constant
from vehicle.analysis.weighting import weighted_record

OFFSET_EFFECT = 0.01
"""Change of a weighted RMS by the offset above which someone must say what the offset is [-]."""


def without_offset(signals: ArrayLike) -> NDArray[np.float64]:
    """Return the signals (k, n) with the mean of each taken away; a constant one becomes exactly zero."""
    array = checked_signals("acceleration", signals)
    return np.where(is_constant(array)[:, None], 0.0, array - array.mean(axis=1, keepdims=True))


def offset_effect(time_step: float, xyz: ArrayLike, *, place: str = "seat") -> NDArray[np.float64]:
    """Return by how much the mean of each axis changes its weighted RMS, |with - without| / without, shape (3,).

    The weighting filters are at rest before the record, so a mean is a step at its beginning. An axis that is nothing
    but an offset has an infinite effect, one that is zero none.

    Args:
        time_step: [s].
        xyz: acceleration [m/s2], shape (3, n).
        place: point of contact, which names the weightings.
    """
    array = checked_signals("acceleration", xyz)
    effects = []
    for record, clean, name in zip(array, without_offset(array), application(place).weightings, strict=True):
        kept = weighted_rms(weighted_record(time_step, record, name))
        removed = weighted_rms(weighted_record(time_step, clean, name))
        # below 1e-12 of the record itself the rest is rounding
        if removed > 1e-12 * float(np.abs(record).max()):
            effects.append(abs(kept - removed) / removed)
        else:
            effects.append(np.inf if kept > 0.0 else 0.0)
    return np.asarray(effects)
