"""A car on four wheels on roads of ISO 8608: class and speed, damper friction, with and without an occupant.

python -m scenarios.road [--output DIR] [--quick] [--jobs N] [--records N] [--engine auto|reduced|mujoco]
    [--vehicle FILE.toml] [--set PATH=VALUE]
"""

from __future__ import annotations

import argparse
import sys
import time as clock
from dataclasses import asdict
from pathlib import Path
from typing import Any

from scenarios.car_runs import CarRuns
from scenarios.claims import Findings
from scenarios.road.figures import draw_classes, draw_friction
from scenarios.road.findings import check_table, class_table, friction_claims, friction_table, scaling_claim, words
from scenarios.road.runs import Ride, RideRuns
from scenarios.study import QUICK_NOTE, car_study
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import VEHICLES

CARS = {"without occupant": "focus_road", "with occupant": "focus_road_seated"}
"""Shipped cars of the study by their names in tables."""

ROADS, SPEEDS = ("A", "B", "C"), (50.0, 80.0, 120.0)
FRICTIONS = (0.0, 31.25, 62.5, 125.0, 250.0)
"""Coulomb friction of every damper [N]; Bommer 2006 has 125 N in front."""

SPEED = 80.0
"""Speed of the study of friction [km/h]."""

RECORDS, DURATION_S = 3, 30.0
QUICK_DURATION_S = 4.0
QUICK_WHY = f"one record of {QUICK_DURATION_S:g} s tells it too coarsely"


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run the cars on all roads, write the figures into the folder, and return the findings."""
    quick, started = options.quick, clock.perf_counter()
    if options.records is not None and options.records < 1:
        raise ConfigurationError(f"--records {options.records}: must be at least 1; an error needs at least 2")
    cars = {name: VEHICLES / car / "vehicle.toml" for name, car in CARS.items()}
    if runs.vehicle is not None:
        cars = {runs.car().vehicle.name: runs.vehicle}
    rides = RideRuns(
        cars,
        overrides=runs.overrides,
        engine=runs.engine,
        jobs=runs.jobs,
        records=options.records or (1 if quick else RECORDS),
        duration=QUICK_DURATION_S if quick else DURATION_S,
        folder=folder / "sweep",
    )
    roads, speeds = (ROADS[::2], SPEEDS[1:2]) if quick else (ROADS, SPEEDS)
    frictions = FRICTIONS[::4] if quick else FRICTIONS
    grid = [Ride(car=car, road=road, speed=speed) for car in cars for road in roads for speed in speeds]
    varied = [
        Ride(car=car, road=road, speed=SPEED, friction=claim) for car in cars for road in roads for claim in frictions
    ]
    rides.compute([*grid, *varied])
    draw_classes(folder / "class_and_speed.png", rides, roads, speeds)
    draw_friction(folder / "friction.png", rides, roads, SPEED, frictions)
    subjects = [(rides, car, roads, SPEED, frictions) for car in cars]
    claims = [claim for each in subjects for claim in (*friction_claims(*each), *scaling_claim(*each))]
    notes = [
        f"{rides.text()}; the same roads under every car. Isotropic tracks, wheelbase delay, contact patch of 0.1 m. ± "
        "is one standard error over the records; that of a ratio is over the ratios of the single records.",
        "Class and speed, friction of the vehicle file:",
        class_table(rides, grid),
        f"Friction of every damper at {SPEED:g} km/h; % of the same car without friction on the same records:",
        friction_table(rides, varied),
        *(words(*each) for each in subjects),
    ]
    data: dict[str, Any] = {"rides": [{**asdict(ride), **asdict(rides(ride))} for ride in (*grid, *varied)]}
    if not quick:
        notes += checks(rides, folder, list(cars)[-1], roads)
    seconds = clock.perf_counter() - started
    return Findings(
        title="A car on four wheels on the road: class, speed, friction, occupant (beyond Bommer 2006)",
        claims=claims,
        tyres=rides.tyres(),
        unjudged={claim.name: QUICK_WHY for claim in claims} if quick else {},
        notes=[*notes, f"{rides.computed} runs in {seconds:.0f} s.", *([QUICK_NOTE] if quick else [])],
        data={
            **data,
            "engine": rides.engine,
            "records": rides.records,
            "duration_s": rides.duration,
            "seconds": seconds,
        },
    )


def checks(rides: RideRuns, folder: Path, car: str, roads: tuple[str, ...]) -> list[str]:
    """Return tables of the last car by both engines, and on the roughest road with tyres that can lift off."""
    rough, engine = roads[-1], "mujoco"
    compared = RideRuns(
        {car: rides.cars[car]},
        overrides=rides.overrides,
        engine="reduced",
        jobs=rides.jobs,
        records=1,
        duration=rides.duration,
        folder=folder / "sweep",
    )
    pairs = {
        f"class {road}, {SPEED:g} km/h: MuJoCo against the reduced engine": (
            Ride(car=car, road=road, speed=SPEED),
            Ride(car=car, road=road, speed=SPEED, engine=engine),
        )
        for road in roads
    }
    pairs[f"class {rough}, {SPEED:g} km/h: tyres that cannot pull against tyres that can, MuJoCo"] = (
        Ride(car=car, road=rough, speed=SPEED, engine=engine),
        Ride(car=car, road=rough, speed=SPEED, engine=engine, one_sided=True),
    )
    compared.compute([ride for pair in pairs.values() for ride in pair])
    return [
        f"Checks, {car}, {compared.text().partition(',')[0]}: differences of the second to the first:",
        check_table(compared, pairs),
    ]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this study: the reduced engine by default, the number of records."""
    parser.set_defaults(engine="auto")
    records_help = f"roads for every point, {DURATION_S:g} s each; {RECORDS} by default"
    parser.add_argument("--records", type=int, metavar="N", help=records_help)


main = car_study("road", study, add_options)

if __name__ == "__main__":
    sys.exit(main())
