"""Evaluation of the cases of a sweep in this process, in batches where the reduced engine supports it."""

import math
import threading
import time as clock
from collections.abc import Callable, Hashable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import numpy as np

from vehicle.engines.reduced.batch_simulation import COARSE_STEP, BatchRuns, simulate_batch
from vehicle.engines.reduced.table_layout import LANES
from vehicle.engines.reduced.validity import REMEDY
from vehicle.engines.simulation.judgement import require_finite, require_samples
from vehicle.engines.simulation.recording import Recording
from vehicle.errors import SimulationError, VehicleError
from vehicle.model.parameters.force_elements import LIFTS
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car, Run
from vehicle.runs.car.run_twin import damper_channels, signal_period
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.case import Case, signal_of
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.estimate_measure import ESTIMATE, EstimateMeasure
from vehicle.studies.sweeps.function_measure import FunctionMeasure
from vehicle.studies.sweeps.measure import BatchMeasure, ComfortMeasure, Measure, figures_of
from vehicle.threads import one_blas_thread

T = TypeVar("T")
R = TypeVar("R")

BATCH_CARS = 4 * LANES
"""Maximum number of cars in memory."""
ROOM = 2**26
"""Maximum size of the channels in memory [byte]: six channels of 32 cars for about half a minute."""

OF_A_RUN = (VehicleError, ArithmeticError, ValueError, MemoryError)
"""Errors of a single run, stored as the reason of its failure."""

_ONE_AT_A_TIME = threading.Lock()
"""Lock for MuJoCo, whose callbacks belong to the whole process: an executor may use threads."""


@one_blas_thread()
def evaluate(cases: Sequence[Case], measure: Measure) -> list[Result]:
    """Evaluate the cases of a sweep in this process, in batches where the reduced engine supports it.

    Returns:
        Results in the order of the cases; a failed case has an error message instead of values. The values of a case
        are bitwise independent of the other cases.
    """
    if isinstance(measure, EstimateMeasure):
        return [_estimated(case, measure) for case in cases]
    results: dict[int, Result] = {}
    if isinstance(measure, BatchMeasure):
        cars: dict[Hashable, list[int]] = {}
        for number, case in enumerate(cases):
            if case.engine != "mujoco":
                cars.setdefault((case.vehicle, case.shared, case.overrides), []).append(number)
        numbers_by_car = list(cars.values())
        for first in range(0, len(numbers_by_car), BATCH_CARS):
            batch = [number for car in numbers_by_car[first : first + BATCH_CARS] for number in car]
            results |= zip(batch, _batch_results([cases[number] for number in batch], measure), strict=True)
    return [results[number] if number in results else _single(case, measure) for number, case in enumerate(cases)]


def reason_for_mujoco(case: Case, measure: BatchMeasure) -> str | None:
    """Return the reason why "auto" runs a case with MuJoCo, from a run with the reduced engine.

    Returns:
        The first warning of the reduced engine, and the one on a tyre that would lift off; empty in its valid range;
        None if the run fails, whose row then has the error message.
    """
    try:
        car, signal = _car_of(case), signal_of(case.source)
        _require(car.vehicle, signal, measure)
        statistics = _simulated([car], signal, measure.channels, measure.timestep).statistics[0]
    except OF_A_RUN:
        return None
    if statistics.within_validity:
        return ""
    first, *others = (text.removesuffix(REMEDY) for text in statistics.warnings)
    return "; ".join([first, *[text for text in others if LIFTS in text][:1]])


def run_of(case: Case, channels: Sequence[str] | None = None) -> Run:
    """Run a single case; channels as in `Car.run`."""
    # Only "auto" needs the errors, for its choice.
    stated = case.engine == "auto"
    return loaded_car(case).run(signal_of(case.source), engine=case.engine, channels=channels, stated_errors=stated)


def loaded_car(case: Case) -> Car:
    """Return the car of a case, loaded from its vehicle file."""
    changed = _changed(case.vehicle)
    # The variation of a case acts on the car of the study; one variation with the values of both makes the same car.
    overrides = _varied(case.vehicle, changed, case.overrides[: case.shared], case.overrides[case.shared :]).overrides
    return _loaded(case.vehicle, changed, overrides)


# A study runs the same car on several roads in succession; building a car costs as much as half a minute of road.
@lru_cache(maxsize=4)
def _loaded(vehicle: Path | None, changed: int, overrides: tuple[str, ...]) -> Car:
    return Car.load(vehicle, overrides)


# A separate cache, so that cars of single runs do not evict the reference cars, one for each speed.
@lru_cache(maxsize=16)
def _reference(vehicle: Path | None, changed: int, shared: tuple[str, ...]) -> Car:
    return Car.load(vehicle, shared)


@lru_cache(maxsize=4)
def _varied(vehicle: Path | None, changed: int, shared: tuple[str, ...], overrides: tuple[str, ...]) -> Car:
    return _reference(vehicle, changed, shared).with_(overrides)


