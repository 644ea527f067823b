"""Tasks of many cases in the hands of an executor: how large they are, and what happens when a worker dies."""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait

from vehicle.errors import SimulationError, VehicleError
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.executors import workers_of
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import program_digest
from vehicle.studies.sweeps.worker import carry_out

PER_WORKER = 2
"""Tasks in the hands of an executor for each of its workers, so that none waits for the next."""
UNTOLD = 64
"""The same in all, where an executor does not tell how many workers it has."""

FILL = 8
"""Cars that fill a vector unit: tasks hold multiples of it, each car with all its inputs."""
TASK_S = 1.0
"""Computing time of a task [s]: handing it out costs a thousandth of it, and rows are kept every second."""
LARGEST = 32 * FILL
"""Most cases of a task."""

LOOK_AGAIN_S = 2.0
"""Time after which new workers get work although no task is finished [s]."""

DIED = "the worker died in this run, twice (killed, or out of memory)"

Keep = Callable[[Sequence[str], Sequence[Result]], None]
"""Takes finished rows: their keys and results."""


def in_groups(todo: dict[str, Case]) -> deque[str]:
    """Keys in the order of the work: cases that share a vehicle file and an engine, and of these the same car."""
    places: dict[object, int] = {}
    order = {}
    for key, case in todo.items():
        group = places.setdefault((case.vehicle, case.engine), len(places))
        order[key] = (group, places.setdefault((case.vehicle, case.engine, case.overrides), len(places)))
    return deque(sorted(todo, key=order.__getitem__))


class Dispatcher:
    """Hands cases to an executor and survives the death of its workers.

    Args:
        given: makes the executor, or is one.
        measure: of all cases.
    """

    def __init__(self, given: Executor | Callable[[], Executor], measure: Measure) -> None:
        self.make = None if isinstance(given, Executor) else given
        self.executor = given if isinstance(given, Executor) else given()
        self.measure, self.program = measure, program_digest()
        self.pace: float | None = None

    def work(self, todo: dict[str, Case], keep: Keep) -> None:
        """Carry out all cases; `keep` is called as they finish.

        Raises:
            SimulationError: the executor is lost and cannot be made again.
        """
        waiting = in_groups(todo)
        suspects: deque[list[str]] = deque()
        try:
            while waiting or suspects:
                if suspects:
                    # One task alone, then one run alone, so that only the run that kills its worker is blamed.
                    task = suspects.popleft()
                    if not self._round(deque(task), todo, keep, len(task)):
                        continue
                    if len(task) == 1:
                        keep(task, [Result(reason=DIED)])
                    suspects.extend([key] for key in task if len(task) > 1)
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

    def _round(self, waiting: deque[str], todo: dict[str, Case], keep: Keep, size: int = 0) -> list[list[str]]:
        """Work until nothing waits or a worker dies; returns the tasks that were in hand then.

        Args:
            size: cases of a task; by default as many as their pace asks for.
        """
        flying: dict[Future[list[Result]], list[str]] = {}
        lost: list[list[str]] = []
        while waiting or flying:
            workers = workers_of(self.executor)  # those of a cluster come and go
            at_once = UNTOLD if workers is None else PER_WORKER * workers
            while waiting and len(flying) < at_once and not lost:
                task = self._task(waiting, todo, size, at_once)
                try:
                    flying[self._submit(task, todo)] = task
                except BrokenExecutor:
                    lost.append(task)
            if not flying:
                break
            for future in wait(flying, timeout=LOOK_AGAIN_S, return_when=FIRST_COMPLETED).done:
                task = flying.pop(future)
                error = future.exception()
                if error is None:
                    results = future.result()
                    self.pace = sum(one.seconds for one in results) / len(results)
                    keep(task, results)
                elif isinstance(error, BrokenExecutor):
                    lost.append(task)
                elif isinstance(error, VehicleError):
                    raise error  # about the worker itself: those of a run are rows
                elif len(task) == 1:
                    keep(task, [Result(reason=f"{type(error).__name__}: {error}")])
                else:
                    for key in task:  # one of them: each by itself
                        flying[self._submit([key], todo)] = [key]
        if lost:
            if self.make is None:
                raise SimulationError(
                    "a worker of the given executor died; finished rows are kept. Give a function that makes the "
                    "executor instead: it is then made again, and the sweep goes on"
                )
            _close(self.executor)
            self.executor = self.make()
        return lost

    def _task(self, waiting: deque[str], todo: dict[str, Case], size: int, at_once: int) -> list[str]:
        """Take the cases of a task from those that wait: of one vehicle file and engine, about `TASK_S` of work."""
        first = todo[waiting[0]]
        if not size:
            paced = FILL if self.pace is None else TASK_S / max(self.pace, 1e-9)
            even = len(waiting) / at_once  # so that all workers end together
            size = max(int(min(paced, even, LARGEST)), 1)
            if first.engine != "mujoco" and paced > 2.0:
                inputs = _of_one_car(waiting, todo)
                fill = FILL * inputs
                # One car alone fills nothing; a task of very many inputs would keep its rows too late.
                if inputs < len(waiting) and fill <= LARGEST:
                    size = min(fill * -(-size // fill), LARGEST, -(-PER_WORKER * len(waiting) // at_once))
        task: list[str] = []
        while waiting and len(task) < size:
            case = todo[waiting[0]]
            if (case.vehicle, case.engine) != (first.vehicle, first.engine):
                break
            task.append(waiting.popleft())
        return task

    def _submit(self, task: list[str], todo: dict[str, Case]) -> Future[list[Result]]:
        return self.executor.submit(carry_out, [todo[key] for key in task], self.measure, self.program)


def _of_one_car(waiting: deque[str], todo: dict[str, Case]) -> int:
    """How many of the next cases are about one car."""
    first = todo[waiting[0]].overrides
    return sum(1 for _ in itertools.takewhile(lambda key: todo[key].overrides == first, waiting))


def _close(executor: Executor) -> None:
    """End an executor without waiting for what nobody wants any more; a Dask client goes with its own."""
    client = getattr(executor, "_client", None)
    if client is None:
        executor.shutdown(wait=True, cancel_futures=True)
    else:
        executor.shutdown(wait=False)
        client.close()
