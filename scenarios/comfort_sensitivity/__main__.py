"""Comfort on a smooth and a rough road against friction, suspension mount and body stiffness (Bommer 2006, chapter 4).

python -m scenarios.comfort_sensitivity [--output DIR] [--quick] [--jobs N] [--engine auto|reduced|mujoco]
    [--records N] [--source-only] [--vehicle FILE.toml] [--set PATH=VALUE]
"""

import sys
import time as clock
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from scenarios.car_runs import CarRuns
from scenarios.claims import Findings, markdown
from scenarios.comfort_runs import QUICK, RECORDS, Changes, ComfortRuns, Curves, Point, Records
from scenarios.comfort_sensitivity.claims import (
    BODY,
    DEGRESSIVE,
    RIGID_BODY,
    SOURCE,
    TITLES,
    body_claim,
    degressive_claim,
    order_claims,
    size_claims,
    slip_claims,
)
from scenarios.comfort_sensitivity.figures import curve_table, draw_variation, draw_wheel, plain, setting
from scenarios.comfort_sensitivity.histories import (
    amplification_claim,
    history_claims,
    level_claims,
    road_levels,
    stiffness_claim,
    wheel_claims,
    wheel_modes,
)
from scenarios.comfort_sensitivity.trials import end_trials, level_trials, trial_cases
from scenarios.signals.exact_road import ROAD_EDGE_HZ, ROAD_RMS
from scenarios.study import QUICK_NOTE, CarSettings, car_study
from vehicle.settings import setting as declared
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED
from vehicle.studies.sweeps.case import Case

QUICK_WHY = f"records of {QUICK.duration:g} s tell it too coarsely"

SURE = f"comfort value against {TITLES['coulomb_friction']}, smooth road"
"""Row that short records can judge: friction reduces comfort on a smooth road by far more than their error."""

ENGINES = ("reduced", "mujoco")


@dataclass(frozen=True, kw_only=True, slots=True)
class SensitivitySettings(CarSettings):
    """Settings of the study of comfort."""

    engine: str = "auto"
    records: int | None = declared(
        f"records of road for every point, 60 s each; {RECORDS} by default", within="[1, inf)", type=int, metavar="N"
    )
    source_only: bool = declared("only the three parameters of Bommer 2006", False, action="store_true")


def records_of(settings: SensitivitySettings) -> Records:
    """Return the records of every point."""
    base = QUICK if settings.quick else Records(count=RECORDS)
    return base if settings.records is None else replace(base, count=settings.records)


def study(runs: CarRuns, folder: Path, settings: SensitivitySettings) -> Findings:
    """Run all cars on both roads, draw the figures into the folder, and compare."""
    comfort = ComfortRuns(runs, records_of(settings), folder / "sweep")
    started = clock.perf_counter()
    beyond = not (settings.quick or settings.source_only)
    cases = [case for variation in SOURCE for case in comfort.all_cases(variation)]
    # All at once: the worker processes take longer to start than most of the runs.
    comfort([*cases, *(beyond_cases(comfort) if beyond else [])])
    seconds = clock.perf_counter() - started
    curves = {variation.name: comfort.curves(variation) for variation in SOURCE}
    # Without the flexible modes of the body, whose shapes are assumed.
    rigid = {variation.name: comfort.curves(variation, RIGID_BODY) for variation in SOURCE} if beyond else None
    notes = [
        *setting(comfort),
        f"{comfort.computed} runs of {comfort.records.duration:g} s, {len(set(cases))} of them for the three "
        f"parameters of Bommer 2006; computed in {seconds:.1f} s with --jobs {runs.jobs}.",
    ]
    for variation in SOURCE:
        beside = {"with a rigid body": rigid[variation.name]} if rigid else {}
        draw_variation(folder / f"{variation.name}.png", comfort, variation, curves[variation.name], beside=beside)
        notes.append(curve_table(variation.label, curves[variation.name]))
    data: dict[str, Any] = {
        "source": plain(curves),
        "records": asdict(comfort.records),
        "engine": comfort.engine,
        "road_edge_hz": ROAD_EDGE_HZ,
        "runs": comfort.computed,
        "seconds": seconds,
    }
    if rigid:
        more, numbers = beyond_findings(comfort, folder, curves)
        notes += more
        data |= numbers | plain({"rigid_body_" + name: entries for name, entries in rigid.items()})
    levels = road_levels(comfort)
    draw_wheel(folder / "wheel.png", comfort, levels)
    trials, louder = (end_trials(comfort), level_trials(comfort)) if beyond else ({}, {})
    data["levels"] = {
        road: {
            "largest_seat_rail": {name: entry.tolist() for name, entry in entries.largest.items()},
            "swing": entries.swing.tolist(),
        }
        for road, entries in levels.items()
    }
    data["trials"] = {
        label: {f"{name}, {road}, {value:g}": entry for (name, road, value), entry in entries.items()}
        for label, entries in trials.items()
    }
    records = {road: comfort(comfort.cases((), road)) for road in ROAD_RMS}
    slip = slip_claims(records, runs.car().vehicle.damper.slip_velocity)
    claims = [*slip, *order_claims(curves), *size_claims(curves, trials), *level_claims(levels, louder)]
    claims += [*history_claims(levels), amplification_claim(comfort.nominal()), stiffness_claim(wheel_modes(comfort))]
    claims += [*wheel_claims(levels), degressive_claim(degressive_points(comfort))]
    claims.append(body_claim(body_points(comfort)))
    return Findings(
        title="Comfort on a smooth and a rough road (Bommer 2006, chapter 4)",
        claims=claims,
        tyres=comfort.tyres,
        unjudged={entry.name: QUICK_WHY for entry in claims if entry.name != SURE} if settings.quick else {},
        notes=[*notes, *([QUICK_NOTE] if settings.quick else [])],
        data=data,
    )