def _car_of(case: Case) -> Car:
    """Return the car of a case, modified from the reference car of the study and checked for its engine."""
    changed = _changed(case.vehicle)
    with _ONE_AT_A_TIME:
        car = _varied(case.vehicle, changed, case.overrides[: case.shared], case.overrides[case.shared :])
        car.check(case.engine)
    return car


def _changed(vehicle: Path | None) -> int:
    """Return the modification time of a vehicle file [ns]; 0 without a file."""
    return 0 if vehicle is None or not vehicle.exists() else vehicle.stat().st_mtime_ns


def _single(case: Case, measure: Measure, engine: str | None = None) -> Result:
    """Run a single case and return its result; `engine` replaces the engine of the case."""
    started = clock.perf_counter()
    try:
        with _ONE_AT_A_TIME:
            more = _for_twin(measure, loaded_car(case).vehicle, signal_of(case.source))
            names = None if measure.channels is None else (*measure.channels, *more)
            run = run_of(replace(case, engine=engine or case.engine), names)
        with _lock_of(measure):
            values = _checked({name: float(value) for name, value in measure(run).items()})
    except OF_A_RUN as error:
        return _failed(error, started)
    return Result(values=values, engine=run.recording.statistics.engine, seconds=clock.perf_counter() - started)


def _for_twin(measure: Measure, vehicle: Vehicle, signal: Signal) -> tuple[str, ...]:
    """Return the further channels of a run for the error by its twin; none without this error."""
    names, errors = measure.channels, getattr(measure, "errors", True)
    if not names or not errors or signal_period(signal) is None:
        return ()
    return tuple(name for name in damper_channels(vehicle) if name not in names)


def _estimated(case: Case, measure: EstimateMeasure) -> Result:
    """Estimate a single case without a run."""
    started = clock.perf_counter()
    try:
        with _ONE_AT_A_TIME:
            shared, changes = case.overrides[: case.shared], case.overrides[case.shared :]
            # Roads of one speed take the same car one after the other.
            car = _varied(case.vehicle, _changed(case.vehicle), shared, changes)
            values = _checked(measure.of_car(car, case.source))
    except OF_A_RUN as error:
        return _failed(error, started)
    return Result(values=values, engine=ESTIMATE, seconds=clock.perf_counter() - started)


def _lock_of(measure: Measure) -> AbstractContextManager[object]:
    """Return the lock of MuJoCo for a measure that may build a model: functions, and figures of the car itself."""
    figures = () if isinstance(measure, FunctionMeasure) else figures_of(measure)
    free = isinstance(measure, ComfortMeasure) or (figures and not any(each.figure.exact for each in figures))
    return nullcontext() if free else _ONE_AT_A_TIME


def _batch_results(cases: Sequence[Case], measure: BatchMeasure) -> list[Result]:
    """Run a batch with the reduced engine; rerun cases outside its valid range with MuJoCo if the case allows it."""
    started = clock.perf_counter()
    finished: dict[int, Result | None] = {}
    cars: dict[int, Car] = {}
    groups: dict[tuple[tuple[str, ...], *tuple[Hashable, ...]], list[int]] = {}
    for number, case in enumerate(cases):
        try:
            cars[number], signal = _car_of(case), signal_of(case.source)
            _require(cars[number].vehicle, signal, measure)
            more = _for_twin(measure, cars[number].vehicle, signal)
        except OF_A_RUN as error:
            finished[number] = _failed(error)
            continue
        groups.setdefault((more, case.source, case.engine, batch_key(cars[number])), []).append(number)
    for (more, *_), group in groups.items():
        case, rate = cases[group[0]], cars[group[0]].vehicle.solver.record_rate
        signal = signal_of(case.source)
        size = cars_at_once(signal.duration * rate, len((*measure.channels, *more)))
        for first in range(0, len(group), size):
            batch = group[first : first + size]
            accept = case.engine == "reduced"
            runs = measured_batch([cars[number] for number in batch], signal, measure, accept_invalid=accept)
            finished |= zip(batch, runs, strict=True)
    seconds = (clock.perf_counter() - started) / len(cases)
    results = [finished[number] or _single(case, measure, "mujoco") for number, case in enumerate(cases)]
    return [replace(result, seconds=result.seconds + seconds) for result in results]


def cars_at_once(samples: float, channels: int) -> int:
    """Return the number of cars whose channels fit into `ROOM`, at least one; from `LANES` on in full vectors.

    Figures of the car alone, for example a natural frequency, read no channel.
    """
    size = int(max(ROOM / (8.0 * max(channels, 1) * (samples + 1.0)), 1.0))
    return size - (size % LANES if size > LANES else 0)


def _require(vehicle: Vehicle, signal: Signal, measure: BatchMeasure) -> None:
    """Check channels, wheels and number of samples, as `Car.run` does."""
    vehicle.require_channels(measure.channels, vehicle.channels)
    vehicle.require_wheels(signal.wheels)
    require_samples(signal.duration * vehicle.solver.record_rate, len(measure.channels))


