"""A car over single obstacles at a row of speeds: peaks and doses at seat and rail, knuckle peaks, settling, lift-off.

python -m scenarios.obstacles [--output DIR] [--quick] [--jobs N] [--obstacle TEXT ...] [--speeds KM/H,...]
    [--engine auto|reduced|mujoco] [--vehicle FILE.toml] [--set PATH=VALUE]

Rolling tyres that envelop the obstacle by two elliptical cams, and lift off. `python -m vehicle shaker` with
`--road cleat:20x50 --speed 30 --video` films one passage.
"""

import argparse
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from scenarios.car_runs import CarRuns, in_processes
from scenarios.charts import figure_file
from scenarios.claims import OWN_CHECK, Claim, Findings, markdown
from scenarios.study import QUICK_NOTE, car_study
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.figure import COLOURS, INK
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.runs.output.run_obstacle import obstacle_values
from vehicle.signals.excitation.obstacle import Obstacle

CAR = "focus_road"

SHORT = ("cleat:20x50", "half_round:50", "pothole:50x300")
LONG = ("ramp:50x1000", "speed_bump:100x3700")
OBSTACLES = (*SHORT, "cobbles:10x120x100", *LONG)
"""Obstacles of the study: shorter and longer than the way of a wheel in a period of its hop, and a row of stones."""

SPEEDS = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
"""Speeds [km/h]."""

Values = Mapping[str, float]

PANELS = (
    ("peak_to_peak_z", "peak to peak, vertical [m/s²]"),
    ("peak_to_peak_x", "peak to peak, longitudinal [m/s²]"),
    ("vdv", "vibration dose value, vector sum [m/s$^{1.75}$]"),
)
"""Values at the seat rail and on the seat, with their labels."""

