"""Errors of the values of a sweep by its time step, against 0.05 ms with all poles in double precision.

python -m tests.benchmarks.sweep_step [--steps 0.0002 0.0005 0.001] [--duration 30]

bias: largest mean error of a comfort value over the cars; scatter: largest standard deviation over the cars, the error
of a difference of two cars over sqrt(2). Slip shares in points, first slips in ms.
"""

import argparse
from dataclasses import replace

import numpy as np

from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.runs.car import Car, Road
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.studies.sweeps.case_evaluation import measured_batch
from vehicle.studies.sweeps.measure import ComfortMeasure, comfort_measure

FINE = 5e-5
"""Step of the reference [s]."""

CASES = (("focus_road", "A", 80.0), ("focus_road", "C", 80.0), ("sedan", "B", 80.0), ("focus", "low.csv", 0.0),
         ("focus", "high.csv", 0.0))  # fmt: skip
"""Car, road class and speed [km/h], or signal of the shaker."""


def variants(car: Car) -> list[Car]:
    """Return the car with other friction, damping and tyres."""
    factors = [(f, v, t) for f in (0.6, 1.0, 1.6) for v, t in ((0.7, 1.0), (1.0, 1.0), (1.3, 1.1))]
    endings = ("damper.coulomb_friction", "damper.viscous", "tyre.stiffness.z")
    paths = [[each.path for each in car.search() if each.path.endswith(ending)] for ending in endings]
    return [
        car.with_({path: factor * car[path].value for each, factor in zip(paths, three, strict=True) for path in each})
        for three in factors
    ]


def drive(name: str, source: str, speed: float, duration: float) -> tuple[list[Car], Signal, float]:
    """Return the cars, their signal and the start of the evaluation [s]."""
    car = Car.load(name)
    if not speed:
        return variants(car), read_signal(find_input(source), wheel=car.vehicle.shaker_wheel), 0.0
    ride = Road(source, speed, duration=duration).under(car.vehicle)
    return variants(car.with_(ride.overrides)), ride.signal(), ride.skip


def reference(car: Car, signal: Signal, measure: ComfortMeasure) -> dict[str, float]:
    """Return the values at the fine step with all poles."""
    run = simulate_reduced(
        car.poles,
        signal,
        dampers=[damper.law for damper in car.vehicle.composition.dampers],
        record_rate=car.vehicle.solver.record_rate,
        tyre_load=car.static.tyre_load,
        channels=measure.channels,
        step=FINE,
    )
    runs = Runs(
        time=run.time,
        channels={name: values[None] for name, values in run.channels.items()},
        vehicles=(car.vehicle,),
        tyre_load={wheel: np.array([load]) for wheel, load in car.static.tyre_load.items()},
        random=signal.random,
        left_obstacle=signal.left_obstacle,
        cars=(car,),
    )
    return {name: float(values[0]) for name, values in measure.of(runs).items()}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=float, nargs="+", default=[2e-4, 5e-4, 1e-3])
    parser.add_argument("--duration", type=float, default=30.0)
    options = parser.parse_args()
    print("car, input          step [ms]  unweighted: bias, scatter [%]  weighted          slip share  first slip")
    for name, source, speed in CASES:
        cars, signal, skip = drive(name, source, speed, options.duration)
        usual = comfort_measure(cars[0].vehicle, skip)
        fine = [reference(car, signal, usual) for car in cars]
        for step in options.steps:
            measure = replace(usual, timestep=step)
            results = measured_batch(cars, signal, measure, accept_invalid=True)
            coarse = [result.values for result in results if result is not None and result.values]
            pairs = {key: np.array([[c[key], f[key]] for c, f in zip(coarse, fine, strict=True)]) for key in fine[0]}
            cells = [f"{name}, {source}".ljust(19), f"{1e3 * step:9.3g}"]
            for kind in ("unweighted", "weighted"):
                keys = [key for key in measure.units if key.startswith(kind) and "error" not in key]
                errors = [100.0 * (pairs[key][:, 0] / pairs[key][:, 1] - 1.0) for key in keys]
                cells.append(f"{max(abs(e.mean()) for e in errors):.4f}, {max(e.std() for e in errors):.4f}".rjust(18))
            for kind, factor in (("slip_share", 100.0), ("first_slip", 1e3)):
                differences = [np.abs(np.diff(pairs[key])) for key in measure.units if key.startswith(kind)]
                cells.append(f"{factor * np.nanmax(differences):10.3f}")
            print("  ".join(cells), flush=True)


if __name__ == "__main__":
    main()
