"""Stepping loop of a run, with checks for states and warnings that MuJoCo ignores."""

import time as clock
from collections.abc import Callable, Sequence
from functools import partial

import mujoco
import numpy as np

from vehicle.engines.simulation.applied_forces import averaged_forces, force_lines
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.compiled import CompiledRows, SteppingLoop
from vehicle.engines.simulation.judgement import judge_energy
from vehicle.engines.simulation.plate_arrays import PlateArrays, PlateBlock
from vehicle.engines.simulation.recorded_acceleration import AHEAD
from vehicle.engines.simulation.recorder import CHUNK, Recorder
from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.run_model import run_model
from vehicle.engines.simulation.tyre_variation import run_out, with_run_out
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.laws.controller_fmu import controllers
from vehicle.signals.excitation.signal import Signal

Progress = Callable[[float], None]

POSE_RATE = 100.0
"""Rate [Hz] of the stored poses for films."""


LARGEST_STATE = 1e8
"""Maximum velocity or acceleration of a valid state; the limit of MuJoCo is higher."""


def simulate(
    car: CarModel, signal: Signal, *, progress: Progress | None = None, requested: Sequence[str] = ()
) -> Recording:
    """Run a car on its shaker plates; the recording is sampled at `solver.record_rate`.

    Args:
        car: compiled car in static equilibrium.
        signal: displacement of the plates.
        progress: function that is called with the finished fraction [-] about every `CHUNK` samples.
        requested: names of additional channels: loads and damper settings.

    Raises:
        ConfigurationError: the recording rate is not an integer fraction of the step rate, or the signal has too few
            samples for a run-out.
        MissingPartError: there is no core for this platform, or the installed MuJoCo does not match its declarations.
        SimulationError: the state is not finite, MuJoCo warned, or the energy balance does not close; the
            message contains time and joint.
    """
    force_lines(car.vehicle.composition.forces)[0].require_length(signal.duration)
    every = record_every(car)
    model, space = run_model(car)
    data = mujoco.MjData(model)
    rows = Rows(model, car.static.preload, space)
    step = model.opt.timestep
    count = int(np.floor(signal.duration / step + 1e-6))
    # The last step has a sample.
    count -= count % every
    pose_every = max(round(1.0 / (POSE_RATE * step * every)), 1)
    mocap = [int(model.body_mocapid[model.body(wheel.plate).id]) for wheel in car.vehicle.composition.wheels]
    level = data.mocap_pos[mocap, 2].copy()
    unit = every * pose_every
    forces = car.vehicle.composition.forces
    road = with_run_out(signal, run_out(forces))
    motion = partial(PlateArrays.of, road, step, count, car.vehicle.wheels, AHEAD * every, forces=forces)
    block = PlateBlock(
        motion,
        count + 1 + AHEAD * every,
        level,
        unit=unit,
        minimum=(CHUNK + 1) * every + unit,
        forces=partial(averaged_forces, forces, step),
    )
    state = rows.state
    plates = {
        **vars(block),
        "mocap": np.array(mocap, dtype=np.int64),
        "mocap_position": data.mocap_pos,
        "row_velocity": state.plate_velocity,
        "row_acceleration": state.plate_acceleration,
        "row_slope": state.slope_velocity,
        "applied": state.applied,
    }
    compiled = CompiledRows(rows)
    recorder = Recorder(
        car, model, data, rows, samples=count // every + 1, every=every, pose_every=pose_every, requested=requested
    )
    compiled.attach(data, sparse=True)
    loop = SteppingLoop(order=recorder.order, plates=plates, sources=recorder.sources, samples=recorder.buffers)
    laws = {damper.name: damper.law.controlled for damper in car.vehicle.composition.dampers}
    names = [rows.laws.dampers[index] for index in rows.layout.controls.dampers]
    controls = [(name, control) for name in names if (control := laws[name]) is not None]
    with controllers(rows.layout.controls.laws, controls, step) as check, installed(rows, compiled) as check_laws:
        started = clock.perf_counter()
        index = 0
        while index <= count:
            # The first and the last sample need the energy of the car, so their steps are taken singly.
            last = every * min(recorder.done + CHUNK - 1, count // every - 1)
            several = 0 < index <= last
            # The block must contain all samples in the buffers, which are evaluated together.
            offset = block.reach(min(index, every * recorder.done), last if several else index)
            if several:
                recorder.keep(last, loop.advance(index - offset, last - offset, recorder.filled))
                index = last
            else:
                loop.move_plates(index - offset)
                recorded, moved = index % every == 0, index < count
                if recorded:
                    recorder.before_step()
                # The final state is evaluated without a step.
                (mujoco.mj_step if moved else mujoco.mj_forward)(model, data)
                if recorded:
                    recorder.after_step(loop, moved=moved)
            if index == count or recorder.filled == CHUNK:
                check()
                check_laws()
                _check_state(model, data, recorder, every * step)
                recorder.flush(block.motion, index - offset, every)
                if progress is not None:
                    progress(index / count)
            index += 1
        # Further steps after the end, whose positions the last accelerations need.
        for index in range(count, count + AHEAD * every):
            loop.move_plates(index - block.reach(index, index))
            mujoco.mj_step(model, data)
            if (index + 1) % every == 0:
                recorder.keep_ahead((index + 1 - count) // every - 1)
        check()
        wall = clock.perf_counter() - started
    counts = [int(warning.number) for warning in data.warning]
    warnings = [f"{mujoco.mjtWarning(number).name} ({count} times)" for number, count in enumerate(counts) if count]
    if warnings:
        raise SimulationError(
            f"MuJoCo warned during the run: {'; '.join(warnings)}; its results are discarded: check the input and the "
            "changed parameters, or reduce solver.timestep"
        )
    energies = recorder.energies()
    pulled, notices = recorder.messages()
    statistics = Statistics(
        engine="mujoco",
        callback="native",
        timestep=step,
        steps=count,
        wall_time=wall,
        warnings=(*pulled, *judge_energy(energies, 1.0 / (every * step), step)),
        energies=energies,
        notices=notices,
    )
    return recorder.recording(signal, statistics)


def record_every(car: CarModel) -> int:
    """Return the number of steps between two recorded samples.

    Raises:
        ConfigurationError: the recording rate is not an integer fraction of the step rate.
    """
    rate, step = car.vehicle.solver.record_rate, car.vehicle.solver.step
    every = 1.0 / (rate * step)
    if abs(every - round(every)) > 1e-6 or round(every) < 1:
        raise ConfigurationError(
            f"solver.record_rate: found {rate:g} Hz, must be the step rate {1.0 / step:g} Hz or a whole fraction of it"
        )
    return round(every)


def _check_state(model: mujoco.MjModel, data: mujoco.MjData, recorder: Recorder, interval: float) -> None:
    """Raise an error for a nonfinite state; MuJoCo would continue."""
    good = recorder.finite_samples()
    state = np.concatenate([data.qvel, data.qacc])
    if good == recorder.filled and np.all(np.isfinite(state)) and np.max(np.abs(state)) < LARGEST_STATE:
        return
    bad = np.flatnonzero(~np.isfinite(data.qacc) | (np.abs(data.qacc) > LARGEST_STATE))
    joint = model.joint(model.dof_jntid[bad[0] if len(bad) else int(np.argmax(np.abs(data.qacc)))]).name
    pose_time, pose = recorder.last_pose(good)
    raise SimulationError(
        f"the state is no longer finite at t = {(recorder.done + good) * interval:.4f} s (joint {joint}); "
        "the step is stable for the car at rest, but not for this motion: check the input and the changed parameters",
        state={"time": np.array(pose_time), "qpos": pose},
    )
