"""A run with the reduced engine: the same recording as the MuJoCo path, in a small part of its time."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.control import COEFFICIENT, FORCE, control_of
from vehicle.engines.reduced.loads import direct_forces, load_outputs
from vehicle.engines.reduced.march import March, compiled_march
from vehicle.engines.reduced.plate_samples import LongPlates, plate_samples
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.readout import Readout
from vehicle.engines.reduced.slope import slope_of
from vehicle.engines.reduced.step_factors import StepFactors, step_factors
from vehicle.engines.reduced.validity import ValidityWatch
from vehicle.engines.simulation.recorded_acceleration import AHEAD, acceleration
from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.model.laws.damper import RECORD, damper_curve, pack
from vehicle.model.parameters.elements import Damper
from vehicle.names import channel_units, wheel_channels
from vehicle.signals.excitation.signal import Signal, uniform_time

Vector = npt.NDArray[np.float64]

LONGEST_STEP = 1.25e-4
"""Longest time step [s]. Linear parts are exact at any step; this one places the instants of sticking and slipping and
resolves the friction force, which is constant over a step. Against MuJoCo at the same step every channel of the shipped
inputs agrees within 0.5 % RMS; at 0.2 ms the lateral acceleration of the damper top is 0.7 % off."""

BLOCK = 2048
"""Samples that are turned into channels at once: they stay in the cache, and memory does not grow with the record."""


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
    """Run a car on its plates with the reduced engine.

    Args:
        model: the car as a sum over its poles.
        signal: displacement of the plates.
        dampers: their laws, one for each; the viscous parts are in the model already.
        record_rate: rate of the samples [Hz].
        tyre_load: static tyre loads [N] by wheel.
        channels: names of the recorded channels; all but the loads by default.
        loads: rows of the load channels, where `channels` names such.
        present_load: rolling tyres push on a slope by their present load; by their static load where False.

    Returns:
        The recording; without poses, and without an energy balance.

    Raises:
        MissingPartError: numba is not installed.
    """
    system = model.matrices.system
    wheeled = wheel_channels(system.inputs, [f"damper_{wheel}" for wheel in system.inputs])
    names = (*system.outputs, *wheeled) if channels is None else tuple(channels)
    march = compiled_march(len(dampers) + len(dampers) % 2)
    interval = 1.0 / record_rate
    every = int(np.ceil(interval / LONGEST_STEP - 1e-9))
    samples = int(np.floor(signal.duration / interval + 1e-6)) + 1
    step = interval / every
    plates = plate_samples(signal, step, (samples - 1) * every, AHEAD * every)
    run = _Run(model, step_factors(model, step), dampers, signal.wheels, tyre_load if present_load else None)
    # No step at all: compiling is no part of the time of the run.
    run.advance(march, plates[:1], every, 1, np.zeros((1, run.state().size)))
    run.begin(plates[:1][0, ::2])
    started = clock.perf_counter()
    tyres = {f"tyre_{wheel}_force_z" for wheel in system.inputs}
    linear = [name for name in names if name in system.outputs or name in tyres]
    outputs, chosen = model.outputs(linear), None if loads is None else loads.only(names)
    if chosen is not None:
        outputs += load_outputs(model, chosen)
        linear += chosen.names
    readout = Readout(outputs, run.factors, model.pairs, run.columns)
    watch = ValidityWatch(model, run.factors, run.columns, tyre_load, interval)
    table = np.empty((len(linear), samples + AHEAD))
    table[:, 0] = readout.at(run.state()[None], plates[:1], run.before[:1, : run.count])[:, 0] if linear else 0.0
    channel = {name: row[:samples] for name, row in zip(linear, table, strict=True)}
    statics = (
        [] if chosen is None else list(zip(chosen.names, chosen.static, direct_forces(model, chosen), strict=True))
    )
    for here, heights, friction in run.fill(march, plates, every, readout, table, watch):
        for name, values in run.wheel_channels(model, heights[: max(samples - here.start, 0)]).items():
            if name in names:
                channel.setdefault(name, np.empty(samples))[here] = values
        for name, static, row in statics:
            part = channel[name][here]
            part[:] = part + static + friction[: len(part)] @ row
    # In place: a long record stands in memory once.
    for name, positions in zip(linear, table, strict=True):
        if "_acc_" in name:
            acceleration(positions, interval)
    for wheel in run.corners:
        if f"tyre_{wheel}_force_z" in channel:
            channel[f"tyre_{wheel}_force_z"] += tyre_load[wheel]
    wall, validity = clock.perf_counter() - started, watch.found()
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
            within_validity=validity.held,
            energies=None,
        ),
    )


class _Run:
    """Arrays of one run, as the compiled march takes them.

    Args:
        model: the car.
        factors: of its step.
        dampers: their laws.
        wheels: driven wheels.
        tyre_load: as of `slope_of`.
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
        self.columns = [place for one in map(self.corners.index, wheels) for place in (one, corners + one)]
        count = len(dampers)
        even = count + count % 2
        self.laws = np.zeros(even, dtype=RECORD)
        self.laws[:count] = [pack(damper) for damper in dampers]
        decay, idle = factors.decay[:, None], np.zeros((len(factors.decay), even - count))
        slip, force = np.hstack([model.slip.T, idle]), np.hstack([decay * factors.force, idle])
        plates = factors.plate[:, self.columns]
        self.slope, tyres = slope_of(model, factors, self.columns, tyre_load)
        rows = np.hstack([decay, slip, force[:, :2], plates[:, :2], force[:, 2:], plates[:, 2:], tyres])
        pairs, reals = rows[: model.pairs], rows[model.pairs :]
        self.pair_factors = np.ascontiguousarray(np.stack([pairs.real, pairs.imag], axis=2).reshape(model.pairs, -1).T)
        self.real_factors = np.ascontiguousarray(reals.real.T)
        self.slip_plate, self.gain = np.zeros((even, len(self.columns))), np.zeros((even, even))
        self.slip_plate[:count] = (model.slip @ factors.ahead[:, self.columns]).real
        self.gain[:count, :count] = (model.slip @ factors.force).real
        self.rest = np.array([pack(damper)["rest_force"] for damper in dampers])
        self.curves = _curves(dampers, np.diag(self.gain))
        self.control = control_of(model, factors, dampers, self.columns)
        self.count = count
        self.pair, self.real = np.zeros((2, len(pairs))), np.zeros(len(reals))
        self.force = np.zeros(even)
        self.velocities = self.before = self.after = np.zeros((1, even))

    def state(self) -> Vector:
        """eta of the pairs, real and imaginary, and of the real poles; (2 p + q,)."""
        return np.concatenate([self.pair[0], self.pair[1], self.real])

    def begin(self, heights: Vector) -> None:
        """Start a car that has not moved yet, xi = 0, over plates that stand anywhere.

        Args:
            heights: z of the driven plates [m]; (w,). Their first velocity changes xi by c1 z', of second order in h.
        """
        eta, pairs = 0.0 - self.factors.ahead[:, self.columns[::2]] @ heights, self.pairs
        self.pair, self.real = np.stack([eta[:pairs].real, eta[:pairs].imag]), eta[pairs:].real.copy()

    def advance(self, march: March, piece: Vector, every: int, sample: int, states: Vector) -> None:
        """Take the steps between the rows of `piece`; the first sample they end at is `sample`."""
        march(
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
        march: March,
        plates: Vector | LongPlates,
        every: int,
        readout: Readout,
        table: Vector,
        watch: ValidityWatch,
    ) -> Iterator[tuple[slice, Vector, Vector]]:
        """Fill the table of outputs, (outputs, samples), and block by block the arrays of the dampers.

        Yields:
            Samples for which these arrays hold both steps that they lie between, from the last one of the block before
            on; (z, z') of the plates there; nonlinear damper forces there [N], (block, d).
        """
        samples = table.shape[1]
        self.velocities, self.before, self.after = np.zeros((3, BLOCK + 1, len(self.laws)))
        kept = np.zeros((BLOCK + 1, len(self.control.dampers), 4))
        self.control = self.control._replace(kept=kept)
        states = np.zeros((BLOCK, len(self.state())))
        for done in range(1, samples, BLOCK):
            size = min(BLOCK, samples - done)
            first, here = (done - 1) * every, slice(1, size + 1)
            piece = plates[first : first + size * every + 1]
            self.advance(march, piece, every, 1, states)
            ends, force = piece[every::every], self.before[here, : self.count]
            table[:, done : done + size] = readout.at(states[:size], ends, force)
            watch.look(states[:size], ends, force)
            if done == 1:
                kept[0, :, COEFFICIENT] = kept[0, :, COEFFICIENT + 1]
            yield slice(done - 1, done - 1 + size), piece[:-1:every], self.friction(size)
            for array in (self.velocities, self.before, self.after, kept):
                array[0] = array[size]

    def friction(self, samples: int) -> Vector:
        """Nonlinear damper forces at the first samples of a block [N]; (samples, d).

        The force of a step belongs to its middle: at a sample it is the mean of the steps on both sides.
        """
        return 0.5 * (self.before + self.after)[:samples, : self.count]

    def wheel_channels(self, model: PoleModel, plates: Vector) -> dict[str, Vector]:
        """Plate displacements, damper velocities and damper forces at the first samples of a block."""
        found = {}
        for column, wheel in enumerate(self.corners):
            driven = wheel in self.wheels
            height = plates[:, 2 * self.wheels.index(wheel)] if driven else np.zeros(len(plates))
            velocity = self.velocities[: len(plates), column]
            friction = self.friction(len(plates))[:, column]
            found[f"plate_{wheel}_displacement"] = height
            found[f"damper_{wheel}_velocity"] = velocity
            viscous: Vector | float = model.matrices.viscous[column]
            if column in self.control.dampers:
                kept = self.control.kept[: len(plates), list(self.control.dampers).index(column)]
                viscous = 0.5 * (kept[:, COEFFICIENT] + kept[:, COEFFICIENT + 1])
                friction = friction - 0.5 * (kept[:, FORCE] + kept[:, FORCE + 1])
                found[f"damper_{wheel}_coefficient"] = viscous
            found[f"damper_{wheel}_force"] = viscous * velocity - friction + self.rest[column]
        return found


def _curves(dampers: Sequence[Damper], gains: Vector) -> Vector:
    """Pieces of the curves without D v and F(0), as the march takes them; (w, 4, pieces), idle ones behind the last."""
    found = np.zeros((len(gains), 4, max(len(damper_curve(damper).slopes) for damper in dampers)))
    found[:, 0], found[:, 3] = np.inf, 1.0
    for own, damper, gain in zip(found, dampers, gains, strict=False):
        curve = damper_curve(damper)
        count, excess = len(curve.slopes), curve.slopes - curve.least_slope
        own[0, : count - 1] = curve.knots
        own[1, :count], own[2, :count] = excess, curve.offsets - curve.force(0.0)
        own[3, :count] = 1.0 / (1.0 + gain * excess)
    return found
