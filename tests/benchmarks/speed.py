"""Speed and accuracy of the time simulation: `python -m tests.benchmarks.speed [--json] [--compare FILE]`.

Counts first (rows, degrees of freedom), then time: medians of interleaved runs on one core, and the price in accuracy.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.car import Car
from vehicle.excitation.csv_file import read_signal
from vehicle.excitation.input_files import find_input
from vehicle.excitation.signal import Signal
from vehicle.names import WHEELS, acceleration_channels
from vehicle.simulation.callbacks import installed
from vehicle.simulation.element_rows import ElementRows, prepare_model
from vehicle.simulation.native import native_callback
from vehicle.simulation.plate_arrays import PlateArrays

SHOWN = {
    "rows": "constraint rows",
    "dof": "degrees of freedom",
    "timestep": "default step [s]",
    "step_us": "step with the callbacks that a run uses, in motion [us]",
    "python_step_us": "step with the callbacks in Python, in motion [us]",
    "plain_step_us": "step of the same model without callbacks, in motion [us]",
    "realtime_factor": "simulated over computing time, recording included",
    "rms_error": "largest RMS error of an acceleration channel against an eighth of the step",
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Effort:
    """How long the benchmark may take.

    Attributes:
        repeats: interleaved repetitions of each measurement.
        steps: steps of one repetition.
        seconds: length of the runs [s].
    """

    repeats: int = 7
    steps: int = 2000
    seconds: float = 4.0


def pin_to_one_core() -> None:
    """Keep this process on one core, where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def piece(seconds: float) -> Signal:
    """Beginning of the shipped high input; it starts at rest."""
    signal = read_signal(find_input("high.csv"))
    count = int(np.searchsorted(signal.time, seconds)) + 1
    return Signal(time=signal.time[:count], displacement={"fr": signal.displacement["fr"][:count]})


def stepping_time(car: Car, signal: Signal, steps: int, form: str) -> float:
    """Time of a step [us] of the moving car, one call of mj_step each.

    Args:
        car: the car.
        signal: motion of the plates.
        steps: number of steps.
        form: "native" (Python where it cannot be had), "python", or "plain": MuJoCo's own welds hold the car.

    Returns:
        Mean over the steps.
    """
    model = car.model.spec.compile()
    model.qpos_spring[:] = car.model.model.qpos_spring
    prepare_model(model)
    data = mujoco.MjData(model)
    rows = ElementRows(model, car.model.static.preload)
    motion = PlateArrays.of(signal, model.opt.timestep * np.arange(steps))
    plates = [model.body_mocapid[model.body(f"plate_{wheel}").id] for wheel in WHEELS]
    heights = data.mocap_pos[plates, 2] + motion.displacement

    def go() -> float:
        started = time.perf_counter()
        for index in range(steps):
            data.mocap_pos[plates, 2] = heights[index]
            rows.plate_velocity[:, 2] = motion.velocity[index]
            rows.plate_acceleration[:, 2] = motion.acceleration[index]
            mujoco.mj_step(model, data)
        return 1e6 * (time.perf_counter() - started) / steps

    if form == "plain":
        spent = go()
    else:
        found = native_callback(rows) if form == "native" else "not asked for"
        native = None if isinstance(found, str) else found
        with installed(rows, native):
            if native is not None:
                native.attach(data)
            spent = go()
    if not np.isfinite(data.qpos).all() or not np.any(data.qvel):
        raise RuntimeError("the car is lost or does not move: nothing was measured")
    return spent


def measure(effort: Effort) -> dict[str, float]:
    """All figures of the benchmark; times are medians of interleaved repetitions."""
    car = Car.load()
    signal = piece(effort.seconds)
    model = car.model.model
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    steps = min(effort.steps, int(signal.duration / model.opt.timestep))
    native, python, plain, factors = [], [], [], []
    run = car.run(signal)
    for _ in range(effort.repeats):
        native.append(stepping_time(car, signal, steps, "native"))
        python.append(stepping_time(car, signal, steps, "python"))
        plain.append(stepping_time(car, signal, steps, "plain"))
        run = car.run(signal)
        factors.append(run.recording.statistics.realtime_factor)
    fine = Car.load(None, [f"solver.timestep={car.vehicle.solver.timestep / 8}"]).run(signal)
    return {
        "rows": int(data.nefc),
        "dof": int(model.nv),
        "timestep": float(model.opt.timestep),
        "step_us": median(native),
        "python_step_us": median(python),
        "plain_step_us": median(plain),
        "realtime_factor": median(factors),
        "rms_error": max(abs(_rms(run[name]) / _rms(fine[name]) - 1.0) for name in acceleration_channels()),
    }


def _rms(values: npt.NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


def report(found: dict[str, float], before: dict[str, float] | None) -> str:
    """Table of the figures, with those of an earlier run beside them."""
    lines = []
    for key, meaning in SHOWN.items():
        text = f"{key:<16} {found[key]:>10.4g}"
        if before is not None and key in before:
            change = f"{100.0 * (found[key] / before[key] - 1.0):+.1f} %" if before[key] else ""
            text += f"   before {before[key]:>10.4g} {change:>9}"
        lines.append(f"{text}   {meaning}")
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None, effort: Effort | None = None) -> int:
    """Run the benchmark and print it."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.speed", description="Speed of the car.")
    parser.add_argument("--json", action="store_true", help="print JSON, as --compare reads it")
    parser.add_argument("--compare", type=Path, metavar="FILE", help="JSON of an earlier run, shown beside this one")
    options = parser.parse_args(arguments)
    before = json.loads(options.compare.read_text(encoding="utf-8")) if options.compare else None
    pin_to_one_core()
    found = measure(effort or Effort())
    print(json.dumps(found, indent=2) if options.json else report(found, before))
    return 0


if __name__ == "__main__":
    sys.exit(main())
