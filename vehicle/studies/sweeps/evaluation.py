"""Results of many cases in this process: cars are varied from one, and marched side by side where the engine allows."""

from __future__ import annotations

import math
import threading
import time as clock
from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import numpy as np

from vehicle.engines.reduced.batch_layout import LANES
from vehicle.engines.reduced.batch_simulation import COARSE_STEP, BatchRuns, simulate_batch
from vehicle.engines.reduced.pole_stepping import has_compiler
from vehicle.engines.simulation.judgement import require_finite, require_samples
from vehicle.engines.simulation.recording import Recording
from vehicle.errors import SimulationError, VehicleError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.case import Case, signal_of
from vehicle.studies.sweeps.measure import BatchMeasure, Measure
from vehicle.studies.sweeps.result import Result
from vehicle.studies.sweeps.runs import Runs

T = TypeVar("T")
R = TypeVar("R")

TOGETHER = 4 * LANES
"""Most cars that are in memory at once."""
ROOM = 2**26
"""Most channels that are in memory at once [byte]: of 32 cars about half a minute of six."""

OF_A_RUN = (VehicleError, ArithmeticError, ValueError, MemoryError)
"""Errors that are about a run, and become its reason."""

_ONE_AT_A_TIME = threading.Lock()
"""MuJoCo's callbacks belong to the whole process, and an executor of threads may be given."""


def evaluate(cases: Sequence[Case], measure: Measure) -> list[Result]:
    """Carry out cases and measure them.

    Args:
        cases: the runs; those of one car need not stand together.
        measure: turns them into numbers.

    Returns:
        Results in the order of the cases; a run that fails has its reason instead of numbers. The numbers of a case do
        not depend on the others, to the last digit.
    """
    found: dict[int, Result] = {}
    if isinstance(measure, BatchMeasure) and has_compiler():
        cars: dict[Hashable, list[int]] = {}
        for number, case in enumerate(cases):
            if case.engine != "mujoco":
                cars.setdefault((case.vehicle, case.shared, case.overrides), []).append(number)
        together = list(cars.values())
        for first in range(0, len(together), TOGETHER):
            some = [number for car in together[first : first + TOGETHER] for number in car]
            found |= zip(some, _side_by_side([cases[number] for number in some], measure), strict=True)
    return [found[number] if number in found else _alone(case, measure) for number, case in enumerate(cases)]


def run_of(case: Case, channels: Sequence[str] | None = None) -> Run:
    """Carry out the run of a case by itself; channels as of `Car.run`."""
    car = _loaded(case.vehicle, _changed(case.vehicle), case.overrides)
    return car.run(signal_of(case.source), engine=case.engine, channels=channels)


# A study asks the same car about several roads in a row; building one costs as much as half a minute on the road.
@lru_cache(maxsize=4)
def _loaded(vehicle: Path | None, changed: int, overrides: tuple[str, ...]) -> Car:
    return Car.load(vehicle, overrides)


# Apart from those that are run by themselves, so that these do not push it out.
@lru_cache(maxsize=4)
def _reference(vehicle: Path | None, changed: int, shared: tuple[str, ...]) -> Car:
    return Car.load(vehicle, shared)


@lru_cache(maxsize=4)
def _varied(vehicle: Path | None, changed: int, shared: tuple[str, ...], overrides: tuple[str, ...]) -> Car:
    return _reference(vehicle, changed, shared).varied(overrides)


def _car_of(case: Case) -> Car:
    """The car of a case, varied from the one with what its study shares; checked for the reduced engine."""
    changed = _changed(case.vehicle)
    with _ONE_AT_A_TIME:
        car = _varied(case.vehicle, changed, case.overrides[: case.shared], case.overrides[case.shared :])
        car.check("reduced")
    return car


def _changed(vehicle: Path | None) -> int:
    """When a vehicle file was changed last [ns]."""
    return 0 if vehicle is None or not vehicle.exists() else vehicle.stat().st_mtime_ns


def _alone(case: Case, measure: Measure, engine: str | None = None) -> Result:
    """Result of a run by itself, with another engine than that of the case if one is given."""
    started = clock.perf_counter()
    try:
        with _ONE_AT_A_TIME:
            run = run_of(replace(case, engine=engine or case.engine), measure.channels)
        values = _checked({name: float(value) for name, value in measure(run).items()})
    except OF_A_RUN as error:
        return _failed(error, started)
    return Result(values=values, engine=run.recording.statistics.engine, seconds=clock.perf_counter() - started)


