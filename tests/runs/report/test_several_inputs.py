"""Statements of a report of runs on different inputs."""

import dataclasses
from typing import Any

from vehicle.runs.report.answer import answer
from vehicle.runs.report.base_run import base_run
from vehicle.runs.report.finished_run import FinishedRun, read_run


def on_input(run: FinishedRun, name: str, file: str) -> FinishedRun:
    """The run as on another file."""
    summary: Any = {**run.summary, "input": {**run.summary["input"], "file": file}}
    return dataclasses.replace(run, name=name, summary=summary)


def test_a_run_is_compared_on_its_input_and_an_input_is_not_rated(reported):
    changed = read_run(reported.folder)
    base = base_run(changed)
    assert base is not None
    runs = [
        on_input(base, "base A", "a.csv"), on_input(changed, "changed B", "b.csv"),
        on_input(base, "base B", "b.csv"), on_input(changed, "changed A", "a.csv"),
    ]  # fmt: skip
    told = str(answer(runs, [{}] * 4))
    first, second, third = (told.index(f"{a} against {b} (") for a, b in (
        ("changed B", "base A"), ("base B", "changed B"), ("changed A", "base A")))  # fmt: skip
    rated = [any(word in part for word in (", better)", ", worse)")) for part in (
        told[first:second], told[second:third], told[third:])]  # fmt: skip
    assert rated == [False, True, True]
