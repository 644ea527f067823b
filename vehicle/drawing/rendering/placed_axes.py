"""Axes at places given in inches.

A layout that is found from the words as they are drawn costs more than the drawing. The pictures of a run have the same
words every time, so that the room they need is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LABEL_DISTANCE = 0.52
"""From an axis to the near edge of its vertical label [inch]: room for five digits, a sign and a point."""

LABEL_DEPTH = 0.25
"""From an axis to the upper edge of its horizontal label [inch]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Margins:
    """Room around and between axes [inch]."""

    left: float
    right: float
    bottom: float
    top: float
    across: float = 0.0
    """between columns"""
    down: float = 0.0
    """between rows"""


def placed_axes(
    figure: Figure,
    margins: Margins,
    *,
    widths: Sequence[float] = (1.0,),
    heights: Sequence[float] = (1.0,),
    sharex: bool = False,
    sharey: Literal["row", "none"] = "none",
) -> npt.NDArray[Any]:
    """Axes in rows and columns, whose labels and titles have fixed places too.

    Args:
        figure: the figure, as of `saved_figure` with `placed`.
        margins: room around them.
        widths: of the columns, relative to each other.
        heights: of the rows.
        sharex: one horizontal scale for all.
        sharey: "row" for one vertical scale in each row.

    Returns:
        The axes, (rows, columns).
    """
    width, height = (float(size) for size in figure.get_size_inches())
    gaps_across, gaps_down = (len(widths) - 1) * margins.across, (len(heights) - 1) * margins.down
    wide, high = width - margins.left - margins.right - gaps_across, height - margins.bottom - margins.top - gaps_down
    grid = figure.add_gridspec(
        len(heights),
        len(widths),
        left=margins.left / width,
        right=1.0 - margins.right / width,
        bottom=margins.bottom / height,
        top=1.0 - margins.top / height,
        wspace=margins.across * len(widths) / wide,
        hspace=margins.down * len(heights) / high,
        width_ratios=widths,
        height_ratios=heights,
    )
    axes = np.asarray(grid.subplots(sharex=sharex, sharey=sharey, squeeze=False))
    for row, upward in zip(axes, heights, strict=True):
        for axis, along in zip(row, widths, strict=True):
            axis.yaxis.set_label_coords(-LABEL_DISTANCE * sum(widths) / (wide * along), 0.5)
            axis.xaxis.set_label_coords(0.5, -LABEL_DEPTH * sum(heights) / (high * upward))
            axis.set_title("", y=1.0)  # left to itself, it looks for what it could stand on
    return axes
