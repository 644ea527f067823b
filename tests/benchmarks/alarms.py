"""Where the reduced engine advises MuJoCo on roads of class A to C, beside its differences from MuJoCo.

python -m tests.benchmarks.alarms [--roads A,B,C] [--speeds 50,80,120] [--cars sedan,van] [--references FOLDER]

Shipped cars, and new cars from a few stated numbers, 8 s each; MuJoCo at a quarter of its step. A line for each run:
largest error of a comfort value, of an axis with a tenth of the acceleration, and of the force of a tyre or damper;
the number of channels that are off by more than 2 %, and those that are not stated within a factor of two; then a false
alarm (MuJoCo is advised where comfort, axes and forces are within 1 %), or a missing one (one of them is off by more
than 3 %). FOLDER keeps the values of MuJoCo, 2 s of processor time each.
"""

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from tests.benchmarks.stated_errors import levels
from vehicle.engines.reduced.stated_errors import NAMED_ERROR, SMALL_AXIS
from vehicle.engines.reduced.validity import REMEDY
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.studies.design.new_car import new_car
from vehicle.studies.design.stated_numbers import stated_numbers

SHIPPED = ("focus_road", "focus_road_seated", "sedan", "sedan_steering", "kinematic_reference")

NEW: dict[str, tuple[str, dict[str, object]]] = {
    "small": ("sedan", {"car_class": "small"}),
    "middle": ("sedan", {"car_class": "sedan"}),
    "van": ("sedan", {"car_class": "van"}),
    "electric_suv": ("sedan", {"car_class": "electric-suv"}),
    "hatchback": (
        "focus_road",
        {"kerb_mass": 1200.0, "front_axle_load": "61%", "cog_height": 0.53, "wheelbase": 2.55, "inertia": "survey"},
    ),
    "suv": (
        "sedan",
        {"kerb_mass": 2050.0, "front_axle_load": "54%", "cog_height": 0.70, "wheelbase": 2.85, "track_front": 1.64,
         "track_rear": 1.65, "tyre_radius": 0.36, "ride_frequency_front": 1.35, "ride_frequency_rear": 1.5},
    ),
    "large": (
        "sedan",
        {"kerb_mass": 1850.0, "cog_height": 0.54, "wheelbase": 2.95, "ride_frequency_front": 1.1,
         "ride_frequency_rear": 1.25, "damping_ratio_front": 0.25},
    ),
    "minivan": (
        "sedan",
        {"kerb_mass": 1650.0, "front_axle_load": "55%", "cog_height": 0.65, "wheelbase": 2.75,
         "tyre_size": "205/60R16", "inertia": "survey"},
    ),
}  # fmt: skip
"""Template and stated numbers of the new cars."""

SAME, DIFFERENT = 0.01, 0.03
"""Errors up to which a warning is false, and from which on it is missing."""


