"""Section of a report: FRFs of the car at every level, where its dampers slip, and the damping that is left."""

from collections.abc import Sequence
from functools import partial

from markupsafe import Markup

from vehicle.drawing.rendering.level_plot import plot_level_map
from vehicle.runs.car.levels import FREQUENCY, LEVEL
from vehicle.runs.output.level_files import LevelReport, peak_table, slip_lines
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.runs.report.svg_figure import drawing

fill = templates(__file__)


def levels_section(motion: str, runs: Sequence[FinishedRun]) -> Markup:
    """Return chart and table of each car.

    Args:
        motion: motion of the plates, see `Car.levels`.
        runs: finished runs; equal cars have one chart.

    Raises:
        ConfigurationError: a motion or car without periodic states, see `Car.levels`.
    """
    charts = []
    for row, run in enumerate(runs):
        if any(run.car == before.car for before in runs[:row]):
            continue
        report = LevelReport(run.car.levels(plates=motion, frequency=FREQUENCY, level=LEVEL))
        title = f"{run.name}: {report.states.driven.words}" if len(runs) > 1 else report.states.driven.words
        chart = partial(plot_level_map, data=report.picture(0), rows=report.rows, title=title, caption=report.proof())
        heads, rows = peak_table(report)
        charts.append((drawing(chart, title), slip_lines(report), heads, rows, report.states.notices))
    return fill("levels", charts=charts)
