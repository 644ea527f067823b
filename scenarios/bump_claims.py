"""Published statements about the bumps beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from scenarios.bump_extremes import extreme_claims, extremes
from scenarios.claim import Claim, number_claim, statement_claim
from scenarios.ring_down import ring_down_times
from vehicle.car import SATURATED_VELOCITY, Run
from vehicle.excitation.bump import BUMP_START_S

FIRST_SLIP, FIRST_SLIP_TOLERANCE = 5.035, 0.010
"""First slip after the 7.5 mm bump with Fd 125 N [s], read off figure 3.12."""

PUBLISHED_FRICTION = 125.0
"""Fd at which the model of the source slipped when the car did [N]."""

RATIO = 2.0
"""'Much more time' to ring down: at least this ratio."""


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
        other_first_slip=f"{_when(slips[0])} (above 1 mm/s {_when(slips[1])})",
        other_low_velocity=other_low,
        other_low_slips=other_low > slip_velocity,
    )


def slip_after(run: Run, start: float, velocity: float) -> float | None:
    """First time [s] with the right damper above a velocity after the start of the bump, as if that were at 5 s."""
    speed = np.abs(run["damper_fr_velocity"])
    at = np.flatnonzero((speed > velocity) & (run.time >= start))
    return None if not at.size else float(run.time[at[0]]) - start + BUMP_START_S


def bump_claims(values: BumpNumbers, *, quick: bool) -> tuple[list[Claim], dict[str, str]]:
    """Rows of the bumps, and the statements that a short record cannot judge."""
    claims = [*_slip_claims(values), _low_claim(values), *_extreme_claims(values)]
    if quick:
        names = [ring_down_name(point) for point in (*SHOWN_POINTS, WEAKEST)]
        return claims, dict.fromkeys(names, "the record ends before the motion has rung down")
    return [*claims, *_ring_down_claims(values.ring_down)], {}


def _slip_claims(values: BumpNumbers) -> list[Claim]:
    times = values.first_slip
    ordered = [times[friction] for friction in sorted(times)]
    rising = all(time is not None for time in ordered) and bool(np.all(np.diff(np.array(ordered, dtype=float)) > 0.0))
    slip, end = (found[PUBLISHED_FRICTION] for found in (times, values.stick_end))
    return [
        number_claim(
            "bump 7.5 mm, first slip with Fd 125 N [s]",
            FIRST_SLIP,
            float("inf") if slip is None else slip,
            FIRST_SLIP_TOLERANCE,
            f"first sample above {1e3 * values.slip_velocity:g} mm/s, the velocity of all slip shares; read off a "
            "figure: 10 ms. The figure shows the end of stick, before the damper is that fast: the next row",
            status="predicted",
            source="text",
        ),
        number_claim(
            "bump 7.5 mm, end of stick with Fd 125 N [s]",
            FIRST_SLIP,
            float("inf") if end is None else end,
            FIRST_SLIP_TOLERANCE,
            "first sample above 1 mm/s, where the friction is saturated: no definition of slip here. The reading of "
            "the printed amplitude as height was chosen by it and by the 1.5 mm bump",
            status="chosen",
            source="text",
        ),
        statement_claim(
            "bump 7.5 mm, first slip against Fd",
            "later for a larger Fd, earlier for a smaller one",
            ", ".join(f"{friction:g} N {_when(time)}" for friction, time in times.items()),
            rising,
            "rising from value to value",
            status="predicted",
            source="text",
        ),
    ]


def _extreme_claims(values: BumpNumbers) -> list[Claim]:
    return extreme_claims(values.extremes, values.other_extremes, values.other_reading)


def _low_claim(values: BumpNumbers) -> Claim:
    return statement_claim(
        "bump 1.5 mm",
        "no slip",
        f"largest damper velocity {1e3 * values.low_velocity:.1f} mm/s",
        values.low_velocity <= values.slip_velocity,
        f"slip is above {1e3 * values.slip_velocity:g} mm/s, the velocity fitted to the slip shares of the random "
        f"inputs; the friction is saturated, above 1 mm/s, for {1e3 * values.low_saturated:.0f} ms. The reading of the "
        "printed amplitude as height was chosen by it",
        status="chosen",
        source="text",
    )


SHOWN_POINTS = {
    "seat_rail": "3.13, where it is not said",
    "seat": "3.14, where it is not said",
    "engine": "3.17, where the source says so",
    "roof_left_rear": "3.18, where it is not said",
}
"""Points whose vertical histories the source shows for both bumps, and the figure."""

WEAKEST = "the weakest of all points and of the body as a whole"


def ring_down_name(point: str) -> str:
    """Name of the row of a point."""
    return f"ring-down to 20 %, 1.5 mm against 7.5 mm, {point.replace('_', ' ')}"


def _ring_down_claims(times: Sequence[Mapping[str, float]]) -> list[Claim]:
    low, high = times
    weakest = min(low, key=lambda point: low[point] / high[point])
    after = (
        "our own check: when the damper sticks again after 7.5 mm, what is left rings on as slowly as after 1.5 mm, "
        "and here more than 20 % are left"
    )
    rows = [
        *((point, point, f"definition below the table; figure {figure}") for point, figure in SHOWN_POINTS.items()),
        (WEAKEST, weakest, after),
    ]
    return [
        statement_claim(
            ring_down_name(name),
            "much longer (at least twice)",
            f"{point.replace('_', ' ')}: {low[point]:.2f} s against {high[point]:.2f} s, "
            f"{low[point] / high[point]:.1f} times",
            low[point] / high[point] >= RATIO,
            why,
            status="predicted" if name == "engine" else "own check",
            source="text" if name == "engine" else "inferred",
        )
        for name, point, why in rows
    ]


def slip_table(values: BumpNumbers) -> str:
    """First slip by friction limit, and ring-down times, as tables."""
    lines = [
        "First slip after the 7.5 mm bump that begins at 5 s [s]:",
        "",
        f"| Fd [N] | slip, above {1e3 * values.slip_velocity:g} mm/s | end of stick, above 1 mm/s |",
        "|---|---|---|",
        *(
            f"| {friction:g} | {_when(time)} | {_when(values.stick_end[friction])} |"
            for friction, time in values.first_slip.items()
        ),
        "",
        "Ring-down to 20 % [s]:",
        "",
        "| point | 1.5 mm | 7.5 mm | ratio |",
        "|---|---|---|---|",
    ]
    low, high = values.ring_down
    for point, time in low.items():
        cells = [f"{value:.2f}" if np.isfinite(value) else "-" for value in (time, high[point], time / high[point])]
        lines.append(f"| {point.replace('_', ' ')} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _when(time: float | None) -> str:
    return "never" if time is None else f"{time:.3f} s"
