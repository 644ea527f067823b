"""Speed and accuracy of the time simulation: `python -m tests.benchmarks.speed [--json] [--compare FILE]`.

Times are those of what users call (`car.run`, the command, a case of a sweep): minima of the processor time of
interleaved repetitions on one core, and their ratios to a fixed loop in numpy, `kernel`, measured beside them, which
compare two states of the program on a machine whose speed drifts. Then the price in accuracy. Counts, which need no
clock, are in `tests.benchmarks.counts`.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
import numpy.typing as npt

from tests.benchmarks.sweep_case import case_alone_ms, case_ms
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.compiled import CompiledRows
from vehicle.engines.simulation.plate_arrays import PlateArrays
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal

SHOWN = {
    "rows": "constraint rows",
    "dof": "degrees of freedom",
    "timestep": "default step [s]",
    "kernel_ms": "fixed loop in numpy, the unit of the ratios [ms]",
    "run_ms": "`car.run` with MuJoCo, 4 s [ms]",
    "four_wheel_run_ms": "the same of focus_road on four plates [ms]",
    "reduced_run_ms": "`car.run` with the reduced engine, 60 s, all channels, stated errors [ms]",
    "reduced_bare_ms": "the same without stated errors [ms]",
    "stated_errors_share": "share of the stated errors in that run [-]",
    "reduced_few_ms": "with the channels of seat rail and dampers only [ms]",
    "four_wheel_reduced_ms": "focus_road on four plates [ms]",
    "four_wheel_bare_ms": "the same without stated errors [ms]",
    "four_wheel_stated_errors_share": "share of the stated errors in that run [-]",
    "batch_ms": "16 cars at once, seat rail and damper velocities [ms]",
    "step_us": "step of `car.run`, everything included [us]",
    "plain_step_us": "step of the same model without callbacks, in motion [us]",
    "realtime_factor": "simulated over computing time, recording included",
    "rms_error": "largest RMS error of an acceleration channel against an eighth of the step, low and high level",
    "rms_error_channel": "that channel",
    "slip_error": "largest difference of a slip share against an eighth of the step",
    "reduced_realtime_factor": "the same for the reduced engine, all channels",
    "reduced_few_realtime_factor": "the same with the channels of seat rail and dampers only",
    "batch_realtime_factor": "simulated over computing time of many cars at once, seat rail and damper velocities",
    "four_wheel_rows": "constraint rows of focus_road, on four plates",
    "four_wheel_dof": "degrees of freedom of focus_road",
    "four_wheel_step_us": "step of its `car.run`, all plates in motion [us]",
    "four_wheel_step_ratio": "that over step_us",
    "four_wheel_reduced_realtime_factor": "simulated over computing time of its reduced engine, all channels",
    "case_ms": "processor time of a sweep case of 30 s, ten parameters varied, everything included [ms]",
    "import_ms": "processor time of `import vehicle` in a new process, files cached [ms]",
    "shaker_ms": "processor time of `python -m vehicle.shaker --input low.csv --engine reduced`, all files [ms]",
    "first_car_ms": "processor time of `from vehicle import Car; Car.load('focus')` in a new process [ms]",
    "reduced_rms_error": "largest RMS difference of an acceleration channel to MuJoCo at an eighth of the step",
}

FEW = [
    *(f"seat_rail_acc_{axis}" for axis in AXES),
    *(f"damper_{wheel}_{quantity}" for wheel in ("fr", "fl") for quantity in ("velocity", "force")),
]
"""Channels of a study of comfort and friction."""

BATCH = 16
"""Cars that are run at once."""

PARTS = {
    "position": "mjTIMER_POSITION", "velocity": "mjTIMER_VELOCITY", "control": "mjTIMER_ACTUATION",
    "constraint": "mjTIMER_CONSTRAINT", "advance": "mjTIMER_ADVANCE",
}  # fmt: skip
"""Parts of a step that MuJoCo's timers know; `control` holds the callbacks, the rest is inertia and sensors."""

Figures = dict[str, float | str | dict[str, float]]


