"""Bumps of 1.5 and 7.5 mm under the wheel on the shaker: first slip, extremes, ring-down (chapter 3 of Bommer 2006).

python -m scenarios.bump [--output DIR] [--reading height|literal] [--video [FILE.mp4]] [--quick] [--jobs N] ...
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scenarios.bump.claims import extreme_claims, ring_down_claims, slip_claims
from scenarios.bump.figures import friction_figure, history_figures, ring_down_figure, side_by_side
from scenarios.bump.linear_models import linear_claim, linear_errors
from scenarios.bump.runs import (
    FRICTIONS,
    FULL,
    OTHER,
    QUICK,
    Bumps,
    fastest,
    ring_down_times,
    run_bumps,
    slip_after,
    when,
)
from scenarios.bump.seeds import RECORD, SEEDS, BumpSeeds, experiments, many_seeds
from scenarios.car_runs import CarRuns
from scenarios.claims import Findings, markdown
from scenarios.signals.bump import Reading
from scenarios.study import CarSettings, car_study, setting
from vehicle.errors import ConfigurationError
from vehicle.runs.car import SATURATED_VELOCITY
from vehicle.settings import setting as declared

RING_DOWN = (
    "Ring-down time: from the end of the bump until the vertical acceleration last exceeds 20 % of its largest value "
    "after the bump, in a run without the random noise, which alone is above 20 % at most points. Body: RMS over seat "
    "rail, seat, roof left rear and body front."
)


@dataclass(frozen=True, kw_only=True, slots=True)
class BumpSettings(CarSettings):
    """Settings of the study of bumps."""

    reading: Reading = declared(
        "A of the printed formula as peak height, or taken literally (peak 2 A)", "height", choices=sorted(OTHER)
    )
    video: str | None = declared(
        "film of both bumps side by side, in step", nargs="?", const="bumps.mp4", metavar="FILE.mp4"
    )


def study(runs: CarRuns, folder: Path, settings: BumpSettings) -> Findings:
    """Run the bumps, draw the figures (and the film) into the folder, and compare."""
    if settings.video is not None:
        from vehicle.drawing.rendering.backend import require_film

        if Path(settings.video).suffix != ".mp4":
            raise ConfigurationError(f"--video {settings.video}: a film is written as .mp4; give FILE.mp4")
        require_film()
    record = QUICK if settings.quick else FULL
    frictions = FRICTIONS[::2] if settings.quick else FRICTIONS
    bumps = run_bumps(runs, record, settings.reading, frictions)
    count = 2 if settings.quick else SEEDS
    seeds = many_seeds(runs, settings.reading, frictions, count)
    trials = {} if settings.quick else experiments(runs, settings.reading, bumps.other_reading, seeds)
    history_figures(folder, bumps, seeds)
    friction_figure(folder / "friction.png", bumps)
    ring_down_figure(folder / "ring_down.png", bumps)
    if settings.video is not None:
        shown = runs([runs.case(run.signal, engine="mujoco") for run in bumps.noisy])
        side_by_side(folder / settings.video, shown, start=record.start - 0.1, duration=record.film)
    ends = extreme_claims(seeds, trials)
    slips, ringing = slip_claims(bumps, seeds), list(ring_down_claims(bumps))
    too_short = {claim.name: "the record ends before the motion has rung down" for claim in ringing}
    # The last of the slips must hold with every seed.
    too_few = {claim.name: "two seeds of the noise tell its spread too coarsely" for claim in (slips[-1], *ends)}
    low, high = bumps.other
    slip, end = (when(slip_after(high, record.start, limit)) for limit in (bumps.slip_velocity, SATURATED_VELOCITY))
    return Findings(
        title=f"Bumps of 1.5 and 7.5 mm, {settings.reading} reading (Bommer 2006, section 3.2.2)",
        claims=[*slips, *ends, *ringing, linear_claim(linear_errors(runs, count))],
        tyres=runs.car().vehicle.driving.words,
        unjudged={**too_few, **too_short} if settings.quick else {},
        notes=[
            slip_table(bumps),
            seeds_text(seeds),
            RING_DOWN,
            f"The other reading of the printed formula ({bumps.other_reading}): first slip {slip} (above 1 mm/s {end}) "
            f"with 7.5 mm; with 1.5 mm largest damper velocity {1e3 * fastest(low):.1f} mm/s "
            f"({'slips' if fastest(low) > bumps.slip_velocity else 'does not slip'}).",
            *setting(runs, bumps.noisy[0], settings.quick),
        ],
        data={**bumps.data(), **seeds.data(), "experiments": trials},
    )


main = car_study("bump", study, BumpSettings)


def seeds_text(seeds: BumpSeeds) -> str:
    """Return a note on the seeds, noise and engine of the rows over seeds."""
    return (
        f"End of sticking and extremes: {seeds.count} seeds of the noise, {RECORD.noisy:g} s each with the bump at "
        f"{RECORD.start:g} s, engine {seeds.engine}; the pictured runs have the seed of the shipped inputs. "
        "Experiments beside a row that disagrees: means of the same seeds."
    )


def slip_table(bumps: Bumps) -> str:
    """Return tables of the first slip by friction limit, and of the ring-down times."""
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


if __name__ == "__main__":
    sys.exit(main())
