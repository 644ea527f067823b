"""Figures without global state: Agg canvas, one style, bitwise reproducible files."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Mask
from vehicle.drawing.rendering.grid_lines import bared, draw_grid
from vehicle.signals.analysis.samples import Complex, Vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#1a73c4", "#b3261e", "#35ab8f", "#eeaa1c", "#3d1560")
"""Line colours of every figure and film: blue, red, green, amber, violet. With and without red or green sight any two
are at least six just noticeable differences apart, and as far from the paper."""

LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
"""Line styles in addition to the colours, to distinguish curves in black-and-white print."""

FADING = ((-1.0, 0.5, 0.2), (0.5, 0.8, 0.5), (0.8, 2.0, 1.0))
"""Ranges of coherence and the opacity of a magnitude in each: motion that the plate does not cause is pale."""

FADED = "pale: coherence below 0.8; very pale, without band: below 0.5"
"""Explanation of `FADING` and `SHOWN_BAND` in a caption."""

SHOWN_BAND = 0.5
"""Coherence from which the band of the random error is drawn: below it the band is wider than the magnitude and would
cover the other curves."""

PAGE_WIDTH = 9.5
"""Width of a figure of a report [inch]: on 180 mm of paper its text of 9 points has 6.7 points."""

EDGE = 0.06
"""Distance of title and caption from the edge of a figure with placed axes [inch]."""

COMPRESSION = 3
"""Compression level of PNG files: higher levels take three times as long and save a tenth of the file."""

LETTERS_PER_INCH = 15.0
"""Letters of a caption on an inch of its figure: DejaVu Sans has 0.55 em a letter on average, here of 8.5 points."""

INK = "#444444"
"""Colour of captions."""

UNDRIVEN = "#ececec"
"""Colour of a frequency band without an FRF."""

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

FRF_BAND = (1.0, 50.0)
FRF_TICKS = (1, 2, 3, 5, 10, 20, 30, 50)
"""Frequency axis of an FRF [Hz]."""

COMFORT_TICKS = (0.5, 1, 2, 5, 10, 20, 50)
"""Frequency axis of a spectrum of comfort [Hz]."""

FULL_LABEL = 7.0
"""Height of a figure [inch] with space for the whole label of the magnitude of an FRF."""

STYLE = {
    "figure.dpi": 110,
    "font.size": 9,
    "axes.grid": True,
    "axes.grid.which": "both",
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "lines.linewidth": 1.1,
    "legend.fontsize": 8,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "agg.path.chunksize": 20000,
}

SVG = {
    "svg.hashsalt": "vehicle",
    "svg.fonttype": "none",
    "path.simplify_threshold": 0.35,
    "savefig.dpi": 160,
}
"""SVG settings: text as text, reproducible names of elements, lines simplified below a third of a dot."""


@contextmanager
def saved_figure(
    path: Path, size: tuple[float, float], title: str = "", caption: str = "", *, placed: bool = False
) -> Iterator[Figure]:
    """Yield an empty figure, and write the file at the end of the block.

    Args:
        path: PNG or SVG file, by its extension.
        size: width and height [inch].
        placed: the axes come from `placed_axes`, so that no layout is computed.

    Yields:
        The figure.
    """
    from matplotlib import rc_context, rcParamsDefault
    from matplotlib.figure import Figure

    # The matplotlibrc of the user must not change the files of a run. A figure needs no backend, which loads pyplot.
    form = "svg" if path.suffix == ".svg" else "png"
    defaults = {name: value for name, value in rcParamsDefault.items() if name != "backend"}
    with rc_context({**defaults, **STYLE, **(SVG if form == "svg" else {})}):
        figure = Figure(figsize=size, layout=None if placed else "constrained")
        yield figure
        parts: list[Any] = [figure, *figure.subfigs]
        grids = [(axes, bared(axes)) for part in parts for axes in part.axes]
        edge = EDGE / size[1]
        if title:
            figure.suptitle(title, fontsize=12, **({"y": 1.0 - edge} if placed else {}))
        if caption:
            figure.supxlabel(caption, fontsize=8.5, color=INK, **({"y": edge} if placed else {}))
        # Compute the layout once; savefig would draw everything once more for it.
        engine = figure.get_layout_engine()
        if engine is not None:
            engine.execute(figure)
            figure.set_layout_engine(None)
        for axes, grid in grids:
            draw_grid(axes, grid)
        save_options: dict[str, Any] = {
            "metadata": dict.fromkeys(("Date", "Creator") if form == "svg" else ("Software",))
        }
        if form == "png":
            save_options["pil_kwargs"] = {"compress_level": COMPRESSION}
        figure.savefig(path, format=form, **save_options)


def wrapped(caption: str, width: float) -> str:
    """Return a caption, one line of text, in lines that fit under a figure of a width [inch]."""
    return textwrap.fill(caption, int(LETTERS_PER_INCH * width))


def power_of_ten(value: float, _: int | None = None) -> str:
    """Return the label of a decade as plain text; the labels of matplotlib need its parser of formulas."""
    return "10" + str(round(np.log10(value))).translate(SUPERSCRIPTS)


def frf_axes(figure: Figure, axes: npt.NDArray[Any], coherence_ticks: tuple[float, ...]) -> None:
    """Set scales, limits and labels of magnitude, phase and coherence over one logarithmic frequency axis.

    Args:
        axes: axes of the figure, (3, columns), with y shared by rows.
    """
    upper, middle, lower = axes[:, 0]
    low = figure.get_size_inches()[1] < FULL_LABEL
    label = "FRF [(m/s²)/m]" if low else "acceleration / plate displacement [(m/s²)/m]"
    upper.set(xscale="log", yscale="log", xlim=FRF_BAND, ylabel=label)
    middle.set(ylim=(-180.0, 180.0), yticks=(-180, -90, 0, 90, 180), ylabel="phase [deg]")
    lower.set(ylim=(0.0, 1.05), yticks=coherence_ticks, ylabel="coherence [-]")
    upper.yaxis.set_major_formatter(power_of_ten)
    for axis in axes[2]:
        axis.set_xlabel("frequency [Hz]")
        frequency_ticks(axis, FRF_TICKS)
    figure.align_ylabels(axes[:, 0])


def frequency_ticks(axis: Axes, ticks: Sequence[float]) -> None:
    """Label a logarithmic frequency axis at some frequencies [Hz], without any other ticks."""
    axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.set_xticks([], minor=True)


def looks() -> Iterator[dict[str, Any]]:
    """Yield colour and line style of one curve after another, without an end."""
    for colour, line in cycle(zip(COLOURS, LINES, strict=True)):
        yield {"color": colour, "linestyle": line}


def wrapped_phase(response: Complex) -> Vector:
    """Return the phase [deg] between -180 and 180, with NaN after each jump so that no line crosses the picture.

    Returns:
        Phase of a line to draw, (m,), with NaN at the first point after a jump.
    """
    phase = np.degrees(np.angle(response))
    phase[np.flatnonzero(np.abs(np.diff(phase)) > 180.0) + 1] = np.nan
    return np.asarray(phase)


def fading(
    axis: Axes,
    frequency: Vector,
    values: Vector,
    coherence: Vector,
    label: str | None = None,
    **style: Any,
) -> None:
    """Draw a magnitude that is pale where its coherence is low.

    Args:
        frequency: [Hz], (m,).
        values: magnitude, (m,).
        coherence: gamma^2 [-], (m,); where it is unknown the line is not pale.
    """
    finite = np.where(np.isfinite(coherence), coherence, 1.0)
    for lowest, highest, opacity in FADING:
        in_range = (finite >= lowest) & (finite < highest)
        # One more point, so that the segments join.
        joined = in_range | np.concatenate([[False], in_range[:-1]])
        label_of_line = label if opacity == 1.0 else None
        if label_of_line or joined.any():
            axis.plot(frequency, np.where(joined, values, np.nan), alpha=opacity, label=label_of_line, **style)


def error_band(
    axis: Axes,
    frequency: Vector,
    values: Vector,
    half: Vector,
    coherence: Vector,
    colour: str,
) -> None:
    """Draw the band of the random error of a magnitude, not where the coherence is below `SHOWN_BAND`.

    Args:
        frequency, values: see `fading`.
        half: half width of the band, (m,).
        coherence: gamma^2 [-], (m,); where it is unknown the band is drawn.
    """
    low = np.maximum(values - half, 0.01 * values)
    where = ~(coherence < SHOWN_BAND)
    axis.fill_between(frequency, low, values + half, where=where, alpha=0.25, linewidth=0.0, color=colour)


def shade(axis: Axes, along: npt.ArrayLike, where: Mask, colour: str, label: str | None = None) -> None:
    """Colour the whole height of an axis where something holds.

    Args:
        along: places on its horizontal scale, (n,).
        where: whether it holds there, (n,).
    """
    if not where.any():
        return
    transform = axis.get_xaxis_transform()
    axis.fill_between(along, 0.0, 1.0, where=where, transform=transform, color=colour, zorder=0, label=label)


def name_bars(axis: Axes, values: Sequence[float] | Vector, texts: Sequence[str], distance: float) -> None:
    """Write a text at the end of each horizontal bar, outside of the bar.

    Args:
        values: ends of the bars, (n,).
        distance: distance of the text from the end [point].
    """
    for row, (value, text) in enumerate(zip(values, texts, strict=True)):
        side, across = (distance, "left") if value >= 0.0 else (-distance, "right")
        axis.annotate(text, (value, row), (side, 0), textcoords="offset points", va="center", ha=across, fontsize=8)
