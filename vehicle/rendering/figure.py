"""Figures without global state: the Agg canvas, one style, the same bytes for the same data."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#1f5fa8", "#d1495b", "#2e8b57", "#d98e04", "#6a4c93")
"""Line colours, told apart in print and by most colour-blind readers."""

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


@contextmanager
def saved_figure(path: Path, size: tuple[float, float]) -> Iterator[Figure]:
    """Give an empty figure; write it as PNG when the block is done.

    Args:
        path: PNG file.
        size: width and height [inch].

    Yields:
        The figure.
    """
    from matplotlib import style
    from matplotlib.figure import Figure

    # The reader's own matplotlibrc must not change the files of a run.
    with style.context(["default", STYLE]):
        figure = Figure(figsize=size, layout="constrained")
        yield figure
        figure.savefig(path, format="png", metadata={"Software": None})
