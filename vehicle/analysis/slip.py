"""How long a damper slips: share of the time, first instant, intervals.

A damper slips while |v| > v_slip, with v_slip = `damper.slip_velocity` of the parameters. Slip shares, first slips,
sweeps, tables, figures and the lamps of the films all use that velocity. Where the friction alone is meant, which
reaches its limit at 1 mm/s, the name says "saturated".
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.samples import checked_same_length, checked_signals
from vehicle.errors import ConfigurationError, DataError


def _slipping(velocity: ArrayLike, slip_velocity: float) -> NDArray[np.bool_]:
    """Tell in which samples |v| is above the slip velocity, shape (n,)."""
    limit = float(slip_velocity)
    if not (np.isfinite(limit) and limit >= 0.0):
        raise ConfigurationError(f"slip velocity: found {slip_velocity!r} m/s, allowed is a finite number >= 0 m/s")
    signal = checked_signals("damper velocity", velocity)
    if signal.shape[0] != 1:
        raise DataError(f"damper velocity: found {signal.shape[0]} signals, needed is one damper at a time, shape (n,)")
    return np.asarray(np.abs(signal[0]) > limit)


def _instants(time: ArrayLike, samples: int) -> NDArray[np.float64]:
    """Return the time stamps [s], shape (n,), when they fit the velocity and increase."""
    stamps = checked_signals("time", time)
    checked_same_length("time", stamps, "the damper velocity", samples)
    if np.any(np.diff(stamps[0]) <= 0.0):
        first = int(np.argmax(np.diff(stamps[0]) <= 0.0)) + 1
        raise DataError(f"time: found {stamps[0][first]:g} s at sample {first}, not after its predecessor")
    return np.asarray(stamps[0])


def slip_share(velocity: ArrayLike, slip_velocity: float) -> float:
    """Return the share of the samples with |v| > slip velocity, between 0 and 1.

    Args:
        velocity: of the damper [m/s], shape (n,), uniformly sampled.
        slip_velocity: speed that counts as slip [m/s].
    """
    return float(np.mean(_slipping(velocity, slip_velocity)))


def first_slip(time: ArrayLike, velocity: ArrayLike, slip_velocity: float) -> float | None:
    """Return the time [s] of the first sample with |v| > slip velocity, None when there is none.

    Args:
        time: [s], shape (n,).
        velocity: of the damper [m/s], shape (n,).
        slip_velocity: speed that counts as slip [m/s].
    """
    slips = _slipping(velocity, slip_velocity)
    instants = _instants(time, slips.size)
    return float(instants[np.argmax(slips)]) if slips.any() else None


def slip_intervals(time: ArrayLike, velocity: ArrayLike, slip_velocity: float) -> NDArray[np.float64]:
    """Return start and end [s] of every slip, shape (s, 2): first sample above the limit, first sample back below.

    A slip that lasts to the end of the record ends with its last time stamp.

    Args:
        time: [s], shape (n,).
        velocity: of the damper [m/s], shape (n,).
        slip_velocity: speed that counts as slip [m/s].
    """
    slips = _slipping(velocity, slip_velocity)
    instants = _instants(time, slips.size)
    change = np.diff(np.concatenate(([0], slips.astype(np.int8), [0])))
    starts = np.flatnonzero(change == 1)
    ends = np.minimum(np.flatnonzero(change == -1), slips.size - 1)
    return np.column_stack((instants[starts], instants[ends]))
