"""Runs of the bumps and what is read off them: first slip, extremes, ring-down."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scenarios.car_runs import CarRuns
from scenarios.evidence import INSTANT_READING, SLIP_INSTANT
from scenarios.signals.bump import BUMP_DURATION_S, BUMP_START_S, NOISE_RMS, Reading, bump
from vehicle.arrays import Vector
from vehicle.names import AXES
from vehicle.runs.car import SATURATED_VELOCITY, Run
from vehicle.signals.excitation.signal import Signal


def relative_acceleration(run: Run) -> Vector:
    """Return the acceleration of damper top minus knuckle over the plate, along the strut axis [m/s2], (n,).

    a = n (a_top - a_knuckle), n from the damper bottom to the strut top in the design position. In the vertical alone
    the rotation of the strut would show while it sticks.
    """
    points, wheel = run.car.vehicle.points, run.wheel
    axis = np.array(points[f"strut_top_{wheel}"]) - np.array(points[f"damper_bottom_{wheel}"])
    direction = axis / np.linalg.norm(axis)
    top, knuckle = (
        np.array([run[f"{point}_{wheel}_acc_{name}"] for name in AXES]) for point in ("damper_top", "knuckle")
    )
    return np.asarray(direction @ (top - knuckle))


SIZES = (1.5e-3, 7.5e-3)
"""A of the bumps [m]."""

FRICTIONS = (75.0, 100.0, 125.0, 150.0, 175.0)
"""Friction limits Fd of figure 3.12 [N]."""

FIRST_SLIP, FIRST_SLIP_TOLERANCE = SLIP_INSTANT, INSTANT_READING
"""End of sticking after the 7.5 mm bump with Fd 125 N [s], figure 3.12."""

PUBLISHED_FRICTION = 125.0
"""Fd at which the model of the source slipped when the car did [N]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Record:
    """Start of the bump, durations of the records with and without noise, and duration of the film [s]."""

    start: float
    noisy: float
    quiet: float
    film: float

    @property
    def end(self) -> float:
        """Return the end of the bump [s]."""
        return self.start + BUMP_DURATION_S

    def signal(self, size: float, reading: Reading, wheel: str, *, noise: bool = True) -> Signal:
        """Return a bump of amplitude A [m], with or without the noise of the thesis."""
        duration, level = (self.noisy, NOISE_RMS) if noise else (self.quiet, 0.0)
        signal = bump(
            amplitude=size, reading=reading, duration=duration, start=self.start, noise_rms=level, wheel=wheel
        )
        # The film shows the name of the source, and the text of the generator is too long for it.
        return replace(signal, source=f"bump {1e3 * size:g} mm")


FULL = Record(start=BUMP_START_S, noisy=10.0, quiet=14.0, film=9.0)
"""As shipped; without noise long enough to ring down."""

QUICK = Record(start=0.6, noisy=1.5, quiet=1.5, film=0.5)

OTHER: dict[Reading, Reading] = {"height": "literal", "literal": "height"}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bumps:
    """Runs of the study, low bump before high one; times read off them are as if the bump began at 5 s."""

    record: Record  # times of the bump
    noisy: Sequence[Run]  # noisy, quiet: with and without the random noise
    quiet: Sequence[Run]
    other: Sequence[Run]  # with noise, in the other reading of the printed formula
    other_reading: Reading  # name of it
    by_friction: Mapping[float, Run]  # friction limit [N] to the high bump

    @property
    def slip_velocity(self) -> float:
        """Return the slip velocity of the parameters [m/s]."""
        return self.noisy[0].car.vehicle.damper.slip_velocity

    def first_slip(self, velocity: float) -> dict[float, float | None]:
        """Return friction limit [N] to the first time above a velocity [s], None if never above."""
        return {friction: slip_after(run, self.record.start, velocity) for friction, run in self.by_friction.items()}

    def data(self) -> dict[str, Any]:
        """Return the entries of `results.json`."""
        low = fastest(self.noisy[0])
        times = {"first_slip_s": self.slip_velocity, "first_saturated_s": SATURATED_VELOCITY}
        return {
            **{
                name: {f"{friction:g} N": time for friction, time in self.first_slip(velocity).items()}
                for name, velocity in times.items()
            },
            "slip_velocity": self.slip_velocity,
            "low_bump": {"largest_velocity": low, "time_above_1_mm_s": saturated_time(self.noisy[0])},
            "ring_down_s": {
                f"{1e3 * size:g} mm": ring_down_times(run, self.record.end)
                for size, run in zip(SIZES, self.quiet, strict=True)
            },
        }