def batch_key(car: Car) -> Hashable:
    """Return the key shared by all cars of a batch: channel and element names, sample rate, rolling or standing."""
    vehicle = car.vehicle
    dampers = tuple(damper.name for damper in vehicle.composition.dampers)
    bodies, rolling = tuple(car.matrices.body_rows), vehicle.driving.rolling
    return vehicle.wheels, dampers, vehicle.channels, bodies, vehicle.solver.record_rate, rolling


def measured_batch(
    cars: Sequence[Car], signal: Signal, measure: BatchMeasure, *, accept_invalid: bool
) -> list[Result | None]:
    """Simulate a batch of cars on a signal with the reduced engine and return the result of each car.

    Args:
        cars: cars with equal `batch_key`.
        signal: plate signals of all cars.
        measure: measure of all runs.
        accept_invalid: keep runs outside the valid range of the reduced engine; otherwise their result is None.
    """
    try:
        names = (*measure.channels, *_for_twin(measure, cars[0].vehicle, signal))
        simulated = _simulated(cars, signal, names, measure.timestep)
    except OF_A_RUN as error:
        return _retry_each(
            cars, error, lambda car: measured_batch([car], signal, measure, accept_invalid=accept_invalid)[0]
        )
    results: list[Result | None] = [None] * len(cars)
    good = []
    for row, statistics in enumerate(simulated.statistics):
        if accept_invalid or statistics.within_validity:
            try:
                require_finite(simulated.recording(row))
                good.append(row)
            except SimulationError as error:
                results[row] = _failed(error)
    if good:
        for row, result in zip(good, _measured(cars, simulated, good, measure, signal), strict=True):
            results[row] = result
    return results


def _measured(
    cars: Sequence[Car], simulated: BatchRuns, rows: list[int], measure: BatchMeasure, signal: Signal
) -> list[Result]:
    """Return the values of selected rows of a simulated batch on a signal."""
    whole = len(rows) == len(cars)
    runs = Runs(
        time=simulated.time,
        channels={name: table if whole else table[rows] for name, table in simulated.channels.items()},
        vehicles=tuple(cars[row].vehicle for row in rows),
        tyre_load={
            wheel: np.array([cars[row].static.tyre_load[wheel] for row in rows]) for wheel in cars[0].vehicle.wheels
        },
        random=signal.random,
        left_obstacle=signal.left_obstacle,
        cars=tuple(cars[row] for row in rows),
        period=signal_period(signal),
    )
    try:
        with _lock_of(measure):
            columns = measure.of(runs)
    except OF_A_RUN as error:
        return _retry_each(rows, error, lambda row: _measured(cars, simulated, [row], measure, signal)[0])
    results = []
    for index, row in enumerate(rows):
        try:
            values = _checked({name: float(column[index]) for name, column in columns.items()})
            results.append(Result(values=values, engine=simulated.statistics[row].engine))
        except SimulationError as error:
            results.append(_failed(error))
    return results


def _retry_each(items: Sequence[T], error: Exception, retry: Callable[[T], R]) -> list[R | Result]:
    """Retry the items of a failed batch one at a time, so that only the faulty item fails."""
    return [retry(item) for item in items] if len(items) > 1 else [_failed(error)]


def _simulated(cars: Sequence[Car], signal: Signal, channels: Sequence[str], step: float) -> BatchRuns:
    """Simulate a batch of cars on a signal with the reduced engine."""
    return simulate_batch(
        [car.poles for car in cars],
        signal,
        dampers=[[damper.law for damper in car.vehicle.composition.dampers] for car in cars],
        record_rate=cars[0].vehicle.solver.record_rate,
        tyre_load=[car.static.tyre_load for car in cars],
        channels=channels,
        step=step,
    )


def _checked(values: dict[str, float]) -> dict[str, float]:
    """Check that no value of a run is infinite, and return the values."""
    # NaN is an undefined value, for example the first slip of a damper that never slips.
    infinite = [name for name, value in values.items() if math.isinf(value)]
    if infinite:
        raise SimulationError(f"{', '.join(infinite)}: infinite values (overflow); narrow the varied ranges")
    return values


def _failed(error: Exception, started: float | None = None) -> Result:
    """Return the result of a failed run with its error message."""
    seconds = 0.0 if started is None else clock.perf_counter() - started
    return Result(reason=f"{type(error).__name__}: {error}", seconds=seconds)


def recordings_of(cases: Sequence[Case], channels: Sequence[str]) -> list[Recording]:
    """Return time histories of cars on one input, simulated as a batch with the reduced engine as in a sweep.

    Args:
        cases: runs on one input of cars with equal `batch_key`; the engine of a case is ignored.
        channels: names of the recorded channels.
    """
    cars, signal = [_car_of(case) for case in cases], signal_of(cases[0].source)
    simulated = _simulated(cars, signal, channels, COARSE_STEP)
    for row in range(len(simulated)):
        require_finite(simulated.recording(row))
    return [simulated.recording(row) for row in range(len(simulated))]