@dataclass(frozen=True, kw_only=True, slots=True)
class Effort:
    """How long the benchmark may take.

    Attributes:
        repeats: interleaved repetitions of each measurement.
        starts: repetitions of a start in a new process, after a first one.
        steps: steps of one repetition.
        seconds: length of the timed runs [s].
        accuracy_seconds: length of the runs that are compared with an eighth of the step [s].
        cases: of the timed sweep.
    """

    repeats: int = 7
    starts: int = 7
    steps: int = 2000
    seconds: float = 4.0
    accuracy_seconds: float = 60.0
    cases: int = 64


def pin_to_one_core() -> None:
    """Keep this process on one core, where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def piece(seconds: float, level: str = "high") -> Signal:
    """Beginning of a shipped input; it starts at rest."""
    signal = read_signal(find_input(f"{level}.csv"), wheel="fr")
    count = int(np.searchsorted(signal.time, seconds)) + 1
    return Signal(time=signal.time[:count], displacement={"fr": signal.displacement["fr"][:count]})


def on_four_plates(signal: Signal) -> Signal:
    """The signal of the front right plate under four wheels, 40 samples later from each to the next."""
    z = signal.displacement["fr"]
    late = {wheel: 40 * number for number, wheel in enumerate(("fr", "fl", "rr", "rl"))}
    plates = {wheel: np.concatenate([np.zeros(delay), z[: z.size - delay]]) for wheel, delay in late.items()}
    return Signal(time=signal.time, displacement=plates)


def stepping_time(car: Car, signal: Signal, steps: int, form: str, parts: dict[str, float] | None = None) -> float:
    """Time of a step [us] of the moving car, one call of mj_step each.

    Args:
        car: the car.
        signal: motion of the plates.
        steps: number of steps.
        form: "native", or "plain": MuJoCo's own rows hold the car.
        parts: filled with the time of each part of a step [us]; MuJoCo's timers make every step some us longer.

    Returns:
        Mean over the steps.
    """
    model = car.model.spec.compile()
    model.qpos_spring[:] = car.model.model.qpos_spring
    # As in a run, whose steps never enter Python: `vehicle.engines.simulation.run_model`.
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
    prepare_model(model)
    data = mujoco.MjData(model)
    rows = Rows(model, car.model.static.preload)
    motion = PlateArrays.of(signal, model.opt.timestep, steps - 1, car.vehicle.wheels)
    plates = [model.body_mocapid[model.body(f"plate_{wheel}").id] for wheel in car.vehicle.wheels]
    heights = data.mocap_pos[plates, 2] + motion.displacement

    def go() -> float:
        started = time.perf_counter()
        for index in range(steps):
            data.mocap_pos[plates, 2] = heights[index]
            rows.state.plate_velocity[:, 2] = motion.velocity[index]
            rows.state.plate_acceleration[:, 2] = motion.acceleration[index]
            mujoco.mj_step(model, data)
        return 1e6 * (time.perf_counter() - started) / steps

    if parts is not None:
        mujoco.set_mjcb_time(lambda: 1e6 * time.perf_counter())
    if form == "plain":
        spent = go()
    else:
        native = CompiledRows(rows)
        with installed(rows, native):
            native.attach(data, sparse=True)
            spent = go()
    if parts is not None:
        mujoco.set_mjcb_time(None)
        parts |= {name: data.timer[getattr(mujoco.mjtTimer, timer)].duration / steps for name, timer in PARTS.items()}
        parts["step"] = data.timer[mujoco.mjtTimer.mjTIMER_STEP].duration / steps
    if not np.isfinite(data.qpos).all() or not np.any(data.qvel):
        raise RuntimeError("the car is lost or does not move: nothing was measured")
    return spent


def run_batch(car: Car, signal: Signal) -> None:
    """Run a batch of equal cars, tables and all, with the channels of comfort and slip."""
    simulate_batch(
        [car.poles] * BATCH, signal, dampers=[[damper.law for damper in car.vehicle.composition.dampers]] * BATCH,
        record_rate=car.vehicle.solver.record_rate, tyre_load=[car.model.static.tyre_load] * BATCH,
        channels=[name for name in FEW if not name.endswith("_force")],
    )  # fmt: skip


def start_ms(statement: str, repeats: int) -> float:
    """Return the processor time of a statement in a new process [ms]: minimum after a first run, or that run."""
    code = f"import time; begin = time.process_time(); {statement}; print(time.process_time() - begin)"
    command = [sys.executable, "-c", code]
    times = [subprocess.run(command, capture_output=True, text=True, check=True).stdout for _ in range(repeats + 1)]
    return 1e3 * min(float(text) for text in times)


def shaker_ms(repeats: int) -> float:
    """Return the processor time of the command `shaker` with the reduced engine in a new process [ms]."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["--input", "low.csv", "--engine", "reduced", "--output", f"{folder}/run", "--force", "--quiet"]
        return start_ms(f"from vehicle.commands.shaker import main; main({words})", repeats)


