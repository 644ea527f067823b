"""Cars on a four-post rig: heave, pitch, roll and warp of the plates, dampers stuck and sliding.

python -m scenarios.four_post [--output DIR] [--quick] [--engine mujoco|reduced|auto] [--vehicle FILE.toml]
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.claims import OWN_CHECK, Claim, Findings, markdown
from scenarios.four_post.figures import Exact, level_words, response_figure, slip_figure
from scenarios.four_post.runs import (
    LEVELS,
    PROMINENCE_DB,
    QUICK_DURATION,
    QUICK_LEVELS,
    STATES,
    Matched,
    OneRun,
    distance_db,
    matched_peaks,
    matrix_response,
    run_motion,
)
from scenarios.signals.four_post import DURATION_S, MOTIONS
from scenarios.study import QUICK_NOTE, Study, study_parser
from vehicle.commands.options import setting_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.engines.linear.car_modes import Mode
from vehicle.model.parameters.driving import tyre_words
from vehicle.runs.car import Car
from vehicle.studies.sweeps.sweep_settings import SweepSettings

CARS = ("focus_road", "sedan")
"""Shipped cars on four wheels."""

STICKS, SLIDES = 0.01, 0.3
"""Share of the time in slip up to which a car sticks, and from which it slides."""

TOO_SHORT = f"{QUICK_DURATION:g} s of signal do not resolve the peaks of a car without damping"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Found:
    """Results of one car on the rig."""

    car: Car  # the car
    runs: Sequence[OneRun]  # runs of all motions and levels
    exact: Exact  # FRFs from the matrices
    modes: dict[str, list[Mode]]  # state of the dampers to modes
    peaks: Sequence[Matched]  # peaks of the lowest level, matched with the matrices with stuck dampers
    # (motion, level, state) to the distance of the FRFs of run and matrices [dB]
    distances: dict[tuple[str, float, str], float]


def examine(car: Car, *, quick: bool, engine: str) -> Found:
    """Run a car in all motions and levels, and compare the runs with the matrices."""
    levels = QUICK_LEVELS if quick else LEVELS
    ends, duration = (levels[0], levels[-1]), QUICK_DURATION if quick else DURATION_S
    runs = [
        run_motion(car, motion, level, duration=duration, engine=engine, response=level in ends)
        for motion in MOTIONS
        for level in levels
    ]
    exact = {(motion, state): matrix_response(car, motion, state) for motion in MOTIONS for state in STATES}
    modes = {state: car.modes(state) for state in STATES}
    shown = [response_run for response_run in runs if response_run.response is not None]
    low = [response_run for response_run in shown if response_run.level == ends[0]]
    return Found(
        car=car,
        runs=runs,
        exact=exact,
        modes=modes,
        peaks=[
            peak
            for response_run in low
            for peak in matched_peaks(car, response_run, "stuck", exact[response_run.motion, "stuck"], modes["stuck"])
        ],
        distances={
            (response_run.motion, response_run.level, state): distance_db(
                response_run.response, exact[response_run.motion, state]
            )
            for response_run in shown
            for state in STATES
            if response_run.response is not None
        },
    )


def study(cars: Sequence[Car], folder: Path, options: argparse.Namespace) -> Findings:
    """Put every car on the rig, draw the figures into the folder, and compare."""
    examined = [examine(car, quick=options.quick, engine=options.engine) for car in cars]
    for entry in examined:
        name, shown = entry.car.vehicle.name, [run for run in entry.runs if run.response is not None]
        engines = " and ".join(sorted({run.engine for run in entry.runs}))
        settings = f"engine {engines}; {QUICK_DURATION if options.quick else DURATION_S:g} s each"
        settings = f"tyres {entry.car.vehicle.driving.words}; {settings}"
        caption = (
            f"Displacements of the plates as on, and a share of those on, a road of class A at 80 km/h; {settings}"
        )
        response_figure(folder / f"{name}_responses.png", entry.car, shown, entry.exact, caption)
        slip = 1e3 * entry.car.vehicle.damper.slip_velocity
        slip_figure(folder / f"{name}_slip.png", entry.car, entry.runs, f"In slip: |v| above {slip:g} mm/s; {settings}")
    claims = [claim for entry in examined for claim in claims_of(entry)]
    peaks = {claim.name for claim in claims if "peaks" in claim.name}
    return Findings(
        title="Cars on a four-post rig",
        claims=claims,
        tyres=tyre_words(entry.vehicle.driving for entry in cars),
        unjudged=dict.fromkeys(peaks, TOO_SHORT) if options.quick else {},
        notes=[
            *(
                text
                for entry in examined
                for text in (in_words(entry), mode_table(entry), peak_table(entry), level_table(entry))
            ),
            *([QUICK_NOTE] if options.quick else []),
        ],
        data={"cars": {entry.car.vehicle.name: numbers(entry) for entry in examined}},
    )


def claims_of(examined: Found) -> list[Claim]:
    """Return the rows on the runs of a car: checks against the matrices and the friction law."""
    name, low, high = examined.car.vehicle.name, examined.runs[0].level, examined.runs[-1].level
    slips = {level: [max(run.slip.values()) for run in examined.runs if run.level == level] for level in (low, high)}
    errors = [(abs(peak.deviation), width(peak)) for peak in examined.peaks if peak.deviation is not None]
    outside = sum(deviation > allowed for deviation, allowed in errors)
    closer = [
        (examined.distances[motion, low, "stuck"] < examined.distances[motion, low, "sliding"])
        and (examined.distances[motion, high, "sliding"] < examined.distances[motion, high, "stuck"])
        for motion in MOTIONS
    ]
    return [
        OWN_CHECK.statement(
            f"{name}: dampers on {level_words(low)}",
            "stuck",
            f"at most {100 * max(slips[low]):.2f} % of the time in slip",
            max(slips[low]) <= STICKS,
            f"all four motions, the damper that slips most; up to {100 * STICKS:g} % counts as stuck",
        ),
        OWN_CHECK.statement(
            f"{name}: dampers on {level_words(high)}",
            "sliding",
            f"at least {100 * min(slips[high]):.0f} % of the time in slip",
            min(slips[high]) >= SLIDES,
            f"all four motions, the damper that slips most; from {100 * SLIDES:g} % on counts as sliding",
        ),
        OWN_CHECK.statement(
            f"{name}: peaks on {level_words(low)} against the matrices with stuck dampers",
            "all within their width",
            f"{len(errors)} of {len(examined.peaks)} found, {outside} outside, "
            f"largest deviation {100 * max((deviation for deviation, _ in errors), default=np.inf):.2f} %",
            len(errors) >= 0.8 * len(examined.peaks) and not outside,
            f"peaks of the matrices of {PROMINENCE_DB:g} dB and more; half of the half-power width, the damping ratio "
            "of the mode, and a line of the record; one in five may be too narrow for the record",
        ),
        OWN_CHECK.statement(
            f"{name}: which linear car the FRFs are near to",
            "stuck below, sliding above",
            f"{sum(closer)} of {len(closer)} motions",
            all(closer),
            "RMS distance of the magnitudes in dB, 1 to 30 Hz, body and wheel carriers",
        ),
        OWN_CHECK.statement(
            f"{name}: seat rail over the level, {level_words(low)} against {level_words(high)}",
            "more, since nothing but rubber damps a car whose dampers stick",
            ", ".join(f"{motion} {ratio:.1f} times" for motion, ratio in roughness(examined).items()),
            min(roughness(examined).values()) > 1.0,
            "RMS of the unfiltered acceleration, 2 to 50 Hz, over the displacement of the plates",
        ),
    ]


def width(peak: Matched) -> float:
    """Return half of the half-power width of a peak plus a line spacing of the record, over the frequency."""
    damping = 0.0 if peak.mode is None else peak.mode.damping_ratio
    return damping + 1.0 / (DURATION_S * peak.peak.frequency_hz)


def roughness(examined: Found) -> dict[str, float]:
    """Return motion to ratio of (comfort value over level) on smoothest and roughest input; 1 for a linear car."""
    roughness_by_motion = {}
    for motion in MOTIONS:
        motion_runs = [run for run in examined.runs if run.motion == motion]
        roughness_by_motion[motion] = (
            motion_runs[0].comfort / motion_runs[0].level / (motion_runs[-1].comfort / motion_runs[-1].level)
        )
    return roughness_by_motion


def in_words(examined: Found) -> str:
    """Return a text on the results: maximum level with stuck dampers, and change of the ride modes."""
    levels = sorted({run.level for run in examined.runs})
    sticking = [
        level for level in levels if all(max(r.slip.values()) <= STICKS for r in examined.runs if r.level <= level)
    ]
    sticks = f"sticks in all four motions up to {level_words(sticking[-1])}" if sticking else "sticks on none of them"
    first = {
        state: next((mode for mode in examined.modes[state] if mode.description.startswith("body heave")), None)
        for state in STATES
    }
    heave = " and ".join(
        f"{mode.frequency:.2f} Hz with {100 * mode.damping_ratio:.1f} % while they are {state}"
        for state, mode in first.items()
        if mode is not None
    )
    shares = [100 * max(run.slip.values()) for run in examined.runs if run.level == levels[-1]]
    more = roughness(examined).values()
    return (
        f"{examined.car.vehicle.name} {sticks}; on {level_words(levels[-1])} its dampers slip {min(shares):.0f} to "
        f"{max(shares):.0f} % of the time. Body heave is at {heave or 'no mode of its own'}. The seat rail shakes, "
        f"over the level of the input, {min(more):.1f} to {max(more):.1f} times as much on {level_words(levels[0])} as "
        f"on {level_words(levels[-1])}."
    )


def mode_table(examined: Found) -> str:
    """Return a table of ride modes (led by the body) and vertical wheel modes, dampers stuck and sliding."""

    def kept(mode: Mode) -> bool:
        leader = mode.description.partition(",")[0]
        return leader.startswith("body") or leader.endswith("wheel vertical")

    rows = [
        [state, f"{mode.frequency:.2f}", f"{100 * mode.damping_ratio:.1f}", mode.description]
        for state in STATES
        for mode in examined.modes[state]
        if kept(mode)
    ]
    head = f"{examined.car.vehicle.name}: modes of body and wheels (vehicle.modes has all):\n\n"
    return head + markdown(("dampers", "frequency [Hz]", "damping [%]", "what moves"), rows)


def peak_table(examined: Found) -> str:
    """Return a table of the peaks of the lowest level with those of the matrices, and the modes."""
    rows = [
        [
            peak.motion,
            peak.channel,
            f"{peak.peak.frequency_hz:.2f}",
            "-" if peak.found is None else f"{peak.found.frequency_hz:.2f}",
            "-" if peak.deviation is None else f"{100 * peak.deviation:+.2f}",
            "-" if peak.found is None else f"{peak.found.magnitude / peak.peak.magnitude:.2f}",
            "-" if peak.mode is None else f"{peak.mode.frequency:.2f} Hz, {peak.mode.description}",
        ]
        for peak in examined.peaks
    ]
    head = (
        f"{examined.car.vehicle.name}: peaks of the transmissibility, run on "
        f"{level_words(examined.runs[0].level)} against the "
        "matrices with stuck dampers, and the mode nearest in frequency:\n\n"
    )
    heads = ("plates", "channel", "matrices [Hz]", "run [Hz]", "deviation [%]", "height over matrices", "mode")
    return head + markdown(heads, rows)


def level_table(examined: Found) -> str:
    """Return a table of slip, comfort and distance to both linear cars over the level."""
    rows = [
        [
            run.motion,
            level_words(run.level),
            run.engine,
            *(f"{100 * run.slip.get(wheel, float('nan')):.1f}" for wheel in ("fr", "rr")),
            f"{run.comfort:.3f}",
            *(
                "-" if (value := examined.distances.get((run.motion, run.level, state))) is None else f"{value:.2f}"
                for state in STATES
            ),
        ]
        for run in examined.runs
    ]
    heads = ("plates", "level", "engine", "slip front [%]", "slip rear [%]", "seat rail RMS [m/s2]")
    head = f"{examined.car.vehicle.name}: share of the time in slip, and how far the FRFs are from the linear car:\n\n"
    return head + markdown((*heads, "to stuck [dB]", "to sliding [dB]"), rows)


def numbers(examined: Found) -> dict[str, Any]:
    """Return the values of the tables as plain data."""
    return {
        "runs": [
            {"motion": run.motion, "level": run.level, "engine": run.engine, "slip": run.slip, "comfort": run.comfort}
            | {f"to_{state}_db": examined.distances.get((run.motion, run.level, state)) for state in STATES}
            for run in examined.runs
        ],
        "peaks": [
            {
                "motion": peak.motion,
                "channel": peak.channel,
                "matrices_hz": peak.peak.frequency_hz,
                "run_hz": None if peak.found is None else peak.found.frequency_hz,
                "mode_hz": None if peak.mode is None else peak.mode.frequency,
                "mode": None if peak.mode is None else peak.mode.description,
            }
            for peak in examined.peaks
        ],
    }


def load(options: argparse.Namespace) -> list[Car]:
    """Return the car of --vehicle, or the shipped cars on four wheels."""
    names = CARS if options.vehicle is None else (options.vehicle,)
    cars = [Car.load(name, options.overrides) for name in names]
    for car in cars:
        car.vehicle.require_wheels(MOTIONS["heave"])
    return cars


def _parser() -> Parser:
    jobs = "; this study runs in one process, so that it changes nothing"
    parser = study_parser("four_post", quick="short signals at two levels; peaks are left open", jobs=jobs)
    vehicle_options(parser)
    setting_options(parser, SweepSettings, "engine")
    return parser


main = Study(parser=_parser(), load=load, study=study)


if __name__ == "__main__":
    sys.exit(main())
