"""The number of processes of a sweep is that which pays."""

from dataclasses import replace

import pytest

from vehicle.signals.excitation.input_files import find_input
from vehicle.studies.sweeps import chosen_jobs, sweep
from vehicle.studies.sweeps.case import Case, SignalFile
from vehicle.studies.sweeps.executors import ThisProcess
from vehicle.studies.sweeps.measure import ComfortMeasure, SingleMeasure

ROAD = SignalFile(path=find_input("bump_1p5mm.csv"), wheel="fl")
CASE = Case(source=ROAD, engine="auto")


@pytest.fixture(autouse=True)
def machine(monkeypatch):
    """Eight processors with 64 GB."""
    monkeypatch.setattr(chosen_jobs, "processors", lambda: 8)
    monkeypatch.setattr(chosen_jobs, "free_memory", lambda: 64e9)


@pytest.mark.parametrize("runs", [1, 16, 100, 400, 5000])
def test_a_process_takes_less_time_to_start_than_its_runs(runs, monkeypatch):
    """T/n + start is smaller than T for the chosen n, and n = 1 where no n would be faster by its own share."""
    (count, text), seconds = (
        chosen_jobs.chosen_jobs([CASE], runs, ComfortMeasure()),
        chosen_jobs.work([CASE], runs, ComfortMeasure()),
    )
    assert (count > 1) == bool(text) == (seconds >= 2 * chosen_jobs.START)
    assert count == 1 or (seconds / count >= chosen_jobs.START and seconds / count + chosen_jobs.START <= seconds)
    assert count <= 8


def test_mujoco_and_single_runs_are_more_work():
    cases = [CASE, replace(CASE, engine="mujoco")]
    batch, complete = (chosen_jobs.work([case], 10, ComfortMeasure()) for case in cases)
    single = chosen_jobs.work([CASE], 10, SingleMeasure(each=None))  # type: ignore[arg-type]
    assert batch < single < complete
    assert chosen_jobs.work(cases, 10, ComfortMeasure()) == pytest.approx(0.5 * (batch + complete))


def test_memory_limits_the_processes(monkeypatch):
    monkeypatch.setattr(chosen_jobs, "free_memory", lambda: 0.0)
    assert chosen_jobs.chosen_jobs([CASE], 5000, ComfortMeasure()) == (1, "")


@pytest.mark.parametrize(("asked", "pools"), [(None, [3]), (2, [2]), (1, [])])
def test_the_chosen_number_is_said_and_another_one_is_obeyed(asked, pools, monkeypatch):
    made, said = list[int](), list[str]()
    monkeypatch.setattr(sweep, "chosen_jobs", lambda *arguments: (3, "3 processes"))

    def pool(jobs):
        made.append(jobs)
        return ThisProcess()

    monkeypatch.setattr(sweep, "process_pool", pool)
    table = sweep.sweep([CASE], ComfortMeasure(), jobs=asked, notice=said.append)
    assert (made, said, table.failed) == (pools, ["3 processes"] if asked is None else [], [])