def _side_by_side(cases: Sequence[Case], measure: BatchMeasure) -> list[Result]:
    """Results of runs with the reduced engine, and with MuJoCo of those that leave its validity and may."""
    started = clock.perf_counter()
    found: dict[int, Result | None] = {}
    cars: dict[int, Car] = {}
    groups: dict[Hashable, list[int]] = {}
    for number, case in enumerate(cases):
        try:
            cars[number], signal = _car_of(case), signal_of(case.source)
            _require(cars[number].vehicle, signal, measure)
        except OF_A_RUN as error:
            found[number] = _failed(error)
        else:
            groups.setdefault((case.source, case.engine, kind(cars[number])), []).append(number)
    for group in groups.values():
        case, rate = cases[group[0]], cars[group[0]].vehicle.solver.record_rate
        signal = signal_of(case.source)
        size = int(max(ROOM / (8.0 * len(measure.channels) * (signal.duration * rate + 1.0)), 1.0))
        for first in range(0, len(group), size):
            some = group[first : first + size]
            runs = marched([cars[number] for number in some], signal, measure, beyond=case.engine == "reduced")
            found |= zip(some, runs, strict=True)
    seconds = (clock.perf_counter() - started) / len(cases)
    results = [found[number] or _alone(case, measure, "mujoco") for number, case in enumerate(cases)]
    return [replace(one, seconds=one.seconds + seconds) for one in results]


def _require(vehicle: Vehicle, signal: Signal, measure: BatchMeasure) -> None:
    """Refuse what `Car.run` refuses."""
    vehicle.require_channels(measure.channels, vehicle.channels)
    vehicle.require_wheels(signal.wheels)
    require_samples(signal.duration * vehicle.solver.record_rate, len(measure.channels))


def kind(car: Car) -> Hashable:
    """What cars that are marched together have in common: all names, and the rate of the samples."""
    own = car.vehicle
    dampers = tuple(damper.name for damper in own.composition.dampers)
    return own.wheels, dampers, own.channels, tuple(car.matrices.body_rows), own.solver.record_rate


def marched(cars: Sequence[Car], signal: Signal, measure: BatchMeasure, *, beyond: bool) -> list[Result | None]:
    """Results of cars of one kind on a signal.

    Args:
        cars, signal, measure: as of a run.
        beyond: whether a run beyond the validity of the reduced engine counts; else its result is None.
    """
    try:
        many = _marched(cars, signal, measure.channels, measure.timestep)
    except OF_A_RUN as error:
        return _each(cars, error, lambda car: marched([car], signal, measure, beyond=beyond)[0])
    found: list[Result | None] = [None] * len(cars)
    good = []
    for row, statistics in enumerate(many.statistics):
        if beyond or statistics.within_validity:
            try:
                require_finite(many.recording(row))
                good.append(row)
            except SimulationError as error:
                found[row] = _failed(error)
    if good:
        for row, result in zip(good, _measured(cars, many, good, measure), strict=True):
            found[row] = result
    return found


def _measured(cars: Sequence[Car], many: BatchRuns, rows: list[int], measure: BatchMeasure) -> list[Result]:
    """Numbers of some of many runs."""
    whole = len(rows) == len(cars)
    runs = Runs(
        time=many.time,
        channels={name: table if whole else table[rows] for name, table in many.channels.items()},
        vehicles=tuple(cars[row].vehicle for row in rows),
        tyre_load={
            wheel: np.array([cars[row].static.tyre_load[wheel] for row in rows]) for wheel in cars[0].vehicle.wheels
        },
    )
    try:
        columns = measure.of(runs)
    except OF_A_RUN as error:
        return _each(rows, error, lambda row: _measured(cars, many, [row], measure)[0])
    found = []
    for place, row in enumerate(rows):
        try:
            values = _checked({name: float(column[place]) for name, column in columns.items()})
            found.append(Result(values=values, engine=many.statistics[row].engine))
        except SimulationError as error:
            found.append(_failed(error))
    return found


def _each(items: Sequence[T], error: Exception, one: Callable[[T], R]) -> list[R | Result]:
    """Each of several by itself after an error of all together, so that only what has it fails."""
    return [one(item) for item in items] if len(items) > 1 else [_failed(error)]


def recordings_of(cases: Sequence[Case], channels: Sequence[str]) -> list[Recording]:
    """Time histories of cars of one kind on one input with the reduced engine, marched side by side as in a sweep.

    Args:
        cases: the runs; their engine is not looked at.
        channels: names of the recorded channels.

    Raises:
        VehicleError: as of `Car.run`.
    """
    cars, signal = [_car_of(case) for case in cases], signal_of(cases[0].source)
    many = _marched(cars, signal, channels, COARSE_STEP)
    for row in range(len(many)):
        require_finite(many.recording(row))
    return [many.recording(row) for row in range(len(many))]


def _marched(cars: Sequence[Car], signal: Signal, channels: Sequence[str], step: float) -> BatchRuns:
    """Cars of one kind on a signal."""
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
    """The numbers of a run, none of them infinite."""
    # NaN is a number that does not exist, as the first slip of a damper that never slips.
    endless = [name for name, value in values.items() if math.isinf(value)]
    if endless:
        raise SimulationError(f"{', '.join(endless)}: infinite; the run left the range of numbers")
    return values


def _failed(error: Exception, started: float | None = None) -> Result:
    """The reason of a run that failed."""
    seconds = 0.0 if started is None else clock.perf_counter() - started
    return Result(reason=f"{type(error).__name__}: {error}", seconds=seconds)
