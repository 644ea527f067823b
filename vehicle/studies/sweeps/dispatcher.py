"""Dispatch of cases to an executor in tasks: size of the tasks, and recovery from the death of a worker."""

import time as clock
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import suppress
from dataclasses import dataclass
from itertools import takewhile
from queue import Empty, SimpleQueue

import numpy as np

from vehicle.arrays import Indices
from vehicle.errors import SimulationError, VehicleError
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.executors import StandingExecutor, ThisProcess, close, worker_remedy, workers_of
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.program import program_digest
from vehicle.studies.sweeps.worker import TimeLimit, carry_out

PER_WORKER = 2
"""Submitted tasks per worker of an executor, so that no worker is idle."""
UNKNOWN_WORKERS = 64
"""Submitted tasks of an executor whose number of workers is unknown."""

FILL = 8
"""Number of cars in a SIMD vector: tasks contain multiples of this number, each car with all its inputs."""
TASK_S = 1.0
"""Target computing time of a task [s]: dispatch costs a thousandth of it, and rows are stored every second."""
TASKS_PER_S = 200.0
"""Maximum number of tasks that all workers finish in a second: a task costs a Dask client and its scheduler 1 to 2 ms
of processor time. Above 200 workers the tasks take longer instead."""
LARGEST = 32 * FILL
"""Maximum number of cases of a task."""

LOOK_AGAIN_S = 1.0
"""Interval after which the workers are counted again even if no task has finished, so that new ones get tasks [s]."""
NO_WORKER_NOTICE_S = 5.0
"""Time without any worker after which a notice is given [s]."""
NO_WORKER_LIMIT_S = 300.0
"""Maximum time without any worker [s]: a batch system starts workers successively."""

PACE_RESERVE = 10.0
"""Multiple of the expected computing time of a task that its time limit allows."""

DIED = "the worker died twice during this run (killed or out of memory)"

Keep = Callable[[Indices, Block], None]
"""Function that stores finished rows: numbers of the cases and their rows."""
Notice = Callable[[str], None]
"""Function that shows a message while the sweep is running."""


def overdue(limit: float) -> str:
    """Return the reason of a failed run that took longer than the time limit [s]."""
    return f"exceeded the time limit of {limit:g} s; its worker was stopped"


def in_groups(cases: Sequence[Case], numbers: Indices) -> Indices:
    """Return numbers of cases sorted by vehicle file and engine, then by car, in the order of first occurrence.

    Args:
        numbers: numbers of the cases to sort, ascending.
    """
    # Hashes instead of the cars: 8 byte a case. Two cars of equal hash would only be evaluated alternately.
    groups: dict[object, int] = {}
    group = np.empty(len(numbers), dtype=np.int32)
    car = np.empty(len(numbers), dtype=np.int64)
    for position, case in enumerate(cases if len(numbers) == len(cases) else map(cases.__getitem__, numbers.tolist())):
        group[position] = groups.setdefault((case.vehicle, case.engine), len(groups))
        car[position] = hash(case.overrides)
    by_car = np.argsort(car, kind="stable")
    new = np.append(True, np.diff(car[by_car]) != 0)
    first = np.empty(len(numbers), dtype=np.int32)
    first[by_car] = by_car[new][np.cumsum(new, dtype=np.int32) - 1]
    order: Indices = numbers[np.lexsort((first, group))]
    return order


@dataclass(slots=True, eq=False)
class Waiting:
    """Numbers of the cases that wait for a worker."""

    numbers: Indices  # numbers of the cases, in the order of submission
    submitted: int = 0  # number of cases that were submitted

    def __len__(self) -> int:
        """Return the number of waiting cases."""
        return len(self.numbers) - self.submitted

    def leading(self, count: int) -> Indices:
        """Return the numbers of the next cases, at most `count`."""
        return self.numbers[self.submitted : self.submitted + count]


