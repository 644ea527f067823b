"""Sweep: run cases on any executor, store finished rows, and continue after an interruption."""

import time as clock
from collections.abc import Collection, Sequence
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from vehicle.arrays import Indices
from vehicle.model.parameters.driving import tyre_words
from vehicle.runs.output.locks import folder_lock
from vehicle.settings import with_settings
from vehicle.studies.sweeps.case import Case, drivings, rates_of
from vehicle.studies.sweeps.case_keys import CaseKeys
from vehicle.studies.sweeps.case_result import Block
from vehicle.studies.sweeps.chosen_jobs import chosen_jobs
from vehicle.studies.sweeps.dispatcher import Dispatcher
from vehicle.studies.sweeps.executors import ThisProcess, process_pool
from vehicle.studies.sweeps.function_measure import require_picklable
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import libraries, program_digest
from vehicle.studies.sweeps.store import ROWS, StoredRows
from vehicle.studies.sweeps.study_size import state_size
from vehicle.studies.sweeps.sweep_settings import RunSettings
from vehicle.studies.sweeps.sweep_table import SweepTable
from vehicle.studies.sweeps.table_files import write_table


def sweep_cases(cases: Sequence[Case], measure: Measure, settings: RunSettings) -> SweepTable:
    """Run cases and tabulate their measured values.

    A failed run is a row with an error message. With one job, no executor and no time limit the runs are in this
    process, so that a script needs no guard of its main module. Otherwise workers get tasks of many runs, about a
    second of work. If a worker dies, no finished row is lost: a new executor is created and the submitted tasks are
    repeated one at a time. The runs of a task that kills its worker again are repeated one at a time, and the run that
    kills its worker is a failed row. With a folder, rows are stored as their tasks finish, and stored rows are not
    computed again if car, input, measure and program are equal. The table is bitwise independent of the number of
    workers and the sizes of the tasks.

    The time limit of a run includes its car and, for the first run of a worker, imports and compilation; the worker of
    a run that takes longer is ended.

    Returns:
        The table, in the order of the cases.

    Raises:
        ConfigurationError, DataError: an input or vehicle file cannot be read, another process uses the folder, or the
            runs do not fit into memory or disk, see `state_size`.
        OutputError: a row cannot be written.
        SimulationError: the executor broke and cannot be created again; finished rows are stored.
    """
    folder, progress = settings.folder, settings.progress
    key_of, each = CaseKeys(measure), _one_of_each(cases)
    # A run in this process cannot be stopped.
    if not settings.executor and (settings.time_limit is not None or settings.jobs not in (1, None)):
        require_picklable(measure)
    for case in each:
        key_of(case)  # raises the error of an input or a vehicle file before the first run
    with ExitStack() as held:
        if folder is not None:
            held.enter_context(folder_lock(folder.resolve()))
        rows = StoredRows(folder / ROWS if folder is not None else None, len(cases))
        rows.use_stored(cases, key_of)
        todo = np.flatnonzero(~rows.stored | rows.failed if settings.retry_failed else ~rows.stored)
        began, done = clock.perf_counter(), len(cases) - len(todo)

        def keep(numbers: Indices, block: Block) -> None:
            nonlocal done
            rows.append(numbers, block)
            done += len(numbers)
            if progress is not None:
                progress(done / len(cases))

        if len(todo):
            jobs, text = (settings.jobs, "") if settings.jobs else chosen_jobs(each, len(todo), measure)
            settings = replace(settings, jobs=jobs)
            if text and settings.notice is not None and not settings.executor:
                settings.notice(text)
            apart = jobs > 1 or settings.time_limit is not None
            state_size(each, len(todo), measure, settings)
            if progress is not None:
                progress(done / len(cases))
            dispatcher = Dispatcher(
                settings.executor or (partial(process_pool, jobs) if apart else ThisProcess),
                measure,
                key_of=key_of,
                time_limit=settings.time_limit,
                notice=settings.notice,
            )
            dispatcher.work(cases, keep, todo)
            rows.synchronise()
        # A function of the user's own states no units: its names are those of the first finished run.
        finished = next((each.values for each in rows if each.values), {}) if not measure.units else {}
        units = measure.units or dict.fromkeys(finished, "?")
        table = SweepTable(cases=cases, results=rows, units=units, made=_made(cases, each, measure))
        if folder is not None:
            write_table(table, folder, f"{len(todo)} runs computed in {clock.perf_counter() - began:.2f} s")
        return table


sweep = with_settings(RunSettings)(sweep_cases)
"""`sweep_cases` with its settings as arguments."""


def _one_of_each(cases: Sequence[Case]) -> Collection[Case]:
    """Return a case for each input, vehicle file, engine and record rate."""
    return {(id(case.source), case.vehicle, case.engine, rates_of(case)): case for case in cases}.values()


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
