"""Bumps of 1.5 and 7.5 mm under the right front wheel: first slip, extremes, ring-down (chapter 3 of source 1).

python -m scenarios.bump [--output DIR] [--reading height|literal] [--video [FILE.mp4]] [--quick] [--jobs N] ...
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from scenarios.bump.claims import bump_claims, slip_table
from scenarios.bump.figures import friction_figure, history_figures, ring_down_figure, side_by_side
from scenarios.bump.runs import FRICTIONS, FULL, HIGH, LOW, OTHER, QUICK, QUICK_FRICTIONS, bump_signal, numbers
from scenarios.car_runs import CarRuns, Case
from scenarios.claims import Findings
from scenarios.study import car_study, setting
from vehicle.errors import ConfigurationError
from vehicle.excitation.bump import Reading

RING_DOWN = (
    "Ring-down time: from the end of the bump until the vertical acceleration last exceeds 20 % of its largest value "
    "after the bump, in a run without the random noise, which alone is above 20 % at most points. Body: RMS over seat "
    "rail, seat, roof left rear and body front."
)


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run the bumps, draw the figures (and the film) into the folder, and compare."""
    quick, video = options.quick, options.video
    reading: Reading = options.reading
    if video is not None:
        from vehicle.rendering.backend import require_film

        if Path(video).suffix != ".mp4":
            raise ConfigurationError(f"--video {video}: a film is written as .mp4; give FILE.mp4")
        require_film()
    record = QUICK if quick else FULL
    frictions = QUICK_FRICTIONS if quick else FRICTIONS
    noisy = [Case(signal=bump_signal(record, size, reading, noise=True)) for size in (LOW, HIGH)]
    quiet = [Case(signal=bump_signal(record, size, reading, noise=False)) for size in (LOW, HIGH)]
    varied = [
        Case(signal=noisy[1].signal, overrides=(f"damper.coulomb_friction={friction!r}",)) for friction in frictions
    ]
    other = [Case(signal=bump_signal(record, size, OTHER[reading], noise=True)) for size in (LOW, HIGH)]
    found = runs([*noisy, *quiet, *varied, *other])
    bumps, still = found[:2], found[2:4]
    by_friction = dict(zip(frictions, found[4 : 4 + len(frictions)], strict=True))
    values = numbers(bumps, still, by_friction, found[-2:], OTHER[reading], start=record.start, end=record.end)
    history_figures(folder, bumps, still, (LOW, HIGH), record.start)
    friction_figure(folder / "friction.png", by_friction, values, record.start)
    ring_down_figure(folder / "ring_down.png", still, (LOW, HIGH), record.end)
    if video is not None:
        cases = [Case(signal=case.signal, engine="mujoco") for case in noisy]
        side_by_side(folder / video, runs(cases), (LOW, HIGH), start=record.start - 0.1, duration=record.film)
    claims, unjudged = bump_claims(values, quick=quick)
    return Findings(
        title=f"Bumps of 1.5 and 7.5 mm, {reading} reading (source 1, section 3.2.2)",
        claims=claims,
        unjudged=unjudged,
        notes=[
            slip_table(values),
            RING_DOWN,
            f"The other reading of the printed formula ({OTHER[reading]}): first slip {values.other_first_slip} with "
            f"7.5 mm; with 1.5 mm largest damper velocity {1e3 * values.other_low_velocity:.1f} mm/s "
            f"({'slips' if values.other_low_slips else 'does not slip'}).",
            *setting(runs, found[0], quick),
        ],
        data=values.data(),
    )


def add_options(parser: argparse.ArgumentParser) -> None:
    """Options of this study alone."""
    meaning = "A of the printed formula as peak height, or taken literally (peak 2 A)"
    parser.add_argument("--reading", choices=sorted(OTHER), default="height", help=meaning)
    film = "film of both bumps side by side, in step"
    parser.add_argument("--video", nargs="?", const="bumps.mp4", metavar="FILE.mp4", help=film)


main = car_study("bump", study, add_options)


if __name__ == "__main__":
    sys.exit(main())
