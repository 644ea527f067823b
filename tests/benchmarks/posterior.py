"""Posterior of synthetic cars of `focus_road`: `python -m tests.benchmarks.posterior [coverage|laws] [--cars N]`.

`coverage`: share of hidden values within the 90 % intervals, with noise and a discrepancy of 10 %. `laws`: evidence of
friction against a degressive damper at five levels of noise, for a hidden car of each.
"""

import argparse
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from vehicle.errors import SimulationError
from vehicle.model.parameters.paths import overrides_of, value_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car
from vehicle.signals.analysis.response_name import ResponseName, plates_of
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.frf_file import FrfData
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.posterior import EmulatedCar, emulated_car, posterior_of, values_at, verdict
from vehicle.studies.tuning.response_cells import evaluated_cars

FACTORS = {
    "front.main_spring.stiffness": (0.6, 1.6), "front.damper.viscous": (0.5, 2.0),
    "front.damper.coulomb_friction": (0.5, 2.0), "front.bushings.tyre.stiffness.z": (0.7, 1.4),
    "front.parts.tyre.mass": (0.7, 1.4), "front.bushings.suspension_mount.stiffness.z": (0.5, 2.0),
}  # fmt: skip
"""Bounds of the six parameters over the values of `focus_road`."""

DEGRESSIVE = ("front.damper.viscous_law=degressive", "front.damper.coulomb_friction=1.0")
LAW = {
    "front.damper.viscous": (500.0, 2000.0),
    "front.damper.degressive_viscous": (2.1e3, 1.2e4),
    "front.damper.degressive_velocity": (0.01, 0.1),
}
"""The rival law: almost no friction, a larger damping constant below a velocity."""

CHANNELS = ("knuckle_fl_acc_z", "seat_rail_acc_z")
LEVELS = ("low", "mid", "high")
FREQUENCY = np.arange(3.0, 45.0, 0.5)
WINDOW, LENGTH = 4.0, 30.0
DISCREPANCY = 0.1
COHERENCE, AVERAGES = 0.95, 14.0
"""Coherence and independent averages of the synthetic measurement: 30 s in windows of 4 s with half overlap."""


def ranges(car: Car, factors: Mapping[str, tuple[float, float]]) -> list[Range]:
    """Return bounds as factors of the values of a car."""
    return [
        Range(path=path, low=low * value_of(car.vehicle, path), high=high * value_of(car.vehicle, path),
              start=value_of(car.vehicle, path))
        for path, (low, high) in factors.items()
    ]  # fmt: skip


def targets(coherence: float = COHERENCE) -> list[FrfTarget]:
    """Return targets without data: FRFs of one plate at three levels."""
    shape = (len(CHANNELS), FREQUENCY.size)
    names = tuple(ResponseName(name, plates_of({"fl": 1.0})) for name in CHANNELS)
    listed = []
    for level in LEVELS:
        signal = read_signal(find_input(f"{level}.csv"), wheel="fl")
        count = int(LENGTH / signal.timestep) + 1
        signal = Signal(
            time=uniform_time(samples=count, timestep=signal.timestep),
            displacement={"fl": signal.displacement["fl"][:count]},
            source=level,
        )
        data = FrfData(frequency=FREQUENCY, names=names, response=np.ones(shape, dtype=complex),
                       coherence=np.full(shape, coherence), random_error=np.full(shape, np.nan))  # fmt: skip
        listed.append(FrfTarget(name=level, data=data, signal=signal, averages=AVERAGES, window=WINDOW))
    return listed


def hidden_cells(car: Car, emulated: EmulatedCar, points: np.ndarray) -> np.ndarray:
    """Return the exact cells of cars at points, without noise."""
    paths = [parameter.path for parameter in emulated.parameters]
    cars = [
        car.with_(overrides_of(car.vehicle, dict(zip(paths, row, strict=True))))
        for row in values_at(emulated.parameters, points)
    ]
    return evaluated_cars(cars, emulated.cells)[0]