class Dispatcher:
    """Dispatches cases to an executor and recovers from the death of workers.

    Args:
        executor: executor, or function that returns an executor.
        measure: measure of all cases.
        key_of: function that returns the key of a case for its row; by default the keys are empty.
        time_limit: maximum computing time of a run [s], see `TimeLimit`; None for no limit.
        notice: called with messages.

    Raises:
        ConfigurationError: the time limit is no positive number.
    """

    def __init__(
        self,
        executor: Executor | Callable[[], Executor],
        measure: Measure,
        *,
        key_of: Callable[[Case], str] | None = None,
        time_limit: float | None = None,
        notice: Notice | None = None,
    ) -> None:
        self.make = None if isinstance(executor, Executor) else executor
        self.executor = executor if isinstance(executor, Executor) else executor()
        self.measure, self.program = measure, program_digest()
        self.key_of, self.time_limit, self.notice = key_of, time_limit, notice
        self.pace: float | None = None
        self._workers: int | None = None
        self._counted = self._last_worker = -np.inf
        self._noticed = False

    def work(self, cases: Sequence[Case], keep: Keep, numbers: Indices | None = None) -> None:
        """Run cases; `keep` is called with finished rows.

        Args:
            keep: called with the numbers of finished cases and their rows.
            numbers: numbers of the cases to run, ascending; by default all.
        """
        waiting = Waiting(in_groups(cases, np.arange(len(cases)) if numbers is None else numbers))
        suspects: deque[Indices] = deque()
        died = set[int]()
        self._last_worker = clock.monotonic()
        try:
            while waiting or suspects:
                if suspects:
                    # A single task, then single runs, so that only the run that kills its worker fails.
                    task = suspects.popleft()
                    began = clock.monotonic()
                    if not self._run_waiting(Waiting(task), cases, keep, len(task)):
                        continue
                    if len(task) == 1:
                        reason, number = self._death(began), int(task[0])
                        # The first loss may be due to another run in the same pool: two deaths of its worker alone.
                        if reason == DIED and number not in died:
                            died.add(number)
                            suspects.append(task)
                        else:
                            keep(task, self._failed(cases, task, reason))
                    else:
                        suspects.extend(np.split(task, len(task)))
                else:
                    suspects.extend(self._run_waiting(waiting, cases, keep))
        except CancelledError:
            raise SimulationError(
                "the runs were cancelled, possibly because the connection to the cluster (Dask) was lost; finished "
                "runs are stored: continue with --resume"
            ) from None
        finally:
            if self.make is not None and not isinstance(self.make, StandingExecutor):
                close(self.executor)

    def _run_waiting(self, waiting: Waiting, cases: Sequence[Case], keep: Keep, size: int = 0) -> list[Indices]:
        """Run waiting cases until all are finished or a worker dies.

        Args:
            keep: called with finished rows.
            size: number of cases of a task; by default from the measured computing time.

        Returns:
            Tasks that were submitted and lost.
        """
        flying: dict[Future[Block], tuple[Indices, float]] = {}
        finished: SimpleQueue[Future[Block]] = SimpleQueue()
        lost: list[Indices] = []

        def submit_task(task: Indices, task_cases: Sequence[Case]) -> None:
            future = self._submit(task_cases)
            flying[future] = task, clock.monotonic()
            # The queue has the order in which the tasks finish, and costs the same with any number of tasks.
            future.add_done_callback(finished.put)

        while waiting or flying:
            workers = self._count_workers()
            at_once = UNKNOWN_WORKERS if workers is None else PER_WORKER * max(workers, 1)
            if isinstance(self.executor, ThisProcess):
                at_once = 1  # a row is kept as soon as it is finished
            while waiting and len(flying) < at_once and not lost:
                task, task_cases = self._next_task(waiting, cases, size, at_once)
                try:
                    submit_task(task, task_cases)
                except BrokenExecutor:
                    lost.append(task)
            if not flying:
                break
            for future in _drained(finished):
                task, began = flying.pop(future)
                error = future.exception()
                if error is None:
                    block = future.result()
                    # The computing time of a vector of cars with the reduced engine is that of a single car.
                    cars = len({cases[number].overrides for number in task.tolist()}) if block.reduced else FILL
                    self.pace = block.seconds / len(task) * min(cars / FILL, 1.0)
                    keep(task, block)
                elif isinstance(error, BrokenExecutor):
                    lost.append(task)
                elif isinstance(error, VehicleError):
                    raise error  # an error of the worker itself: errors of runs are results
                elif len(task) == 1:
                    # Dask repeats the task of a dead worker, and gives up with this error.
                    killed = type(error).__name__ == "KilledWorker"
                    reason = self._death(began) if killed else f"{type(error).__name__}: {error}"
                    keep(task, self._failed(cases, task, reason))
                else:
                    for single in np.split(task, len(task)):  # an error of one case: submit each case separately
                        submit_task(single, [cases[single[0]]])
        if lost:
            if self.make is None:
                raise SimulationError(
                    "a worker of the executor died; finished rows are stored. Pass a function that returns an executor "
                    "instead: the sweep then continues with a new executor"
                )
            if isinstance(self.make, StandingExecutor):
                self.executor = self.make.renew()
            else:
                close(self.executor)
                self.executor = self.make()
        return lost

    def _count_workers(self) -> int | None:
        """Return the number of workers, counted again after `LOOK_AGAIN_S`: a cluster may grow; None if unknown."""
        now = clock.monotonic()
        if now - self._counted >= LOOK_AGAIN_S:
            self._workers, self._counted = workers_of(self.executor), now
            if self._workers != 0:
                self._last_worker, self._noticed = now, False
            elif now - self._last_worker > NO_WORKER_LIMIT_S:
                raise SimulationError(
                    f"no worker for {NO_WORKER_LIMIT_S:g} s; {worker_remedy(self.executor)}. Finished rows are stored; "
                    "continue with --resume"
                )
            elif now - self._last_worker > NO_WORKER_NOTICE_S and not self._noticed and self.notice is not None:
                self._noticed = True
                self.notice(
                    f"no worker for {now - self._last_worker:.0f} s; the sweep waits up to {NO_WORKER_LIMIT_S:g} s: "
                    f"{worker_remedy(self.executor)}"
                )
        return self._workers

    def _next_task(
        self, waiting: Waiting, cases: Sequence[Case], size: int, at_once: int
    ) -> tuple[Indices, list[Case]]:
        """Remove the cases of a task from the waiting cases: one vehicle file and engine, about `TASK_S` of work."""
        first = cases[waiting.leading(1)[0]]
        if not size:
            size = self._size(waiting, cases, first, at_once)
        group = first.vehicle, first.engine
        listed = map(cases.__getitem__, waiting.leading(size).tolist())
        task_cases = list(takewhile(lambda case: (case.vehicle, case.engine) == group, listed))
        task = waiting.leading(len(task_cases))
        waiting.submitted += len(task_cases)
        return task, task_cases

    def _size(self, waiting: Waiting, cases: Sequence[Case], first: Case, at_once: int) -> int:
        """Return the number of cases of the next task."""
        if self.pace is None:
            # Single runs of MuJoCo tell early how long the sweep takes; with a time limit they are limited exactly.
            paced = 1.0 if self.time_limit is not None or first.engine != "reduced" else float(FILL)
        else:
            paced = max(TASK_S, at_once / PER_WORKER / TASKS_PER_S) / max(self.pace, 1e-9)
        even = len(waiting) / at_once  # so that all workers finish at the same time
        size = max(int(min(paced, even, LARGEST)), 1)
        if first.engine != "mujoco" and paced > 2.0:
            inputs = 0
            for number in waiting.leading(LARGEST // FILL + 1).tolist():
                if cases[number].overrides != first.overrides:
                    break
                inputs += 1
            fill = FILL * inputs
            # A single car cannot fill a vector; a task with very many inputs would store its rows too overran.
            if inputs < len(waiting) and fill <= LARGEST:
                size = min(fill * -(-size // fill), LARGEST, -(-PER_WORKER * len(waiting) // at_once))
        return size

    def _submit(self, task: Sequence[Case]) -> Future[Block]:
        keys = [""] * len(task) if self.key_of is None else [self.key_of(case) for case in task]
        limit = None
        if self.time_limit is not None:
            # A task of several runs that takes too long is repeated run by run.
            expected = 0.0 if self.pace is None or len(task) == 1 else PACE_RESERVE * self.pace * len(task)
            limit = TimeLimit(seconds=max(self.time_limit, expected))
        return self.executor.submit(carry_out, task, keys, self.measure, self.program, limit)

    def _failed(self, cases: Sequence[Case], task: Indices, reason: str) -> Block:
        """Return the row of a single failed run."""
        case = cases[task[0]]
        return Block.of([case], ["" if self.key_of is None else self.key_of(case)], [Result(reason=reason)])

    def _death(self, began: float) -> str:
        """Return the reason of a run whose worker died; `began` is the time of its submission [s]."""
        overran = self.time_limit is not None and clock.monotonic() - began >= self.time_limit
        return overdue(self.time_limit) if overran and self.time_limit is not None else DIED


def _drained(finished: SimpleQueue[Future[Block]]) -> list[Future[Block]]:
    """Wait for a finished task for `LOOK_AGAIN_S`; return all finished tasks, in the order in which they finished."""
    futures = []
    with suppress(Empty):
        futures.append(finished.get(timeout=LOOK_AGAIN_S))
        while True:
            futures.append(finished.get_nowait())
    return futures
