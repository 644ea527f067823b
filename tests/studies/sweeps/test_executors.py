"""Executors of a sweep: number of submitted tasks, broken executors, workers with another program."""

from __future__ import annotations

from concurrent.futures import Executor, Future, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from threading import Timer
from typing import ClassVar

import pytest

from tests.studies.sweeps.sweep_samples import Peak, ShortRoad, grid
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.studies.sweeps import executors
from vehicle.studies.sweeps.case_keys import case_keys
from vehicle.studies.sweeps.case_result import Block, Result
from vehicle.studies.sweeps.dispatcher import FILL, PER_WORKER
from vehicle.studies.sweeps.executors import process_pool, workers_of
from vehicle.studies.sweeps.program import program_digest
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
        self.held[future] = Block.of(*arguments[:2], [Result(values={"peak": 1.0})] * len(arguments[0]))
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
    with pytest.raises(SimulationError, match="the executor cancelled its runs"):
        sweep(many(2), Peak(), executor=lambda: Fails())


def test_an_interruption_keeps_the_rows(tmp_path):
    def interrupt(fraction):
        raise KeyboardInterrupt

    cases = many(FILL + 2)
    with pytest.raises(KeyboardInterrupt):
        sweep(cases, Peak(), executor=lambda: ThreadPoolExecutor(1), folder=tmp_path, progress=interrupt)
    # Rows of the first task.
    assert (tmp_path / "rows.jsonl").read_text(encoding="utf-8").count("\n") == FILL
    counted: list[float] = []
    table = sweep(cases, Peak(), executor=lambda: ThreadPoolExecutor(1), folder=tmp_path, progress=counted.append)
    assert counted == [0.5, 1.0] and not table.failed


def test_a_worker_with_another_program_is_rejected():
    cases = many(1)
    assert not carry_out(cases, [""], Peak(), program_digest()).failed
    with pytest.raises(ConfigurationError, match="the workers have another program"):
        carry_out(cases, [""], Peak(), "another")
    # An error of the worker, not of the run, is not a row.
    with pytest.raises(ConfigurationError, match="another program"):
        sweep(cases, Peak(), executor=Fails(ConfigurationError("another program")))


def test_processes_that_do_not_start_are_an_error(monkeypatch):
    class NoProcesses(Fails):
        def __init__(self, *arguments, **named):
            super().__init__(BrokenProcessPool("terminated abruptly"))

    monkeypatch.setattr(executors, "ProcessPoolExecutor", NoProcesses)
    with pytest.raises(ConfigurationError, match='if __name__ == "__main__"'):
        process_pool(2)


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
