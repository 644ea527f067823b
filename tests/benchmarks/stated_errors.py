"""Errors that the reduced engine states of its channels, against MuJoCo at a quarter of its step.

python -m tests.benchmarks.stated_errors [--first 0] [--cases 200] [--references FOLDER]

Each case is a car with random numbers within 20 % on a road of class A to D for 8 s or over an obstacle, at a random
speed; the first nine are fixed. A line for each case: the channel with the largest error found, and the main channel
with the largest error that was not stated. Then a table of all main channels: stated and found, within a factor of two
or 1 %. FOLDER keeps the RMS values of MuJoCo.
"""

import argparse
import json
from pathlib import Path

import numpy as np

from vehicle.engines.reduced.stated_errors import is_main
from vehicle.engines.simulation.recording import Recording
from vehicle.errors import VehicleError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

CARS = ("focus_road", "sedan", "focus_road_seated", "focus_road", "sedan", "focus_road_seated", "kinematic_reference")

UNITS = {"N/m", "N s/m", "N", "kg", "N m/rad", "kg m2"}
"""Units of the numbers that vary."""

SPREAD = 0.2
"""Largest relative change of a number."""

FIXED = (
    ("sedan", "half_round:15", 20.0), ("sedan", "cleat:10x50", 30.0), ("focus_road", "cleat:5x50", 28.0),
    ("focus_road", "cleat:10x50", 30.0), ("focus_road", "pothole:20x300", 40.0), ("focus_road", "C", 80.0),
    ("kinematic_reference", "C", 80.0), ("sedan", "C", 80.0), ("focus_road_seated", "C", 60.0),
)  # fmt: skip

CHANNELS = {
    "seat": "seat and seat rail", "body": "body", "knuckle": "knuckles", "tyre": "tyre forces",
    "damper": "damper forces",
}  # fmt: skip


def main() -> None:
    """Print a line for each case, then the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--references", type=Path)
    options = parser.parse_args()
    pairs: list[tuple[str, float, float]] = []
    for number in range(options.first, options.first + options.cases):
        name, road, speed, changes = case(number)
        try:
            new = compared(number, name, road, speed, changes, options.references)
        except VehicleError as error:
            print(f"{number:3d} {name} {road} {speed:g} km/h: left out, {str(error)[:80]}", flush=True)
            continue
        pairs += new
        worst, unsaid = max(new, key=lambda pair: abs(pair[2])), max(new, key=lambda pair: abs(pair[2] - pair[1]))
        print(
            f"{number:3d} {name} {road} {speed:g} km/h: "
            + "; ".join(
                f"{channel} stated {stated:+.1%} found {found:+.1%}" for channel, stated, found in (worst, unsaid)
            ),
            flush=True,
        )
    table(pairs)


def case(number: int) -> tuple[str, str, float, list[str]]:
    """Return car, road, speed [km/h] and changed parameters of a case."""
    if number < len(FIXED):
        return *FIXED[number], []
    random = np.random.default_rng(1000 + number)
    name, kind = CARS[random.integers(len(CARS))], int(random.integers(8))
    if kind < 4:
        road, speed = "ABCD"[kind], random.uniform(30.0, (120.0, 120.0, 100.0, 60.0)[kind])
    elif kind < 6:
        road, speed = f"cleat:{random.integers(5, 21)}x{random.integers(20, 61)}", random.uniform(15.0, 50.0)
    elif kind == 6:
        road, speed = f"half_round:{random.integers(10, 31)}", random.uniform(10.0, 40.0)
    else:
        road, speed = f"pothole:{random.integers(10, 31)}x{random.integers(100, 401)}", random.uniform(20.0, 60.0)
    changes = []
    for parameter in Car.load(name).search():
        path, value = parameter.path, parameter.value
        if parameter.unit not in UNITS or path.startswith(("solver", "body.inertia")) or isinstance(value, bool):
            continue
        if isinstance(value, float | int) and value > 0.0:
            changes.append(f"{path}={value * random.uniform(1.0 - SPREAD, 1.0 + SPREAD)!r}")
        elif isinstance(value, list | tuple) and path.endswith(".stiffness") and max(value) > 0.0 <= min(value):
            factor = random.uniform(1.0 - SPREAD, 1.0 + SPREAD)
            changes.append(f"{path}={[float(each * factor) for each in value]}")
    return name, road, round(float(speed), 1), changes


def compared(
    number: int, name: str, road: str, speed: float, changes: list[str], folder: Path | None
) -> list[tuple[str, float, float]]:
    """Return channel, stated and found error of the RMS of a case."""
    of_class = road in "ABCD"
    drive = Road(road, speed=speed, duration=8.0 if of_class else None, seed=number if of_class else None).under(
        Car.load(name, changes).vehicle, changes
    )
    car, signal = Car.load(name, [*changes, *drive.overrides]), drive.signal()
    reduced = car.run(signal, engine="reduced").recording
    file = None if folder is None else folder / f"{number:03d}.json"
    if file is not None and file.is_file():
        expected = json.loads(file.read_text())
    else:
        step = car.stepped().vehicle.solver.timestep
        assert step is not None
        fine = Car.load(name, [*changes, *drive.overrides, f"solver.timestep={step / 4.0}"])
        expected = levels(fine.run(signal).recording)
        if file is not None:
            file.write_text(json.dumps(expected))
    found = levels(reduced)
    return [
        (channel, stated, found[channel] / expected[channel] - 1.0)
        for channel, stated in reduced.statistics.errors.items()
        if is_main(channel) and expected[channel] > 0.0
    ]


def levels(recording: Recording) -> dict[str, float]:
    """Return the RMS of all channels, of forces without their mean."""
    return {
        name: float(np.std(values) if name.endswith(("_force", "_force_z")) else np.sqrt(np.mean(values**2)))
        for name, values in recording.channels.items()
    }


def table(pairs: list[tuple[str, float, float]]) -> None:
    """Print how stated and found errors agree, by kind of channel."""
    print(
        f"\n{'channels':<20}{'number':>8}{'found > 2 %':>13}{'within 2x':>11}{'unsaid':>8}{'stated, found < 1 %':>21}"
        f"{'largest found':>15}{'rest RMS':>10}"
    )
    for start, words in (*CHANNELS.items(), ("", "all")):
        stated, found = np.array([pair[1:] for pair in pairs if pair[0].startswith(start)]).T
        large = np.abs(found) > 0.02
        near = (stated * found > 0.0) & (np.abs(stated) < 2.0 * np.abs(found)) & (np.abs(found) < 2.0 * np.abs(stated))
        share = float(np.mean(near[large])) if np.any(large) else 1.0
        print(
            f"{words:<20}{found.size:8d}{np.count_nonzero(large):13d}{share:11.0%}"
            f"{np.count_nonzero(large & (np.abs(stated) <= 0.02) & (np.abs(found - stated) > 0.01)):8d}"
            f"{np.count_nonzero((np.abs(stated) > 0.02) & (np.abs(found) < 0.01)):21d}{np.max(np.abs(found)):15.1%}"
            f"{float(np.sqrt(np.mean((stated - found) ** 2))):10.2%}"
        )


if __name__ == "__main__":
    main()
