"""Published statements about the bumps beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from scenarios.bump.runs import FIGURE_AXES, RELATIVE, SHOWN_S, BumpNumbers, when
from scenarios.claims import CHOSEN, OWN_CHECK, PREDICTED, Claim, interval_claim

FIRST_SLIP, FIRST_SLIP_TOLERANCE = 5.035, 0.010
"""First slip after the 7.5 mm bump with Fd 125 N [s], read off figure 3.12."""

PUBLISHED_FRICTION = 125.0
"""Fd at which the model of the source slipped when the car did [N]."""

RATIO = 2.0
"""'Much more time' to ring down: at least this ratio."""


def bump_claims(values: BumpNumbers, *, quick: bool) -> tuple[list[Claim], dict[str, str]]:
    """Rows of the bumps, and the statements that a short record cannot judge."""
    claims = [
        *_slip_claims(values),
        _low_claim(values),
        *extreme_claims(values.extremes, values.other_extremes, values.other_reading),
    ]
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
        PREDICTED.number(
            "bump 7.5 mm, first slip with Fd 125 N [s]",
            FIRST_SLIP,
            float("inf") if slip is None else slip,
            FIRST_SLIP_TOLERANCE,
            f"first sample above {1e3 * values.slip_velocity:g} mm/s, the velocity of all slip shares; read off a "
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
    ]


def _low_claim(values: BumpNumbers) -> Claim:
    return CHOSEN.statement(
        "bump 1.5 mm",
        "no slip",
        f"largest damper velocity {1e3 * values.low_velocity:.1f} mm/s",
        values.low_velocity <= values.slip_velocity,
        f"slip is above {1e3 * values.slip_velocity:g} mm/s, the velocity fitted to the slip shares of the random "
        f"inputs; the friction is saturated, above 1 mm/s, for {1e3 * values.low_saturated:.0f} ms. The reading of the "
        "printed amplitude as height was chosen by it",
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
        (PREDICTED if name == "engine" else OWN_CHECK).statement(
            ring_down_name(name),
            "much longer (at least twice)",
            f"{point.replace('_', ' ')}: {low[point]:.2f} s against {high[point]:.2f} s, "
            f"{low[point] / high[point]:.1f} times",
            low[point] / high[point] >= RATIO,
            why,
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
            f"| {friction:g} | {when(time)} | {when(values.stick_end[friction])} |"
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


def extreme_claims(
    found: dict[str, tuple[float, float]], literal: dict[str, tuple[float, float]], name: str
) -> list[Claim]:
    """A row for each end of each axis.

    Args:
        found: point to lowest and highest acceleration [m/s2].
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
