"""Peaks of the relative acceleration after a damper has begun to slip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.signal import find_peaks

from vehicle.analysis.slip import slip_intervals

Vector = npt.NDArray[np.float64]

SHORTEST_SLIP = 0.020
"""Shorter slips [s] have no room for a peak after the break-away."""

BREAK_AWAY = 0.005
"""The jump of breaking away itself lies within this time of the end of stick [s]."""

SEARCHED = 0.060
"""Peaks are looked for this long after the end of stick [s]: 'just after'."""

STANDING_OUT = 0.5
"""A peak counts when it stands out by at least this share of the largest break-away jump of the run."""


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
    time: Vector, velocity: Vector, relative: Vector, *, saturated: float, begin: float, until: float
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
            tops, properties = find_peaks(sign * relative[window], prominence=0.0)
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