def accuracy(car: Car, seconds: float) -> Figures:
    """RMS of every acceleration and slip shares against an eighth of the step, and the reduced engine against both."""
    fine_car = Car.load(None, [f"solver.timestep={car.vehicle.solver.step / 8}"])
    errors, slips, reduced = {}, [], []
    for level in ("low", "high"):
        signal = piece(seconds, level)
        fine, run, other = fine_car.run(signal), car.run(signal), car.run(signal, engine="reduced")
        for name in car.vehicle.acceleration_channels:
            errors[f"{level}: {name}"] = abs(_rms(run[name]) / _rms(fine[name]) - 1.0)
            reduced.append(abs(_rms(other[name]) / _rms(fine[name]) - 1.0))
        slips += [abs(run.slip_share(wheel) - fine.slip_share(wheel)) for wheel in car.vehicle.wheels]
    worst = max(errors, key=lambda name: errors[name])
    return {
        "rms_error": errors[worst],
        "rms_error_channel": worst,
        "slip_error": max(slips),
        "reduced_rms_error": max(reduced),
    }


def kernel() -> None:
    """Fixed work in numpy, the unit of the ratios: products of matrices of 160 rows, Fourier transforms, a loop."""
    rows = np.linspace(-1.0, 1.0, 160 * 160).reshape(160, 160)
    signal = np.linspace(-1.0, 1.0, 2**16)
    total = 0.0
    for _ in range(30):
        rows = np.tanh(rows @ rows.T / 160.0)
        total += float(np.abs(np.fft.rfft(signal)[1]))
    for index in range(100_000):
        total += index & 3
    assert np.isfinite(total)


def processor_ms(piece_of_work: Callable[[], object]) -> float:
    """Return the processor time of a function [ms]."""
    started = time.process_time()
    piece_of_work()
    return 1e3 * (time.process_time() - started)


