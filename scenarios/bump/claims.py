"""Rows of published statements about the bumps: end of sticking, extremes over noise seeds, ring-down."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from scenarios.bump.runs import (
    FIRST_SLIP,
    PUBLISHED_FRICTION,
    SIZES,
    Bumps,
    damper_velocity,
    fastest,
    ring_down_times,
    saturated_time,
)
from scenarios.bump.seeds import BumpSeeds, row_key
from scenarios.claims import OWN_CHECK, PREDICTED, Claim
from scenarios.evidence import HIGH_PANELS, LOW_PANELS, evidence_of
from scenarios.evidence_claims import evidence_claim, reason
from scenarios.verdict import common
from vehicle.arrays import Vector
from vehicle.runs.car import SATURATED_VELOCITY, Run

RATIO = 2.0
"""'Much more time' to ring down: at least this ratio."""


def slip_claims(bumps: Bumps, seeds: BumpSeeds) -> list[Claim]:
    """Return the rows about the end of sticking of both bumps, over the seeds of the noise."""
    ends, low = seeds.stick_end, seeds.fastest[SIZES[0]]
    ordered = np.array([ends[friction] for friction in sorted(ends)])
    rising = bool(np.all(np.isfinite(ordered)) and np.all(np.diff(ordered, axis=0) > 0.0))
    return [
        evidence_claim(
            "bump_7p5_end_of_stick",
            f"bump 7.5 mm, first slip (end of sticking) with Fd {PUBLISHED_FRICTION:g} N [s]",
            ends[PUBLISHED_FRICTION],
            f"first sample above {1e3 * SATURATED_VELOCITY:g} mm/s, where the friction is saturated: the figure shows "
            "where the relative acceleration leaves zero. The reading of the printed amplitude as height was chosen by "
            "it and by the 1.5 mm bump",
            printed=FIRST_SLIP,
        ).at(picture="friction.png"),
        PREDICTED.statement(
            "bump 7.5 mm, first slip against Fd",
            "later for a larger Fd, earlier for a smaller one",
            ", ".join(f"{friction:g} N {np.mean(times):.3f} s" for friction, times in ends.items()),
            rising,
            f"end of sticking, means of {low.size} seeds; rising from value to value in every seed",
        ).at("figure 3.12", "friction.png"),
        no_slip_claim(bumps, low),
    ]


def no_slip_claim(bumps: Bumps, low: Vector) -> Claim:
    """Return the row on the low bump, undecided where single seeds of the noise differ: the figure shows one record.

    Args:
        bumps: pictured runs.
        low: largest velocity of the damper over the plate for every seed [m/s], (n,).
    """
    limit, pictured = bumps.slip_velocity, bumps.noisy[0]
    row = evidence_claim(
        "bump_1p5_no_slip",
        "bump 1.5 mm, no slip: largest velocity of the damper over the slip velocity",
        low / limit,
        f"slip is above {1e3 * limit:g} mm/s, as in the slip shares: {np.sum(low <= limit)} of {low.size} seeds stay "
        f"below; {np.sum(low <= SATURATED_VELOCITY)} stay below {1e3 * SATURATED_VELOCITY:g} mm/s, where the friction "
        f"is saturated and sticking ends. The shipped bump reaches {1e3 * fastest(pictured):.2f} mm/s and is above "
        f"{1e3 * SATURATED_VELOCITY:g} mm/s for {1e3 * saturated_time(pictured):.0f} ms. The reading of the printed "
        "amplitude as height was chosen by it",
    ).at(picture="relative_acceleration.png")
    return replace(row, within=common(low <= limit))


PANELS = {SIZES[1]: HIGH_PANELS, SIZES[0]: LOW_PANELS}
"""A of the bump [m] to what its figures show."""


def extreme_claims(seeds: BumpSeeds, trials: Mapping[str, Mapping[str, float]]) -> list[Claim]:
    """Return a row for each readable end of each axis, over the seeds of the noise.

    Args:
        seeds: ours.
        trials: label of a change of the model to the mean of each row with it, as evidence for the reason of a
            disagreement; see `scenarios.bump.seeds.experiments`.
    """
    claims = []
    for size, panels in PANELS.items():
        for point, name, *_ in panels:
            for column, word in enumerate(("lowest", "highest")):
                key, ours = row_key(size, point, word), seeds.extremes[size, point][:, column]
                row = f"bump {1e3 * size:g} mm, {word} {name} [m/s2]"
                claim = evidence_claim(key, row, ours, AXIS).at(picture=picture_of(point))
                if not claim.within and claim.status != "not testable" and trials:
                    why = reason(evidence_of(key).interval, {label: values[key] for label, values in trials.items()})
                    claim = evidence_claim(key, row, ours, f"{AXIS}; {why}").at(picture=picture_of(point))
                claims.append(claim)
    return claims


AXIS = "3 s from the bump; the axis holds model and measurement, either of which may be the wider"


def picture_of(point: str) -> str:
    """Return the file name of the figure that shows a point."""
    if point == "relative":
        return "relative_acceleration.png"
    return "histories_horizontal.png" if point[-2:] in ("_x", "_y") else "histories_vertical.png"


SHOWN_POINTS = {
    "seat_rail": ("figure 3.13", "where it is not said"),
    "seat": ("figure 3.14", "where it is not said"),
    "engine": ("figure 3.17", "as the thesis states"),
    "roof_right_rear": ("figure 3.18", "where it is not said"),
}
"""Points whose vertical histories the source shows for both bumps, and the figure."""

WEAKEST = "the weakest of all points and of the body as a whole"


def ring_down_claims(bumps: Bumps) -> Iterator[Claim]:
    """Return the rows on the slower ring-down after the low bump."""
    low, high = (ring_down_times(run, bumps.record.end) for run in bumps.quiet)
    for name in (*SHOWN_POINTS, WEAKEST):
        source_place, said = SHOWN_POINTS.get(name, ("", ""))
        point = min(low, key=lambda motion: low[motion] / high[motion]) if name == WEAKEST else name
        why = f"definition below the table; {said}" if said else left_ringing(bumps.quiet[1], bumps.record.end, point)
        ratio = low[point] / high[point]
        yield (
            (PREDICTED if name == "engine" else OWN_CHECK)
            .statement(
                f"ring-down to 20 %, 1.5 mm against 7.5 mm, {name.replace('_', ' ')}",
                "much longer (at least twice)",
                f"{point.replace('_', ' ')}: {low[point]:.2f} s against {high[point]:.2f} s, {ratio:.1f} times",
                ratio >= RATIO,
                why,
            )
            .at(source_place, "ring_down.png")
        )


def left_ringing(run: Run, end: float, point: str) -> str:
    """Return a text on the motion of a point that remains when the damper finally sticks after the high bump."""
    sliding = run.time[np.abs(damper_velocity(run)) > SATURATED_VELOCITY]
    stuck = max(float(sliding[-1]), end) if sliding.size else end
    status = "own check"
    if point == "body":
        return f"{status}; the damper sticks for good {stuck - end:.2f} s after the bump"
    motion = np.abs(run[f"{point}_acc_z"])
    share = float(np.max(motion[run.time > stuck]) / np.max(motion[run.time >= end]))
    return (
        f"{status}: the damper sticks for good {stuck - end:.2f} s after the high bump, where {100.0 * share:.0f} % of "
        "the motion are left; from there it rings on as slowly as after the low one"
    )