SINGLE_PANELS = (
    ("knuckle_peak", "largest knuckle acceleration, vertical [m/s²]"),
    ("settling", "settling time of the seat rail [s]"),
    ("lowest_load", "lowest over static tyre load [%]"),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Passage:
    """Passage over an obstacle."""

    vehicle: Path  # vehicle file
    overrides: tuple[str, ...]  # overrides of the car
    engine: str  # engine, see `Car.run`
    obstacle: str  # text of the obstacle, see `Obstacle.parse`
    speed: float  # speed [km/h]

    def run(self) -> Run:
        """Run the car, whose tyres lift off."""
        return car_of(self.vehicle, self.overrides).run(Road(self.obstacle, speed=self.speed), engine=self.engine)


@lru_cache(maxsize=2)
def car_of(vehicle: Path, overrides: tuple[str, ...]) -> Car:
    """Return a car, cached in the process."""
    return Car.load(vehicle, overrides)


def passage_values(passage: Passage) -> dict[str, float]:
    """Return the values of a passage; empty if the run could not be carried through.

    Peak-to-peak accelerations [m/s2] and vibration dose values [m/s^1.75] of the points, as "peak_to_peak_z seat_rail";
    the largest vertical knuckle acceleration [m/s2]; the settling time of the seat rail [s], NaN if it does not settle
    within the record; the lowest tyre load over the static one [%].
    """
    try:
        run = passage.run()
    except SimulationError:
        return {}
    summary = obstacle_values(run)
    assert summary is not None
    values: dict[str, float] = {}
    for point, peaks in summary["peak_to_peak"].items():
        values |= {f"peak_to_peak_{axis} {point}": peaks[axis] for axis in "xz"}
        values[f"vdv {point}"] = summary["vdv"][point]["overall"]
    settled = summary["settling_s"]["seat_rail"]
    loads = {wheel: run[f"tyre_{wheel}_force_z"][run.evaluated] for wheel in run.car.vehicle.wheels}
    static = run.car.static.tyre_load
    return values | {
        "knuckle_peak": max(summary["knuckle_peak"].values()),
        "settling": float("nan") if settled is None else settled,
        "lowest_load": min(100.0 * float(np.min(load)) / static[wheel] for wheel, load in loads.items()),
    }


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run all passages, write the picture into the folder, and return the findings."""
    speeds = _speeds(options.speeds) if options.speeds else (SPEEDS[1::2] if options.quick else SPEEDS)
    obstacles = tuple(options.obstacle or (SHORT[:1] + LONG[1:] if options.quick else OBSTACLES))
    for text in obstacles:
        Obstacle.parse(text)
    file = runs.vehicle or vehicle_file(CAR)
    passages = [
        Passage(vehicle=file, overrides=runs.overrides, engine=runs.engine, obstacle=text, speed=speed)
        for text in obstacles
        for speed in speeds
    ]
    values = dict(zip(passages, in_processes(passage_values, passages, runs.jobs), strict=True))
    car = car_of(file, runs.overrides)
    points = tuple(point for point in ("seat_rail", "seat") if any(f"vdv {point}" in row for row in values.values()))
    caption = (
        f"{car.vehicle.name}, rolling tyres that lift off and envelop the obstacle by two elliptical cams; engine "
        f"{runs.engine}; accelerations as recorded, dose values weighted (ISO 2631-1)"
    )
    draw_over_speed(folder / "obstacles.png", values, points, caption)
    failed = [f"{passage.obstacle} at {passage.speed:g} km/h" for passage, row in values.items() if not row]
    return Findings(
        title="A car over obstacles: speed, peaks, doses, settling",
        claims=list(dose_claims(values)),
        tyres="rolling, one-sided, enveloping by two cams",
        unjudged={} if len(speeds) > 2 else {claim.name: "two speeds" for claim in dose_claims(values)},
        notes=[
            f"{caption}. Settling time: from the last wheel leaving the obstacle to the last vertical acceleration of "
            "the seat rail above 10 % of its peak. Knuckle peak and lowest tyre load are those of the worst wheel; in "
            "the sample in which a tyre lifts off, its load may be a few percent below zero.",
            passage_table(values, points),
            *([f"Not carried through: {', '.join(failed)}."] if failed else []),
            *([QUICK_NOTE] if options.quick else []),
        ],
        data={
            "passages": [
                {"obstacle": passage.obstacle, "speed_kmh": passage.speed, "engine": passage.engine, **row}
                for passage, row in values.items()
            ]
        },
    )


def dose_claims(values: Mapping[Passage, Values]) -> Sequence[Claim]:
    """Return the checks: over the speed a short obstacle has a largest dose, and the dose of a long obstacle rises."""
    rows = []
    for text in dict.fromkeys(passage.obstacle for passage in values):
        row = {passage.speed: each.get("vdv seat_rail", np.nan) for passage, each in values.items()
               if passage.obstacle == text}  # fmt: skip
        speeds = sorted(row)
        if text not in (*SHORT, *LONG) or len(speeds) < 2:
            continue
        peak, short = max(speeds, key=lambda speed: row[speed]), text in SHORT
        rows.append(
            OWN_CHECK.statement(
                f"{text}: dose at the rail over speed",
                "highest below the highest speed" if short else "highest at the highest speed",
                ", ".join(f"{row[speed]:.3g}" for speed in speeds)
                + f" m/s^1.75 at {', '.join(f'{speed:g}' for speed in speeds)} km/h",
                (peak < speeds[-1]) is short,
                "a short obstacle is passed in less than a period of the wheel beyond some speed, and its impulse "
                "falls with the speed; a long one lifts the wheels with an acceleration that rises with its square",
                picture="obstacles.png",
            )
        )
    return rows


def passage_table(values: Mapping[Passage, Values], points: Sequence[str]) -> str:
    """Return all values as a Markdown table."""
    names = [f"{name} {point}" for name, _ in PANELS for point in points] + [name for name, _ in SINGLE_PANELS]
    heads = {"peak_to_peak_z": "z p-p", "peak_to_peak_x": "x p-p", "vdv": "VDV", "knuckle_peak": "knuckle peak z",
             "settling": "settling [s]", "lowest_load": "lowest load [%]"}  # fmt: skip
    columns = ["obstacle", "speed [km/h]"]
    columns += [" ".join([heads[name.split()[0]], *(part.replace("_", " ") for part in name.split()[1:])])
                for name in names]  # fmt: skip
    rows = [
        (passage.obstacle, f"{passage.speed:g}", *(_cell(name, row.get(name, np.nan)) for name in names))
        for passage, row in values.items()
    ]
    return markdown(columns, rows)


def _cell(name: str, value: float) -> str:
    return "-" if not np.isfinite(value) else f"{value:.3g}" if name != "lowest_load" else f"{round(value)}"


def draw_over_speed(path: Path, values: Mapping[Passage, Values], points: Sequence[str], caption: str) -> None:
    """Draw all values over the speed, a colour for each obstacle; the seat dashed."""
    obstacles = list(dict.fromkeys(passage.obstacle for passage in values))
    colours = [*COLOURS, INK, *COLOURS][: len(obstacles)]
    seat = "; seat dashed" if "seat" in points else ""
    with figure_file(path, (13.0, 7.6), "Obstacles over the speed", caption + seat) as figure:
        axes = figure.subplots(2, 3, sharex=True)
        for text, colour in zip(obstacles, colours, strict=False):
            rows = {passage.speed: row for passage, row in values.items() if passage.obstacle == text}
            for axis, (name, label) in zip(axes.ravel(), (*PANELS, *SINGLE_PANELS), strict=True):
                for point, style in zip(points if (name, label) in PANELS else ("",), ("-", "--"), strict=False):
                    key = f"{name} {point}".strip()
                    y = [row.get(key, np.nan) for row in rows.values()]
                    shown = text if style == "-" else None
                    axis.plot(list(rows), y, style, color=colour, marker="o", markersize=3.5, label=shown)
                axis.set_title(label, fontsize=9)
        for axis in axes.ravel():
            axis.set_ylim(0.0, 1.05 * axis.get_ylim()[1])
        for axis in axes[1]:
            axis.set_xlabel("speed [km/h]")
        axes[1, 2].legend()


def _speeds(text: str) -> tuple[float, ...]:
    """Return the speeds of --speeds [km/h]."""
    try:
        speeds = tuple(float(cell) for cell in text.split(","))
    except ValueError:
        speeds = ()
    if not speeds or not all(0.0 < speed <= 400.0 for speed in speeds):
        raise ConfigurationError(f"--speeds {text}: must be speeds above 0 to 400 km/h, as 10,20,30")
    return speeds


def add_options(parser: Parser) -> None:
    """Add the options of this study."""
    help_text = "obstacle in place of those of the study, as cleat:10x30; repeatable"
    parser.add_argument("--obstacle", action="append", metavar="TEXT", help=help_text)
    parser.add_argument("--speeds", metavar="KM/H,...", help="speeds [km/h], as 10,20,30")


main = car_study("obstacles", study, add_options)

if __name__ == "__main__":
    sys.exit(main())
