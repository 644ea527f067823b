"""Run of a single car with the reduced engine, which gives the same recording as MuJoCo in much shorter time."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.controlled_dampers import COEFFICIENT, FORCE, control_at_rest
from vehicle.engines.reduced.load_outputs import direct_forces, load_outputs
from vehicle.engines.reduced.plate_samples import LongPlateSamples, plate_samples
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.pole_stepping import PoleStepping, compiled_stepping
from vehicle.engines.reduced.readout import Readout
from vehicle.engines.reduced.slope_force import slope_forces_at_rest
from vehicle.engines.reduced.step_factors import StepFactors, step_factors
from vehicle.engines.reduced.validity import ValidityWatch
from vehicle.engines.simulation.recorded_acceleration import AHEAD, acceleration
from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.model.laws.damper import RECORD, damper_curve, pack
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import channel_units, wheel_channels
from vehicle.signals.excitation.signal import Signal, uniform_time

Vector = npt.NDArray[np.float64]

LONGEST_STEP = 1.25e-4
"""Maximum time step [s]. Linear parts are exact at any step; the step only limits the accuracy of the instants of
sticking and slipping, and of the friction force, which is constant over a step. Against MuJoCo at the same step every
channel of the shipped inputs agrees within 0.5 % RMS; at 0.2 ms the lateral acceleration of the damper top is 0.7 %
off."""

BLOCK = 2048
"""Samples in a block of channels: they fit in the cache, and memory does not grow with the record."""


def simulate_reduced(
    model: PoleModel,
    signal: Signal,
    *,
    dampers: Sequence[Damper],
    record_rate: float,
    tyre_load: Mapping[str, float],
    channels: Sequence[str] | None = None,
    loads: LoadRows | None = None,
    present_load: bool = True,
) -> Recording:
    """Simulate a car on its plates with the reduced engine.

    Args:
        model: pole model of the car.
        signal: displacement of the plates.
        dampers: laws of the dampers; the model already contains their viscous parts.
        record_rate: rate of the samples [Hz].
        tyre_load: static tyre loads [N] by wheel.
        channels: names of the recorded channels; all except the loads by default.
        loads: rows of the load channels; needed if `channels` contains load channels.
        present_load: slope forces of rolling tyres by their current load; if False, by their static load.

    Returns:
        The recording, without poses and energy balance.

    Raises:
        MissingPartError: numba is not installed.
    """
    system = model.matrices.system
    wheeled = wheel_channels(system.inputs, [f"damper_{wheel}" for wheel in system.inputs])
    names = (*system.outputs, *wheeled) if channels is None else tuple(channels)
    step_poles = compiled_stepping(len(dampers) + len(dampers) % 2)
    interval = 1.0 / record_rate
    every = int(np.ceil(interval / LONGEST_STEP - 1e-9))
    samples = int(np.floor(signal.duration / interval + 1e-6)) + 1
    step = interval / every
    plates = plate_samples(signal, step, (samples - 1) * every, AHEAD * every)
    run = _Run(model, step_factors(model, step), dampers, signal.wheels, tyre_load if present_load else None)
    # Zero steps: exclude compiling from the time of the run.
    run.advance(step_poles, plates[:1], every, 1, np.zeros((1, run.state().size)))
    run.begin(plates[:1][0, ::2])
    started = clock.perf_counter()
    tyres = {f"tyre_{wheel}_force_z" for wheel in system.inputs}
    linear_names = [name for name in names if name in system.outputs or name in tyres]
    outputs, load_rows = model.outputs(linear_names), None if loads is None else loads.only(names)
    if load_rows is not None:
        outputs += load_outputs(model, load_rows)
        linear_names += load_rows.names
    readout = Readout(outputs, run.factors, model.pairs, run.columns)
    watch = ValidityWatch(model, run.factors, run.columns, tyre_load, interval)
    table = np.empty((len(linear_names), samples + AHEAD))
    table[:, 0] = readout.at(run.state()[None], plates[:1], run.before[:1, : run.count])[:, 0] if linear_names else 0.0
    channel = {name: row[:samples] for name, row in zip(linear_names, table, strict=True)}
    statics = (
        []
        if load_rows is None
        else list(zip(load_rows.names, load_rows.static, direct_forces(model, load_rows), strict=True))
    )
    for block, block_plates, friction in run.fill(step_poles, plates, every, readout, table, watch):
        for name, values in run.wheel_channels(model, block_plates[: max(samples - block.start, 0)]).items():
            if name in names:
                channel.setdefault(name, np.empty(samples))[block] = values
        for name, static, row in statics:
            block_values = channel[name][block]
            block_values[:] = block_values + static + friction[: len(block_values)] @ row
    # In place, so that memory contains a long record only once.
    for name, positions in zip(linear_names, table, strict=True):
        if "_acc_" in name:
            acceleration(positions, interval)
    for wheel in run.corners:
        if f"tyre_{wheel}_force_z" in channel:
            channel[f"tyre_{wheel}_force_z"] += tyre_load[wheel]
    wall, validity = clock.perf_counter() - started, watch.result()
    return Recording(
        time=uniform_time(samples=samples, timestep=interval),
        channels={name: channel[name] for name in names},
        units=channel_units(names),
        excited=tuple(wheel for wheel in signal.wheels if np.any(signal.displacement[wheel] != 0.0)),
        pose_time=np.zeros(0),
        poses=np.zeros((0, 0)),
        statistics=Statistics(
            engine="reduced",
            callback="native",
            timestep=step,
            steps=(samples - 1) * every,
            wall_time=wall,
            warnings=validity.warnings(),
            within_validity=validity.within_limits,
            energies=None,
        ),
    )


class _Run:
    """Arrays of one run for the compiled time stepping.

    Args:
        model: pole model of the car.
        factors: factors of the step.
        dampers: laws of the dampers.
        wheels: driven wheels.
        tyre_load: see `slope_forces_at_rest`.
    """

    def __init__(
        self,
        model: PoleModel,
        factors: StepFactors,
        dampers: Sequence[Damper],
        wheels: tuple[str, ...],
        tyre_load: Mapping[str, float] | None,
    ) -> None:
        self.factors, self.pairs, self.wheels = factors, model.pairs, wheels
        self.corners = model.matrices.system.inputs
        corners = len(self.corners)
        self.columns = [column for index in map(self.corners.index, wheels) for column in (index, corners + index)]
        count = len(dampers)
        even = count + count % 2
        self.laws = np.zeros(even, dtype=RECORD)
        self.laws[:count] = [pack(damper) for damper in dampers]
        decay, idle = factors.decay[:, None], np.zeros((len(factors.decay), even - count))
        slip, force = np.hstack([model.slip.T, idle]), np.hstack([decay * factors.force, idle])
        plates = factors.plate[:, self.columns]
        self.slope, tyres = slope_forces_at_rest(model, factors, self.columns, tyre_load)
        rows = np.hstack([decay, slip, force[:, :2], plates[:, :2], force[:, 2:], plates[:, 2:], tyres])
        pairs, reals = rows[: model.pairs], rows[model.pairs :]
        self.pair_factors = np.ascontiguousarray(np.stack([pairs.real, pairs.imag], axis=2).reshape(model.pairs, -1).T)
        self.real_factors = np.ascontiguousarray(reals.real.T)
        self.slip_plate, self.gain = np.zeros((even, len(self.columns))), np.zeros((even, even))
        self.slip_plate[:count] = (model.slip @ factors.ahead[:, self.columns]).real
        self.gain[:count, :count] = (model.slip @ factors.force).real
        self.rest_forces = np.array([pack(damper)["rest_force"] for damper in dampers])
        self.curves = _curves(dampers, np.diag(self.gain))
        self.control = control_at_rest(model, factors, dampers, self.columns)
        self.count = count
        self.pair, self.real = np.zeros((2, len(pairs))), np.zeros(len(reals))
        self.force = np.zeros(even)
        self.velocities = self.before = self.after = np.zeros((1, even))

    def state(self) -> Vector:
        """Return eta of the pairs, real and imaginary parts, and of the real poles; (2 p + q,)."""
        return np.concatenate([self.pair[0], self.pair[1], self.real])

    def begin(self, plate_z: Vector) -> None:
        """Set the initial state of a car at rest, xi = 0, over plates with any displacement.

        Args:
            plate_z: z of the driven plates [m]; (w,). Their initial velocity changes xi by c1 z', of second order in h.
        """
        eta, pairs = 0.0 - self.factors.ahead[:, self.columns[::2]] @ plate_z, self.pairs
        self.pair, self.real = np.stack([eta[:pairs].real, eta[:pairs].imag]), eta[pairs:].real.copy()

    def advance(self, step_poles: PoleStepping, piece: Vector, every: int, sample: int, states: Vector) -> None:
        """Advance over the steps between the rows of `piece`; the first sample at the end of a step is `sample`."""
        step_poles(
            self.pair_factors,
            self.real_factors,
            self.slip_plate,
            self.gain,
            self.laws,
            self.curves,
            piece,
            self.pair,
            self.real,
            self.force,
            every,
            sample,
            states,
            self.velocities,
            self.before,
            self.after,
            self.control,
            self.slope,
        )

    def fill(
        self,
        step_poles: PoleStepping,
        plates: Vector | LongPlateSamples,
        every: int,
        readout: Readout,
        table: Vector,
        watch: ValidityWatch,
    ) -> Iterator[tuple[slice, Vector, Vector]]:
        """Fill the table of outputs, (outputs, samples), and the arrays of the dampers, block by block.

        Yields:
            Slice of the samples of a block, from the last sample of the previous block on, for which the arrays contain
            the steps on both sides; (z, z') of the plates at these samples; nonlinear damper forces [N], (block, d).
        """
        samples = table.shape[1]
        self.velocities, self.before, self.after = np.zeros((3, BLOCK + 1, len(self.laws)))
        control_samples = np.zeros((BLOCK + 1, len(self.control.dampers), 4))
        self.control = self.control._replace(samples=control_samples)
        states = np.zeros((BLOCK, len(self.state())))
        for first_sample in range(1, samples, BLOCK):
            size = min(BLOCK, samples - first_sample)
            first, new_rows = (first_sample - 1) * every, slice(1, size + 1)
            block_plates = plates[first : first + size * every + 1]
            self.advance(step_poles, block_plates, every, 1, states)
            sample_plates, force = block_plates[every::every], self.before[new_rows, : self.count]
            table[:, first_sample : first_sample + size] = readout.at(states[:size], sample_plates, force)
            watch.update(states[:size], sample_plates, force)
            if first_sample == 1:
                control_samples[0, :, COEFFICIENT] = control_samples[0, :, COEFFICIENT + 1]
            yield slice(first_sample - 1, first_sample - 1 + size), block_plates[:-1:every], self.friction(size)
            for array in (self.velocities, self.before, self.after, control_samples):
                array[0] = array[size]

    def friction(self, samples: int) -> Vector:
        """Return the nonlinear damper forces at the first samples of a block [N]; (samples, d).

        The force of a step belongs to its middle, so the force at a sample is the mean of the steps on both sides.
        """
        return 0.5 * (self.before + self.after)[:samples, : self.count]

    def wheel_channels(self, model: PoleModel, plates: Vector) -> dict[str, Vector]:
        """Return plate displacements, damper velocities and damper forces at the first samples of a block."""
        channels = {}
        for column, wheel in enumerate(self.corners):
            driven = wheel in self.wheels
            height = plates[:, 2 * self.wheels.index(wheel)] if driven else np.zeros(len(plates))
            velocity = self.velocities[: len(plates), column]
            friction = self.friction(len(plates))[:, column]
            channels[f"plate_{wheel}_displacement"] = height
            channels[f"damper_{wheel}_velocity"] = velocity
            viscous: Vector | float = model.matrices.viscous[column]
            if column in self.control.dampers:
                samples_of_control = self.control.samples[: len(plates), list(self.control.dampers).index(column)]
                viscous = 0.5 * (samples_of_control[:, COEFFICIENT] + samples_of_control[:, COEFFICIENT + 1])
                friction = friction - 0.5 * (samples_of_control[:, FORCE] + samples_of_control[:, FORCE + 1])
                channels[f"damper_{wheel}_coefficient"] = viscous
            channels[f"damper_{wheel}_force"] = viscous * velocity - friction + self.rest_forces[column]
        return channels


def _curves(dampers: Sequence[Damper], gains: Vector) -> Vector:
    """Return the segments of the curves without D v and F(0) for `step_poles`; (w, 4, segments), idle segments last."""
    segment_table = np.zeros((len(gains), 4, max(len(damper_curve(damper).slopes) for damper in dampers)))
    segment_table[:, 0], segment_table[:, 3] = np.inf, 1.0
    for segments, damper, gain in zip(segment_table, dampers, gains, strict=False):
        curve = damper_curve(damper)
        count, excess = len(curve.slopes), curve.slopes - curve.least_slope
        segments[0, : count - 1] = curve.knots
        segments[1, :count], segments[2, :count] = excess, curve.offsets - curve.force(0.0)
        segments[3, :count] = 1.0 / (1.0 + gain * excess)
    return segment_table
