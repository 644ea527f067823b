"""Statements of a report of runs on different inputs."""

import dataclasses
import re

import numpy as np
import pytest

from vehicle import Car, road, sweep
from vehicle.commands.shaker import main as shaker
from vehicle.digits import number
from vehicle.runs.report.answer import answer, what_changed
from vehicle.runs.report.band_causes import strongest
from vehicle.runs.report.base_run import base_run
from vehicle.runs.report.finished_run import FinishedRun, read_run
from vehicle.runs.report.main_band import MainBand, main_band, weighted_bands
from vehicle.runs.report.run_input import change_half_width, references
from vehicle.studies.sweeps.change_error import change_errors, half_width


def on_input(run: FinishedRun, name: str, file: str) -> FinishedRun:
    """The run as on another file."""
    summary = dataclasses.replace(run.summary, input=dataclasses.replace(run.summary.input, file=file))
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
    first, second = (told.index(text) for text in ("base B against changed B (", "changed A against base A ("))
    rated = [any(word in part for word in (", better)", ", worse)")) for part in (told[first:second], told[second:])]
    assert rated == [True, True] and told.count(" against ") == told.count('<p class="answer"') == 2
    alone = str(answer([*runs, on_input(base, "base C", "c.csv")], [{}] * 5))
    assert (
        "m/s² weighted at the seat rail) is not compared: no other run here is on c.csv" in alone
        and "base C against" not in alone
    )
    # Only inputs differ: they are compared, and not rated.
    told = str(answer([runs[0], runs[2]], [{}] * 2))
    assert "base B against base A (b.csv" in told and ", better)" not in told and ", worse)" not in told
    assert references(runs) == [None, None, 1, 0] and references(runs[::2]) == [None, 0]


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
    assert measured is not None
    mode = strongest(run, measured, modes)
    assert mode is not None and measured.low <= mode.frequency < measured.high
    edges = np.array([0.9, 1.1, 1.3]) * mode.frequency
    peak, hole = (
        dataclasses.replace(measured, low=edges[0], high=edges[2], edges=edges, parts=np.array(parts))
        for parts in ([1.0, 0.5], [0.5, 1.0])
    )
    assert strongest(run, peak, modes) == mode
    assert strongest(run, hole, modes) is None


@pytest.fixture(scope="module")
def on_roads(tmp_path_factory):
    """Runs of two cars on a road of class A, of the first on a cleat, and of the second with another seed."""
    place, found = tmp_path_factory.mktemp("roads"), []
    softer, a = ["--set", "rear.damper.viscous=1000"], ["--road", "A", "--speed", "80", "--duration", "5"]
    for name, words in {
        "A": a, "B": [*a, *softer], "cleat": ["--road", "cleat:20x50", "--speed", "30"], "seed": [*a, "--seed", "2"]
    }.items():  # fmt: skip
        options = ["--vehicle", "sedan", "--engine", "reduced", "--no-figures", "--quiet"]
        assert shaker([*options, *words, "--output", str(place / name)]) == 0
        found.append(read_run(place / name))
    return found


def test_a_change_on_one_road_has_the_error_of_the_sweep(on_roads):
    first, run, cleat, seed = on_roads
    width = change_half_width(first, run)
    table = sweep(Car.load("sedan"), {"rear.damper.viscous": [1500.0, 1000.0]}, road("A", 80, duration=5),
                  engine="reduced")  # fmt: skip
    errors, _ = change_errors(table.rows(), [[0], [1]], "weighted")
    # Batches run in single precision, 2e-7 of a value; the error is 1e-3 to 1e-2 of it.
    assert width == pytest.approx(100.0 * half_width(errors)[1] / table.column("weighted")[0], rel=5e-3)
    told = str(answer([first, run], [{}] * 2))
    assert re.search(rf"\([+-][\d.]+ ± {number(width, 2)} %, (better|worse|not more than its error)", told)
    assert change_half_width(first, cleat) is change_half_width(cleat, cleat) is change_half_width(first, seed) is None


def test_roads_are_not_compared_with_each_other(on_roads):
    """A report of two roads rated one road against the other, with blue bars; the first run without a partner too."""
    first, run, cleat, _ = on_roads
    told = str(answer([cleat, first], [{}] * 2))
    assert "against" not in told and "<svg" not in told and told.count("is not compared") == 2
    told = str(answer([cleat, first, run], [{}] * 3))
    assert "cleat (" in told and told.count("is not compared") == 1 and "B against A (" in told


def test_what_a_road_sets_is_no_change_of_the_car(on_roads):
    first, _, cleat, _ = on_roads
    assert first.car.vehicle.table != cleat.car.vehicle.table
    told = what_changed(first, cleat)
    assert base_run(cleat) is None, "the car is unchanged"
    assert "one sided" not in told and "one_sided" not in told and "cleat" in told
