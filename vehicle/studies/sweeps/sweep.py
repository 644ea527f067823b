"""A table of runs over any executor: kept as they finish, taken up again after an interruption."""

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
from vehicle.studies.sweeps.crew import Crew
from vehicle.studies.sweeps.differences import DIFFERENCES, differences_text
from vehicle.studies.sweeps.executors import process_pool
from vehicle.studies.sweeps.measure import ComfortMeasure, Measure
from vehicle.studies.sweeps.program import class_source, libraries, program_digest
from vehicle.studies.sweeps.result import Result
from vehicle.studies.sweeps.store import ROWS, Store
from vehicle.studies.sweeps.table import SweepTable

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
    """Carry out runs and tabulate what is measured of them.

    A run that fails is a row with its reason. Workers take tasks of many runs, about a second of work; one that dies
    takes no finished row with it: the executor is made again, the tasks in hand are repeated one at a time, the runs of
    the task that kills its worker again one by one, and the run that does is a failed row. With a folder, rows are on
    the disk as their tasks finish, and rows found there are not computed again while car, input, measure and program
    are the same. The table depends neither on the number of workers nor on the sizes of the tasks, to the last digit.

    Args:
        cases: the runs.
        measure: turns a run into numbers; comfort and slip shares by default.
        executor: makes the executor, as of `executor_factory`; or an executor itself, which stays open and cannot be
            made again if it breaks; processes on this machine by default.
        jobs: number of processes where no executor is given.
        folder: an existing folder for the rows; None keeps them in memory only.
        retry_failed: compute rows again that failed before.
        progress: called with the finished fraction of the runs that are computed here.

    Returns:
        The table, in the order of the cases.

    Raises:
        ConfigurationError, DataError: an input or a vehicle file cannot be read, or another process writes there.
        OutputError: a row cannot be written.
        SimulationError: the executor is lost and cannot be made again; finished rows are kept.
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
                Crew(executor or partial(process_pool, jobs), chosen).work(todo, keep)
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
    """A digest for each case of all that its numbers depend on: car, input, engine, measure and program."""
    made = [program_digest(), repr(measure), class_source(measure)]
    # Thousands of cases share a few inputs and cars; reading each of them once per case would take half a minute.
    sources = {id(case.source): case.source for case in cases}
    inputs = {key: digest(source.identity()) for key, source in sources.items()}
    cars = {vehicle: _car_digest(vehicle) for vehicle in dict.fromkeys(case.vehicle for case in cases)}
    return [
        digest([*made, cars[case.vehicle], inputs[id(case.source)], case.engine, case.shared, case.overrides])
        for case in cases
    ]


def _car_digest(vehicle: Path | None) -> str:
    """Digest of a vehicle file and of the superelements and templates it may name."""
    file = FOCUS_FILE if vehicle is None else vehicle
    load_vehicle(file)  # a bad file is refused here, in the words that it always is
    content = hashlib.sha256(file.read_bytes())
    for folder in dict.fromkeys([file.parent, file.parent / "templates", PACKAGE_FOLDER, TEMPLATES]):
        for path in sorted(folder.glob("*.toml")):
            content.update(path.name.encode() + path.read_bytes())
    return content.hexdigest()[:20]


def _made(cases: Sequence[Case], measure: Measure) -> dict[str, Any]:
    """What `sweep.json` says."""
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
