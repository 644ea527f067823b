"""What a process is told that is one command, and one that only calls a command is not."""

import atexit
import gc
import os
import sys

import pytest

from vehicle.commands import command_line
from vehicle.commands.command_line import COLLECTED, FIRST_COLLECTED, begin_process, parse_and_run
from vehicle.commands.parser import Parser
from vehicle.threads import THREADS


@pytest.fixture
def at_end(monkeypatch):
    """What is to be called at the end of the process; the garbage collector has its own pace again behind the test."""
    registered: list[object] = []
    before, callbacks = gc.get_threshold(), list(gc.callbacks)
    monkeypatch.setattr(atexit, "register", registered.append)
    yield registered
    gc.set_threshold(*before)
    gc.callbacks[:] = callbacks


def test_a_process_collects_seldom_and_loads_no_window(monkeypatch, at_end):
    for name in THREADS:
        monkeypatch.setenv(name, "3")
        monkeypatch.delenv(name)
    monkeypatch.setenv("MUJOCO_GL", "")
    monkeypatch.delenv("MUJOCO_GL")
    begin_process()
    assert gc.isenabled() and gc.get_threshold()[0] == FIRST_COLLECTED > COLLECTED[0]
    gc.collect(0)
    assert gc.get_threshold() == COLLECTED, "from the first collection on"
    assert at_end == [gc.freeze]
    assert os.environ["MUJOCO_GL"] == "disable"
    assert {os.environ.get(name) for name in THREADS} == {"1"}


def test_the_library_that_a_user_names_stays(monkeypatch, at_end):
    monkeypatch.setenv("MUJOCO_GL", "egl")
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    begin_process()
    assert os.environ["MUJOCO_GL"] == "egl"
    assert os.environ["OMP_NUM_THREADS"] == "3"


@pytest.mark.parametrize(("arguments", "times"), [(None, 1), ([], 0)])
def test_only_the_arguments_of_the_process_make_it_one(monkeypatch, arguments, times):
    begun = []
    monkeypatch.setattr(command_line, "begin_process", lambda: begun.append(True))
    monkeypatch.setattr(sys, "argv", ["shaker"])
    assert parse_and_run(Parser(), lambda options, console: None, arguments) == 0
    assert len(begun) == times
