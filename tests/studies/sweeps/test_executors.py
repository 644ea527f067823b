"""Executors of a sweep: number of submitted tasks, broken executors, workers with another program."""

import errno
import math
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from threading import Timer
from typing import ClassVar

import numpy as np
import pytest

from tests.full_disk import largest_file
from tests.studies.sweeps.sweep_samples import Peak, ShortRoad, grid
from vehicle.errors import ConfigurationError, OutputError, SimulationError
from vehicle.studies.sweeps import dispatcher, executors, worker
from vehicle.studies.sweeps.case_keys import case_keys
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.dispatcher import FILL, PER_WORKER, Dispatcher
from vehicle.studies.sweeps.executors import StandingExecutor, process_pool, workers_of
from vehicle.studies.sweeps.program import program_digest
from vehicle.studies.sweeps.store import StoredRows
from vehicle.studies.sweeps.sweep import sweep
from vehicle.studies.sweeps.worker import carry_out


def many(count):
    return grid({"damper.viscous": [1000.0 + index for index in range(count)]}, [ShortRoad()], engine="reduced")


class Slow(Executor):
    """Executor that finishes tasks only after half a second without submission; counts unfinished tasks."""

    def __init__(self, workers):
        self._max_workers = workers
        self.held: dict[Future[Block], Block] = {}
        self.maximum = 0
        self.quiet: Timer | None = None

    def submit(self, function, /, *arguments, **named):
        if self.quiet is not None:
            self.quiet.cancel()
        future: Future[Block] = Future()
        self.held[future] = Block.of(arguments[0], arguments[1], [Result(values={"peak": 1.0})] * len(arguments[0]))
        self.maximum = max(self.maximum, sum(not task.done() for task in self.held))
        self.quiet = Timer(0.5, self.finish)
        self.quiet.start()
        return future

    def finish(self):
        for task, block in list(self.held.items()):
            if not task.done():
                task.set_result(block)


class Fails(Executor):
    """Executor whose tasks all fail with an error, or are cancelled."""

    def __init__(self, error=None):
        self.error = error

    def submit(self, function, /, *arguments, **named):
        future: Future[Block] = Future()
        if self.error is None:
            future.cancel()
            future.set_running_or_notify_cancel()
        else:
            future.set_exception(self.error)
        return future


def test_submitted_tasks_are_proportional_to_the_workers():
    executor = Slow(3)
    assert not sweep(many(300), Peak(), executor=executor).failed
    assert executor.maximum == 3 * PER_WORKER
    with ThreadPoolExecutor(5) as threads:
        assert workers_of(threads) == 5
    assert workers_of(Fails()) is None


class Cluster(Fails):
    """Executor with the client of a cluster, whose workers come and go; it runs a task if there is a worker."""

    scheduler = None

    def __init__(self, workers):
        super().__init__()
        self.workers, self.counted, self._client = list(workers), 0, self
        self.waiting: list[tuple[Future[Block], Block]] = []

    def nthreads(self):
        count = self.workers.pop(0) if len(self.workers) > 1 else self.workers[0]
        if count is None:
            raise OSError("connection lost")
        self.counted += 1
        for future, block in self.waiting[: count and None]:
            future.set_result(block)
        self.waiting = [] if count else self.waiting
        return {str(number): 1 for number in range(count)}

    def submit(self, function, /, *arguments, **named):
        future: Future[Block] = Future()
        self.waiting.append(
            (future, Block.of(arguments[0], arguments[1], [Result(values={"peak": 1.0})] * len(arguments[0])))
        )
        return future

    def shutdown(self, wait=True, *, cancel_futures=False):
        pass

    def close(self):
        pass


@pytest.fixture
def impatient(monkeypatch):
    """Count the workers every hundredth of a second, and give a notice at once."""
    monkeypatch.setattr(dispatcher, "LOOK_AGAIN_S", 0.01)
    monkeypatch.setattr(dispatcher, "NO_WORKER_NOTICE_S", 0.0)


