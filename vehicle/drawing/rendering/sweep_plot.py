"""Picture of a sweep: comfort over a parameter, a map over two, or parallel axes over more."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure
from vehicle.signals.analysis.samples import Vector

MOST_LINES = 3000
"""Maximum number of cars drawn on parallel axes: the most comfortable and evenly spaced others."""

MOST_TICKS = 8
"""Maximum number of values of a parameter that all have a tick."""

COLOURS_OF_COMFORT = "viridis"

ABOVE: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 2}
"""Position of a legend above the axes, where it covers no cars."""


def plot_sweep(
    path: Path,
    names: Sequence[str],
    parameters: Vector,
    weighted: Vector,
    unweighted: Vector,
    title: str = "",
    caption: str = "",
) -> None:
    """Plot the comfort of the cars of a sweep; a star marks the most comfortable car, a circle the first.

    Args:
        names: varied parameters with units; at least one.
        parameters: values of the parameters; (cars, names).
        weighted: weighted RMS [m/s2]; (cars,).
        unweighted: unweighted RMS, 2 to 50 Hz [m/s2]; (cars,).
    """
    size = (7.6, 5.0) if len(names) < 3 else (2.4 + 1.7 * len(names), 5.4)
    with saved_figure(path, size, title, caption) as figure:
        draw_sweep(figure.subplots(), names, parameters, weighted, unweighted)


def draw_sweep(axis: Any, names: Sequence[str], parameters: Vector, weighted: Vector, unweighted: Vector) -> None:
    """Draw the comfort of the cars of a sweep: a line, a map, or parallel axes; arguments as in `plot_sweep`."""
    if len(names) == 1:
        _line(axis, names[0], parameters[:, 0], weighted, unweighted)
    elif len(names) == 2:
        _map(axis.figure, axis, names, parameters, weighted)
    else:
        _parallel(axis.figure, axis, names, parameters, weighted)


def _line(axis: Any, name: str, values: Vector, weighted: Vector, unweighted: Vector) -> None:
    order = np.argsort(values, kind="stable")
    curves = (("weighted (ISO 2631-1)", weighted, "-"), ("unweighted, 2 to 50 Hz", unweighted, "--"))
    for colour, (label, numbers, line) in zip(COLOURS, curves, strict=False):
        axis.plot(values[order], numbers[order], marker="o", markersize=4, color=colour, linestyle=line, label=label)
    _mark(axis, values, weighted, weighted)
    axis.set(xlabel=name, ylabel="RMS acceleration [m/s²]", ylim=(0.0, None))
    axis.legend()


def _map(figure: Any, axis: Any, names: Sequence[str], parameters: Vector, weighted: Vector) -> None:
    columns, rows = (np.unique(parameters[:, column]) for column in (0, 1))
    if columns.size * rows.size == weighted.size and min(columns.size, rows.size) > 1:
        grid = np.full((rows.size, columns.size), np.nan)
        grid[np.searchsorted(rows, parameters[:, 1]), np.searchsorted(columns, parameters[:, 0])] = weighted
        shown = axis.pcolormesh(columns, rows, grid, cmap=COLOURS_OF_COMFORT, shading="nearest")
        for ticks, values in ((axis.set_xticks, columns), (axis.set_yticks, rows)):
            if values.size <= MOST_TICKS:
                ticks(values, labels=[f"{value:g}" for value in values])
    else:
        shown = axis.scatter(parameters[:, 0], parameters[:, 1], c=weighted, cmap=COLOURS_OF_COMFORT, s=40)
    _mark(axis, parameters[:, 0], parameters[:, 1], weighted)
    axis.set(xlabel=names[0], ylabel=names[1])
    axis.grid(visible=False)
    axis.legend(**ABOVE)
    figure.colorbar(shown, ax=axis, label="weighted RMS [m/s²] (ISO 2631-1)")


def _parallel(figure: Any, axis: Any, names: Sequence[str], parameters: Vector, weighted: Vector) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.collections import LineCollection
    from matplotlib.colors import Normalize

    low, high = parameters.min(axis=0), parameters.max(axis=0)
    shares = (parameters - low) / np.where(high > low, high - low, 1.0)
    order = np.argsort(-np.nan_to_num(weighted, nan=np.inf), kind="stable")
    drawn = order[:: max(order.size // MOST_LINES, 1)]
    scale = Normalize(float(np.nanmin(weighted)), float(np.nanmax(weighted)))
    colours = ScalarMappable(scale, COLOURS_OF_COMFORT)
    across = np.arange(len(names))
    lines = [np.column_stack([across, shares[car]]) for car in drawn]
    axis.add_collection(LineCollection(lines, colors=colours.to_rgba(weighted[drawn]), linewidths=0.8, alpha=0.6))
    best = int(np.nanargmin(weighted))
    axis.plot(across, shares[best], color="black", linewidth=2.4, label="most comfortable")
    axis.plot(across, shares[0], color="black", linewidth=1.6, linestyle="--", label="first car")
    axis.set(xlim=(-0.2, len(names) - 0.8), ylim=(-0.08, 1.08), yticks=[], xticks=across)
    axis.set_xticklabels([name.replace(".", ".\n") for name in names])
    for column in across:
        axis.annotate(f"{high[column]:.6g}", (column, 1.02), ha="center", va="bottom", fontsize=8, color=INK)
        axis.annotate(f"{low[column]:.6g}", (column, -0.02), ha="center", va="top", fontsize=8, color=INK)
    axis.legend(**ABOVE)
    figure.colorbar(colours, ax=axis, label="weighted RMS [m/s²] (ISO 2631-1)")


def _mark(axis: Any, x: Vector, y: Vector, weighted: Vector) -> None:
    """Mark the most comfortable car and the first car."""
    from matplotlib.patheffects import withStroke

    best, halo = int(np.nanargmin(weighted)), [withStroke(linewidth=3.5, foreground="white")]
    # Black and white are seen on every colour of a map.
    star = {"marker": "*", "markersize": 15, "color": "white", "markeredgecolor": "black"}
    circle = {"marker": "o", "markersize": 17, "markerfacecolor": "none", "markeredgecolor": "black"}
    for index, look, label in ((best, star, "most comfortable"), (0, circle, "first car")):
        axis.plot(x[index], y[index], linestyle="none", label=label, path_effects=halo, **look)
