"""An interruption that a library has swallowed is noticed at the next sign of progress."""

from __future__ import annotations

import os
import signal

from vehicle.commands.command_line import INTERRUPTED, ProgressLine, run_command


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
    assert capsys.readouterr().err.splitlines() == ["work: 1 %", "work: 11 %, 276 s left", "work: 21 %, 245 s left"]
