"""Batch of cars on one signal, with longer steps than a single run: eight at once in single precision where possible.

Linear parts are exact at any step, and a stuck damper has third order, so the step only limits the accuracy of the
instants of sticking and slipping. At `COARSE_STEP`, against 0.05 ms in double precision with all poles
(`python -m tests.benchmarks.sweep_step`: three cars with nine variants each, roads A to C of 30 s and both shipped
signals), unweighted comfort is at most 0.049 % off and weighted comfort 0.022 %, nearly the same for all variants
(0.004 % apart); slip shares are within 0.06 points and first slips equal. At 1 ms it is 0.38 % and 0.26 points. Peaks
of damper tops are 1.6 % off and need `vehicle.engines.reduced.reduced_run.LONGEST_STEP`.
"""

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.displacement_laws import STOP
from vehicle.engines.linear.load_rows import LoadRows, stop_rows
from vehicle.engines.reduced.group_run import GroupRun, time_steps
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.reduced.step_factors import SLOWEST, CarFactors, car_factors
from vehicle.engines.reduced.table_layout import LANES, SINGLE
from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.engines.simulation.tyre_variation import with_plates, with_run_out
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import channel_units
from vehicle.signals.excitation.signal import Signal, uniform_time
from vehicle.threads import one_blas_thread

