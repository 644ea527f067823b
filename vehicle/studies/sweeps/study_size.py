"""Memory and disk that a sweep or a search needs, stated before its first run."""

from collections.abc import Collection
from contextlib import suppress
from pathlib import Path

from vehicle.machine import free_memory
from vehicle.model.parameters.vehicle import Vehicle, load_vehicle
from vehicle.runs.output.run_size import BASE, batch_memory, say_size
from vehicle.studies.sweeps.case import Case, Input, rates_of, signal_of
from vehicle.studies.sweeps.case_evaluation import BATCH_CARS, cars_at_once
from vehicle.studies.sweeps.executors import StandingExecutor
from vehicle.studies.sweeps.measure import BatchMeasure, Measure
from vehicle.studies.sweeps.sweep_settings import PoolSettings

ROW, VALUE = 300.0, 90.0
"""Size of a run in the files of a sweep [byte]: ROW + VALUE for each value of its measure; 1726 measured with 16."""

ROW_OF_CAR, VALUE_OF_CAR = 20.0, 20.0
"""Size of a car in the table of a search [byte]: ROW_OF_CAR + VALUE_OF_CAR for each parameter and criterion."""

CASE = 60.0
"""Memory of a run in the process of the sweep [byte]: 58 measured with a million runs, which stay in the file."""

KEPT_SIGNALS = 8
"""Maximum number of inputs that a process keeps, see `vehicle.studies.sweeps.case.signal_of`."""

SIGNAL = 40.0
"""Memory of a kept input for each of its samples [byte]: time and four plates."""


def state_size(
    each: Collection[Case], runs: int, measure: Measure, settings: PoolSettings, *, cars: int = 0, numbers: int = 0
) -> None:
    """State memory and disk of many runs from 1 GB on, and refuse what does not fit; see
    `vehicle.runs.output.run_size.stated_size`.

    A process has one batch of cars at a time, so its memory depends on the longest input and not on the number of runs:

    memory = busy (`batch_memory` + `SIGNAL` n (inputs - 1)) + (jobs - busy) `BASE` + `CASE` runs

    busy = min(jobs, runs),    disk = size of a row times runs; 0 without a folder

    Workers of a user-defined executor may be on other machines: then only the disk is checked.

    Args:
        each: a case of each input, vehicle, engine and record rate.
        runs: number of runs: of a sweep that are not stored yet, of a search in a generation.
        measure: measure of the runs.
        settings: processes, and folder of the rows.
        cars: number of cars of a search, whose table has a row for each car, instead of one for each run.
        numbers: numbers in a row of this table.

    Raises:
        ConfigurationError: more than the memory of the machine or the free disk, with the settings that fit.
    """
    worker = samples = 0.0
    if settings.executor is None or isinstance(settings.executor, StandingExecutor):
        worker, samples = _worker(each, runs, measure)
    jobs = settings.jobs or 1
    busy = min(jobs, runs)
    memory = busy * worker + (jobs - busy) * BASE + CASE * runs if worker else 0.0
    disk = cars * (ROW_OF_CAR + VALUE_OF_CAR * numbers) if cars else runs * (ROW + VALUE * len(measure.units))
    disk = 0.0 if settings.folder is None else disk
    remedy = "to reduce it, shorten the inputs, or choose a lower solver.record_rate"
    if jobs > 1 and worker:
        fit = max(int((free_memory() - CASE * runs) / worker), 1)
        fewer = f"--jobs {fit}" if fit < busy else "fewer processes (--jobs)"
        remedy = f"to reduce it, use {fewer}, shorten the inputs, or choose a lower solver.record_rate"
    if disk > memory:
        remedy = "to reduce it, vary fewer values, or use fewer inputs"
    subject = f"{runs} runs of up to {samples:.3g} samples on {jobs} processes" if samples else f"{runs} runs"
    say_size(settings.folder or Path(), subject.replace("on 1 processes", "in one process"), memory, disk, remedy)


def _worker(each: Collection[Case], runs: int, measure: Measure) -> tuple[float, float]:
    """Return the largest memory of a process [byte], and the samples of this run."""
    vehicles: dict[tuple[Path | None, tuple[str, ...]], Vehicle] = {}
    durations: dict[Input, float] = {}
    simulated = []
    for case in each:
        # The statement must not end a sweep: an invalid car, and an input of the user that raises, are failed rows.
        with suppress(Exception):
            if case.source not in durations:
                durations[case.source] = duration_of(case.source)
            if (car := (case.vehicle, rates_of(case))) not in vehicles:
                vehicles[car] = load_vehicle(case.vehicle, case.overrides)
            simulated.append((case, vehicles[car], durations[case.source]))
    others = sum(sorted(durations.values())[-KEPT_SIGNALS:-1])
    largest = 0.0, 0.0
    for case, vehicle, duration in simulated:
        rate = vehicle.solver.record_rate
        samples, channels = rate * duration, len(vehicle.channels if measure.channels is None else measure.channels)
        batch = case.engine != "mujoco" and isinstance(measure, BatchMeasure)
        cars = min(cars_at_once(samples, channels), BATCH_CARS, -(-runs // len(each))) if batch else 1
        memory = batch_memory(samples, channels, cars=cars, reduced=case.engine == "reduced") + SIGNAL * rate * others
        largest = max(largest, (memory, samples))
    return largest


def duration_of(source: Input) -> float:
    """Return the length of an input [s]; of a road without making it."""
    return float(getattr(source, "duration", None) or signal_of(source).duration)
