"""A table of runs over any executor: kept as they finish, taken up again after an interruption."""

from __future__ import annotations

import hashlib
import time as clock
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

from vehicle.errors import SimulationError, VehicleError
from vehicle.flexbody.library import PACKAGE_FOLDER
from vehicle.output.folder import folder_lock
from vehicle.parameters.shipped import FOCUS_FILE
from vehicle.parameters.template import SHIPPED as TEMPLATES
from vehicle.parameters.vehicle import load_vehicle
from vehicle.sweeps.case import Case, digest
from vehicle.sweeps.executors import process_pool, workers_of
from vehicle.sweeps.measure import ComfortMeasure, Measure
from vehicle.sweeps.program import class_source, libraries, program_digest
from vehicle.sweeps.store import ROWS, Store
from vehicle.sweeps.table import SweepTable
from vehicle.sweeps.worker import Result, carry_out

Progress = Callable[[float], None]

PER_WORKER = 4
"""Cases in the hands of an executor for each of its workers: enough that none waits for the next, few enough that ten
thousand do not fill the memory, and that few must be repeated when a worker dies."""
UNTOLD = 64
"""The same in all, where an executor does not tell how many workers it has."""

DIED = "the worker died in this run, twice (killed, or out of memory)"


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

    A run that fails is a row with its reason. A worker that dies takes no finished row with it: the executor is made
    again, the runs it held are repeated one at a time, and the one that kills its worker again is a failed row. With a
    folder, rows are on the disk as they finish, and rows found there are not computed again while car, input, measure
    and program are the same. The table does not depend on the number of workers.

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

        def keep(key: str, result: Result) -> None:
            finished[key] = result
            if store is not None:
                store.add(key, todo[key].label, result)
            done.add(key)
            if progress is not None:
                progress(len(done) / len(todo))

        done: set[str] = set()
        try:
            if todo:
                _Crew(executor or partial(process_pool, jobs), chosen).work(todo, keep)
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
            table.write(folder)
            _say_how_long(folder, clock.perf_counter() - began, len(todo))
        return table


def case_keys(cases: Sequence[Case], measure: Measure) -> list[str]:
    """A digest for each case of all that its numbers depend on: car, input, engine, measure and program."""
    made = [program_digest(), repr(measure), class_source(measure)]
    # Thousands of cases share a few inputs and cars; reading each of them once per case would take half a minute.
    sources = {id(case.source): case.source for case in cases}
    inputs = {key: digest(source.identity()) for key, source in sources.items()}
    cars = {vehicle: _car_digest(vehicle) for vehicle in dict.fromkeys(case.vehicle for case in cases)}
    return [digest([*made, cars[case.vehicle], inputs[id(case.source)], case.engine, case.overrides]) for case in cases]


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
        "measure": repr(measure),
        "program": program_digest(),
        "libraries": libraries(),
    }


def _say_how_long(folder: Path, seconds: float, runs: int) -> None:
    with (folder / "timing.csv").open("a", encoding="utf-8") as file:
        file.write(f"# {runs} runs computed in {seconds:.2f} s\n")


class _Crew:
    """Hands cases to an executor and survives the death of its workers."""

    def __init__(self, given: Executor | Callable[[], Executor], measure: Measure) -> None:
        self.make = None if isinstance(given, Executor) else given
        self.executor = given if isinstance(given, Executor) else given()
        self.measure, self.program = measure, program_digest()

    def work(self, todo: dict[str, Case], keep: Callable[[str, Result], None]) -> None:
        """Carry out all cases; `keep` is called for each as it finishes."""
        waiting = deque(todo)
        suspects: deque[str] = deque()
        try:
            while waiting or suspects:
                if suspects:
                    # Alone, so that only the run that kills its worker is blamed.
                    key = suspects.popleft()
                    if self._round(deque([key]), todo, keep):
                        keep(key, Result(reason=DIED))
                else:
                    suspects.extend(self._round(waiting, todo, keep))
        except CancelledError:
            raise SimulationError(
                "the executor gave up its runs (a Dask scheduler that is gone?); finished rows are kept, "
                "--resume goes on"
            ) from None
        finally:
            if self.make is not None:
                _close(self.executor)

    def _round(self, waiting: deque[str], todo: dict[str, Case], keep: Callable[[str, Result], None]) -> list[str]:
        """Work until nothing waits or a worker dies; returns the cases that were in hand then."""
        flying: dict[Future[Result], str] = {}
        lost: list[str] = []
        workers = workers_of(self.executor)
        at_once = UNTOLD if workers is None else PER_WORKER * workers
        while waiting or flying:
            while waiting and len(flying) < at_once and not lost:
                key = waiting.popleft()
                try:
                    flying[self.executor.submit(carry_out, todo[key], self.measure, self.program)] = key
                except BrokenExecutor:
                    lost.append(key)
            if not flying:
                break
            for future in wait(flying, return_when=FIRST_COMPLETED).done:
                key = flying.pop(future)
                error = future.exception()
                if error is None:
                    keep(key, future.result())
                elif isinstance(error, BrokenExecutor):
                    lost.append(key)
                elif isinstance(error, VehicleError):
                    raise error  # about the worker itself: those of a run are rows
                else:
                    keep(key, Result(reason=f"{type(error).__name__}: {error}"))
        if lost:
            if self.make is None:
                raise SimulationError(
                    "a worker of the given executor died; finished rows are kept. Give a function that makes the "
                    "executor instead: it is then made again, and the sweep goes on"
                )
            _close(self.executor)
            self.executor = self.make()
        return lost


def _close(executor: Executor) -> None:
    """End an executor without waiting for what nobody wants any more; a Dask client goes with its own."""
    client = getattr(executor, "_client", None)
    if client is None:
        executor.shutdown(wait=True, cancel_futures=True)
    else:
        executor.shutdown(wait=False)
        client.close()
