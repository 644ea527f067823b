"""What the offset and drift of a record (a sensor's zero, gravity) do to its evaluation, and taking them away."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.evaluation import application
from vehicle.analysis.exposure import vibration_dose_value, weighted_rms
from vehicle.analysis.samples import checked_signals, is_constant
from vehicle.analysis.weighting import weighted_record

OFFSET_EFFECT = 0.01
"""Change of a weighted RMS or VDV by the offset above which someone must say what the offset is [-]."""
LARGEST_MEAN = 1.0
"""Mean acceleration that no ride keeps up: 20 s of it are 72 km/h [m/s2]"""


def offset_line(signals: ArrayLike) -> NDArray[np.float64]:
    """Return the straight line nearest to each of the signals (k, n): mean and drift, shape (k, n)."""
    array = checked_signals("acceleration", signals)
    count = np.arange(array.shape[1]) - 0.5 * (array.shape[1] - 1)
    slope = (array @ count) / max(float(count @ count), 1.0)
    line = array.mean(axis=1)[:, None] + slope[:, None] * count
    return np.where(is_constant(array)[:, None], array, line)


def without_offset(signals: ArrayLike) -> NDArray[np.float64]:
    """Return the signals (k, n) with mean and drift of each taken away; a constant one becomes exactly zero.

    Every weighting has a double zero at 0 Hz: once settled it does not see a straight line, so nothing of the vibration
    is lost.
    """
    array = checked_signals("acceleration", signals)
    return array - offset_line(array)


def offset_effect(time_step: float, xyz: ArrayLike, *, place: str = "seat") -> NDArray[np.float64]:
    """Return by how much mean and drift change weighted RMS or VDV, |with - without| / without, shape (3,).

    The larger of the two changes. The weighting filters are at rest before the record, so a mean is a step at its
    beginning; of a long record the VDV feels it longest. An axis that is nothing but an offset has an infinite effect,
    one that is zero none.

    Args:
        time_step: [s].
        xyz: acceleration [m/s2], shape (3, n).
        place: point of contact, which names the weightings.
    """
    array = checked_signals("acceleration", xyz)
    effects = []
    for record, clean, name in zip(array, without_offset(array), application(place).weightings, strict=True):
        weighted = [weighted_record(time_step, signal, name) for signal in (record, clean)]
        kept, removed = (np.array([weighted_rms(w), vibration_dose_value(time_step, w)]) for w in weighted)
        # below 1e-12 of the record itself the rest is rounding
        if removed[0] > 1e-12 * float(np.abs(record).max()):
            effects.append(float(np.max(np.abs(kept - removed) / removed)))
        else:
            effects.append(np.inf if kept[0] > 0.0 else 0.0)
    return np.asarray(effects)
