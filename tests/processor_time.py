"""Processor time of the tests: what to begin with, and where the time goes.

`python -m pytest --processor-time` prints the seconds of each folder, children included, and writes those of the
modules above `SHORTEST` to `tests/processor_time.csv`; by this table the longest modules begin, so that all workers end
at about the same time.
"""

import os
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

FILE = Path(__file__).with_suffix(".csv")
SHORTEST = 2.0
"""Modules with less are not in the table [s]."""


@cache
def known() -> dict[str, float]:
    """Return the processor time [s] of each module of the table, by its path under tests/."""
    rows = (line.split(",") for line in FILE.read_text(encoding="utf-8").splitlines()) if FILE.exists() else ()
    return {module: float(seconds) for module, seconds in rows}


def used() -> float:
    """Return the processor time of this process and its ended children [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class ProcessorTime:
    """Measures each test, with its fixtures, where it runs, and adds up where the results come together."""

    def __init__(self) -> None:
        self.begin = 0.0
        self.modules: Counter[str] = Counter()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self):
        """Note the begin of a test."""
        self.begin = used()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self):
        """Add the time since the last report to this one; a worker sends it."""
        report = yield
        now = used()
        report.processor_time, self.begin = now - self.begin, now
        return report

    def pytest_runtest_logreport(self, report):
        """Add up."""
        module = report.nodeid.partition("::")[0].removeprefix("tests/")
        self.modules[module] += report.processor_time

    def pytest_terminal_summary(self, terminalreporter):
        """Print the folders and write the table; modules that did not run keep their time."""
        folders: Counter[str] = Counter()
        for module, seconds in self.modules.items():
            folders[str(Path(module).parent)] += seconds
        terminalreporter.section("processor time")
        for folder, seconds in [*folders.most_common(), ("all", folders.total())]:
            terminalreporter.line(f"{seconds:8.1f} s  {folder}")
        there = {module: seconds for module, seconds in known().items() if (FILE.parent / module).exists()}
        rows = Counter({**there, **self.modules}).most_common()
        text = "".join(f"{module},{seconds:.0f}\n" for module, seconds in rows if seconds >= SHORTEST)
        FILE.write_text(text, encoding="utf-8")
