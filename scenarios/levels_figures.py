"""Figures of the three levels: the FRFs of chapter 3 of source 1, every output with all levels in one picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from scenarios.car_charts import LEVEL_COLOURS, FrfCurve, draw_frf, measured_curve
from scenarios.car_study import computed_by, estimator_text
from vehicle.analysis.frf import FrequencyResponse
from vehicle.car import Run

OUTPUTS = {
    "seat_rail_acc_z": ("seat_rail_z", "Seat rail, vertical (figures 3.3, 3.21, 3.22)"),
    "seat_acc_z": ("seat_z", "Seat, vertical (figures 3.4, 3.23, 3.24)"),
    "knuckle_fr_acc_z": ("knuckle_z", "Right knuckle, vertical (figures 3.5, 3.25, 3.26, 3.29, 3.30)"),
    "engine_acc_z": ("engine_z", "Engine, vertical (figures 3.7, 3.31, 3.32)"),
    "roof_left_rear_acc_z": ("roof_left_rear_z", "Roof left rear, vertical (figures 3.8, 3.33, 3.34)"),
    "body_front_acc_z": ("body_front_z", "Body front, vertical (figure 3.9)"),
    "seat_rail_acc_x": ("seat_rail_x", "Seat rail, longitudinal (figures 3.11, 3.35)"),
    "seat_rail_acc_y": ("seat_rail_y", "Seat rail, lateral (figures 3.10, 3.36)"),
}
"""Channel to the name of its file and its title, with the figures of source 1 that show it."""

DAMPER = ("knuckle_fr_acc_z", "damper_top_fr_acc_z")

CHANNELS = (*OUTPUTS, DAMPER[1])
"""Channels whose FRFs are estimated."""

LINEAR_LABEL = "linear model, dampers stuck"


def level_figures(
    folder: Path, runs: Mapping[str, Run], responses: Mapping[str, FrequencyResponse], outputs: Sequence[str]
) -> None:
    """Write one figure for each output, and one of damper top and knuckle together.

    Args:
        folder: where to.
        runs: level to run.
        responses: level to FRFs, rows as `CHANNELS`.
        outputs: channels of `OUTPUTS` to draw.
    """
    any_run = next(iter(runs.values()))
    lines = np.geomspace(1.0, 50.0, 800)
    linear = any_run.car.matrix_frf(outputs, lines)
    note = caption(runs, responses)
    for row, channel in enumerate(outputs):
        name, title = OUTPUTS[channel]
        curves = [
            measured_curve(responses[level], CHANNELS.index(channel), level, colour)
            for level, colour in zip(runs, LEVEL_COLOURS, strict=True)
        ]
        curves.append(FrfCurve(label=LINEAR_LABEL, frequency=lines, response=linear[row], colour="#222222", style=":"))
        draw_frf(folder / f"{name}.png", title, note, [("", curves)])
    columns = []
    for level in runs:
        pair = [
            measured_curve(responses[level], CHANNELS.index(channel), label, colour, style)
            for channel, label, colour, style in (
                (DAMPER[0], "knuckle", LEVEL_COLOURS[0], "-"),
                (DAMPER[1], "damper top", LEVEL_COLOURS[2], "--"),
            )
        ]
        columns.append((level, pair))
    title = "Right damper top and knuckle, vertical (figures 3.6, 3.27, 3.28)"
    draw_frf(folder / "damper_top_and_knuckle_z.png", title, note, columns)


def caption(runs: Mapping[str, Run], responses: Mapping[str, FrequencyResponse]) -> str:
    """Levels, estimator, averages, engine."""
    response = next(iter(responses.values()))
    run = next(iter(runs.values()))
    levels = ", ".join(f"{level} {1e3 * run.signal.rms(run.wheel):.3g} mm RMS" for level, run in runs.items())
    return (
        f"FRFs to the plate under the right front wheel. {levels}; {run.signal.duration:g} s each; "
        f"{estimator_text(response)}; {computed_by(run)}"
    )