@pytest.mark.usefixtures("impatient")
def test_new_workers_get_tasks_while_a_sweep_is_running():
    class Held(Slow):
        """Executor with a second worker after the first look; counts its unfinished tasks."""

        def submit(self, function, /, *arguments, **named):
            Timer(0.1, setattr, (self, "_max_workers", 4)).start()
            return super().submit(function, *arguments, **named)

    executor = Held(1)
    assert not sweep(many(300), Peak(), executor=executor).failed
    assert executor.maximum == 4 * PER_WORKER


@pytest.mark.usefixtures("impatient")
def test_no_worker_is_said_and_waited_for():
    notices: list[str] = []
    executor = Cluster([0, 0, 0, 2])
    assert not sweep(many(2), Peak(), executor=lambda: executor, notice=notices.append).failed
    (notice,) = notices
    assert "no worker for 0 s" in notice and "300 s" in notice


@pytest.mark.usefixtures("impatient")
def test_no_worker_for_too_long_and_a_lost_scheduler_are_errors(monkeypatch):
    with pytest.raises(SimulationError, match=r"\(connection lost\).*--resume"):
        sweep(many(2), Peak(), executor=lambda: Cluster([0, None]))
    monkeypatch.setattr(dispatcher, "NO_WORKER_LIMIT_S", 0.05)
    with pytest.raises(SimulationError, match=r"0\.05 s.*--resume"):
        sweep(many(2), Peak(), executor=lambda: Cluster([0]))


def test_rows_are_stored_in_the_order_in_which_tasks_finish():
    """A set of finished tasks has another order: a killed sweep then had the rows of later cases only."""
    order: list[int] = []
    executor = Slow(8)
    Dispatcher(executor, Peak()).work(many(200), lambda numbers, _: order.extend(numbers.tolist()))
    assert executor.maximum == 8 * PER_WORKER and order == list(range(200))


def test_a_full_disk_of_a_worker_stops_the_sweep(monkeypatch):
    def full(cases, measure):
        raise OSError(errno.ENOSPC, "No space left on device", "/scratch/road.npz")

    monkeypatch.setattr(worker, "evaluate", full)
    with pytest.raises(OutputError, match=r"worker .*No space left on device: '/scratch/road.npz'"):
        sweep(many(3), Peak(), executor=lambda: ThreadPoolExecutor(1))


def test_a_full_disk_of_the_sweep_stops_it(tmp_path):
    rows = StoredRows(tmp_path / "rows.jsonl", 1)
    with (
        largest_file(10),
        pytest.raises(OutputError, match=r"0 rows: File too large.*--resume"),
    ):
        rows.append(np.arange(1), Block.of(many(1), ["k" * 64], [Result()]))


def test_no_file_of_rows_stays_open(tmp_path):
    """Windows moves no folder with an open file: rows are read from where the folder was, not from a descriptor."""
    (tmp_path / "work").mkdir()
    table = sweep(many(3), Peak(), executor=lambda: ThreadPoolExecutor(1), folder=tmp_path / "work")
    before = table.text()
    (tmp_path / "work" / "rows.jsonl").rename(tmp_path / "rows.jsonl")
    with pytest.raises(FileNotFoundError):
        table.text()
    (tmp_path / "rows.jsonl").rename(tmp_path / "work" / "rows.jsonl")
    assert table.text() == before and [result.values for result in table.results] == [
        table.results[number].values for number in range(3)
    ]


def test_a_time_limit_needs_processes():
    with pytest.raises(ConfigurationError, match=r"time limit: .*--jobs"):
        sweep(many(1), Peak(), executor=lambda: ThreadPoolExecutor(1), time_limit=60.0)
    for limit in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ConfigurationError, match=r"--time-limit .*: must be above 0"):
            sweep(many(1), Peak(), executor=lambda: ThreadPoolExecutor(1), time_limit=limit)


def test_an_executor_of_the_caller_stays_open():
    with ThreadPoolExecutor(1) as threads:
        first = sweep(many(1), Peak(), executor=threads)
        assert sweep(many(1), Peak(), executor=threads).text() == first.text()
        assert not first.failed


