"""Dispatch of cases to an executor in tasks: size of the tasks, and recovery from the death of a worker."""

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
"""Submitted tasks per worker of an executor, so that no worker is idle."""
UNKNOWN_WORKERS = 64
"""Submitted tasks of an executor whose number of workers is unknown."""

FILL = 8
"""Number of cars in a SIMD vector: tasks contain multiples of this number, each car with all its inputs."""
TASK_S = 1.0
"""Target computing time of a task [s]: dispatch costs a thousandth of it, and rows are stored every second."""
LARGEST = 32 * FILL
"""Maximum number of cases of a task."""

LOOK_AGAIN_S = 2.0
"""Interval after which new workers get tasks even if no task has finished [s]."""

DIED = "the worker died in this run, twice (killed, or out of memory)"

Keep = Callable[[Sequence[str], Sequence[Result]], None]
"""Function that stores finished rows: keys and results."""


def in_groups(todo: dict[str, Case]) -> deque[str]:
    """Return the keys sorted by vehicle file and engine, then by car; groups are in the order of first occurrence."""
    positions: dict[object, int] = {}
    order = {}
    for key, case in todo.items():
        group = positions.setdefault((case.vehicle, case.engine), len(positions))
        order[key] = (group, positions.setdefault((case.vehicle, case.engine, case.overrides), len(positions)))
    return deque(sorted(todo, key=order.__getitem__))


class Dispatcher:
    """Dispatches cases to an executor and recovers from the death of workers.

    Args:
        executor: executor, or function that returns an executor.
        measure: measure of all cases.
    """

    def __init__(self, executor: Executor | Callable[[], Executor], measure: Measure) -> None:
        self.make = None if isinstance(executor, Executor) else executor
        self.executor = executor if isinstance(executor, Executor) else executor()
        self.measure, self.program = measure, program_digest()
        self.pace: float | None = None

    def work(self, todo: dict[str, Case], keep: Keep) -> None:
        """Run all cases; `keep` is called with finished rows.

        Raises:
            SimulationError: the executor broke and cannot be created again.
        """
        waiting = in_groups(todo)
        suspects: deque[list[str]] = deque()
        try:
            while waiting or suspects:
                if suspects:
                    # A single task, then single runs, so that only the run that kills its worker fails.
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
                "the executor cancelled its runs (lost Dask scheduler?); finished rows are stored, continue with "
                "--resume"
            ) from None
        finally:
            if self.make is not None:
                _close(self.executor)

    def _round(self, waiting: deque[str], todo: dict[str, Case], keep: Keep, size: int = 0) -> list[list[str]]:
        """Run waiting cases until all are finished or a worker dies.

        Args:
            waiting: keys of the waiting cases; removed as they are submitted.
            todo: key to case.
            keep: called with finished rows.
            size: number of cases of a task; by default from the measured computing time.

        Returns:
            Tasks that were submitted and lost.
        """
        flying: dict[Future[list[Result]], list[str]] = {}
        lost: list[list[str]] = []
        while waiting or flying:
            workers = workers_of(self.executor)  # may change in a cluster
            at_once = UNKNOWN_WORKERS if workers is None else PER_WORKER * workers
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
                    self.pace = sum(result.seconds for result in results) / len(results)
                    keep(task, results)
                elif isinstance(error, BrokenExecutor):
                    lost.append(task)
                elif isinstance(error, VehicleError):
                    raise error  # an error of the worker itself: errors of runs are results
                elif len(task) == 1:
                    keep(task, [Result(reason=f"{type(error).__name__}: {error}")])
                else:
                    for key in task:  # an error of one case: submit each case separately
                        flying[self._submit([key], todo)] = [key]
        if lost:
            if self.make is None:
                raise SimulationError(
                    "a worker of the executor died; finished rows are stored. Pass a function that returns an executor "
                    "instead: the sweep then continues with a new executor"
                )
            _close(self.executor)
            self.executor = self.make()
        return lost

    def _task(self, waiting: deque[str], todo: dict[str, Case], size: int, at_once: int) -> list[str]:
        """Remove the cases of a task from the waiting cases: one vehicle file and engine, about `TASK_S` of work."""
        first = todo[waiting[0]]
        if not size:
            paced = FILL if self.pace is None else TASK_S / max(self.pace, 1e-9)
            even = len(waiting) / at_once  # so that all workers finish at the same time
            size = max(int(min(paced, even, LARGEST)), 1)
            if first.engine != "mujoco" and paced > 2.0:
                inputs = _of_one_car(waiting, todo)
                fill = FILL * inputs
                # A single car cannot fill a vector; a task with very many inputs would store its rows too late.
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
    """Return the number of leading cases of the same car."""
    first = todo[waiting[0]].overrides
    return sum(1 for _ in itertools.takewhile(lambda key: todo[key].overrides == first, waiting))


def _close(executor: Executor) -> None:
    """Shut down an executor and cancel its pending tasks; close the client of a Dask executor."""
    client = getattr(executor, "_client", None)
    if client is None:
        executor.shutdown(wait=True, cancel_futures=True)
    else:
        executor.shutdown(wait=False)
        client.close()
