"""Runs of the bumps and what is read off them: first slip, extremes, ring-down."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from scenarios.claims import Interval
from vehicle.car import SATURATED_VELOCITY, Run
from vehicle.excitation.bump import BUMP_DURATION_S, BUMP_START_S, NOISE_RMS, Reading, bump
from vehicle.excitation.signal import Signal
from vehicle.names import AXES


def relative_acceleration(run: Run, wheel: str = "fr") -> npt.NDArray[np.float64]:
    """Acceleration of the damper top less that of the knuckle, along the strut axis.

    a = n (a_top - a_knuckle), n from the damper bottom to the strut top in the design position. In the vertical alone
    the rotation of the strut would show while it sticks.

    Args:
        run: a finished run.
        wheel: of the damper.

    Returns:
        [m/s2], shape (n,).
    """
    points = run.car.vehicle.hardpoints.all_points()
    axis = np.array(points[f"strut_top_{wheel}"]) - np.array(points[f"damper_bottom_{wheel}"])
    direction = axis / np.linalg.norm(axis)
    top, knuckle = (
        np.array([run[f"{place}_{wheel}_acc_{name}"] for name in AXES]) for place in ("damper_top", "knuckle")
    )
    return np.asarray(direction @ (top - knuckle))


LOW, HIGH = 1.5e-3, 7.5e-3
"""A of the bumps [m]."""

FRICTIONS = (75.0, 100.0, 125.0, 150.0, 175.0)
"""Friction limits Fd of figure 3.12 [N]."""

QUICK_FRICTIONS = (75.0, 125.0, 175.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Record:
    """When the bump begins, how long the records with and without noise are, and the film [s]."""

    start: float
    noisy: float
    quiet: float
    film: float

    @property
    def end(self) -> float:
        """End of the bump [s]."""
        return self.start + BUMP_DURATION_S


FULL = Record(start=BUMP_START_S, noisy=10.0, quiet=14.0, film=9.0)
"""As shipped; without noise long enough to ring down."""

QUICK = Record(start=0.6, noisy=1.5, quiet=1.5, film=0.5)

OTHER: dict[Reading, Reading] = {"height": "literal", "literal": "height"}


def bump_signal(record: Record, amplitude: float, reading: Reading, *, noise: bool) -> Signal:
    """Bump of an amplitude A [m], with or without the random noise of the source."""
    duration, level = (record.noisy, NOISE_RMS) if noise else (record.quiet, 0.0)
    signal = bump(amplitude=amplitude, reading=reading, duration=duration, start=record.start, noise_rms=level)
    # The film writes the source over its picture, where the text of the generator has no room.
    return replace(signal, source=f"bump {1e3 * amplitude:g} mm")


@dataclass(frozen=True, kw_only=True, slots=True)
class BumpNumbers:
    """What is read off the bumps; times as if the bump began at 5 s, low bump before high one.

    Attributes:
        first_slip: friction limit [N] to the first slip [s] after the start of the bump, None for never.
        stick_end: the same above 1 mm/s, where the friction is saturated.
        slip_velocity: that of the parameters [m/s].
        extremes, other_extremes: point to lowest and highest acceleration after the high bump [m/s2], in both readings.
        other_reading: name of the other one.
        low_velocity: largest damper velocity in the low bump [m/s].
        low_saturated: time above 1 mm/s in the low bump [s].
        ring_down: ring-down times of both bumps [s], by point.
        other_first_slip: first slip with the other reading, high bump, in words.
        other_low_velocity, other_low_slips: damper in the low bump with the other reading.
    """

    first_slip: Mapping[float, float | None]
    stick_end: Mapping[float, float | None]
    slip_velocity: float
    extremes: dict[str, tuple[float, float]]
    other_extremes: dict[str, tuple[float, float]]
    other_reading: str
    low_velocity: float
    low_saturated: float
    ring_down: Sequence[Mapping[str, float]]
    other_first_slip: str
    other_low_velocity: float
    other_low_slips: bool

    def data(self) -> dict[str, Any]:
        """For `results.json`."""
        return {
            "first_slip_s": {f"{friction:g} N": time for friction, time in self.first_slip.items()},
            "first_saturated_s": {f"{friction:g} N": time for friction, time in self.stick_end.items()},
            "slip_velocity": self.slip_velocity,
            "low_bump": {"largest_velocity": self.low_velocity, "time_above_1_mm_s": self.low_saturated},
            "extremes": self.extremes,
            "ring_down_s": {"1.5 mm": dict(self.ring_down[0]), "7.5 mm": dict(self.ring_down[1])},
        }


def numbers(
    bumps: Sequence[Run],
    still: Sequence[Run],
    by_friction: Mapping[float, Run],
    other: Sequence[Run],
    other_reading: str,
    *,
    start: float,
    end: float,
) -> BumpNumbers:
    """Read the numbers off the runs.

    Args:
        bumps: low and high bump with noise.
        still: the same without noise.
        by_friction: friction limit [N] to the high bump.
        other: low and high bump in the other reading.
        other_reading: name of it.
        start, end: of the bump [s].
    """
    low = np.abs(bumps[0]["damper_fr_velocity"])
    slip_velocity = bumps[0].car.vehicle.damper.slip_velocity
    slips = [slip_after(other[1], start, velocity) for velocity in (slip_velocity, SATURATED_VELOCITY)]
    other_low = float(np.max(np.abs(other[0]["damper_fr_velocity"])))
    return BumpNumbers(
        first_slip={friction: slip_after(run, start, slip_velocity) for friction, run in by_friction.items()},
        stick_end={friction: slip_after(run, start, SATURATED_VELOCITY) for friction, run in by_friction.items()},
        slip_velocity=slip_velocity,
        extremes=extremes(bumps[1], start),
        other_extremes=extremes(other[1], start),
        other_reading=other_reading,
        low_velocity=float(np.max(low)),
        low_saturated=float(np.mean(low > SATURATED_VELOCITY)) * bumps[0].signal.duration,
        ring_down=[ring_down_times(run, end) for run in still],
        other_first_slip=f"{when(slips[0])} (above 1 mm/s {when(slips[1])})",
        other_low_velocity=other_low,
        other_low_slips=other_low > slip_velocity,
    )


def slip_after(run: Run, start: float, velocity: float) -> float | None:
    """First time [s] with the right damper above a velocity after the start of the bump, as if that were at 5 s."""
    speed = np.abs(run["damper_fr_velocity"])
    at = np.flatnonzero((speed > velocity) & (run.time >= start))
    return None if not at.size else float(run.time[at[0]]) - start + BUMP_START_S


def when(time: float | None) -> str:
    """A time [s] in words."""
    return "never" if time is None else f"{time:.3f} s"


SHOWN_S = 3.0
"""The figures show 3 s from the start of the bump [s]."""

RELATIVE = "relative acceleration damper top - knuckle"

FIGURE_AXES: dict[str, tuple[str, str, Interval, Interval]] = {
    "seat rail": ("3.13", "seat_rail_acc_z", (-0.8, -0.6), (0.4, 0.6)),
    "seat": ("3.14", "seat_acc_z", (-1.0, -0.5), (0.0, 0.5)),
    "knuckle": ("3.15", "knuckle_fr_acc_z", (-2.0, -1.0), (1.0, 2.0)),
    RELATIVE: ("3.16", "", (-5.0, 0.0), (0.0, 5.0)),
    "engine": ("3.17", "engine_acc_z", (-1.5, -1.0), (0.5, math.inf)),
    "roof left rear": ("3.18", "roof_left_rear_acc_z", (-0.8, -0.6), (0.4, 0.6)),
}
"""Point to figure, channel, and the last intervals of its axis at the lower and the upper end [m/s2]. Figure 3.16 has
ticks at -5, 0 and 5 only; the upper end of 3.17 is unreadable above 0.5."""


def extremes(run: Run, start: float) -> dict[str, tuple[float, float]]:
    """Lowest and highest vertical acceleration [m/s2] of every point, from the start of the bump on [s]."""
    shown = (run.time >= start) & (run.time <= start + SHOWN_S)
    found = {}
    for point, (_, channel, _, _) in FIGURE_AXES.items():
        values = (run[channel] if channel else relative_acceleration(run))[shown]
        found[point] = (float(np.min(values)), float(np.max(values)))
    return found


Vector = npt.NDArray[np.float64]

RUNG_DOWN = 0.2
"""Rung down when the motion stays below this share of its largest value after the bump."""

BODY = ("seat_rail", "seat", "roof_left_rear", "body_front")
"""Output points on the body, whose RMS stands for its vertical motion."""

POINTS = (*BODY, "suspension_mount_fr", "suspension_mount_fl", "engine")
"""Points whose ring-down times are told."""


def body_envelope(run: Run) -> Vector:
    """Root mean square of the vertical acceleration over the output points of the body [m/s2], shape (n,)."""
    return np.asarray(np.sqrt(np.mean([run[f"{place}_acc_z"] ** 2 for place in BODY], axis=0)))


def ring_down_time(time: Vector, motion: Vector, end: float, share: float = RUNG_DOWN) -> float:
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
