"""How long a damper slips: share of the time, first instant, intervals; peaks after it has begun to.

A damper slips while |v| > v_slip, with v_slip = `damper.slip_velocity` of the parameters. Slip shares, first slips,
sweeps, tables, figures and the lamps of the films all use that velocity. Where the friction alone is meant, which
reaches its limit at 1 mm/s, the name says "saturated".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.samples import checked_same_length, checked_signals

Real = NDArray[np.float64]

SHORTEST_SLIP = 0.020
"""Shorter slips [s] have no room for a peak after the break-away."""

BREAK_AWAY = 0.005
"""The jump of breaking away itself lies within this time of the end of stick [s]."""

SEARCHED = 0.060
"""Peaks are looked for this long after the end of stick [s]: 'just after'."""

STANDING_OUT = 0.5
"""A peak counts when it stands out by at least this share of the largest break-away jump of the run."""


def _slipping(velocity: ArrayLike, slip_velocity: ArrayLike) -> NDArray[np.bool_]:
    """Tell in which samples |v| is above the slip velocity of its damper, shape (d, n)."""
    limits = np.asarray(slip_velocity, dtype=np.float64).reshape(-1)
    if not (np.isfinite(limits).all() and (limits >= 0.0).all()):
        raise ConfigurationError(f"slip velocity: found {slip_velocity!r} m/s, allowed is a finite number >= 0 m/s")
    return np.asarray(np.abs(checked_signals("damper velocity", velocity)) > limits[:, None])


def _one(velocity: ArrayLike) -> Real:
    """Return the velocity of a single damper, shape (1, n)."""
    signal = checked_signals("damper velocity", velocity)
    if signal.shape[0] != 1:
        raise DataError(f"damper velocity: found {signal.shape[0]} signals, needed is one damper at a time, shape (n,)")
    return signal


def _instants(time: ArrayLike, samples: int) -> Real:
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
    return float(slip_shares(_one(velocity), slip_velocity)[0])


def slip_shares(velocity: ArrayLike, slip_velocity: ArrayLike) -> Real:
    """Return the slip share of each of several dampers, shape (d,); velocities (d, n), slip velocities (d,)."""
    return np.asarray(np.mean(_slipping(velocity, slip_velocity), axis=1))


def first_slip(time: ArrayLike, velocity: ArrayLike, slip_velocity: float) -> float | None:
    """Return the time [s] of the first sample with |v| > slip velocity, None when there is none.

    Args:
        time: [s], shape (n,).
        velocity: of the damper [m/s], shape (n,).
        slip_velocity: speed that counts as slip [m/s].
    """
    first = float(first_slips(time, _one(velocity), slip_velocity)[0])
    return None if np.isnan(first) else first


def first_slips(time: ArrayLike, velocity: ArrayLike, slip_velocity: ArrayLike) -> Real:
    """Return the first slip [s] of each of several dampers, NaN where there is none, shape (d,); as `slip_shares`."""
    slips = _slipping(velocity, slip_velocity)
    instants = _instants(time, slips.shape[1])
    return np.where(slips.any(axis=1), instants[np.argmax(slips, axis=1)], np.nan)


def slip_intervals(time: ArrayLike, velocity: ArrayLike, slip_velocity: float) -> Real:
    """Return start and end [s] of every slip, shape (s, 2): first sample above the limit, first sample back below.

    A slip that lasts to the end of the record ends with its last time stamp.

    Args:
        time: [s], shape (n,).
        velocity: of the damper [m/s], shape (n,).
        slip_velocity: speed that counts as slip [m/s].
    """
    slips = _slipping(_one(velocity), slip_velocity)[0]
    instants = _instants(time, slips.size)
    change = np.diff(np.concatenate(([0], slips.astype(np.int8), [0])))
    starts = np.flatnonzero(change == 1)
    ends = np.minimum(np.flatnonzero(change == -1), slips.size - 1)
    return np.column_stack((instants[starts], instants[ends]))


@dataclass(frozen=True, kw_only=True, slots=True)
class SlipPeak:
    """A local extremum of the relative acceleration after a break-away.

    Attributes:
        time: [s].
        delay: after the end of stick [s].
        height: relative acceleration [m/s2].
        prominence: how far it stands out from its surroundings [m/s2].
    """

    time: float
    delay: float
    height: float
    prominence: float


@dataclass(frozen=True, kw_only=True, slots=True)
class SlipPhase:
    """A slip of a damper, from the end of stick on.

    Attributes:
        start, end: [s].
        jump: largest |relative acceleration| within `BREAK_AWAY` of its start [m/s2].
        velocity: largest damper velocity [m/s].
        peaks: every extremum between `BREAK_AWAY` and `SEARCHED` after its start.
    """

    start: float
    end: float
    jump: float
    velocity: float
    peaks: tuple[SlipPeak, ...]


def slip_phases(
    time: Real, velocity: Real, relative: Real, *, saturated: float, begin: float, until: float
) -> list[SlipPhase]:
    """Slips that begin in a stretch of a run, with the peaks that follow each break-away.

    Args:
        time: [s], (n,).
        velocity: of the damper [m/s], (n,).
        relative: acceleration of the damper top relative to the knuckle [m/s2], (n,).
        saturated: velocity above which the friction is saturated and stick has ended [m/s].
        begin, until: stretch [s].

    Returns:
        Phases of at least `SHORTEST_SLIP`, in the order of time.
    """
    phases = []
    for start, end in slip_intervals(time, velocity, saturated):
        if not begin <= start <= until or end - start < SHORTEST_SLIP:
            continue
        # The jump back to zero at the end of the slip is no peak: the window ends before it.
        window = np.flatnonzero((time >= start - BREAK_AWAY) & (time <= min(end - BREAK_AWAY, start + SEARCHED)))
        found = []
        for sign in (1.0, -1.0):
            tops, properties = scipy.signal.find_peaks(sign * relative[window], prominence=0.0)
            for top, prominence in zip(window[tops], properties["prominences"], strict=True):
                delay = float(time[top] - start)
                if delay > BREAK_AWAY:
                    found.append(
                        SlipPeak(
                            time=float(time[top]),
                            delay=delay,
                            height=float(relative[top]),
                            prominence=float(prominence),
                        )
                    )
        near = np.abs(time - start) <= BREAK_AWAY
        during = (time >= start) & (time <= end)
        phases.append(
            SlipPhase(
                start=float(start),
                end=float(end),
                jump=float(np.max(np.abs(relative[near]))),
                velocity=float(np.max(np.abs(velocity[during]))),
                peaks=tuple(sorted(found, key=lambda peak: peak.time)),
            )
        )
    return phases


def extra_peaks(phases: list[SlipPhase]) -> list[SlipPeak]:
    """Peaks after break-away that stand out by half of the largest break-away jump of all phases."""
    limit = STANDING_OUT * max((phase.jump for phase in phases), default=float("inf"))
    return [peak for phase in phases for peak in phase.peaks if peak.prominence >= limit]


def most_prominent(phases: list[SlipPhase]) -> SlipPeak | None:
    """The peak after break-away that stands out most; None where there is none at all."""
    return max((peak for phase in phases for peak in phase.peaks), key=lambda peak: peak.prominence, default=None)
