"""The one stepping loop: plates in, recording out, guarded against everything MuJoCo would pass over in silence."""

from __future__ import annotations

import time as clock
from collections.abc import Callable

import mujoco
import numpy as np

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.excitation.signal import Signal
from vehicle.names import WHEELS
from vehicle.simulation.callbacks import installed
from vehicle.simulation.car_model import CarModel
from vehicle.simulation.element_rows import ElementRows, prepare_model
from vehicle.simulation.plate_arrays import PlateArrays
from vehicle.simulation.recorder import CHUNK, Recorder
from vehicle.simulation.recording import Recording, Statistics

Progress = Callable[[float], None]

POSE_RATE = 100.0
"""Rate [Hz] of the poses kept for films."""


LARGEST_STATE = 1e8
"""Velocity or acceleration beyond which a state is lost, long before it is infinite; the limit of MuJoCo is higher."""


def simulate(car: CarModel, signal: Signal, *, progress: Progress | None = None) -> Recording:
    """Run a car on its shaker plates.

    Args:
        car: compiled and trimmed car.
        signal: displacement of the plates.
        progress: called with the finished fraction [-] now and then.

    Returns:
        The recording, sampled at `solver.record_rate`.

    Raises:
        ConfigurationError: the recording rate is no whole fraction of the step rate.
        SimulationError: the state is no longer finite, or MuJoCo warned; the message says when and where.
    """
    every = record_every(car)
    model = car.spec.compile()
    model.qpos_spring[:] = car.model.qpos_spring
    prepare_model(model)
    data = mujoco.MjData(model)
    rows = ElementRows(model, car.static.preload)
    step = model.opt.timestep
    count = int(np.floor(signal.duration / step + 1e-6))
    count -= count % every
    times = step * np.arange(count + 1)
    motion = PlateArrays.of(signal, times)
    plates = [model.body_mocapid[model.body(f"plate_{wheel}").id] for wheel in WHEELS]
    height = data.mocap_pos[plates, 2].copy()
    recorder = Recorder(car, model, data, rows, samples=count // every + 1, pose_every=_pose_every(car, every))
    heights = height + motion.displacement
    started = clock.perf_counter()
    with installed(rows):
        for index in range(count + 1):
            data.mocap_pos[plates, 2] = heights[index]
            rows.plate_velocity[:, 2] = motion.velocity[index]
            rows.plate_acceleration[:, 2] = motion.acceleration[index]
            if index % every:
                mujoco.mj_step(model, data)
                continue
            recorder.before_step()
            if index < count:
                mujoco.mj_step(model, data)
            else:
                mujoco.mj_forward(model, data)
            recorder.after_step(moved=index < count)
            if recorder.filled == CHUNK or index == count:
                _check_state(model, data, recorder, every * step)
                recorder.flush(motion, index, every)
                if progress is not None:
                    progress(index / count)
    wall = clock.perf_counter() - started
    warnings = _warnings(data)
    if warnings:
        raise SimulationError(f"MuJoCo warned during the run: {'; '.join(warnings)}; no result of it may be used")
    statistics = Statistics(
        engine="mujoco",
        timestep=step,
        steps=count,
        wall_time=wall,
        warnings=recorder.warnings(),
        energies=recorder.energies(),
    )
    return recorder.recording(signal, statistics)


def record_every(car: CarModel) -> int:
    """Number of steps between two recorded samples.

    Raises:
        ConfigurationError: the two rates do not divide.
    """
    rate, step = car.vehicle.solver.record_rate, car.vehicle.solver.timestep
    every = 1.0 / (rate * step)
    if abs(every - round(every)) > 1e-6 or round(every) < 1:
        raise ConfigurationError(
            f"solver.record_rate: found {rate:g} Hz, must be the step rate {1.0 / step:g} Hz or a whole fraction of it"
        )
    return round(every)


def _pose_every(car: CarModel, every: int) -> int:
    return max(round(1.0 / (POSE_RATE * car.vehicle.solver.timestep * every)), 1)


def _check_state(model: mujoco.MjModel, data: mujoco.MjData, recorder: Recorder, interval: float) -> None:
    """Stop at the first state that is not finite; MuJoCo itself would go on."""
    good = recorder.finite_samples()
    state = np.concatenate([data.qvel, data.qacc])
    if good == recorder.filled and np.all(np.isfinite(state)) and np.max(np.abs(state)) < LARGEST_STATE:
        return
    bad = np.flatnonzero(~np.isfinite(data.qacc) | (np.abs(data.qacc) > LARGEST_STATE))
    joint = model.joint(model.dof_jntid[bad[0] if len(bad) else int(np.argmax(np.abs(data.qacc)))]).name
    pose_time, pose = recorder.last_pose(good)
    raise SimulationError(
        f"the state is no longer finite at t = {(recorder.done + good) * interval:.4f} s (joint {joint}); "
        "reduce solver.timestep or check the parameters that you changed",
        state={"time": np.array(pose_time), "qpos": pose},
    )


def _warnings(data: mujoco.MjData) -> list[str]:
    """Warnings MuJoCo counted during the run."""
    kinds = mujoco.mjtWarning
    found = []
    for kind in range(int(kinds.mjNWARNING)):
        number = int(data.warning[kind].number)
        if number:
            found.append(f"{kinds(kind).name} ({number} times)")
    return found