def main() -> None:
    """Print a line for each run, then the sums."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--roads", default="A,B,C")
    parser.add_argument("--speeds", default="50,80,120")
    parser.add_argument("--cars", default=",".join([*SHIPPED, *NEW]))
    parser.add_argument("--references", type=Path)
    options = parser.parse_args()
    rows = []
    with TemporaryDirectory() as folder:
        for name in options.cars.split(","):
            file = car_file(name, Path(folder))
            for road in options.roads.split(","):
                for speed in map(float, options.speeds.split(",")):
                    rows.append(compared(name, file, road, speed, options.references))
                    print(line(f"{name}, {road}, {speed:g} km/h", *rows[-1]), flush=True)
    print(summary(rows))


def car_file(name: str, folder: Path) -> str:
    """Return the name of a shipped car, or the file of a new one, written to a folder."""
    if name not in NEW:
        return name
    template, numbers = NEW[name]
    file = folder / f"{name}.toml"
    file.write_text(new_car(name, template, stated_numbers(None, numbers)).text)
    return str(file)


def values(run: Run) -> dict[str, float]:
    """Return comfort of a run, then the RMS of its channels, under their names."""
    comfort = {f"comfort {name}": value for name, value in run.comfort().values.items() if "_error" not in name}
    return comfort | levels(run.recording)


def compared(
    name: str, file: str, road: str, speed: float, folder: Path | None
) -> tuple[dict[str, float], dict[str, float], bool]:
    """Return the errors of comfort and channels of the reduced engine, those stated, and True if it advises MuJoCo."""
    base = Car.load(file)
    drive = Road(road, speed, duration=8.0).under(base.vehicle)
    car, signal = Car.load(file, drive.overrides), drive.signal()
    run = car.run(signal, engine="reduced")
    kept = None if folder is None else folder / f"{name}_{road}_{speed:g}.json"
    if kept is not None and kept.is_file():
        expected = json.loads(kept.read_text())
    else:
        step = car.stepped().vehicle.solver.step
        expected = values(Car.load(file, [*drive.overrides, f"solver.timestep={step / 4.0}"]).run(signal))
        if kept is not None:
            kept.write_text(json.dumps(expected))
    found = values(run)
    errors = {name: found[name] / value - 1.0 for name, value in expected.items() if value > 0.0 and name in found}
    small = {
        f"{name}_{axis}"
        for name in expected
        for axis in "xyz"
        if expected.get(f"{name}_{axis}", np.inf) < SMALL_AXIS * expected[name]
    }
    statistics = run.recording.statistics
    kept_errors = {name: error for name, error in errors.items() if name not in small}
    return kept_errors, dict(statistics.errors), any(REMEDY in text for text in statistics.warnings)


def read(errors: dict[str, float]) -> Iterator[float]:
    """Return the errors of comfort, its axes, and forces of tyres and dampers."""
    return (abs(e) for name, e in errors.items() if name.startswith("comfort") or name.endswith(("_force", "_force_z")))


def unstated(errors: dict[str, float], stated: dict[str, float]) -> tuple[list[str], list[str]]:
    """Return the channels that are off, found or stated, and those whose error is not stated within a factor of two."""
    channels = [name for name in errors if name in stated]
    off = [name for name in channels if max(abs(errors[name]), abs(stated[name])) > NAMED_ERROR]
    return off, [name for name in off if not 0.5 <= stated[name] / errors[name] <= 2.0]


def line(title: str, errors: dict[str, float], stated: dict[str, float], warned: bool) -> str:
    """Return the line of a run."""
    comfort = [abs(errors[name]) for name in errors if name in ("comfort unweighted", "comfort weighted")]
    axes = [
        abs(error) for name, error in errors.items() if name.startswith("comfort") and name[-2:] in ("_x", "_y", "_z")
    ]
    forces = [abs(error) for name, error in errors.items() if name.endswith(("_force", "_force_z"))]
    off, wrong = unstated(errors, stated)
    worst = max(read(errors))
    text = f"{title:<36} comfort {max(comfort):6.2%} axes {max(axes):6.2%} forces {max(forces):6.2%}"
    text += f" off {len(off):2d} not stated {', '.join(wrong) or 0}"
    alarm = "  FALSE ALARM" if worst < SAME else "  warns"
    return text + (alarm if warned else "  NO ALARM" if worst > DIFFERENT else "")


def summary(rows: list[tuple[dict[str, float], dict[str, float], bool]]) -> str:
    """Return the sums over all runs."""
    same = [warned for errors, _, warned in rows if max(read(errors)) < SAME]
    different = [warned for errors, _, warned in rows if max(read(errors)) > DIFFERENT]
    off = [unstated(errors, stated) for errors, stated, _ in rows]
    rest = np.array([stated[name] - errors[name] for errors, stated, _ in rows for name in stated if name in errors])
    return (
        f"{len(rows)} runs, {sum(warned for *_, warned in rows)} warn; {sum(same)} of {len(same)} with comfort, axes "
        f"and forces within {SAME:.0%}; {sum(different)} of {len(different)} above {DIFFERENT:.0%}\n"
        f"{sum(len(pair[0]) for pair in off)} of {len(rest)} channels off by more than {NAMED_ERROR:.0%}, "
        f"{sum(len(pair[1]) for pair in off)} of these not stated within a factor of two; stated less found: RMS "
        f"{np.sqrt(np.mean(rest**2)):.2%}, largest {np.max(np.abs(rest)):.2%}"
    )


if __name__ == "__main__":
    main()
