"""Settling time of a transient that returns to zero."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError


def settling_time(time: npt.ArrayLike, signal: npt.ArrayLike, band: float) -> float | None:
    """Last instant at which |y| exceeds a share of its largest magnitude.

    t_s = max { t : |y(t)| > band max|y| }: from there on the motion stays inside the band around its final value 0.

    Args:
        time: [s], shape (m,).
        signal: y, shape (m,).
        band: share of the peak [-], as 0.05.

    Returns:
        The time on the same clock [s]; None where the record ends outside the band. 0 for a signal that is zero.

    Raises:
        ConfigurationError: band not between 0 and 1.
    """
    if not 0.0 < band < 1.0:
        raise ConfigurationError(f"settling time: band: found {band!r}, must be between 0 and 1")
    instants, magnitude = np.asarray(time, dtype=float), np.abs(np.asarray(signal, dtype=float))
    outside = np.flatnonzero(magnitude > band * magnitude.max())
    if outside.size == 0:
        return 0.0
    if outside[-1] == magnitude.size - 1:
        return None
    return float(instants[outside[-1]])
