"""Sweep: run cases on any executor, store finished rows, and continue after an interruption."""

from __future__ import annotations

import hashlib
import time as clock
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

from vehicle.model.flexbody.body_model import PACKAGE_FOLDER
from vehicle.model.parameters.driving import tyre_words
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.template import SHIPPED as TEMPLATES
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.output.folder import folder_lock, write_text
from vehicle.studies.sweeps.case import Case, digest, drivings
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.differences import DIFFERENCES, differences_text
from vehicle.studies.sweeps.dispatcher import Dispatcher
from vehicle.studies.sweeps.executors import process_pool
from vehicle.studies.sweeps.measure import ComfortMeasure, Measure
from vehicle.studies.sweeps.program import class_source, libraries, program_digest
from vehicle.studies.sweeps.store import ROWS, Store
from vehicle.studies.sweeps.sweep_table import SweepTable

Progress = Callable[[float], None]


def sweep(
    cases: Sequence[Case],
    measure: Measure | None = None,
    *,
    executor: Executor | Callable[[], Executor] | None = None,
    jobs: int = 1,
    folder: Path | None = None,
    retry_failed: bool = False,
    progress: Progress | None = None,
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
        progress: called with the finished fraction of the runs computed by this call.

    Returns:
        The table, in the order of the cases.

    Raises:
        ConfigurationError, DataError: an input or vehicle file cannot be read, or another process uses the folder.
        OutputError: a row cannot be written.
        SimulationError: the executor broke and cannot be created again; finished rows are stored.
    """
    chosen = ComfortMeasure() if measure is None else measure
    keys = case_keys(cases, chosen)
    with ExitStack() as held:
        if folder is not None:
            held.enter_context(folder_lock(folder.resolve()))
        store = Store(folder / ROWS) if folder is not None else None
        finished: dict[str, Result] = {} if store is None else dict(store.finished)
        todo = {
            key: case
            for key, case in zip(keys, cases, strict=True)
            if key not in finished or (retry_failed and finished[key].reason)
        }
        began = clock.perf_counter()

        def keep(keys: Sequence[str], results: Sequence[Result]) -> None:
            finished.update(zip(keys, results, strict=True))
            if store is not None:
                store.add({key: (todo[key].label, finished[key]) for key in keys})
            for key in keys:
                done.add(key)
                if progress is not None:
                    progress(len(done) / len(todo))

        done: set[str] = set()
        try:
            if todo:
                Dispatcher(executor or partial(process_pool, jobs), chosen).work(todo, keep)
        finally:
            if store is not None:
                store.close()
        table = SweepTable(
            cases=list(cases),
            results=[finished[key] for key in keys],
            units=chosen.units,
            made=_made(cases, chosen),
        )
        if folder is not None:
            table.write(folder, f"{len(todo)} runs computed in {clock.perf_counter() - began:.2f} s")
            if text := differences_text(table):
                write_text(folder / DIFFERENCES, text)
        return table


def case_keys(cases: Sequence[Case], measure: Measure) -> list[str]:
    """Return a digest for each case of all data that its values depend on: car, input, engine, measure and program."""
    common = [program_digest(), repr(measure), class_source(measure)]
    # Thousands of cases share a few inputs and cars; reading them for every case would take half a minute.
    sources = {id(case.source): case.source for case in cases}
    inputs = {key: digest(source.identity()) for key, source in sources.items()}
    cars = {vehicle: _car_digest(vehicle) for vehicle in dict.fromkeys(case.vehicle for case in cases)}
    return [
        digest([*common, cars[case.vehicle], inputs[id(case.source)], case.engine, case.shared, case.overrides])
        for case in cases
    ]


def _car_digest(vehicle: Path | None) -> str:
    """Return a digest of a vehicle file and of all superelements and templates that it may refer to."""
    file = FOCUS_FILE if vehicle is None else vehicle
    load_vehicle(file)  # raises the usual error for a bad file
    content = hashlib.sha256(file.read_bytes())
    for folder in dict.fromkeys([file.parent, file.parent / "templates", PACKAGE_FOLDER, TEMPLATES]):
        for path in sorted(folder.glob("*.toml")):
            content.update(path.name.encode() + path.read_bytes())
    return content.hexdigest()[:20]


def _made(cases: Sequence[Case], measure: Measure) -> dict[str, Any]:
    """Return the content of `sweep.json`."""
    sources = {id(case.source): case.source for case in cases}
    return {
        "runs": len(cases),
        "vehicles": sorted({"focus" if case.vehicle is None else case.vehicle.name for case in cases}),
        "engines_asked": sorted({case.engine for case in cases}),
        "inputs": {source.name: source.identity() for source in sources.values()},
        "tyre": {name: tyre_words(cars) for name, cars in drivings(cases).items()},
        "measure": repr(measure),
        "evaluated_from_s": getattr(measure, "skip", None),
        "program": program_digest(),
        "libraries": libraries(),
    }
