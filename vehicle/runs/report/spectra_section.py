"""Section of the report with spectra of the seat rail and the seat, and the level of the road."""

from collections.abc import Sequence
from functools import partial

from markupsafe import Markup

from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.spectra_plot import plot_spectra
from vehicle.errors import DataError
from vehicle.names import CORNERS, wheel_words
from vehicle.runs.output.spectra_files import picture_columns
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.runs.report.svg_figure import drawing
from vehicle.signals.records.record_spectra import RecordSpectra, recorded_spectra

fill = templates(__file__)


def spectra(runs: Sequence[FinishedRun]) -> Markup:
    """Return figures of spectra of one run, or of several runs over each other, and the levels of their roads."""
    try:
        of_runs = {run.name: _spectra(run) for run in runs}
        pictures = picture_columns(list(of_runs.values()))
    except DataError as error:
        return fill("spectra", error=error)
    by_name = {name: run.channels for name, run in of_runs.items()}
    caption = "; ".join(dict.fromkeys(run.caption for run in of_runs.values()))
    figures = [
        drawing(
            partial(plot_spectra, runs=by_name, channels=columns, title=title, caption=caption, max_width=PAGE_WIDTH),
            title,
        )
        for title, columns in pictures.values()
    ]
    roads = [
        (name, wheel_words(wheel, CORNERS.values()), level)
        for name, run in of_runs.items()
        for wheel, level in run.road_levels.items()
    ]
    return fill("spectra", error=None, single=len(runs) == 1, figures=figures, roads=roads)


def _spectra(run: FinishedRun) -> RecordSpectra:
    names = [f"{point}_acc_{axis}" for point in _points(run) for axis in "xyz"]
    recorded = [name for name in names if name in run.recording.channels]
    if not recorded:
        raise DataError("the run records no acceleration of a seat rail or seat")
    return recorded_spectra(
        run.recording,
        run.name,
        run.caption,
        recorded,
        begin=run.skip,
        road=run.summary.input.road,
    )


def _points(run: FinishedRun) -> tuple[str, ...]:
    """Return the points of the figures: the seat only if the car has one."""
    return ("seat_rail", "seat") if run.summary.seat_value is not None else ("seat_rail",)