main = car_study("comfort_sensitivity", study, SensitivitySettings, engine="auto")


def beyond_cases(comfort: ComfortRuns) -> list[Case]:
    """Return the runs not in the thesis: other dampers and bodies, both engines on one record."""
    more = [
        case for base in (DEGRESSIVE, RIGID_BODY) for variation in SOURCE for case in comfort.all_cases(variation, base)
    ]
    checks = [
        case
        for car in corners(comfort).values()
        for road in ROAD_RMS
        for engine in ENGINES
        for case in comfort.cases(car, road, engine=engine, count=1)
    ]
    return [*more, *comfort.all_cases(BODY), *checks, *trial_cases(comfort)]


def degressive_points(comfort: ComfortRuns) -> dict[str, Point]:
    """Return road to the point of the car with the degressive damper, relative to that with the linear one."""
    return {road: comfort.point(0.0, DEGRESSIVE, road, ()) for road in ROAD_RMS}


def body_points(comfort: ComfortRuns) -> dict[str, list[Point]]:
    """Return road to the points of the cars with the softest and the stiffest body."""
    cars = comfort.cars(BODY)
    return {
        road: [comfort.point(value, cars[value], road, ()) for value in (BODY.values[0], BODY.values[-1])]
        for road in ROAD_RMS
    }


def beyond_findings(
    comfort: ComfortRuns, folder: Path, linear: Mapping[str, Curves]
) -> tuple[list[str], dict[str, Any]]:
    """Draw the figures into the folder; notes and data of the findings."""
    against = degressive_points(comfort)
    damper = comfort.runs.car(DEGRESSIVE).vehicle.damper
    ratios = (
        f"{100.0 * point.relative:.1f} ± {100.0 * point.relative_error:.2f} % on the {road} road"
        for road, point in against.items()
    )
    notes = [
        f"Degressive damper ({damper.degressive_viscous:g} N s/m up to {damper.degressive_velocity:g} m/s, "
        f"{damper.viscous:g} N s/m above, as equation C.1): comfort value {', '.join(ratios)} of that with the linear "
        "damper. The same parameters, relative to the car that has it:"
    ]
    degressive = {variation.name: comfort.curves(variation, DEGRESSIVE) for variation in SOURCE}
    for variation in SOURCE:
        draw_variation(
            folder / f"{variation.name}_degressive.png",
            comfort,
            variation,
            degressive[variation.name],
            base=DEGRESSIVE,
            title=f"Degressive damper: comfort against {variation.label} (beyond the source)",
            beside={"with the linear damper": linear[variation.name]},
        )
        notes.append(curve_table(variation.label, degressive[variation.name]))
    body = comfort.curves(BODY)
    draw_variation(folder / f"{BODY.name}.png", comfort, BODY, body)
    notes += ["Body stiffness:", curve_table(BODY.label, body), check_table(comfort)]
    return notes, {
        "degressive": plain(degressive),
        "degressive_against_linear": {road: asdict(point) for road, point in against.items()},
        **plain({BODY.name: body}),
    }


def corners(comfort: ComfortRuns) -> dict[str, Changes]:
    """Return name to overrides of the cars for the comparison of both engines: nominal, ends of variations, damper."""
    changes: dict[str, Changes] = {"nominal": ()}
    for variation in SOURCE:
        cars = comfort.cars(variation)
        changes |= {f"{variation.label}: {value:g}": cars[value] for value in variation.values[:: len(cars) - 1]}
    return {name: car for name, car in changes.items() if car or name == "nominal"} | {"degressive damper": DEGRESSIVE}


def check_table(comfort: ComfortRuns) -> str:
    """Return the differences of both engines on the first record as a Markdown table."""
    rows = []
    for road in ROAD_RMS:
        reference: tuple[float, float] | None = None
        for name, car in corners(comfort).items():
            pair = [comfort(comfort.cases(car, road, engine=engine, count=1))[0] for engine in ENGINES]
            reduced, mujoco = pair
            values = reduced[UNWEIGHTED], mujoco[UNWEIGHTED]
            reference = reference or values
            relative = (
                f"{100.0 * value / base:.2f}" for value, base in zip(values[::-1], reference[::-1], strict=True)
            )
            rows.append(
                [
                    *(name, road, f"{values[1]:.4f}", f"{100.0 * (values[0] / values[1] - 1.0):+.2f}"),
                    ", ".join(relative),
                    f"{100.0 * mujoco['slip']:.2f}, {100.0 * reduced['slip']:.2f}",
                    f"{mujoco['lowest_load']:.0f}, {reduced['lowest_load']:.0f}",
                ]
            )
    return (
        f"Reduced engine against MuJoCo, one record of {comfort.records.duration:g} s (on the rough road parts turn by "
        "more than the 0.05 rad that the reduced engine vouches for):\n\n"
    ) + markdown(
        (
            "car",
            "road",
            "comfort value, MuJoCo [m/s²]",
            "reduced against it [%]",
            "relative comfort value, MuJoCo, reduced [%]",
            "slip share, MuJoCo, reduced [%]",
            "lowest load, MuJoCo, reduced [N]",
        ),
        rows,
    )


if __name__ == "__main__":
    sys.exit(main())
