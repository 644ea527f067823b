"""Sweep: run cases on any executor, store finished rows, and continue after an interruption."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Collection, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.model.parameters.driving import tyre_words
from vehicle.runs.output.locks import folder_lock
from vehicle.studies.sweeps.case import Case, drivings
from vehicle.studies.sweeps.case_keys import CaseKeys
from vehicle.studies.sweeps.case_result import Block
from vehicle.studies.sweeps.dispatcher import Dispatcher, Notice
from vehicle.studies.sweeps.executors import process_pool
from vehicle.studies.sweeps.measure import ComfortMeasure, Measure
from vehicle.studies.sweeps.program import libraries, program_digest
from vehicle.studies.sweeps.store import ROWS, Indices, StoredRows
from vehicle.studies.sweeps.sweep_table import SweepTable
from vehicle.studies.sweeps.table_files import write_table

Progress = Callable[[float], None]


def sweep(
    cases: Sequence[Case],
    measure: Measure | None = None,
    *,
    executor: Executor | Callable[[], Executor] | None = None,
    jobs: int = 1,
    folder: Path | None = None,
    retry_failed: bool = False,
    time_limit: float | None = None,
    progress: Progress | None = None,
    notice: Notice | None = None,
) -> SweepTable:
    """Run cases and tabulate their measured values.

    A failed run is a row with an error message. Workers get tasks of many runs, about a second of work. If a worker
    dies, no finished row is lost: a new executor is created and the submitted tasks are repeated one at a time. The
    runs of a task that kills its worker again are repeated one at a time, and the run that kills its worker is a failed
    row. With a folder, rows are stored as their tasks finish, and stored rows are not computed again if car, input,
    measure and program are equal. The table is bitwise independent of the number of workers and the sizes of the tasks.

    Args:
        cases: the runs.
        measure: measure of each run; by default comfort and slip shares.
        executor: function that returns an executor, see `executor_factory`; or an executor, which stays open and is not
            replaced if it breaks; by default processes on this machine.
        jobs: number of processes without `executor`.
        folder: existing folder for the rows; None stores no rows.
        retry_failed: compute failed rows again.
        time_limit: maximum computing time of a run [s], including its car and, for the first run of a worker, imports
            and compilation; the worker of a run that takes longer is ended, and the run is a failed row. None for no
            limit.
        progress: called with the finished fraction of all runs, stored rows among them.
        notice: called with messages while the sweep is running, as that a cluster has no workers.

    Returns:
        The table, in the order of the cases.

    Raises:
        ConfigurationError, DataError: an input or vehicle file cannot be read, or another process uses the folder.
        OutputError: a row cannot be written.
        SimulationError: the executor broke and cannot be created again; finished rows are stored.
    """
    chosen = ComfortMeasure() if measure is None else measure
    key_of, each = CaseKeys(chosen), _one_of_each(cases)
    for case in each:
        key_of(case)  # raises the error of an input or a vehicle file before the first run
    with ExitStack() as held:
        if folder is not None:
            held.enter_context(folder_lock(folder.resolve()))
        rows = StoredRows(folder / ROWS if folder is not None else None, len(cases))
        rows.use_stored(cases, key_of)
        todo = np.flatnonzero(~rows.stored | rows.failed if retry_failed else ~rows.stored)
        began, done = clock.perf_counter(), len(cases) - len(todo)

        def keep(numbers: Indices, block: Block) -> None:
            nonlocal done
            rows.append(numbers, block)
            if progress is not None:
                for _ in numbers:
                    done += 1
                    progress(done / len(cases))

        if len(todo):
            dispatcher = Dispatcher(
                executor or partial(process_pool, jobs), chosen, key_of=key_of, time_limit=time_limit, notice=notice
            )
            dispatcher.work(cases, keep, todo)
            rows.synchronise()
        table = SweepTable(cases=cases, results=rows, units=chosen.units, made=_made(cases, each, chosen))
        if folder is not None:
            write_table(table, folder, f"{len(todo)} runs computed in {clock.perf_counter() - began:.2f} s")
        return table


def _one_of_each(cases: Sequence[Case]) -> Collection[Case]:
    """Return a case for each input, vehicle file and engine."""
    return {(id(case.source), case.vehicle, case.engine): case for case in cases}.values()


def _made(cases: Sequence[Case], each: Collection[Case], measure: Measure) -> dict[str, Any]:
    """Return the content of `sweep.json`."""
    sources = {id(case.source): case.source for case in each}
    return {
        "runs": len(cases),
        "vehicles": sorted({"focus" if case.vehicle is None else case.vehicle.name for case in each}),
        "engines_asked": sorted({case.engine for case in each}),
        "inputs": {source.name: source.identity() for source in sources.values()},
        "tyre": {name: tyre_words(cars) for name, cars in drivings(cases).items()},
        "measure": repr(measure),
        "evaluated_from_s": getattr(measure, "skip", None),
        "program": program_digest(),
        "libraries": libraries(),
    }
