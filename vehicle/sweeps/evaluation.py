"""Results of many cases in this process."""

from __future__ import annotations

import math
import threading
import time as clock
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from vehicle.car import Car, Run
from vehicle.errors import SimulationError, VehicleError
from vehicle.sweeps.case import Case, signal_of
from vehicle.sweeps.measure import Measure
from vehicle.sweeps.result import Result

_ONE_AT_A_TIME = threading.Lock()
"""MuJoCo's callbacks belong to the whole process, and an executor of threads may be given."""

OF_A_RUN = (VehicleError, ArithmeticError, ValueError, MemoryError)
"""Errors that are about a run, and become its reason."""


def evaluate(cases: Sequence[Case], measure: Measure) -> list[Result]:
    """Carry out cases and measure them.

    Args:
        cases: the runs.
        measure: turns them into numbers.

    Returns:
        Results in the order of the cases; a run that fails has its reason instead of numbers. The numbers of a case do
        not depend on the others, to the last digit.
    """
    return [_alone(case, measure) for case in cases]


# A study asks the same car about several roads in a row; building one costs as much as half a minute on the road.
@lru_cache(maxsize=4)
def _car(vehicle: Path | None, overrides: tuple[str, ...], changed: int) -> Car:
    return Car.load(vehicle, overrides)


def _changed(vehicle: Path | None) -> int:
    """When a vehicle file was changed last [ns]."""
    return 0 if vehicle is None or not vehicle.exists() else vehicle.stat().st_mtime_ns


def run_of(case: Case, channels: Sequence[str] | None = None) -> Run:
    """Carry out the run of a case; channels as of `Car.run`."""
    car = _car(case.vehicle, case.overrides, _changed(case.vehicle))
    return car.run(signal_of(case.source), engine=case.engine, channels=channels)


def _alone(case: Case, measure: Measure) -> Result:
    """Result of a run by itself."""
    started = clock.perf_counter()
    try:
        with _ONE_AT_A_TIME:
            run = run_of(case, measure.channels)
        values = checked({name: float(value) for name, value in measure(run).items()})
    except OF_A_RUN as error:
        return Result(reason=f"{type(error).__name__}: {error}", seconds=clock.perf_counter() - started)
    return Result(values=values, engine=run.recording.statistics.engine, seconds=clock.perf_counter() - started)


def checked(values: dict[str, float]) -> dict[str, float]:
    """The numbers of a run, none of them infinite."""
    # NaN is a number that does not exist, as the first slip of a damper that never slips.
    endless = [name for name, value in values.items() if math.isinf(value)]
    if endless:
        raise SimulationError(f"{', '.join(endless)}: infinite; the run left the range of numbers")
    return values
