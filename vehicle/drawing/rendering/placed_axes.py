"""Axes at fixed positions in inches.

Computing a layout from the drawn text costs more than the drawing. The pictures of a run always have the same text, so
its size is known in advance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LABEL_DISTANCE = 0.52
"""Distance from an axis to its vertical label [inch]: space for five digits, a sign and a point."""

LABEL_DEPTH = 0.25
"""Distance from an axis to the upper edge of its horizontal label [inch]."""

CAPTION_LINE = 0.15
"""Height of a further line of a caption [inch]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Margins:
    """Margins around and between axes [inch]."""

    left: float
    right: float
    bottom: float
    top: float
    across: float = 0.0
    """between columns"""
    down: float = 0.0
    """between rows"""

    def above(self, caption: str) -> Margins:
        """Return the margins above a caption of one or several lines."""
        return replace(self, bottom=self.bottom + CAPTION_LINE * caption.count("\n"))


def placed_axes(
    figure: Figure,
    margins: Margins,
    *,
    widths: Sequence[float] = (1.0,),
    heights: Sequence[float] = (1.0,),
    sharex: bool = False,
    sharey: Literal["row", "none"] = "none",
) -> npt.NDArray[Any]:
    """Return axes in rows and columns, with labels and titles at fixed positions.

    Args:
        figure: figure from `saved_figure` with `placed`.
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
            axis.set_title("", y=1.0)  # otherwise matplotlib searches for a free position
    return axes
