"""Bumps of 1.5 and 7.5 mm under the right front wheel: first slip, extremes, ring-down (chapter 3 of source 1).

python -m scenarios.bump [--output DIR] [--reading height|literal] [--video [FILE.mp4]] [--quick] [--jobs N] ...
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from scenarios.bump.figures import friction_figure, history_figures, ring_down_figure, side_by_side
from scenarios.bump.runs import (
    FIGURE_AXES,
    FIRST_SLIP,
    FIRST_SLIP_TOLERANCE,
    FRICTIONS,
    FULL,
    OTHER,
    PUBLISHED_FRICTION,
    QUICK,
    RELATIVE,
    SHOWN_S,
    Bumps,
    extremes,
    fastest,
    ring_down_times,
    run_bumps,
    saturated_time,
    slip_after,
    when,
)
from scenarios.car_runs import CarRuns
from scenarios.claims import CHOSEN, OWN_CHECK, PREDICTED, Claim, Findings, interval_claim, markdown
from scenarios.study import car_study, setting
from vehicle.car import SATURATED_VELOCITY
from vehicle.errors import ConfigurationError

RING_DOWN = (
    "Ring-down time: from the end of the bump until the vertical acceleration last exceeds 20 % of its largest value "
    "after the bump, in a run without the random noise, which alone is above 20 % at most points. Body: RMS over seat "
    "rail, seat, roof left rear and body front."
)


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run the bumps, draw the figures (and the film) into the folder, and compare."""
    if options.video is not None:
        from vehicle.rendering.backend import require_film

        if Path(options.video).suffix != ".mp4":
            raise ConfigurationError(f"--video {options.video}: a film is written as .mp4; give FILE.mp4")
        require_film()
    record = QUICK if options.quick else FULL
    bumps = run_bumps(runs, record, options.reading, FRICTIONS[::2] if options.quick else FRICTIONS)
    history_figures(folder, bumps)
    friction_figure(folder / "friction.png", bumps)
    ring_down_figure(folder / "ring_down.png", bumps)
    if options.video is not None:
        shown = runs([runs.case(run.signal, engine="mujoco") for run in bumps.noisy])
        side_by_side(folder / options.video, shown, start=record.start - 0.1, duration=record.film)
    found, literal = (extremes(pair[1], record.start) for pair in (bumps.noisy, bumps.other))
    rows = [*slip_claims(bumps), *extreme_claims(found, literal, bumps.other_reading)]
    ringing = list(ring_down_claims(bumps))
    too_short = "the record ends before the motion has rung down"
    low, high = bumps.other
    slip, end = (when(slip_after(high, record.start, limit)) for limit in (bumps.slip_velocity, SATURATED_VELOCITY))
    return Findings(
        title=f"Bumps of 1.5 and 7.5 mm, {options.reading} reading (source 1, section 3.2.2)",
        claims=[*rows, *ringing],
        tyres=runs.car().vehicle.driving.words,
        unjudged={claim.name: too_short for claim in ringing} if options.quick else {},
        notes=[
            slip_table(bumps),
            RING_DOWN,
            f"The other reading of the printed formula ({bumps.other_reading}): first slip {slip} (above 1 mm/s {end}) "
            f"with 7.5 mm; with 1.5 mm largest damper velocity {1e3 * fastest(low):.1f} mm/s "
            f"({'slips' if fastest(low) > bumps.slip_velocity else 'does not slip'}).",
            *setting(runs, bumps.noisy[0], options.quick),
        ],
        data=bumps.data(),
    )


def add_options(parser: argparse.ArgumentParser) -> None:
    """Options of this study alone."""
    meaning = "A of the printed formula as peak height, or taken literally (peak 2 A)"
    parser.add_argument("--reading", choices=sorted(OTHER), default="height", help=meaning)
    film = "film of both bumps side by side, in step"
    parser.add_argument("--video", nargs="?", const="bumps.mp4", metavar="FILE.mp4", help=film)


main = car_study("bump", study, add_options)


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


if __name__ == "__main__":
    sys.exit(main())
