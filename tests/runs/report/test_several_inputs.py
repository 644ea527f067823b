"""Statements of a report of runs on different inputs."""

import dataclasses
from typing import Any

import numpy as np

from vehicle.runs.report.answer import answer
from vehicle.runs.report.band_causes import strongest
from vehicle.runs.report.base_run import base_run
from vehicle.runs.report.finished_run import FinishedRun, read_run
from vehicle.runs.report.main_band import MainBand, main_band, weighted_bands


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


def test_a_mode_outside_the_band_or_in_a_hole_is_no_cause(reported):
    """Third octaves from 5.6 to 14 Hz, as on a road whose wheelbase leaves little of 12 Hz; then a band without it."""
    edges = np.array([5.6, 7.1, 8.9, 11.2, 14.1])
    band = MainBand(axis="z", low=5.6, high=14.1, peak=8.0, share=0.53, edges=edges,
                    parts=np.array([0.10, 0.21, 0.16, 0.067]))  # fmt: skip
    assert [band.explained_by(frequency) for frequency in (3.3, 8.0, 10.0, 12.0, 14.1)] == [
        False, True, True, False, False
    ]  # fmt: skip
    run = read_run(reported.folder)
    measured, modes = main_band(weighted_bands(run)), run.car.modes("sliding")
    mode = strongest(run, measured, modes)
    assert mode is not None and measured.low <= mode.frequency < measured.high
    edges = np.array([0.9, 1.1, 1.3]) * mode.frequency
    peak, hole = (
        dataclasses.replace(measured, low=edges[0], high=edges[2], edges=edges, parts=np.array(parts))
        for parts in ([1.0, 0.5], [0.5, 1.0])
    )
    assert strongest(run, peak, modes) == mode
    assert strongest(run, hole, modes) is None
