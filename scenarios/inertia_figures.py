"""Figure 3.37 of source 1: the seat rail with both moments of inertia, in all three directions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from scenarios.car_charts import LEVEL_COLOURS, draw_frf, measured_curve
from scenarios.car_study import computed_by, estimator_text
from vehicle.analysis.frf import FrequencyResponse
from vehicle.car import Run

CHANNELS = ("seat_rail_acc_z", "seat_rail_acc_x", "seat_rail_acc_y")

TITLES = ("vertical (figure 3.37)", "longitudinal", "lateral")


def inertia_figure(
    path: Path, runs: Mapping[str, Run], responses: Sequence[FrequencyResponse], rolls: Sequence[float]
) -> None:
    """Write the FRFs of the seat rail, one column for each direction.

    Args:
        path: PNG file.
        runs: label to run.
        responses: FRFs of each, rows as `CHANNELS`.
        rolls: roll mode of each, dampers stuck [Hz].
    """
    colours = (LEVEL_COLOURS[0], LEVEL_COLOURS[2])
    columns = [
        (
            title,
            [
                measured_curve(response, row, label, colour)
                for label, response, colour in zip(runs, responses, colours, strict=True)
            ],
        )
        for row, title in enumerate(TITLES)
    ]
    marks = [(f"roll mode {roll:.2f} Hz", roll, colour) for roll, colour in zip(rolls, colours, strict=True)]
    run, response = next(iter(runs.values())), responses[0]
    caption = (
        "FRFs of the seat rail to the plate under the right front wheel, low level "
        f"({1e3 * run.signal.rms(run.wheel):.3g} mm RMS), {run.signal.duration:g} s; {estimator_text(response)}; "
        f"{computed_by(run)}. Dashed: roll mode from the matrices, dampers stuck"
    )
    draw_frf(path, "Seat rail with Ixx of the body 1000 and 1200 kg m²", caption, columns, marks)
