"""Accuracy of `Car.estimate` against runs of random cars: python -m tests.benchmarks.estimate [CARS SEED].

Each random car differs in friction, damping, springs, tyres and mass, on the classes A to D at 50 to 110 km/h; in the
set `stuck` the friction is 1 to 5 times that of the car, on A and B at 20 to 50 km/h, so that dampers stick. The
reference is the mean of three runs of 10 s with the reduced engine. Prints for each class the mean error, its standard
deviation and its largest value over the estimates that are not refused; the shares refused; and of the values that are
off by more than 2 % the share that is refused.
"""

import sys
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from vehicle import Car, road
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.runs.car import road_estimate
from vehicle.runs.car.estimate_limits import LEAST_LOOSE, MOST_ENGAGED, loose_share, outside_share, require_contact
from vehicle.studies.sweeps.plan import sweep

NAMES = ("weighted", "weighted_x", "weighted_y", "weighted_z", "unweighted", "tyre_load_rms")
SEEDS, SPAN_S, SKIP_S = (1, 2, 3), 10.0, 2.0

SEDAN_FORCES = (-2418.0, -2040.2, -1652.8, -1286.4, -939.4, -634.9, -385.2, -185.0, -64.0)
"""Compression side of the table of the front damper of the sedan [N]."""


def random_cars(name: str, count: int, draw: np.random.Generator, friction: tuple[float, float]) -> list[list[str]]:
    """Return the changes of random cars.

    Args:
        name: shipped car.
        count: number of cars.
        draw: generator.
        friction: lowest and highest factor of the friction.
    """

    def factor(low: float, high: float) -> float:
        return float(np.exp(draw.uniform(np.log(low), np.log(high))))

    cars = []
    for _ in range(count):
        if name == "sedan":
            scale = factor(0.6, 1.6)
            table = [round(scale * force, 3) for force in SEDAN_FORCES]
            rows = [f"front.damper.force={table + [-force for force in table[::-1]]}"]
            rows += [f"front.damper.coulomb_friction={80.0 * factor(*friction)}"]
            mass, springs = 1222.1, (29770.0, 37000.0)
        else:
            rows = [f"front.damper.coulomb_friction={125.0 * factor(*friction)}"]
            rows += [f"front.damper.viscous={2250.0 * factor(0.6, 1.6)}"]
            mass, springs = 813.0, (25000.0, 48000.0)
        rows += [
            f"rear.damper.coulomb_friction={40.0 * factor(*friction)}",
            f"rear.damper.viscous={1500.0 * factor(0.6, 1.6)}",
            f"body.mass={mass * factor(0.85, 1.2)}",
            f"front.main_spring.stiffness={springs[0] * factor(0.85, 1.25)}",
            f"rear.main_spring.stiffness={springs[1] * factor(0.85, 1.25)}",
            f"front.bushings.tyre.stiffness.z={210000.0 * factor(0.85, 1.15)}",
        ]
        # The rear end of the shaker car stands on the ground.
        cars.append([row for row in rows if name != "focus" or row.startswith(("front", "body"))])
    return cars


def compared(name: str, speed: float, classes: str, cars: Sequence[Sequence[str]]) -> list[dict[str, Any]]:
    """Return estimate and run of cars on classes: a row for each, with the shares of the limits."""
    base, rows = Car.load(name), []
    seen: list[tuple[float, float]] = []

    def note(dampers: Any, forces: Any, laws: Any, displacements: Any) -> None:
        shares = [loose_share(one.law.static_friction, each) for each, one in zip(forces, dampers, strict=True)]
        outside = [outside_share(law, each) for law, each in zip(laws, displacements, strict=True)]
        seen.append((min(shares), max(outside, default=0.0)))

    def note_contact(*loads: Any) -> None:
        try:
            require_contact(*loads)
        except ConfigurationError:
            seen[-1] = (0.0, seen[-1][1])  # refused

    setattr(road_estimate, "require_motion", note)  # noqa: B010
    setattr(road_estimate, "require_contact", note_contact)  # noqa: B010
    for letter in classes:
        inputs = [road(letter, speed, duration=SKIP_S + SPAN_S + 1.0, seed=seed) for seed in SEEDS]
        measure = ["weighted", "weighted_x", "weighted_y", "weighted_z", "unweighted", "tyre_load_rms"]
        table = sweep(base, cars, inputs, engine="reduced", measure=measure, skip=SKIP_S + 1.0)
        values = np.array([[row["values"].get(n, np.nan) for n in NAMES] for row in table.rows()], dtype=float)
        runs = values.reshape(len(SEEDS), -1, len(NAMES))[:, -len(cars) :]
        for number, change in enumerate(cars):
            began = time.process_time()
            seen.clear()
            try:
                estimate = base.with_(change).estimate(road(letter, speed))
                loads = np.sqrt(np.mean(np.square(list(estimate.tyre_load.values()))))
                found = np.array([*(estimate.values[n] for n in NAMES[:-1]), loads])
            except SimulationError:  # refused, as it finds no state
                found = np.full(len(NAMES), np.nan)
                seen.append((0.0, 0.0))
            seconds = time.process_time() - began
            mean = runs[:, number].mean(axis=0)
            share, outside = seen.pop()
            rows.append({
                "car": name, "class": letter, "speed": speed, "error": 100.0 * (found / mean - 1.0), "run": mean,
                "scatter": 100.0 * runs[:, number].std(axis=0, ddof=1) / mean / np.sqrt(len(SEEDS)),
                "loose": share, "outside": outside, "seconds": seconds,
            })  # fmt: skip
    return rows


def printed(title: str, rows: Sequence[dict[str, Any]]) -> None:
    """Print the rows of a table."""
    error = np.array([row["error"] for row in rows])
    refused = np.array([row["loose"] < LEAST_LOOSE or row["outside"] > MOST_ENGAGED for row in rows])
    off = np.abs(error[:, 0]) > 2.0
    stated = error[~refused]
    text = f"{title:10s} {len(rows):4d} refused {np.mean(refused):5.2f}  off by 2 %: {off.sum():3d}, "
    text += f"refused {np.sum(off & refused):3d}"
    if len(stated):
        text += f" | range {stated[:, 0].min():+.2f} {stated[:, 0].max():+.2f} |"
        for name, errors in zip(NAMES, stated.T, strict=True):
            text += f" {name} {errors.mean():+.2f} {errors.std():.2f}"
    scatter = np.array([row["scatter"][0] for row in rows])
    print(f"{text} | run {scatter.mean():.2f}", flush=True)


def main() -> None:
    """Run both sets and print their tables."""
    count, seed = map(int, sys.argv[1:3]) if len(sys.argv) > 2 else (8, 1)
    draw = np.random.default_rng(seed)
    usual: list[dict[str, Any]] = []
    for name in ("sedan", "focus", "focus_road"):
        for speed in (50.0, 80.0, 110.0):
            cars = random_cars(name, count, draw, (0.3, 2.5))
            usual += compared(name, speed, "ABCD", cars)
    for letter in "ABCD":
        printed(f"usual {letter}", [row for row in usual if row["class"] == letter])
    stuck: list[dict[str, Any]] = []
    for name in ("sedan", "focus_road"):
        for speed in (20.0, 30.0, 50.0):
            stuck += compared(name, speed, "AB", random_cars(name, count, draw, (1.0, 5.0)))
    for letter in "AB":
        printed(f"stuck {letter}", [row for row in stuck if row["class"] == letter])
    everything = usual + stuck
    printed("all", everything)
    print(f"{1e3 * np.median([row['seconds'] for row in everything]):.1f} ms a car and road")


if __name__ == "__main__":
    main()
