"""Slip of dampers: share of the time, first slip, intervals, and acceleration peaks after break-away.

A damper slips while |v| > v_slip, with v_slip = `damper.slip_velocity` of its parameters. Slip shares, first slips,
sweeps, tables, figures and the lamps of the films all use this velocity. Names with "saturated" refer to the
friction force, which reaches its limit at 1 mm/s.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.arrays import Mask
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.samples import Vector, checked_same_length, checked_signals, checked_single
from vehicle.signals.analysis.tops import prominent_tops

SHORTEST_SLIP = 0.020
"""Minimum length of a slip phase with peaks after the break-away [s]."""

BREAK_AWAY = 0.005
"""Maximum time between the end of stick and the break-away jump [s]."""

SEARCHED = 0.060
"""Length of the search for peaks after the end of stick [s]."""

STANDING_OUT = 0.5
"""Minimum prominence of a peak over the largest break-away jump of the run [-]."""


def _slipping(velocity: ArrayLike, slip_velocity: ArrayLike) -> Mask:
    """Return a mask of the samples with |v| above the slip velocity of the damper, shape (d, n)."""
    limits = np.asarray(slip_velocity, dtype=np.float64).reshape(-1)
    if not (np.isfinite(limits).all() and (limits >= 0.0).all()):
        raise ConfigurationError(f"slip velocity: found {slip_velocity!r} m/s, must be a finite number >= 0 m/s")
    return np.asarray(np.abs(checked_signals("damper velocity", velocity)) > limits[:, None])


def _one(velocity: ArrayLike) -> Vector:
    return checked_single("damper velocity", "damper", velocity)


def _instants(time: ArrayLike, samples: int) -> Vector:
    """Return the time stamps [s], shape (n,); check that their number fits the velocity and that they increase."""
    stamps = checked_signals("time", time)
    checked_same_length("time", stamps, "the damper velocity", samples)
    if np.any(np.diff(stamps[0]) <= 0.0):
        first = int(np.argmax(np.diff(stamps[0]) <= 0.0)) + 1
        raise DataError(f"time: found {stamps[0][first]:g} s at sample {first}, must increase from sample to sample")
    return np.asarray(stamps[0])


def slip_share(velocity: ArrayLike, slip_velocity: float) -> float:
    """Return the share of the samples with |v| > slip velocity, between 0 and 1.

    Args:
        velocity: velocity of the damper [m/s], shape (n,), uniformly sampled.
        slip_velocity: speed that counts as slip [m/s].
    """
    return float(slip_shares(_one(velocity), slip_velocity)[0])


def slip_shares(velocity: ArrayLike, slip_velocity: ArrayLike) -> Vector:
    """Return the slip share of each damper, shape (d,); velocities (d, n), slip velocities (d,)."""
    return np.asarray(np.mean(_slipping(velocity, slip_velocity), axis=1))


def first_slip(time: ArrayLike, velocity: ArrayLike, slip_velocity: float) -> float | None:
    """Return the time [s] of the first sample with |v| > slip velocity; None without slip.

    Args:
        time: time stamps [s], shape (n,).
        velocity: velocity of the damper [m/s], shape (n,).
        slip_velocity: speed that counts as slip [m/s].
    """
    first = float(first_slips(time, _one(velocity), slip_velocity)[0])
    return None if np.isnan(first) else first


def first_slips(time: ArrayLike, velocity: ArrayLike, slip_velocity: ArrayLike) -> Vector:
    """Return the first slip [s] of each damper, NaN without slip, shape (d,); arguments as for `slip_shares`."""
    slips = _slipping(velocity, slip_velocity)
    instants = _instants(time, slips.shape[1])
    return np.where(slips.any(axis=1), instants[np.argmax(slips, axis=1)], np.nan)


def slip_intervals(time: ArrayLike, velocity: ArrayLike, slip_velocity: float) -> Vector:
    """Return start and end [s] of every slip, shape (s, 2): first sample above the limit, next sample below.

    A slip that lasts to the end of the record ends with its last time stamp.

    Args:
        time, velocity, slip_velocity: see `first_slip`.
    """
    slips = _slipping(_one(velocity), slip_velocity)[0]
    instants = _instants(time, slips.size)
    # +1 where a slip begins, -1 at the sample after it; the zeros close slips at both ends of the record.
    change = np.diff(np.concatenate(([0], slips.astype(np.int8), [0])))
    starts = np.flatnonzero(change == 1)
    ends = np.minimum(np.flatnonzero(change == -1), slips.size - 1)
    return np.column_stack((instants[starts], instants[ends]))


@dataclass(frozen=True, kw_only=True, slots=True)
class SlipPeak:
    """Local extremum of the relative acceleration after a break-away.

    Attributes:
        time: time of the extremum [s].
        delay: time since the end of stick [s].
        height: relative acceleration [m/s2].
        prominence: height above the higher of the adjacent feet [m/s2].
    """

    time: float
    delay: float
    height: float
    prominence: float


@dataclass(frozen=True, kw_only=True, slots=True)
class SlipPhase:
    """Slip phase of a damper, from the end of stick on.

    Attributes:
        start, end: begin and end of the slip [s].
        jump: largest |relative acceleration| within `BREAK_AWAY` of the start [m/s2].
        velocity: largest |damper velocity| [m/s].
        peaks: extrema between `BREAK_AWAY` and `SEARCHED` after the start.
    """

    start: float
    end: float
    jump: float
    velocity: float
    peaks: tuple[SlipPeak, ...]


def slip_phases(
    time: Vector, velocity: Vector, relative: Vector, *, saturated: float, begin: float, until: float
) -> list[SlipPhase]:
    """Return the slip phases that begin in a time span of a run, with the peaks after each break-away.

    Args:
        time: time stamps [s], (n,).
        velocity: velocity of the damper [m/s], (n,).
        relative: acceleration of the damper top relative to the knuckle [m/s2], (n,).
        saturated: velocity above which the friction is saturated and stick has ended [m/s].
        begin, until: time span [s].

    Returns:
        Phases of at least `SHORTEST_SLIP`, in order of time.
    """
    phases = []
    for start, end in slip_intervals(time, velocity, saturated):
        if not begin <= start <= until or end - start < SHORTEST_SLIP:
            continue
        # The jump back to zero at the end of the slip is no peak: the window ends before it.
        window = np.flatnonzero((time >= start - BREAK_AWAY) & (time <= min(end - BREAK_AWAY, start + SEARCHED)))
        peaks = []
        for sign in (1.0, -1.0):
            for index, prominence, _ in prominent_tops(sign * relative[window], 0.0):
                top = window[index]
                delay = float(time[top] - start)
                if delay > BREAK_AWAY:
                    peaks.append(
                        SlipPeak(time=float(time[top]), delay=delay, height=float(relative[top]), prominence=prominence)
                    )
        at_start = np.abs(time - start) <= BREAK_AWAY
        during = (time >= start) & (time <= end)
        phases.append(
            SlipPhase(
                start=float(start),
                end=float(end),
                jump=float(np.max(np.abs(relative[at_start]))),
                velocity=float(np.max(np.abs(velocity[during]))),
                peaks=tuple(sorted(peaks, key=lambda peak: peak.time)),
            )
        )
    return phases


def extra_peaks(phases: list[SlipPhase]) -> list[SlipPeak]:
    """Return the peaks whose prominence is at least half of the largest break-away jump of all phases."""
    limit = STANDING_OUT * max((phase.jump for phase in phases), default=float("inf"))
    return [peak for phase in phases for peak in phase.peaks if peak.prominence >= limit]


def most_prominent(phases: list[SlipPhase]) -> SlipPeak | None:
    """Return the peak of largest prominence after a break-away; None without peaks."""
    return max((peak for phase in phases for peak in phase.peaks), key=lambda peak: peak.prominence, default=None)