def coverage(cars: int, discrepancy: float) -> list[dict[str, Any]]:
    """Return the coverage of each parameter over synthetic cars drawn from the prior."""
    car = Car.load("focus_road")
    parameters = ranges(car, FACTORS)
    began, wall = time.process_time(), time.perf_counter()
    emulated = emulated_car(car, parameters, targets())
    left_out, noise = 100.0 * emulated.emulator.left_out, 100.0 * np.median(emulated.cells.noise)
    print(
        f"emulator: {time.process_time() - began:.0f} s processor, {time.perf_counter() - wall:.0f} s; "
        f"{emulated.emulator.powers.shape[0]} terms, {emulated.cells.data.size} cells, left-out error median "
        f"{np.median(left_out):.2f} %, largest {left_out.max():.1f} %, noise of a cell {noise:.2f} %",
        flush=True,
    )
    points = 2.0 * scipy.stats.qmc.Sobol(len(parameters), seed=77).random(cars) - 1.0
    exact = hidden_cells(car, emulated, points)
    random = np.random.default_rng(5)
    inside, widths, factors, times = [], [], [], []
    for number, cells in enumerate(exact):
        noise = random.standard_normal(cells.size) * emulated.cells.noise
        bias = random.standard_normal(cells.size) * DISCREPANCY
        began = time.process_time()
        posterior = posterior_of(emulated, data=cells + noise + bias, discrepancy=discrepancy, seed=number)
        times.append(time.process_time() - began)
        low, middle, high = posterior.interval()
        truth = values_at(parameters, points[number : number + 1])[0]
        inside.append((low <= truth) & (truth <= high))
        widths.append(0.5 * (high - low) / middle)
        factors.append(max(posterior.r_hat))
        if number % 10 == 9:
            print(f"{number + 1}: cover {100 * np.mean(inside):.1f} %", flush=True)
    print(f"R-hat at most {max(factors):.4f}; {np.median(times):.1f} s a posterior, at most {max(times):.1f} s")
    return [
        {"parameter": parameter.path, "cover": float(share), "half_width": float(width)}
        for parameter, share, width in zip(parameters, np.mean(inside, axis=0), np.median(widths, axis=0), strict=True)
    ]


def laws(cars: int) -> list[dict[str, Any]]:
    """Return the evidence of friction against a degressive damper for hidden cars of each, at five levels of noise."""
    friction, degressive = Car.load("focus_road"), Car.load("focus_road", DEGRESSIVE)
    other = {path: limits for path, limits in FACTORS.items() if ".damper." not in path}
    law = [Range(path=path, low=low, high=high, start=np.sqrt(low * high)) for path, (low, high) in LAW.items()]
    emulated = {
        "friction": emulated_car(friction, ranges(friction, FACTORS), targets()),
        "degressive": emulated_car(degressive, [*ranges(degressive, other), *law], targets(), cars=384),
    }
    rows = []
    random = np.random.default_rng(6)
    for name, car in (("friction", friction), ("degressive", degressive)):
        points = 1.6 * scipy.stats.qmc.Sobol(len(emulated[name].parameters), seed=78).random(cars) - 0.8
        for number, cells in enumerate(hidden_cells(car, emulated[name], points)):
            for coherence in (0.999, 0.99, 0.95, 0.8, 0.5):
                noise = float(np.sqrt((1.0 - coherence) / (2.0 * coherence * AVERAGES)) / np.sqrt(5.0))
                data = cells + random.standard_normal(cells.size) * np.hypot(noise, DISCREPANCY)
                try:
                    fits = {
                        each: posterior_of(
                            replace(rival, cells=replace(rival.cells, noise=np.full(cells.size, noise))),
                            data=data,
                            discrepancy=DISCREPANCY,
                            seed=number,
                        )
                        for each, rival in emulated.items()
                    }
                    words = verdict(("friction", fits["friction"]), ("degressive", fits["degressive"]))
                    right = "undecided" if words.startswith("undecided") else str(words.startswith(name))
                except SimulationError as error:  # R-hat above its limit: no result
                    words, right = str(error), "no result"
                rows.append({"hidden": name, "coherence": coherence, "right": right, "words": words})
                print(rows[-1], flush=True)
    return rows


def main() -> None:
    """Print the rows of one part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("coverage", "laws"))
    parser.add_argument("--cars", type=int, default=100)
    parser.add_argument("--discrepancy", type=float, default=DISCREPANCY, help="assumed by the posterior")
    options = parser.parse_args()
    for row in coverage(options.cars, options.discrepancy) if options.part == "coverage" else laws(options.cars):
        print(row)


if __name__ == "__main__":
    main()
