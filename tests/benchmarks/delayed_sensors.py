"""Fit of two frictions to late accelerations, over seeds of noise: `python -m tests.benchmarks.delayed_sensors`.

`focus_road` with 70 N in the front and 48 N in the rear dampers on two independent plates, 6 s; the accelerations are
12.3 ms late and have noise of 4 % of their RMS.
"""

import argparse
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from tests.delayed_records import shaken, write_record
from vehicle.runs.car import Car, Run
from vehicle.studies.tuning.car_fit import tune
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.measured_targets import measured_histories

FRONT, REAR = "front.damper.coulomb_friction", "rear.damper.coulomb_friction"
HIDDEN = {FRONT: 70.0, REAR: 48.0}
"""[N]"""
BOUNDS = {FRONT: (20.0, 200.0, 50.0), REAR: (20.0, 200.0, 80.0)}
"""Lower bound, upper bound, start [N]."""
DELAY = 12.3e-3
"""[s]"""
NOISE = 0.04
"""RMS of the noise over that of the acceleration [-]."""
PLATES = ("plate_fl_displacement", "plate_rl_displacement")
ACCELERATIONS = ("knuckle_fl_acc_z", "knuckle_rl_acc_z", "seat_rail_acc_z")


def hidden_run() -> Run:
    """Return the run of the hidden car."""
    signal = shaken(("fl", "rl"), 6.0, rms=0.5e-3, band=(2.0, 45.0))
    return Car.load("focus_road", HIDDEN).run(signal, engine="reduced", channels=[*PLATES, *ACCELERATIONS])


def measured_by(run: Run, path: Path, seed: int) -> Path:
    """Write the record of late sensors with noise."""
    delays = {**dict.fromkeys(PLATES, 0.0), **dict.fromkeys(ACCELERATIONS, DELAY)}
    write_record(path, run, delays, noise=NOISE, seed=seed)
    return path


def fitted(path: Path, delay: Mapping[str, float] | None = None) -> TuningResult:
    """Fit both frictions to a record, with the delay as an unknown unless it is given [s]."""
    car = Car.load("focus_road")
    return tune(car, BOUNDS, [measured_histories(car, path, delay=delay or 0.0)])


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the deviations from the hidden values in standard errors, and their counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    count = parser.parse_args(arguments).seeds
    run, rows = hidden_run(), []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1000, 1000 + count):
            result = fitted(measured_by(run, Path(folder) / "late.csv", seed))
            (delay,) = result.delays
            away = [result.deviation(path, value) for path, value in HIDDEN.items()]
            rows.append([*away, 1e3 * (result.solution[delay.path] - DELAY), result.deviation(delay.path, DELAY)])
            print("seed {}: {:+.2f} {:+.2f} standard errors, delay {:+.4f} ms ({:+.2f})".format(seed, *rows[-1]))
    table = np.array(rows)
    inside = np.count_nonzero(np.all(np.abs(table[:, :2]) < 3.0, axis=1))
    print(f"{inside} of {count} within three standard errors; delay within {np.max(np.abs(table[:, 2])):.4f} ms")
    print(f"scatter in standard errors: {', '.join(f'{value:.2f}' for value in table[:, [0, 1, 3]].std(axis=0))}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
