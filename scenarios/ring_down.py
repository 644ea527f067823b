"""How long the body rings after a bump."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.car import Run

Vector = npt.NDArray[np.float64]

SHARE = 0.2
"""Rung down when the motion stays below this share of its largest value after the bump."""

BODY = ("seat_rail", "seat", "roof_left_rear", "body_front")
"""Output points on the body, whose RMS stands for its vertical motion."""

POINTS = (*BODY, "suspension_mount_fr", "suspension_mount_fl", "engine")
"""Points whose ring-down times are told."""


def body_envelope(run: Run) -> Vector:
    """Root mean square of the vertical acceleration over the output points of the body [m/s2], shape (n,)."""
    return np.asarray(np.sqrt(np.mean([run[f"{place}_acc_z"] ** 2 for place in BODY], axis=0)))


def ring_down_time(time: Vector, motion: Vector, end: float, share: float = SHARE) -> float:
    """Time from the end of a bump until |motion| last exceeds a share of its largest value after the bump.

    Args:
        time: [s], (n,).
        motion: free of other excitation, (n,).
        end: of the bump [s].
        share: of the largest value [-].

    Returns:
        [s]; NaN where the motion still exceeds it within the last tenth of the record, which is then too short.
    """
    after = time >= end
    size = np.abs(motion[after])
    last = float(time[after][np.flatnonzero(size > share * np.max(size))[-1]])
    return last - end if last < end + 0.9 * (float(time[-1]) - end) else float("nan")


def ring_down_times(run: Run, end: float) -> dict[str, float]:
    """Ring-down times [s] of the body as a whole and of single points."""
    points = {place: ring_down_time(run.time, run[f"{place}_acc_z"], end) for place in POINTS}
    return {"body": ring_down_time(run.time, body_envelope(run), end), **points}
