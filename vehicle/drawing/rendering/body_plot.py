"""Picture of a body model: its first modes as wireframes, at rest and at the end of a swing."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Indices
from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.figure import COLOURS, saved_figure
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.thinned_wireframe import thinned

MOST = 12
"""Maximum number of modes in a picture."""

SWING = 0.12
"""Largest displacement drawn, over the length of the body."""

DENSE = 500
"""Number of lines above which they are drawn thinner, since a dense mesh would be a dark patch."""

VIEW = np.array([[0.80, 0.60, 0.0], [-0.23, 0.31, 0.92]])
"""Right and up of the page over x to the rear, y to the right, z up: seen from the left in front, 23 degrees above."""


def plot_body(
    path: Path,
    positions: Vector,
    edges: npt.NDArray[Any],
    shapes: Vector,
    titles: Sequence[str],
    attachments: Indices,
    title: str,
    caption: str,
) -> None:
    """Write the picture of the first modes.

    Args:
        positions: positions of the nodes in the vehicle frame [m], (n, 3).
        edges: pairs of nodes, (m, 2); if empty, nodes are drawn as dots.
        shapes: shapes of the modes, (modes, n, 3); the first `MOST` are drawn.
        attachments: nodes at which the car is fixed to the body, shown as dots.
    """
    from matplotlib.collections import LineCollection

    count, edges = min(len(shapes), MOST), thinned(positions, edges)
    columns = min(3, count)
    flat = positions @ VIEW.T
    length = float(np.ptp(positions, axis=0).max())
    dense = len(edges) > DENSE
    seen = np.unique(np.concatenate([edges.ravel(), attachments])) if len(edges) else np.arange(len(positions))
    with saved_figure(path, (4.0 * columns, 2.9 * -(-count // columns) + 0.9), title, caption) as figure:
        grid = np.atleast_1d(figure.subplots(-(-count // columns), columns, squeeze=False)).ravel()
        for axis, shape, title_of_mode in zip(grid, shapes, titles, strict=False):
            size = np.linalg.norm(shape, axis=1)
            # Nodes without lines are not in the picture and must not determine its scale.
            largest = float(size[seen].max()) or 1.0
            moved = (positions + SWING * length / largest * shape) @ VIEW.T
            if len(edges):
                at_rest: Any = LineCollection(flat[edges], colors="#b8b8b8", linewidths=0.3 if dense else 0.6)
                axis.add_collection(at_rest)
                shades = colours(size[edges].mean(axis=1), largest)
                swung: Any = LineCollection(moved[edges], colors=shades, linewidths=0.6 if dense else 1.4)
                axis.add_collection(swung)
            else:
                axis.scatter(*flat.T, s=4, color="#b8b8b8")
                axis.scatter(*moved.T, s=16, c=colours(size, largest))
            axis.scatter(*moved[attachments].T, s=6, color=COLOURS[4], zorder=3)
            axis.set_title(title_of_mode, fontsize=8.5)
            axis.set_aspect("equal")
            axis.margins(0.04)
            axis.autoscale_view()
            axis.set_axis_off()
        for axis in grid[count:]:
            axis.set_visible(False)
