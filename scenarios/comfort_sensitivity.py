"""Comfort on a smooth and a rough road against friction, suspension mount and body stiffness (source 1, chapter 4).

python -m scenarios.comfort_sensitivity [--output DIR] [--quick] [--jobs N] [--engine auto|reduced|mujoco]
    [--records N] [--source-only] [--vehicle FILE.toml] [--set PATH=VALUE]
"""

from __future__ import annotations

import argparse
import sys
import time as clock
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from scenarios.car_runs import CarRuns
from scenarios.claims import Claim
from scenarios.comfort_command import QUICK, comfort_parser, records_of
from scenarios.comfort_levels import level_claims, road_levels
from scenarios.comfort_sensitivity_beyond import beyond_findings, beyond_questions, rigid_curves
from scenarios.comfort_sensitivity_claims import TITLES, order_claims, size_claims, slip_claims
from scenarios.comfort_sensitivity_figures import draw_variation
from scenarios.comfort_sensitivity_runs import SOURCE, ComfortRuns, Curves
from scenarios.comfort_sensitivity_tables import curve_table, plain
from scenarios.comfort_setting import setting
from scenarios.road_signals import ROAD_EDGE_HZ, ROAD_RMS
from scenarios.study import QUICK_NOTE, Findings, run_car_study

QUICK_WHY = f"records of {QUICK.duration:g} s tell it too coarsely"

SURE = f"comfort value against {TITLES['coulomb_friction']}, smooth road"
"""What short records can judge: friction makes a smooth road worse, by far more than their error."""


def study(comfort: ComfortRuns, folder: Path, *, quick: bool, source_only: bool) -> Findings:
    """Run all cars on both roads, draw the figures into the folder, and compare."""
    started = clock.perf_counter()
    beyond = not (quick or source_only)
    questions = [question for variation in SOURCE for question in comfort.all_questions(variation)]
    # All at once: the worker processes take longer to start than most of the runs.
    comfort([*questions, *(beyond_questions(comfort) if beyond else [])])
    seconds = clock.perf_counter() - started
    curves = {variation.name: comfort.curves(variation) for variation in SOURCE}
    rigid = rigid_curves(comfort) if beyond else None
    notes = [
        *setting(comfort),
        f"{comfort.computed} runs of {comfort.records.duration:g} s, {len(set(questions))} of them for the three "
        f"parameters of source 1; computed in {seconds:.1f} s with --jobs {comfort.runs.jobs}.",
    ]
    for variation in SOURCE:
        beside = {"with a rigid body": rigid[variation.name]} if rigid else {}
        path = folder / f"{variation.name}.png"
        draw_variation(path, comfort, variation, curves[variation.name], beside=beside)
        notes.append(curve_table(variation.label, curves[variation.name]))
    data: dict[str, Any] = {
        "source": plain(curves),
        "records": asdict(comfort.records),
        "engine": comfort.engine,
        "road_edge_hz": ROAD_EDGE_HZ,
        "runs": comfort.computed,
        "seconds": seconds,
    }
    if beyond:
        more, numbers = beyond_findings(comfort, folder, curves)
        notes, data = [*notes, *more], {**data, **numbers}
    levels = road_levels(comfort)
    data["levels"] = {
        road: {"largest_seat_rail": one.seat_rail.tolist(), "swing": one.swing.tolist()} for road, one in levels.items()
    }
    claims = [*all_claims(comfort, curves, rigid), *level_claims(levels)]
    judged = [claim for claim in claims if claim.name == SURE] if quick else claims
    left = [claim for claim in claims if claim not in judged]
    return Findings(
        title="Comfort on a smooth and a rough road (source 1, chapter 4)",
        claims=judged,
        unjudged={claim.name: QUICK_WHY for claim in left},
        notes=[*notes, *([QUICK_NOTE] if quick else [])],
        data=data,
    )


def all_claims(comfort: ComfortRuns, curves: Mapping[str, Curves], rigid: Mapping[str, Curves] | None) -> list[Claim]:
    """The rows of the published results."""
    nominal = {road: comfort.point(0.0, (), road, ()) for road in ROAD_RMS}
    slip_velocity = comfort.runs.car().vehicle.damper.slip_velocity
    return [*slip_claims(nominal, slip_velocity), *order_claims(curves), *size_claims(curves, rigid)]


def main(arguments: list[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = comfort_parser("comfort_sensitivity")
    parser.add_argument("--source-only", action="store_true", help="only the three parameters of source 1")
    return run_car_study(parser, _study, arguments)


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    comfort = ComfortRuns(runs, records_of(options), folder / "sweep")
    return study(comfort, folder, quick=options.quick, source_only=options.source_only)


if __name__ == "__main__":
    sys.exit(main())
