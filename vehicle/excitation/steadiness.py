"""What a record does beside shaking: it drifts, or it stands still for a while. Said, never mended."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from vehicle.records.clock import PAUSE

DRIFT_SHARE = 1.0
"""Drift from the beginning to the end, as a share of the RMS about it, from which it is mentioned [-]. A stationary
record of 20 periods of its lowest frequency stays below 0.2."""


def drifts(displacement: Mapping[str, NDArray[np.float64]]) -> list[str]:
    """A notice for each plate whose straight line of least squares rises by more than the RMS about it.

    b = 12 / (n^2 - 1) mean((k - (n - 1)/2) z_k) a sample, k = 0 ... n - 1; drift b (n - 1).

    Args:
        displacement: wheel -> plate displacement [m], shape (n,).
    """
    found = []
    for wheel, z in displacement.items():
        place = np.arange(z.size) - 0.5 * (z.size - 1)
        slope = 12.0 / (z.size**2 - 1.0) * float(np.mean(place * z))
        drift, rms = slope * (z.size - 1), float(np.std(z - slope * place))
        if abs(drift) > DRIFT_SHARE * rms:
            found.append(
                f"plate {wheel} drifts by {1e3 * drift:.4g} mm from beginning to end (RMS about that line "
                f"{1e3 * rms:.4g} mm): a drifting sensor or integrator? Nothing was subtracted"
            )
    return found


def pauses(wheel: str, time: NDArray[np.float64], values: NDArray[np.float64]) -> list[str]:
    """A notice for the longest stretch of equal values between two motions, if it is a pause.

    Args:
        wheel: whose plate.
        time: sample times [s], shape (n,).
        values: of the plate in any unit, shape (n,).
    """
    moves = np.flatnonzero(np.diff(values) != 0.0)  # steps with motion
    if moves.size < 2:
        return []
    rests = time[moves[1:]] - time[moves[:-1] + 1]
    longest = int(np.argmax(rests))
    if rests[longest] < PAUSE:
        return []
    more = int(np.count_nonzero(rests >= PAUSE)) - 1
    return [
        f"plate {wheel} stands still for {rests[longest]:.4g} s from t = {time[moves[longest] + 1]:.6g} s on, between "
        "two motions: a pause of the record? RMS, comfort and slip shares count it"
        + (f"; {more} shorter pauses beside it" if more else "")
    ]
