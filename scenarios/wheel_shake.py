"""Shake of the seat rail by an imbalance of the right front wheel: grams, speeds, and roads that free the dampers.

python -m scenarios.wheel_shake [--output DIR] [--quick] [--jobs N] [--engine reduced|mujoco|auto] [--vehicle FILE.toml]
    [--set PATH=VALUE]

Order 1 of the vertical acceleration by the difference of two runs on the same road, with and without the imbalance.
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
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.signals.analysis.order_lines import order_lines

CAR, WHEEL, CHANNEL = "sedan", "fr", "seat_rail_acc_z"

RADIUS = 0.2
"""Distance of the mass from the axle [m]."""

GRAMS = (5.0, 10.0, 20.0, 40.0, 80.0, 160.0)
"""Masses [g]; a balanced wheel has 5 to 10."""

SPEEDS = (100.0, 120.0, 140.0, 160.0)
"""Speeds [km/h]."""

ROADS = {"level": "smooth", "A": "class A", "B": "class B"}
"""Roads and their names."""

DURATION = 20.0
"""Length of a run [s]."""

NO_FRICTION = "without friction"


@dataclass(frozen=True, slots=True)
class Drive:
    """Drive of a car over a road, without an imbalance at 0 g.

    Attributes:
        vehicle: vehicle file.
        overrides: changes of the car.
        engine: engine, see `Car.run`.
        road: road, one of `ROADS`.
        speed: speed [km/h].
        grams: mass of the imbalance [g].
        duration: length [s].
    """

    vehicle: Path
    overrides: tuple[str, ...]
    engine: str
    road: str
    speed: float
    grams: float
    duration: float

    def run(self) -> Run:
        """Run the car."""
        car = _car(self.vehicle, self.overrides).with_({"front.right.imbalance.mass": self.grams / 1000.0})
        return car.run(Road(self.road, self.speed, duration=self.duration), engine=self.engine, channels=[CHANNEL])


@lru_cache(maxsize=4)
def _car(vehicle: Path, overrides: tuple[str, ...]) -> Car:
    imbalance = ("front.right.imbalance.mass=0.0", f"front.right.imbalance.radius={RADIUS}")
    return Car.load(vehicle, (*overrides, *imbalance))


@lru_cache(maxsize=1)
def _bare(drive: Drive) -> Run:
    """Run a car without imbalance, which all masses on its road are compared with."""
    return drive.run()


def shake(pair: tuple[Drive, Drive]) -> float:
    """Return the amplitude of order 1 by an imbalance, over the imbalance [m/s2 per kg m].

    Args:
        pair: drive with the imbalance, and the same drive without it.
    """
    loaded, bare = pair[0].run(), _bare(pair[1])
    _, speed = loaded.car.vehicle.composition.turning(f"wheel_{WHEEL}")
    history = (loaded[CHANNEL] - bare[CHANNEL])[None]
    lines = order_lines(loaded.time, history, speed / (2.0 * np.pi), [1.0], begin=loaded.skip)
    return float(abs(lines.amplitude[0, 0])) / (pair[0].grams / 1000.0 * RADIUS)


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run all drives, write the picture, and return the findings."""
    grams, speeds = (GRAMS[2:5:2], SPEEDS[2:3]) if options.quick else (GRAMS, SPEEDS)
    vehicle, duration = runs.vehicle or vehicle_file(CAR), 6.0 if options.quick else DURATION
    free = (*runs.overrides, *(f"{path}.coulomb_friction=0" for path in _damper_paths(vehicle, runs.overrides)))
    cases = {(name, speed, mass): (road, speed, mass, runs.overrides)
             for road, name in ROADS.items() for speed in speeds for mass in grams}  # fmt: skip
    cases |= {(NO_FRICTION, speed, mass): ("level", speed, mass, free) for speed in speeds for mass in grams}
    pairs = [
        (
            Drive(vehicle, changes, runs.engine, road, speed, mass, duration),
            Drive(vehicle, changes, runs.engine, road, speed, 0.0, duration),
        )
        for road, speed, mass, changes in cases.values()
    ]
    values = dict(zip(cases, in_processes(shake, pairs, runs.jobs), strict=True))
    name = _car(vehicle, runs.overrides).vehicle.name
    caption = (
        f"{name}, imbalance of the right front wheel; order 1 of the vertical acceleration of the seat rail, by the "
        f"difference of two runs of {duration:g} s with and without it, over the imbalance; engine {runs.engine}"
    )
    draw(folder / "wheel_shake.png", values, caption)
    claims = friction_claims(values)
    return Findings(
        title="Shake by an imbalance: friction of the dampers and the road",
        claims=claims,
        tyres="rolling",
        unjudged={claim.name: "short runs" for claim in claims} if options.quick else {},
        notes=[f"{caption}.", table(values), *([QUICK_NOTE] if options.quick else [])],
        data={
            "shake": [
                {"road": road, "speed_kmh": speed, "grams": mass, "shake_per_kg_m": value}
                for (road, speed, mass), value in values.items()
            ]
        },
    )


