"""Tornado chart: the changes of a value by single parameters, the largest on top."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure
from vehicle.signals.analysis.samples import Vector

SMOOTHER, ROUGHER = COLOURS[0], COLOURS[3]
"""Colours of a change: less and more acceleration. Blue and amber differ for every eye."""


def plot_tornado(
    path: Path,
    labels: Sequence[str],
    changes: Vector,
    half_widths: Vector,
    ends: Sequence[tuple[str, str]],
    title: str = "",
    caption: str = "",
) -> None:
    """Write a tornado chart.

    Args:
        path: PNG or SVG file.
        labels, changes, half_widths, ends: see `draw_tornado`.
        title, caption: above and below the figure.
    """
    with saved_figure(path, (8.0, 1.9 + 0.36 * len(labels)), title, caption) as figure:
        draw_tornado(figure.subplots(), labels, changes, half_widths, ends)


def draw_tornado(
    axis: Any, labels: Sequence[str], changes: Vector, half_widths: Vector, ends: Sequence[tuple[str, str]]
) -> None:
    """Draw two bars for each parameter, its low and its high value, with their 95 % interval.

    Blue bars are smoother, amber bars rougher; the text at a bar is the value of the parameter.

    Args:
        axis: the axes.
        labels: parameters; the first is on top.
        changes: changes at the low and the high value [%], (parameters, 2); NaN draws no bar.
        half_widths: half widths of the intervals [%], (parameters,); NaN draws none.
        ends: names of the low and the high value of each parameter, as "-20 %".
    """
    rows, width = np.arange(len(labels), dtype=float), np.nan_to_num(half_widths)
    for column, names_of_end in enumerate(zip(*ends, strict=True)):
        height = rows + (0.19 if column else -0.19)
        values = np.nan_to_num(changes[:, column])
        axis.barh(height, values, 0.34, color=np.where(values > 0.0, ROUGHER, SMOOTHER))
        shown = np.isfinite(half_widths) & np.isfinite(changes[:, column])
        axis.errorbar(values[shown], height[shown], xerr=half_widths[shown], fmt="none", ecolor=INK, elinewidth=0.9)
        names = [
            name if np.isfinite(change) else f"{name} failed"
            for name, change in zip(names_of_end, changes[:, column], strict=True)
        ]
        for row, value, half, text in zip(height, values, width, names, strict=True):
            side, across = (3, "left") if value > 0.0 or (value == 0.0 and column) else (-3, "right")
            end = value + np.copysign(half, side)
            axis.annotate(text, (end, row), (side, 0), textcoords="offset points", va="center", ha=across, fontsize=8)
    axis.axvline(0.0, color=INK, linewidth=0.8)
    axis.set_yticks(rows, labels, fontsize=9)
    axis.invert_yaxis()
    # The texts at the bars are not part of the data: room for them on both sides.
    axis.margins(x=0.22)
    axis.set_xlabel("change [%]; blue: smoother, amber: rougher")
    axis.grid(visible=False, axis="y")
