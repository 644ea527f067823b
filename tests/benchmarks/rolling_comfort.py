"""Comfort at the seat rail on roads, with tyres that stand and that roll, and with other holds of the course.

python -m tests.benchmarks.rolling_comfort [--duration 30] [--speed 80] [--engine reduced]
"""

import argparse
from typing import Any

from vehicle.runs.car import Car, Road
from vehicle.runs.output.run_comfort import comfort_values

CASES: dict[str, tuple[dict[str, Any], list[str]]] = {
    "standing, no contact patch": ({"tyre": "standing", "patch": 0.0}, []),
    "standing": ({"tyre": "standing"}, []),
    "rolling": ({}, []),
    "rolling, hold 0.05 Hz": ({}, ["driving.hold_frequency=0.05"]),
    "rolling, hold 0.2 Hz": ({}, ["driving.hold_frequency=0.2"]),
}


def main() -> None:
    """Print a line for each car, class and tyre."""
    found = argparse.ArgumentParser(description=__doc__)
    found.add_argument("--duration", type=float, default=30.0)
    found.add_argument("--speed", type=float, default=80.0)
    found.add_argument("--engine", default="reduced")
    options = found.parse_args()
    print(f"{'car':<12} {'road':<5} {'tyre':<28} {'x':>7} {'y':>7} {'z':>7} {'sum':>7} {'vector':>7}  m/s2")
    for name in ("kinematic_reference", "focus_road"):
        for road in "AB":
            for words, (chosen, overrides) in CASES.items():
                asked = Road(road, options.speed, duration=options.duration, **chosen)
                drive = asked.under(Car.load(name).vehicle)
                car = Car.load(name, [*overrides, *drive.overrides])
                run = car.run(drive.signal(), engine=options.engine)
                rail = comfort_values(run)["seat_rail"]
                x, y, z, total = rail.rms_2_50_hz.values()
                vector = rail.weighted
                print(f"{name:<12} {road:<5} {words:<28} {x:7.3f} {y:7.3f} {z:7.3f} {total:7.3f} {vector:7.3f}")


if __name__ == "__main__":
    main()