def test_a_broken_executor_of_the_caller_is_an_error_and_rows_are_stored(tmp_path):
    sweep(many(2), Peak(), executor=ThreadPoolExecutor(1), folder=tmp_path)
    with pytest.raises(SimulationError, match="Pass a function that returns an executor"):
        sweep(many(3), Peak(), executor=Fails(BrokenProcessPool("killed")), folder=tmp_path)
    assert (tmp_path / "rows.jsonl").read_text(encoding="utf-8").count("\n") == 2


def test_cancelled_tasks_are_an_error():
    with pytest.raises(SimulationError, match="the runs were cancelled"):
        sweep(many(2), Peak(), executor=lambda: Fails())


def test_an_interruption_keeps_the_rows(tmp_path):
    def interrupt(fraction):
        if fraction:
            raise KeyboardInterrupt

    cases = many(FILL + 2)
    with pytest.raises(KeyboardInterrupt):
        sweep(cases, Peak(), executor=lambda: ThreadPoolExecutor(1), folder=tmp_path, progress=interrupt)
    # Rows of the first task.
    assert (tmp_path / "rows.jsonl").read_text(encoding="utf-8").count("\n") == FILL
    counted: list[float] = []
    table = sweep(cases, Peak(), executor=lambda: ThreadPoolExecutor(1), folder=tmp_path, progress=counted.append)
    assert counted == [FILL / (FILL + 2), 1.0] and not table.failed


def test_a_worker_with_another_program_is_rejected():
    cases = many(1)
    assert not carry_out(cases, [""], Peak(), program_digest()).failed
    with pytest.raises(ConfigurationError, match=r"libraries .*\(another\)"):
        carry_out(cases, [""], Peak(), "another")
    # An error of the worker, not of the run, is not a row.
    with pytest.raises(ConfigurationError, match="of the worker"):
        sweep(cases, Peak(), executor=Fails(ConfigurationError("of the worker")))


def test_processes_that_do_not_start_are_an_error(monkeypatch):
    class NoProcesses(Fails):
        def __init__(self, *arguments, **named):
            super().__init__(BrokenProcessPool("terminated abruptly"))

    monkeypatch.setattr(executors, "ProcessPoolExecutor", NoProcesses)
    with pytest.raises(ConfigurationError, match='if __name__ == "__main__"'):
        process_pool(2)


def test_a_standing_executor_serves_several_sweeps_and_survives_the_death_of_a_worker():
    """The first executor dies with its first task; its successor does all sweeps, and is closed at the end only."""
    made = [Fails(BrokenProcessPool("terminated abruptly")), ThreadPoolExecutor(1), ThreadPoolExecutor(1)]
    waiting = iter(made)
    with StandingExecutor(lambda: next(waiting)) as standing:
        for count in (2, 3):
            table = sweep(many(count), Peak(), executor=standing)
            assert not table.failed and len(table.results) == count
            assert standing() is made[1]
    with pytest.raises(RuntimeError, match="after shutdown"):
        made[1].submit(print)
    assert next(waiting) is made[2]


@dataclass(frozen=True)
class Counting(ShortRoad):
    """Road that records the calls of `identity`."""

    calls: ClassVar[list[str]] = []

    def identity(self):
        self.calls.append(self.name)
        return super().identity()


def test_a_shared_input_is_identified_once():
    road = Counting()
    keys = case_keys(grid({"damper.viscous": [1.0, 2.0, 3.0]}, [road]), Peak())
    assert len(set(keys)) == 3
    assert road.calls == ["short"]


def test_the_key_contains_the_source_of_a_measure():
    def measure_with(text):
        return type("Measured", (Peak,), {"__repr__": lambda self: text})()

    cases = many(1)
    # A class without source is identified by its repr; a class with source by both.
    assert case_keys(cases, measure_with("a")) != case_keys(cases, measure_with("b"))
    assert case_keys(cases, measure_with(repr(Peak()))) != case_keys(cases, Peak())
