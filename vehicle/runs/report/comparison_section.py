"""Comparison sections of the report: inputs, key figures, parameters, notices, FRFs and spectra of several runs."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.several_runs import plot_responses, shared_channels
from vehicle.names import side_of, wheel_words
from vehicle.runs.report.differences import changed_parameters, difference, key_figures, parameter_rows, parameter_words
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.general_notices import without_general
from vehicle.runs.report.markup import named, templates
from vehicle.runs.report.run_input import references
from vehicle.runs.report.spectra_section import spectra
from vehicle.runs.report.svg_figure import drawing

fill = templates(__file__)

MANY = 6
"""Number of runs above which a run is a row of the tables, and pictures of single runs are few."""

LEAST_SHIFT = 0.01
"""Least relative difference of speed over wheelbase that is named: it moves a zero at 10 Hz by 0.1 Hz."""

SIZE = (PAGE_WIDTH, 5.6)
"""Width and height of the figure of FRFs [inch]."""


def numbers_beside(runs: Sequence[FinishedRun]) -> Markup:
    """Return tables of inputs, key figures and parameters of several runs, and their notices.

    Above `MANY` runs a run is a row, without the change of each figure.
    """
    names = [run.name for run in runs]
    figures = _figures_of_many(runs) if len(runs) > MANY else _figures_beside(runs)
    changed = changed_parameters([run.car.vehicle for run in runs])
    if len(runs) > MANY:
        columns = [named(path, f"{parameter_words(path)} [{unit}]") for path, unit, _ in changed]
        parameters = (
            ["run", *columns],
            [(name, *(values[k] for *_, values in changed)) for k, name in enumerate(names)],
        )
    else:
        parameters = (["parameter", "unit", *names], parameter_rows(changed))
    inputs = [
        (
            run.name,
            run.car.vehicle.name,
            Path(run.signal.source).name,
            f"{1e3 * run.summary.input.rms_m:.3g}",
            f"{run.summary.input.duration_s:g}",
            run.summary.solver.engine,
        )
        for run in runs
    ]
    if len(runs) > MANY and len({row[1:] for row in inputs}) == 1:
        inputs = [(f"all {len(runs)} runs", *inputs[0][1:])]
    return fill(
        "comparison",
        first=names[0] if any(each is not None for each in references(runs)) else "",
        many=len(runs) > MANY,
        inputs=inputs,
        figures=figures,
        count=len(changed),
        parameters=parameters,
        other_signals=len({run.summary.input.sha256 or run.signal.source for run in runs}) > 1,
        noted=_notices(runs),
    )


Table = tuple[list[str], list[tuple[str, ...]]]
"""Heads and rows of a table."""


def _figures_beside(runs: Sequence[FinishedRun]) -> Table:
    """Return the key figures of runs: a row for each, with its change against the first run on the same input."""
    figures, compared = [key_figures(run) for run in runs], references(runs)
    heads = [""]
    for run, base in zip(runs, compared, strict=True):
        heads += [run.name] if base is None else [run.name, f"change from {runs[base].name}" if base else "change"]
    rows = []
    for name, unit in dict.fromkeys(key for table_of_run in figures for key in table_of_run):
        values = [table_of_run.get((name, unit)) for table_of_run in figures]
        cells = []
        for value, base in zip(values, compared, strict=True):
            cells += [number(value)] if base is None else [number(value), difference(values[base], value, unit)]
        rows.append((f"{name} [{unit}]" if unit else name, *cells))
    return heads, rows


def _figures_of_many(runs: Sequence[FinishedRun]) -> Table:
    """Return the key figures of runs: a row for each run."""
    figures = [key_figures(run) for run in runs]
    keys = list(dict.fromkeys(key for table_of_run in figures for key in table_of_run))
    heads = ["run", *(f"{name} [{unit}]" if unit else name for name, unit in keys)]
    return heads, [
        (run.name, *(number(table_of_run.get(key)) for key in keys))
        for run, table_of_run in zip(runs, figures, strict=True)
    ]


def _notices(runs: Sequence[FinishedRun]) -> list[str]:
    """Return the notices of all runs; those that are not of all runs name theirs."""
    of_runs = {run.name: without_general(run.summary.notices, run.car.vehicle) for run in runs}
    texts = dict.fromkeys(text for notices in of_runs.values() for text in notices)
    items = []
    for text in texts:
        names = [name for name, notices in of_runs.items() if text in notices]
        items.append(text if len(names) == len(runs) else f"{', '.join(names)}: {text}")
    return [*items, *wheelbase_words(runs)]


def wheelbase_words(runs: Sequence[FinishedRun]) -> list[str]:
    """Return a notice if the wheelbase filter of runs on roads differs: wheelbase l or speed v.

    On equal tracks the wheels of an axle at a distance l follow after l/v, so the mean of both axles has zeros at odd
    multiples of v/(2 l) and their difference has zeros at multiples of v/l (Gillespie, Fundamentals of Vehicle
    Dynamics, chapter 5).
    """
    rates = {}
    for run in runs:
        speed, places = run.car.vehicle.driving.speed, [wheel.patch[0] for wheel in run.car.vehicle.composition.wheels]
        if run.summary.input.road and speed > 0.0 and np.ptp(places) > 0.0:
            rates[run.name] = speed / float(np.ptp(places))
    if not rates or max(rates.values()) - min(rates.values()) <= LEAST_SHIFT * max(rates.values()):
        return []
    values = ", ".join(f"{name} {number(0.5 * rate)}" for name, rate in rates.items())
    return [
        "wheelbase or speed differ, so the rear wheels follow after another time: spectra and FRFs have their gaps of "
        f"bounce at odd multiples of half of speed over wheelbase ({values} Hz), of pitch at even ones; differences "
        "there do not come from the suspension"
    ]


def curves_over_each_other(runs: Sequence[FinishedRun]) -> Markup:
    """Return the plot of all FRFs, and the spectra of all runs."""
    parts = []
    for motion in runs[0].responses:
        with_response = {
            run.name: (run, response.response)
            for run in runs
            for response in run.responses
            if response.input == motion.input
        }
        if len(with_response) < 2:
            continue
        wheel, wheels = motion.first, runs[0].car.vehicle.wheels
        wanted = {
            f"knuckle_{wheel}_acc_z": f"Knuckle, {wheel_words(wheel, wheels)}",
            "seat_rail_acc_z": "Seat rail",
            "engine_acc_z": "Engine",
        }
        channels = shared_channels([run for run, _ in with_response.values()], wanted)
        several = any(len(run.responses) > 1 for run, _ in with_response.values())
        plates = " and ".join(side_of(each, wheels) for each in motion.motion)
        title = "Vertical frequency responses of all runs" + (f" from the plate {plates}" if several else "")
        parts.append(
            drawing(partial(plot_responses, runs=with_response, channels=channels, title=title, size=SIZE), title)
        )
    parts.append(spectra(runs))
    return Markup().join(parts)
