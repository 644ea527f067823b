"""Line charts with caption and units, drawn off screen."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy.typing as npt

from scenarios.output_folder import write_figure

COLORS = ("#1b4965", "#c8553d", "#588157", "#8e6c8a", "#d4a017")
"""Line colours, told apart without colour vision by their lightness."""


@contextmanager
def chart(
    path: Path, caption: str, *, rows: int = 1, columns: int = 1, size: tuple[float, float] = (9.0, 5.0)
) -> Iterator[Sequence[Any]]:
    """Open a figure, hand out its axes row by row, put the caption below and save it as PNG.

    Args:
        path: file to write.
        caption: what is seen, under which conditions.
        rows: of panels.
        columns: of panels.
        size: width and height [inch].
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, layout="constrained")
    FigureCanvasAgg(figure)
    axes = [figure.add_subplot(rows, columns, index + 1) for index in range(rows * columns)]
    for panel in axes:
        panel.grid(True, color="#dddddd", linewidth=0.6)
    yield axes
    figure.supxlabel("\n".join(textwrap.wrap(caption, width=int(13 * size[0]))), fontsize=9, color="#444444")
    write_figure(path, figure)


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
    for label, values, color, style in curves:
        panel.plot(x, values, color=color, linestyle=style, linewidth=1.4, label=label)
    panel.set_xlabel(xlabel)
    panel.set_ylabel(ylabel)
    if title:
        panel.set_title(title, fontsize=10)
    if any(label for label, *_ in curves):
        panel.legend(fontsize=8, framealpha=0.9)
