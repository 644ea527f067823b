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
from scenarios.claims import Claim, Findings
from scenarios.comfort_observation import Question
from scenarios.comfort_runs import QUICK, Changes, ComfortRuns, Curves, comfort_options, records_of, setting
from scenarios.comfort_sensitivity.claims import (
    BODY,
    DEGRESSIVE,
    FRICTION,
    MOUNT_DAMPING,
    MOUNT_STIFFNESS,
    RIGID_BODY,
    SOURCE,
    TITLES,
    level_claims,
    order_claims,
    road_levels,
    size_claims,
    slip_claims,
)
from scenarios.comfort_sensitivity.figures import curve_table, draw_band_edge, draw_variation, edge_table, plain
from scenarios.study import QUICK_NOTE, car_study
from vehicle.excitation.exact_road import ROAD_EDGE_HZ, ROAD_RMS
from vehicle.reduced.march import has_compiler

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


def add_options(parser: argparse.ArgumentParser) -> None:
    """Options of this study alone."""
    parser.add_argument("--source-only", action="store_true", help="only the three parameters of source 1")


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    comfort = ComfortRuns(runs, records_of(options), folder / "sweep")
    return study(comfort, folder, quick=options.quick, source_only=options.source_only)


main = car_study("comfort_sensitivity", _study, comfort_options, add_options)


EDGES_HZ = (0.015, 0.02, 0.025, ROAD_EDGE_HZ, 0.035, 0.05, 0.1)
"""Band edges at which the slip shares are shown [Hz]."""


def beyond_questions(comfort: ComfortRuns) -> list[Question]:
    """All runs that `beyond_findings` and `rigid_curves` need."""
    more = [
        question
        for base in (DEGRESSIVE, RIGID_BODY)
        for variation in SOURCE
        for question in comfort.all_questions(variation, base)
    ]
    edges = [question for edge in EDGES_HZ for road in ROAD_RMS for question in comfort.questions((), road, edge=edge)]
    return [*more, *comfort.all_questions(BODY), *edges, *check_questions(comfort)]


def rigid_curves(comfort: ComfortRuns) -> dict[str, Curves]:
    """The variations of source 1 without the flexible modes of the body, whose shapes are assumed."""
    return {variation.name: comfort.curves(variation, RIGID_BODY) for variation in SOURCE}


def beyond_findings(
    comfort: ComfortRuns, folder: Path, linear: Mapping[str, Curves]
) -> tuple[list[str], dict[str, Any]]:
    """Draw the figures into the folder; notes and data of the findings.

    Args:
        comfort: what runs the cars.
        folder: where to.
        linear: curves of source 1, with the linear damper.
    """
    against = {road: comfort.point(0.0, DEGRESSIVE, road, ()) for road in ROAD_RMS}
    damper = comfort.runs.car(DEGRESSIVE).vehicle.damper
    ratios = (
        f"{100.0 * one.relative:.1f} ± {100.0 * one.relative_error:.2f} % on the {road} road"
        for road, one in against.items()
    )
    notes = [
        f"Degressive damper ({damper.degressive_viscous:g} N s/m up to {damper.degressive_velocity:g} m/s, "
        f"{damper.viscous:g} N s/m above, as equation C.1): comfort value {', '.join(ratios)} of that with the linear "
        "damper. The same parameters, relative to the car that has it:"
    ]
    degressive: dict[str, Curves] = {}
    for variation in SOURCE:
        found = degressive[variation.name] = comfort.curves(variation, DEGRESSIVE)
        draw_variation(
            folder / f"{variation.name}_degressive.png",
            comfort,
            variation,
            found,
            base=DEGRESSIVE,
            title=f"Degressive damper: comfort against {variation.label} (beyond the source)",
            beside={"with the linear damper": linear[variation.name]},
        )
        notes.append(curve_table(variation.label, found))
    body = comfort.curves(BODY)
    draw_variation(folder / f"{BODY.name}.png", comfort, BODY, body)
    edges = {road: [comfort.point(edge, (), road, (), edge) for edge in EDGES_HZ] for road in ROAD_RMS}
    draw_band_edge(folder / "band_edge.png", comfort, edges)
    notes += ["Body stiffness:", curve_table(BODY.label, body)]
    notes += ["Band edge of the roads, nominal car:", edge_table(edges), check_table(comfort)]
    return notes, {
        "degressive": plain(degressive),
        "degressive_against_linear": {road: asdict(one) for road, one in against.items()},
        **plain({"rigid_body_" + name: curves for name, curves in rigid_curves(comfort).items()}),
        **plain({BODY.name: body, "band_edge": edges}),
    }


ENGINES = ("reduced", "mujoco")


def corners(comfort: ComfortRuns) -> dict[str, Changes]:
    """Cars of the check by name; the nominal one first."""
    found: dict[str, Changes] = {"nominal": ()}
    for variation in (FRICTION, MOUNT_DAMPING, MOUNT_STIFFNESS):
        cars = comfort.cars(variation)
        for value in (variation.values[0], variation.values[-1]):
            if cars[value]:
                found[f"{variation.label}: {value:g}"] = cars[value]
    return {**found, "degressive damper": DEGRESSIVE}


def check_questions(comfort: ComfortRuns) -> list[Question]:
    """Runs of the check: the first record with both engines; none without numba, which the reduced one needs."""
    if not has_compiler():
        return []
    return [
        question
        for car in corners(comfort).values()
        for road in ROAD_RMS
        for engine in ENGINES
        for question in comfort.questions(car, road, engine=engine, count=1)
    ]


def check_table(comfort: ComfortRuns) -> str:
    """Differences of both engines as a Markdown table."""
    if not has_compiler():
        return "The reduced engine was not compared with MuJoCo: it needs numba."
    lines = [
        f"Reduced engine against MuJoCo, one record of {comfort.records.duration:g} s (on the rough road parts turn by "
        "more than the 0.05 rad that the reduced engine vouches for):",
        "",
        "| car | road | comfort value, MuJoCo [m/s²] | reduced against it [%] | relative comfort value, MuJoCo, "
        "reduced [%] | slip share, MuJoCo, reduced [%] | lowest load, MuJoCo, reduced [N] |",
        "|---|---|---|---|---|---|---|",
    ]
    for road in ROAD_RMS:
        reference: dict[str, float] = {}
        for name, car in corners(comfort).items():
            reduced, mujoco = (comfort(comfort.questions(car, road, engine=engine, count=1))[0] for engine in ENGINES)
            reference = reference or {"reduced": reduced.comfort, "mujoco": mujoco.comfort}
            lines.append(
                f"| {name} | {road} | {mujoco.comfort:.4f} | {100.0 * (reduced.comfort / mujoco.comfort - 1.0):+.2f} | "
                f"{100.0 * mujoco.comfort / reference['mujoco']:.2f}, "
                f"{100.0 * reduced.comfort / reference['reduced']:.2f} | {100.0 * mujoco.slip:.2f}, "
                f"{100.0 * reduced.slip:.2f} | {mujoco.lowest_load:.0f}, {reduced.lowest_load:.0f} |"
            )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
