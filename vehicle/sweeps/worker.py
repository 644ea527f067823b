"""What happens in a worker: build the car of a case, run it, measure it; every failure becomes a reason."""

from __future__ import annotations

import math
import threading
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from vehicle.car import Car, Run
from vehicle.errors import SimulationError, VehicleError
from vehicle.sweeps.case import Case, signal_of
from vehicle.sweeps.measure import Measure
from vehicle.sweeps.program import require_same_program


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Numbers of a run, or why there are none.

    Attributes:
        values: name to number; empty where the run failed.
        engine: engine that answered; empty where the run failed.
        reason: why it failed; empty where it did not.
        seconds: computing time, building the car included [s].
    """

    values: dict[str, float] = field(default_factory=dict)
    engine: str = ""
    reason: str = ""
    seconds: float = 0.0


_ONE_AT_A_TIME = threading.Lock()
"""MuJoCo's callbacks belong to the whole process, and an executor of threads may be given."""


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


def carry_out(case: Case, measure: Measure, program: str) -> Result:
    """Carry out one run of a sweep.

    Args:
        case, measure: the run and what is kept of it.
        program: `program_digest` of the process that started the sweep.

    Raises:
        ConfigurationError: this process has another program.
    """
    require_same_program(program)
    started = clock.perf_counter()
    try:
        with _ONE_AT_A_TIME:
            run = run_of(case, measure.channels)
        values = {name: float(value) for name, value in measure(run).items()}
        # NaN is a number that does not exist, as the first slip of a damper that never slips.
        endless = [name for name, value in values.items() if math.isinf(value)]
        if endless:
            raise SimulationError(f"{', '.join(endless)}: infinite; the run left the range of numbers")
    except (VehicleError, ArithmeticError, ValueError, MemoryError) as error:
        return Result(reason=f"{type(error).__name__}: {error}", seconds=clock.perf_counter() - started)
    return Result(values=values, engine=run.recording.statistics.engine, seconds=clock.perf_counter() - started)
