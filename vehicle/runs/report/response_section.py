"""Section of the report with FRFs and resonances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.frf_plot import plot_frfs
from vehicle.engines.linear.car_modes import Mode
from vehicle.runs.report.findings import main_points, nearest_mode
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.runs.report.svg_figure import drawing

fill = templates(__file__)

SIZE = (PAGE_WIDTH, 5.2)
"""Width and height of the figure [inch]."""

STRONGEST = 6
"""Maximum number of resonances of an output point in a table."""


def responses(run: FinishedRun, modes: Mapping[str, Sequence[Mode]]) -> Markup:
    """Return FRFs and tables of resonances of a run with FRFs."""
    figure = drawing(
        lambda path: plot_frfs(path, run, run.responses, run.caption, SIZE), f"Frequency responses of {run.name}"
    )
    return fill("responses", figure=figure, tables=_resonances(run, modes))


def _resonances(
    run: FinishedRun, modes: Mapping[str, Sequence[Mode]]
) -> list[tuple[str, list[tuple[str, str, str, str]]]]:
    """Return captions and rows of the highest resonances of the main output points with the nearest modes."""
    tables = []
    main = [
        (f" to motion of the {plate}" if plate else "", point, resonances.get(channel, ()))
        for wheel, plate, resonances in run.peaks
        for channel, point in main_points(run, wheel).items()
    ]
    for plate, point, all_peaks in main:
        peaks = sorted(all_peaks, key=lambda peak: -peak["magnitude"])[:STRONGEST]
        rows = []
        for peak in sorted(peaks, key=lambda peak: peak["frequency_hz"]):
            state, mode = nearest_mode(run, peak["frequency_hz"], modes)
            near = "" if mode is None else f"{mode.frequency:.2f} Hz, {mode.description}"
            rows.append((near, f"{peak['frequency_hz']:.2f}", number(peak["magnitude"]), number(peak["coherence"])))
        if rows:
            count = f"the {len(rows)} highest" if len(rows) > 1 else "one found"
            caption = f"Vertical resonances at the {point}{plate}: {count}; modes with {state}"
            tables.append((caption, rows))
    return tables