def run_bumps(runs: CarRuns, record: Record, reading: Reading, frictions: Sequence[float]) -> Bumps:
    """Run all cases of the study, independent runs in parallel."""
    other = OTHER[reading]
    cases = [
        runs.case(record.signal(size, reading_of_case, runs.wheel, noise=noise))
        for reading_of_case, noise in ((reading, True), (reading, False), (other, True))
        for size in SIZES
    ]
    varied = [runs.case(cases[1].source, [f"damper.coulomb_friction={value!r}"]) for value in frictions]
    results = runs([*cases, *varied])
    return Bumps(
        record=record,
        noisy=results[:2],
        quiet=results[2:4],
        other=results[4:6],
        other_reading=other,
        by_friction=dict(zip(frictions, results[6:], strict=True)),
    )


def damper_velocity(run: Run) -> Vector:
    """Return the velocity of the damper over the plate [m/s], (n,)."""
    return np.asarray(run[f"damper_{run.wheel}_velocity"])


def fastest(run: Run) -> float:
    """Return the largest velocity of the damper over the plate [m/s]."""
    return float(np.max(np.abs(damper_velocity(run))))


def saturated_time(run: Run) -> float:
    """Return the time with the damper over the plate above 1 mm/s, where the friction is saturated [s]."""
    return run.slip_share(run.wheel, SATURATED_VELOCITY) * run.signal.duration


def slip_after(run: Run, start: float, velocity: float) -> float | None:
    """Return the first time of the damper over the plate above a velocity, for a bump that begins at 5 s [s]."""
    speed = np.abs(damper_velocity(run))
    at = np.flatnonzero((speed > velocity) & (run.time >= start))
    return None if not at.size else float(run.time[at[0]]) - start + BUMP_START_S


def when(time: float | None) -> str:
    """Return a text for a time [s], or for None."""
    return "never" if time is None else f"{time:.3f} s"


SHOWN_S = 3.0
"""The figures show 3 s from the start of the bump [s]."""

RUNG_DOWN = 0.2
"""Rung down when the motion stays below this share of its largest value after the bump."""

BODY = ("seat_rail", "seat", "roof_right_rear", "body_front")
"""Output points on the body; the RMS over these points represents the vertical motion of the body."""

POINTS = (*BODY, "suspension_mount_fr", "suspension_mount_fl", "engine")
"""Points whose ring-down times are reported."""


def ring_down_time(time: Vector, motion: Vector, end: float) -> float:
    """Return the time from the end of a bump until |motion| last exceeds `RUNG_DOWN` of its largest value after it.

    Args:
        time: [s], (n,).
        motion: free of other excitation, (n,).
        end: of the bump [s].

    Returns:
        [s]; NaN where the motion still exceeds it within the last tenth of the record, which is then too short.
    """
    after = time >= end
    size = np.abs(motion[after])
    last = float(time[after][np.flatnonzero(size > RUNG_DOWN * np.max(size))[-1]])
    return last - end if last < end + 0.9 * (float(time[-1]) - end) else float("nan")


def ring_down_times(run: Run, end: float) -> dict[str, float]:
    """Return the ring-down times [s] of the whole body and of single points."""
    body = np.sqrt(np.mean([run[f"{point}_acc_z"] ** 2 for point in BODY], axis=0))
    motions = {"body": body, **{point: run[f"{point}_acc_z"] for point in POINTS}}
    return {name: ring_down_time(run.time, motion, end) for name, motion in motions.items()}
