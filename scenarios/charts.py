"""Charts with title, caption and units: FRFs, time histories, lines; written whole or not at all."""

import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from scenarios.legend_room import make_room
from vehicle.arrays import Complex, Vector
from vehicle.drawing.rendering.figure import COLOURS, FADED, fading, frf_axes, saved_figure, wrapped_phase
from vehicle.runs.output.folder import write_whole
from vehicle.signals.analysis.frf import FrequencyResponse

LEVEL_COLOURS = (COLOURS[0], COLOURS[3], COLOURS[1])
"""Blue, orange and red for low, mid and high; for two variants the first and the last."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrfCurve:
    """FRF curve of a chart."""

    label: str  # legend text
    frequency: Vector  # frequencies [Hz], (m,)
    response: Complex  # FRF [m/s2 per m], (m,); NaN at gaps
    colour: str  # colour of the line
    coherence: Vector | None = None  # coherence [-], (m,); None for a linear model
    style: str = "-"  # style of the line


def measured_curve(response: FrequencyResponse, row: int, label: str, colour: str, style: str = "-") -> FrfCurve:
    """Return the curve of one row of an estimated FRF."""
    return FrfCurve(
        label=label,
        frequency=response.frequency,
        response=response.response[row],
        coherence=response.coherence[row],
        colour=colour,
        style=style,
    )


def draw_frf(
    path: Path,
    title: str,
    caption: str,
    columns: Sequence[tuple[str, Sequence[FrfCurve]]],
    marks: Sequence[tuple[str, float, str]] = (),
) -> None:
    """Write a figure of FRFs: magnitude (log), phase and coherence over 1 to 50 Hz, one column for each group.

    Args:
        path: PNG file.
        title: over all columns.
        caption: estimator, averages, level and engine.
        columns: title and curves of each.
        marks: label, frequency [Hz] and colour of vertical lines in all columns.
    """
    if any(curve.coherence is not None for _, curves in columns for curve in curves):
        caption = f"{caption.rstrip('.')}; {FADED}"
    with figure_file(path, (max(7.2, 5.2 * len(columns)), 7.4), title, caption) as figure:
        axes = figure.subplots(3, len(columns), sharex=True, sharey="row", height_ratios=(2.4, 1.0, 0.9), squeeze=False)
        for (heading, curves), (magnitude, phase, coherence) in zip(columns, axes.T, strict=True):
            for curve in curves:
                look = {"color": curve.colour, "linestyle": curve.style}
                weight = np.ones(curve.frequency.size) if curve.coherence is None else curve.coherence
                fading(magnitude, curve.frequency, np.abs(curve.response), weight, curve.label, **look)
                phase.plot(curve.frequency, wrapped_phase(curve.response), **look)
                if curve.coherence is not None:
                    coherence.plot(curve.frequency, curve.coherence, **look)
            for label, frequency, colour in marks:
                for axis in (magnitude, phase):
                    axis.axvline(frequency, color=colour, linestyle="--", linewidth=0.9, label=label)
            magnitude.set_title(heading)
            magnitude.legend(loc="best")
        frf_axes(figure, axes, (0, 0.5, 1))


@contextmanager
def figure_file(
    path: Path, size: tuple[float, float], title: str, caption: str, *, placed: bool = False
) -> Iterator[Any]:
    """Yield an empty figure; on exit write it with title and caption to a temporary file and rename the file.

    Args:
        path: PNG file.
        size: width and height [inch].
        title: title of the figure; may be empty.
        caption: content and conditions of the figure.
        placed: see `saved_figure`.
    """
    draft = path.with_name(f".{path.name}.draft.png")
    try:
        with saved_figure(draft, size, title, textwrap.fill(caption, int(14.5 * size[0])), placed=placed) as figure:
            yield figure
            for panel in figure.axes:
                make_room(panel)
        write_whole(path, lambda temporary: draft.replace(temporary))
    finally:
        draft.unlink(missing_ok=True)


@contextmanager
def chart(
    path: Path, caption: str, *, rows: int = 1, columns: int = 1, size: tuple[float, float] = (9.0, 5.0)
) -> Iterator[Sequence[Any]]:
    """Yield the axes of a figure without title, row by row; arguments as in `figure_file`."""
    with figure_file(path, size, "", caption) as figure:
        yield figure.subplots(rows, columns, squeeze=False).ravel()


def lines(
    panel: Any,
    x: npt.ArrayLike,
    curves: Sequence[tuple[str | None, npt.ArrayLike, str, str]],
    *,
    xlabel: str,
    ylabel: str,
    title: str = "",
) -> None:
    """Draw curves (label, values, colour, line style) over a common axis; without label a curve has no legend entry."""
    for label, values, colour, style in curves:
        panel.plot(x, values, color=colour, linestyle=style, linewidth=1.4, label=label)
    panel.set(xlabel=xlabel, ylabel=ylabel, title=title)
    if any(label for label, *_ in curves):
        panel.legend(loc="upper right")


def rows_of(figure: Any, count: int, columns: int, **options: Any) -> Any:
    """Return axes of a grid of time histories: a common time axis in each column, labels only at the bottom."""
    axes = figure.subplots(count, columns, sharex="col", squeeze=False, **options)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    figure.align_ylabels(axes[:, 0])
    return axes
