"""An interruption that a library has swallowed is noticed at the next sign of progress."""

import io
import os
import re
import signal
import time

from tests.patience import HANG
from vehicle.commands import console
from vehicle.commands.command_line import INTERRUPTED, run_command
from vehicle.commands.console import ProgressLine


def test_a_swallowed_interruption_still_ends_the_job(capsys):
    before = signal.getsignal(signal.SIGINT)  # not always Python's own: a shell may have us ignore it
    reached = []

    def job():
        try:
            os.kill(os.getpid(), signal.SIGINT)
        except KeyboardInterrupt:
            reached.append("swallowed")
        ProgressLine("work", enabled=False)(0.5)
        reached.append("went on")

    assert run_command(job) == INTERRUPTED
    assert reached == ["swallowed"]
    assert "interrupted" in capsys.readouterr().err
    # The next job begins anew, and the handlers are those of before.
    assert run_command(lambda: ProgressLine("work", enabled=False)(0.5)) == 0
    assert signal.getsignal(signal.SIGINT) is before


def test_the_time_left_is_that_of_the_work_that_goes_on(monkeypatch, capsys):
    # A minute of compiling before the first sign, then 10 % in 31 s each.
    clock = iter([0.0, 60.0, 91.0, 122.0])
    monkeypatch.setattr("time.monotonic", lambda: next(clock))
    line = ProgressLine("work")
    for fraction in (0.01, 0.11, 0.21):
        line(fraction)
    assert capsys.readouterr().err.splitlines() == ["work: 1 %", "work: 11 %, 4.6 min left", "work: 21 %, 4.1 min left"]


def test_the_line_of_many_runs_counts_them(monkeypatch, capsys):
    """The first finished run tells how long all of them take, without waiting for the next line."""
    clock = iter([0.0, 0.0, 14.0, 20.0, 45.0, 1400.0])
    monkeypatch.setattr("time.monotonic", lambda: next(clock))
    line = ProgressLine("sweep", runs=400)
    for done in (0, 1, 2, 3, 100):
        line(done / 400)
    assert capsys.readouterr().err.splitlines() == [
        "sweep: 0 %, 1 of 400 runs, 93 min left",
        "sweep: 1 %, 3 of 400 runs, 99 min left",
        "sweep: 25 %, 100 of 400 runs, 70 min left",
    ]


class Terminal(io.StringIO):
    """Standard error of a terminal."""

    def isatty(self) -> bool:
        return True


def test_a_bar_moves_without_a_finished_part_until_the_command_ends(monkeypatch):
    """A single case of a sweep may take minutes; the bar of a terminal still moves every two seconds."""
    monkeypatch.setattr(console, "BEAT", 0.02)
    terminal = Terminal()
    monkeypatch.setattr("sys.stderr", terminal)

    def moves(times):
        drawn, late = terminal.getvalue().count("\r"), time.monotonic() + HANG
        while terminal.getvalue().count("\r") < drawn + times and time.monotonic() < late:
            time.sleep(0.01)

    def job():
        line = ProgressLine("work")
        moves(4)
        line(0.1)
        line(0.2)
        moves(4)

    assert run_command(job) == 0
    written = terminal.getvalue()
    drawn = written.split("\r")
    assert len(drawn) > 8 and re.search(r"after \d+ s", drawn[1]) and "s left" in drawn[-1] and " 20 %" in drawn[-1]
    time.sleep(0.1)
    assert terminal.getvalue() == written
