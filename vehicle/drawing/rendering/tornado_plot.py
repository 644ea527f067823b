"""Tornado chart: the changes of a value by single parameters, the largest on top."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure

Vector = npt.NDArray[np.float64]


def plot_tornado(
    path: Path,
    labels: Sequence[str],
    changes: Vector,
    half_widths: Vector,
    ends: tuple[str, str],
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


def draw_tornado(axis: Any, labels: Sequence[str], changes: Vector, half_widths: Vector, ends: tuple[str, str]) -> None:
    """Draw two bars for each parameter, its low and its high value, with their 95 % interval.

    Args:
        axis: the axes.
        labels: parameters; the first is on top.
        changes: changes at the low and the high value [%], (parameters, 2); NaN draws no bar.
        half_widths: half widths of the intervals [%], (parameters,); NaN draws none.
        ends: names of the low and the high value.
    """
    rows = np.arange(len(labels), dtype=float)
    with_interval = np.isfinite(half_widths)
    for column, (name, colour) in enumerate(zip(ends, (COLOURS[0], COLOURS[1]), strict=True)):
        height = rows + (0.19 if column else -0.19)
        values = changes[:, column]
        axis.barh(height, np.nan_to_num(values), 0.34, color=colour, label=name)
        shown = with_interval & np.isfinite(values)
        axis.errorbar(values[shown], height[shown], xerr=half_widths[shown], fmt="none", ecolor=INK, elinewidth=0.9)
    axis.axvline(0.0, color=INK, linewidth=0.8)
    axis.set_yticks(rows, labels, fontsize=8)
    axis.invert_yaxis()
    axis.set_xlabel("change of the weighted acceleration [%]")
    axis.grid(axis="x", alpha=0.3)
    axis.legend(loc="best", fontsize=8, frameon=False)