def measure(effort: Effort) -> Figures:
    """Return all figures of the benchmark; times are minima of the processor time of interleaved repetitions."""
    car, road_car, signal = Car.load(), Car.load("focus_road"), piece(effort.seconds)
    # Long enough that what a run does once is as small a part as in a study.
    long = piece(effort.accuracy_seconds)
    on_four, long_on_four = on_four_plates(signal), on_four_plates(long)
    works: dict[str, Callable[[], object]] = {
        "kernel_ms": kernel,
        "run_ms": lambda: car.run(signal),
        "four_wheel_run_ms": lambda: road_car.run(on_four),
        "reduced_run_ms": lambda: car.run(long, engine="reduced"),
        "reduced_bare_ms": lambda: car.run(long, engine="reduced", stated_errors=False),
        "reduced_few_ms": lambda: car.run(long, engine="reduced", channels=FEW),
        "four_wheel_reduced_ms": lambda: road_car.run(long_on_four, engine="reduced"),
        "four_wheel_bare_ms": lambda: road_car.run(long_on_four, engine="reduced", stated_errors=False),
        "batch_ms": lambda: run_batch(car, long),
    }
    for work in works.values():
        work()
    times = {name: list[float]() for name in works}
    for _ in range(effort.repeats):
        for name, work in works.items():
            times[name].append(processor_ms(work))
    least = {name: min(values) for name, values in times.items()}
    steps, four_wheel_steps = (
        one.run(drive).recording.statistics.steps for one, drive in ((car, signal), (road_car, on_four))
    )
    least |= {
        "case_ms": min(case_ms(effort.cases) for _ in range(2)),
        "import_ms": start_ms("import vehicle", effort.starts),
        "shaker_ms": shaker_ms(effort.starts),
        "first_car_ms": start_ms("from vehicle import Car; Car.load('focus')", effort.starts),
    }
    parts: dict[str, dict[str, float]] = {"native": {}, "plain": {}}
    few = min(effort.steps, steps)
    for form, found in parts.items():
        stepping_time(car, signal, few, form, found)
    counted = dict[str, int]()
    for head, one in (("", car), ("four_wheel_", road_car)):
        data = mujoco.MjData(one.model.model)
        mujoco.mj_forward(one.model.model, data)
        counted |= {f"{head}rows": int(data.nefc), f"{head}dof": int(one.model.model.nv)}
    step, four_wheel_step = 1e3 * least["run_ms"] / steps, 1e3 * least["four_wheel_run_ms"] / four_wheel_steps
    return accuracy(car, effort.accuracy_seconds) | counted | least | {
        "timestep": float(car.model.model.opt.timestep),
        "step_us": step,
        "plain_step_us": min(stepping_time(car, signal, few, "plain") for _ in range(effort.repeats)),
        "four_wheel_step_us": four_wheel_step,
        "four_wheel_step_ratio": four_wheel_step / step,
        "realtime_factor": 1e3 * signal.duration / least["run_ms"],
        "reduced_realtime_factor": 1e3 * long.duration / least["reduced_run_ms"],
        "reduced_few_realtime_factor": 1e3 * long.duration / least["reduced_few_ms"],
        "four_wheel_reduced_realtime_factor": 1e3 * long.duration / least["four_wheel_reduced_ms"],
        "batch_realtime_factor": 1e3 * BATCH * long.duration / least["batch_ms"],
        "stated_errors_share": 1.0 - least["reduced_bare_ms"] / least["reduced_run_ms"],
        "four_wheel_stated_errors_share": 1.0 - least["four_wheel_bare_ms"] / least["four_wheel_reduced_ms"],
        "ratios": {name: value / least["kernel_ms"] for name, value in least.items()},
        "parts_us": parts["native"],
        "plain_parts_us": parts["plain"],
    }  # fmt: skip


def _rms(values: npt.NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


def report(found: Figures, before: Figures | None) -> str:
    """Table of the figures, with those of an earlier run beside them."""
    lines, ratios = [], found["ratios"]
    assert isinstance(ratios, dict)
    for key, meaning in SHOWN.items():
        value, earlier = found[key], None if before is None else before.get(key)
        earlier = found.get("case_before_ms") if key == "case_ms" else earlier
        text = f"{key:<30} {value:>10.4g}" if isinstance(value, float | int) else f"{key:<30} {value}"
        if key in ratios:
            text += f" = {ratios[key]:>8.4g} kernels"
            if before is not None and (ratio := before.get("ratios", {}).get(key)):  # type: ignore[union-attr]
                text += f" (before {ratio:.4g})"
        if isinstance(value, float | int) and isinstance(earlier, float | int):
            change = f"{100.0 * (value / earlier - 1.0):+.1f} %" if earlier else ""
            text += f"   before {earlier:>10.4g} {change:>9}"
        lines.append(f"{text}   {meaning}")
    native, plain = found["parts_us"], found["plain_parts_us"]
    assert isinstance(native, dict) and isinstance(plain, dict)
    lines.append("where the time goes [us a step, by MuJoCo's timers]: with callbacks, without")
    lines += [f"    {name:<12} {native[name]:>8.2f} {plain[name]:>8.2f}" for name in native]
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None, effort: Effort | None = None) -> int:
    """Run the benchmark and print it."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks.speed", description="Speed of the car.")
    parser.add_argument("--json", action="store_true", help="print JSON, as --compare reads it")
    parser.add_argument("--compare", type=Path, metavar="FILE", help="JSON of an earlier run, shown beside this one")
    options = parser.parse_args(arguments)
    before = json.loads(options.compare.read_text(encoding="utf-8")) if options.compare else None
    pin_to_one_core()
    effort = effort or Effort()
    found = measure(effort)
    if before is not None:
        # An earlier program without batches had no such figure: there every case was carried out by itself.
        found["case_before_ms"] = before.get("case_ms") or case_alone_ms(max(effort.cases // 8, 1))
    print(json.dumps(found, indent=2) if options.json else report(found, before))
    return 0


if __name__ == "__main__":
    sys.exit(main())