def _damper_paths(vehicle: Path, overrides: Sequence[str]) -> dict[str, None]:
    """Return the tables of the dampers."""
    return dict.fromkeys(damper.path for damper in _car(vehicle, tuple(overrides)).vehicle.composition.dampers)


Key = tuple[str, float, float]
"""Road, speed [km/h], mass [g]."""


def friction_claims(values: Mapping[Key, float]) -> list[Claim]:
    """Return the checks: sticking dampers shake a balanced wheel more, and a road frees them.

    Args:
        values: shake [m/s2 per kg m] by road, speed and mass.
    """
    speeds, grams = sorted({speed for _, speed, _ in values}), sorted({mass for _, _, mass in values})
    speed = min(speeds, key=lambda each: abs(each - 140.0))
    lightest, balanced = grams[0], min(grams, key=lambda mass: abs(mass - 20.0))
    smooth, free = (values[name, speed, lightest] for name in ("smooth", NO_FRICTION))
    freed = values["class A", speed, balanced] / values["smooth", speed, balanced]
    return [
        OWN_CHECK.statement(
            f"shake by {lightest:g} g at {speed:g} km/h on a smooth road against dampers without friction",
            "larger",
            f"{smooth:.1f} against {free:.1f} m/s2 per kg m, {smooth / free:.2f} times",
            smooth > 1.2 * free,
            "the dampers stick; larger by a fifth counts",
            picture="wheel_shake.png",
        ),
        OWN_CHECK.statement(
            f"shake by {balanced:g} g at {speed:g} km/h on class A against a smooth road",
            "smaller",
            f"{freed:.2f} times",
            freed < 0.8,
            "the road keeps the dampers moving; smaller by a fifth counts",
            picture="wheel_shake.png",
        ),
    ]


def table(values: Mapping[Key, float]) -> str:
    """Return the shake in a table: a row for each road and speed, a column for each mass."""
    grams = sorted({mass for _, _, mass in values})
    keys = dict.fromkeys((road, speed) for road, speed, _ in values)
    rows = [
        (road, f"{speed:g}", *(f"{values[road, speed, mass]:.1f}" for mass in grams))
        for road, speed in sorted(keys, key=lambda key: (key[1], list(ROADS.values()).index(key[0]) if key[0] in
                                                         ROADS.values() else len(ROADS)))
    ]  # fmt: skip
    heads = ("road", "speed [km/h]", *(f"{mass:g} g" for mass in grams))
    return f"Order 1 of the seat rail along z, over the imbalance [m/s2 per kg m]:\n\n{markdown(heads, rows)}"


def draw(path: Path, values: Mapping[Key, float], caption: str) -> None:
    """Write the shake over the mass: a panel for each speed, a curve for each road."""
    roads, speeds = list(dict.fromkeys(key[0] for key in values)), list(dict.fromkeys(key[1] for key in values))
    title = "Shake of the seat rail by an imbalance of one front wheel"
    with figure_file(path, (3.2 * len(speeds) + 1.5, 4.6), title, caption) as figure:
        axes = figure.subplots(1, len(speeds), sharey=True, squeeze=False)[0]
        for axis, speed in zip(axes, speeds, strict=True):
            for road, colour in zip(roads, COLOURS, strict=False):
                points = {mass: value for (name, at, mass), value in values.items() if (name, at) == (road, speed)}
                style = "--" if road == NO_FRICTION else "o-"
                axis.plot([*points], [*points.values()], style, color=colour, markersize=4, label=road)
            axis.set(xscale="log", title=f"{speed:g} km/h", xlabel="imbalance [g at 0.2 m]")
            grams = sorted({mass for _, _, mass in values})
            axis.set_xticks(grams, [f"{mass:g}" for mass in grams])
            axis.minorticks_off()
        axes[0].set_ylim(0.0, 1.1 * max(values.values()))
        axes[0].set_ylabel("seat rail, vertical, order 1\n[m/s² per kg m]")
        axes[-1].legend(loc="best")


main = car_study("wheel_shake", study)

if __name__ == "__main__":
    sys.exit(main())
