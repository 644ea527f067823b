"""Section of the report with spectra of the seat rail and the seat, and the level of the road."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

from vehicle.digits import number
from vehicle.drawing.rendering.figure import PAGE_WIDTH
from vehicle.drawing.rendering.spectra_plot import plot_spectra
from vehicle.errors import DataError
from vehicle.names import CORNERS, wheel_words
from vehicle.runs.output.spectra_files import picture_columns
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import Markup, joined, tag
from vehicle.runs.report.svg_figure import drawing
from vehicle.signals.records.record_spectra import RecordSpectra, evaluated_from, recorded_spectra

EXPLANATION = (
    "Thin: unweighted; thick and pale: weighted as on a seat (ISO 2631-1). One-third octaves and cumulative RMS come "
    "from the whole record, so that the bands add up to its RMS; where the cumulative RMS rises, vibration is added."
)


def spectra(runs: Sequence[FinishedRun]) -> Markup:
    """Return figures of spectra of one run, or of several runs over each other, and the levels of their roads."""
    try:
        of_runs = {run.name: _spectra(run) for run in runs}
        pictures = picture_columns(list(of_runs.values()))
    except DataError as error:
        return tag("p", f"No spectra: {error}.")
    by_name = {name: run.channels for name, run in of_runs.items()}
    caption = "; ".join(dict.fromkeys(run.caption for run in of_runs.values()))
    parts = [
        drawing(
            partial(plot_spectra, runs=by_name, channels=columns, title=title, caption=caption, max_width=PAGE_WIDTH),
            title,
        )
        for title, columns in pictures.values()
    ]
    return joined([*parts, tag("p", EXPLANATION), *_roads(of_runs)])


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
        begin=evaluated_from(run.summary),
        road=run.summary["input"].get("road"),
    )


def _points(run: FinishedRun) -> tuple[str, ...]:
    """Return the points of the figures: the seat only if the car has one."""
    return ("seat_rail", "seat") if run.summary.get("seat_value") is not None else ("seat_rail",)


def _roads(runs: Mapping[str, RecordSpectra]) -> list[Markup]:
    """Return a line on the road under each front wheel."""
    return [
        tag(
            "p",
            f"Road of {name} under the {wheel_words(wheel, CORNERS.values())}: "
            f"class {level.letter} of ISO 8608, G(0.1 cycles/m) = "
            f"{number(1e6 * level.reference_density)}·10⁻⁶ m³, fitted from {level.fitted[0]:.3g} to "
            f"{level.fitted[1]:.3g} cycles/m.",
        )
        for name, run in runs.items()
        for wheel, level in run.road_levels.items()
    ]