COARSE_STEP = 5e-4
"""Maximum time step [s] for comfort values and slip shares."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BatchRuns:
    """Time histories of a batch of cars on one signal.

    Attributes:
        time: sample times [s]; (n,).
        channels: channel name to time histories (cars, n); see `vehicle.names`.
        units: channel name to unit.
        excited: wheels whose plates were driven.
        statistics: statistics of each car; its computing time is its share of the time of the group.
    """

    time: Vector
    channels: Mapping[str, Vector]
    units: Mapping[str, str]
    excited: tuple[str, ...]
    statistics: tuple[Statistics, ...]

    def __len__(self) -> int:
        """Return the number of cars."""
        return len(self.statistics)

    def recording(self, car: int) -> Recording:
        """Return the recording of one car; its channels are views."""
        return Recording(
            time=self.time,
            channels={name: values[car] for name, values in self.channels.items()},
            units=self.units,
            excited=self.excited,
            pose_time=np.zeros(0),
            poses=np.zeros((0, 0)),
            statistics=self.statistics[car],
        )


@one_blas_thread()
def simulate_batch(
    models: Sequence[PoleModel],
    signal: Signal,
    *,
    dampers: Sequence[Sequence[Damper]],
    record_rate: float,
    tyre_load: Sequence[Mapping[str, float]],
    channels: Sequence[str],
    step: float = COARSE_STEP,
) -> BatchRuns:
    """Simulate a batch of cars of one topology on the same plates with the reduced engine.

    The values of a car are bitwise independent of the other cars. Cars with controlled or strongly coupled dampers
    or a law by address, with a pole near zero, or with a stop that is loaded at rest in a recorded damper force are
    simulated one at a time in double precision: the bits of `simulate_reduced` at the same step.

    Args:
        models: pole models of the cars, with the same wheels, dampers, bodies and channels.
        signal: displacement of the plates.
        dampers: damper laws of each car.
        record_rate: rate of the samples [Hz].
        tyre_load: static tyre loads [N] of each car by wheel.
        channels: names of the recorded channels; load channels are not possible.
        step: maximum time step [s].

    Raises:
        ConfigurationError: the list of cars is empty.
    """
    if not models:
        raise ConfigurationError("simulate_batch: the list of cars is empty")
    excited = tuple(wheel for wheel in signal.wheels if np.ptp(signal.displacement[wheel]) > 0.0)
    signal = with_plates(signal, [wheel for model in models for wheel, _, _ in model.matrices.run_out])
    samples, every = time_steps(signal, record_rate, step)
    interval, wheels = 1.0 / record_rate, models[0].matrices.system.inputs
    damper_names = models[0].matrices.damper_names
    # Stops that are free at rest have the forces g of their laws, which follow the channels.
    stopped = any(law.stop for laws in dampers for law in laws)
    most = max(len(model.laws) for model in models) if stopped else 0
    table = np.empty((len(channels) + most, len(models), samples))
    statistics: dict[int, Statistics] = {}
    factors = _single_precision_factors(
        models, dampers, interval / every, [wheels.index(wheel) for wheel in signal.wheels], channels
    )
    for car in {*range(len(models))} - {*factors}:
        # In double precision one car at a time.
        run = simulate_reduced(
            models[car],
            signal,
            dampers=dampers[car],
            record_rate=record_rate,
            tyre_load=tyre_load[car],
            channels=channels,
            step=step,
        )
        statistics[car] = run.statistics
        table[: len(channels), car] = [run[name] for name in channels]
    # Group cars with similar numbers of poles: the largest number in a group applies to all its cars.
    keys = {car: (_nonlinear_elements(models[car]), factors[car].single_iterations) for car in factors}
    ordered_cars = sorted(factors, key=lambda car: (keys[car], factors[car].pairs, factors[car].reals))
    groups = [
        cars[first : first + LANES]
        for cars in (list(equal) for _, equal in groupby(ordered_cars, lambda car: keys[car]))
        # A vector has eight cars.
        for first in range(0, len(cars), LANES)
    ]
    for cars in groups:
        started = clock.perf_counter()
        group = GroupRun(
            [models[car] for car in cars],
            [factors[car] for car in cars],
            [dampers[car] for car in cars],
            [tyre_load[car] for car in cars],
            with_run_out(signal, models[cars[0]].matrices.run_out),
            interval,
            every,
            SINGLE,
            present_load=models[0].slope.shape[1] > 0,
        )
        laws = models[cars[0]].laws if stopped else ()
        every_name = [*channels, *(f"law_{index}" for index in range(len(laws)))]
        validities = group.fill(table[: len(every_name)], cars, every_name)
        for index, law in enumerate(laws):
            # The recorded force of a damper contains that of its stop.
            name = f"{damper_names[law.element[1]]}_force" if law.element[0] == STOP else ""
            if name in channels:
                table[channels.index(name), cars] += table[len(channels) + index, cars]
        time_of_car = (clock.perf_counter() - started) / len(cars)
        for car, validity in zip(cars, validities, strict=True):
            statistics[car] = group.statistics(validity, samples, time_of_car)
    return BatchRuns(
        time=uniform_time(samples=samples, timestep=interval),
        channels=dict(zip(channels, table[: len(channels)], strict=True)),
        units=channel_units(tuple(channels)),
        excited=excited,
        statistics=tuple(statistics[car] for car in range(len(models))),
    )


def _single_precision_factors(
    models: Sequence[PoleModel],
    dampers: Sequence[Sequence[Damper]],
    timestep: float,
    columns: Sequence[int],
    channels: Sequence[str],
) -> dict[int, CarFactors]:
    """Return the factors of the cars for which single precision is sufficient, by their index."""
    forces = [name.replace("_force", "_stop_force") for name in channels]
    suitable = [
        car
        for car, (model, laws) in enumerate(zip(models, dampers, strict=True))
        if not any(law.controlled or law.function for law in laws)
        and not _loaded(stop_rows(model.matrices, laws).only(forces))
        and np.min(np.abs(model.poles)) >= SLOWEST
    ]
    rolling, by_car = models[0].slope.shape[1] > 0, dict[int, CarFactors]()
    # `groupby` joins neighbours only.
    suitable.sort(key=lambda car: _nonlinear_elements(models[car]))
    for _, equal in groupby(suitable, lambda car: _nonlinear_elements(models[car])):
        cars = list(equal)
        # Cars with equal matrices share their model.
        different = list(dict.fromkeys(models[car] for car in cars))
        factors = car_factors(different, timestep, columns, exact=False, present_load=rolling)
        by_model = {model: factor for model, factor in zip(different, factors, strict=True) if factor.single_iterations}
        by_car |= {car: by_model[models[car]] for car in cars if models[car] in by_model}
    return by_car


def _loaded(stops: LoadRows) -> bool:
    """Return True if a stop has a force or a stiffness at rest, which its law in the reduced engine lacks."""
    return bool(np.any(stops.static) or np.any(stops.displacement))


def _nonlinear_elements(model: PoleModel) -> tuple[object, ...]:
    """Return what is equal in a group: dampers with Jenkins elements or side forces, laws, forces, run-outs."""
    sliders, sides = model.matrices.sliders, model.matrices.sides
    laws = tuple((law.element, law.one_sided, law.friction) for law in model.laws)
    elements = tuple(sliders.dampers.tolist()), sliders.stiffness.shape, tuple(sides.dampers.tolist()), laws
    # The text of the histories: a group is sorted, and histories have no order.
    return *elements, repr(model.matrices.lines), model.matrices.run_out
