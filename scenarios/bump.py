"""Bumps of 1.5 and 7.5 mm under the right front wheel: first slip, extremes, ring-down (chapter 3 of source 1).

python -m scenarios.bump [--output DIR] [--reading height|literal] [--video [FILE.mp4]] [--quick] [--jobs N] ...
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, replace
from pathlib import Path

from scenarios.bump_claims import BumpNumbers, bump_claims, numbers, slip_table
from scenarios.bump_figures import friction_figure, history_figures, ring_down_figure
from scenarios.car_runs import CarRuns, Case
from scenarios.car_study import Findings, car_parser, run_car_study, setting
from vehicle.car import Run
from vehicle.errors import ConfigurationError
from vehicle.excitation.bump import BUMP_DURATION_S, BUMP_START_S, NOISE_RMS, Reading, bump
from vehicle.excitation.signal import Signal

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

RING_DOWN = (
    "Ring-down time: from the end of the bump until the vertical acceleration last exceeds 20 % of its largest value "
    "after the bump, in a run without the random noise, which alone is above 20 % at most points. Body: RMS over seat "
    "rail, seat, roof left rear and body front."
)


def study(
    runs: CarRuns, folder: Path, *, quick: bool, reading: Reading = "height", video: Path | None = None
) -> Findings:
    """Run the bumps, draw the figures (and the film) into the folder, and compare."""
    record = QUICK if quick else FULL
    frictions = QUICK_FRICTIONS if quick else FRICTIONS
    noisy = [Case(signal=_signal(record, size, reading, noise=True)) for size in (LOW, HIGH)]
    quiet = [Case(signal=_signal(record, size, reading, noise=False)) for size in (LOW, HIGH)]
    varied = [
        Case(signal=noisy[1].signal, overrides=(f"damper.coulomb_friction={friction!r}",)) for friction in frictions
    ]
    other = [Case(signal=_signal(record, size, OTHER[reading], noise=True)) for size in (LOW, HIGH)]
    found = runs([*noisy, *quiet, *varied, *other])
    bumps, still = found[:2], found[2:4]
    by_friction: dict[float, Run] = dict(zip(frictions, found[4 : 4 + len(frictions)], strict=True))
    values: BumpNumbers = numbers(
        bumps, still, by_friction, found[-2:], OTHER[reading], start=record.start, end=record.end
    )
    history_figures(folder, bumps, still, (LOW, HIGH), record.start)
    friction_figure(folder / "friction.png", by_friction, values, record.start)
    ring_down_figure(folder / "ring_down.png", still, (LOW, HIGH), record.end)
    if video is not None:
        from scenarios.bump_film import side_by_side

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


def _signal(record: Record, amplitude: float, reading: Reading, *, noise: bool) -> Signal:
    duration, level = (record.noisy, NOISE_RMS) if noise else (record.quiet, 0.0)
    signal = bump(amplitude=amplitude, reading=reading, duration=duration, start=record.start, noise_rms=level)
    # The film writes the source over its picture, where the text of the generator has no room.
    return replace(signal, source=f"bump {1e3 * amplitude:g} mm")


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = car_parser("bump", "Bumps of 1.5 and 7.5 mm: first slip against friction, ring-down, time histories.")
    parser.add_argument(
        "--reading",
        choices=sorted(OTHER),
        default="height",
        help="A of the printed formula as peak height, or taken literally (peak 2 A)",
    )
    parser.add_argument(
        "--video", nargs="?", const="bumps.mp4", metavar="FILE.mp4", help="film of both bumps side by side, in step"
    )
    return run_car_study(parser, _study, arguments)


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    video = None if options.video is None else Path(options.video)
    if video is not None:
        from vehicle.rendering.backend import require_film

        if video.suffix != ".mp4":
            raise ConfigurationError(f"--video {video}: a film is written as .mp4; give FILE.mp4")
        require_film()
    return study(runs, folder, quick=options.quick, reading=options.reading, video=video)


if __name__ == "__main__":
    sys.exit(main())
