"""Published statements about the bumps beside ours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from scenarios.bump.runs import (
    FIGURE_AXES,
    RELATIVE,
    SHOWN_S,
    Bumps,
    extremes,
    fastest,
    ring_down_times,
    saturated_time,
    when,
)
from scenarios.claims import CHOSEN, OWN_CHECK, PREDICTED, Claim, interval_claim, markdown
from vehicle.car import SATURATED_VELOCITY

FIRST_SLIP, FIRST_SLIP_TOLERANCE = 5.035, 0.010
"""First slip after the 7.5 mm bump with Fd 125 N [s], read off figure 3.12."""

PUBLISHED_FRICTION = 125.0
"""Fd at which the model of the source slipped when the car did [N]."""

RATIO = 2.0
"""'Much more time' to ring down: at least this ratio."""


def slip_claims(bumps: Bumps) -> list[Claim]:
    """Rows about the first slip of both bumps."""
    times = bumps.first_slip(bumps.slip_velocity)
    slip, end = (bumps.first_slip(limit)[PUBLISHED_FRICTION] for limit in (bumps.slip_velocity, SATURATED_VELOCITY))
    ordered = [times[friction] for friction in sorted(times)]
    rising = all(time is not None for time in ordered) and bool(np.all(np.diff(np.array(ordered, dtype=float)) > 0.0))
    limit = f"{1e3 * bumps.slip_velocity:g} mm/s"
    return [
        PREDICTED.number(
            "bump 7.5 mm, first slip with Fd 125 N [s]",
            FIRST_SLIP,
            float("inf") if slip is None else slip,
            FIRST_SLIP_TOLERANCE,
            f"first sample above {limit}, the velocity of all slip shares; read off a "
            "figure: 10 ms. The figure shows the end of stick, before the damper is that fast: the next row",
        ),
        CHOSEN.number(
            "bump 7.5 mm, end of stick with Fd 125 N [s]",
            FIRST_SLIP,
            float("inf") if end is None else end,
            FIRST_SLIP_TOLERANCE,
            "first sample above 1 mm/s, where the friction is saturated: no definition of slip here. The reading of "
            "the printed amplitude as height was chosen by it and by the 1.5 mm bump",
        ),
        PREDICTED.statement(
            "bump 7.5 mm, first slip against Fd",
            "later for a larger Fd, earlier for a smaller one",
            ", ".join(f"{friction:g} N {when(time)}" for friction, time in times.items()),
            rising,
            "rising from value to value",
        ),
        CHOSEN.statement(
            "bump 1.5 mm",
            "no slip",
            f"largest damper velocity {1e3 * fastest(bumps.noisy[0]):.1f} mm/s",
            fastest(bumps.noisy[0]) <= bumps.slip_velocity,
            f"slip is above {limit}, the velocity fitted to the slip shares of the random "
            f"inputs; the friction is saturated, above 1 mm/s, for {1e3 * saturated_time(bumps.noisy[0]):.0f} ms. "
            "The reading of the printed amplitude as height was chosen by it",
        ),
    ]


SHOWN_POINTS = {
    "seat_rail": "3.13, where it is not said",
    "seat": "3.14, where it is not said",
    "engine": "3.17, where the source says so",
    "roof_left_rear": "3.18, where it is not said",
}
"""Points whose vertical histories the source shows for both bumps, and the figure."""

WEAKEST = "the weakest of all points and of the body as a whole"


def ring_down_claims(bumps: Bumps) -> Iterator[Claim]:
    """Rows: the low bump rings down more slowly."""
    low, high = (ring_down_times(run, bumps.record.end) for run in bumps.quiet)
    after = (
        "our own check: when the damper sticks again after 7.5 mm, what is left rings on as slowly as after 1.5 mm, "
        "and here more than 20 % are left"
    )
    figures = {point: f"definition below the table; figure {figure}" for point, figure in SHOWN_POINTS.items()}
    for name, why in (*figures.items(), (WEAKEST, after)):
        point = min(low, key=lambda one: low[one] / high[one]) if name == WEAKEST else name
        ratio = low[point] / high[point]
        yield (PREDICTED if name == "engine" else OWN_CHECK).statement(
            f"ring-down to 20 %, 1.5 mm against 7.5 mm, {name.replace('_', ' ')}",
            "much longer (at least twice)",
            f"{point.replace('_', ' ')}: {low[point]:.2f} s against {high[point]:.2f} s, {ratio:.1f} times",
            ratio >= RATIO,
            why,
        )


def slip_table(bumps: Bumps) -> str:
    """First slip by friction limit, and ring-down times, as tables."""
    slip, end = (bumps.first_slip(velocity) for velocity in (bumps.slip_velocity, SATURATED_VELOCITY))
    low, high = (ring_down_times(run, bumps.record.end) for run in bumps.quiet)
    times = {point: (time, high[point], time / high[point]) for point, time in low.items()}
    tables = (
        "First slip after the 7.5 mm bump that begins at 5 s [s]:",
        markdown(
            ("Fd [N]", f"slip, above {1e3 * bumps.slip_velocity:g} mm/s", "end of stick, above 1 mm/s"),
            [(f"{friction:g}", when(time), when(end[friction])) for friction, time in slip.items()],
        ),
        "Ring-down to 20 % [s]:",
        markdown(
            ("point", "1.5 mm", "7.5 mm", "ratio"),
            [
                (point.replace("_", " "), *(f"{value:.2f}" if np.isfinite(value) else "-" for value in row))
                for point, row in times.items()
            ],
        ),
    )
    return "\n\n".join(tables)


Extremes = Mapping[str, tuple[float, float]]
"""Point to lowest and highest acceleration [m/s2]."""


def extreme_claims(found: Extremes, literal: Extremes, name: str) -> list[Claim]:
    """A row for each end of each axis.

    Args:
        found: ours.
        literal: the same with the other reading of the printed amplitude, as evidence for a deviation.
        name: of the other reading.
    """
    return [
        interval_claim(
            f"bump 7.5 mm, {word} {point}{'' if point == RELATIVE else ', vertical'} [m/s2]",
            interval,
            ours,
            f"figure {figure}, whose axis holds model and measurement; with noise, {SHOWN_S:g} s from the bump. With "
            f"the {name} reading {other:.2f}",
            # The body was chosen among several with these figures in view (`vehicle.flexbody.fit`).
            status="chosen",
        )
        for point, (figure, _, *ends) in FIGURE_AXES.items()
        for word, interval, ours, other in zip(("lowest", "highest"), ends, found[point], literal[point], strict=True)
    ]


def bump_claims(bumps: Bumps) -> list[Claim]:
    """All rows but those about ring-down, which needs a long record."""
    found, other = (extremes(pair[1], bumps.record.start) for pair in (bumps.noisy, bumps.other))
    return [*slip_claims(bumps), *extreme_claims(found, other, bumps.other_reading)]
