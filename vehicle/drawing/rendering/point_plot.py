"""Picture of the points of an axle over its template: from the side, from behind and from above."""

from collections.abc import Mapping
from pathlib import Path

from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure

Points = Mapping[str, tuple[float, float, float]]
"""Coordinates by name [m]: x to the rear, y to the right, z up."""

VIEWS = (("from the side", 0, 2), ("from behind", 1, 2), ("from above", 0, 1))
"""Views of a row, and the coordinates to the right and up."""
NAMES = "xyz"


def plot_points(path: Path, axles: Mapping[str, tuple[Points, Points, Points]], title: str, caption: str) -> None:
    """Write the picture of points.

    Args:
        path: PNG or SVG file.
        axles: by axle, points of the table, those kept from the template, and all points of the template.
        title, caption: texts.
    """
    with saved_figure(path, (12.0, 4.6 * len(axles) + 0.6), title, caption) as figure:
        rows = figure.subplots(len(axles), 3, squeeze=False)
        for (axle, (of_table, kept, template)), row in zip(axles.items(), rows, strict=True):
            for (view, right, up), axis in zip(VIEWS, row, strict=True):
                for points, style in (
                    (template, {"marker": "x", "color": "#9a9a9a", "label": "template"}),
                    (kept, {"marker": "o", "color": COLOURS[3], "label": "car, from the template"}),
                    (of_table, {"marker": "o", "color": COLOURS[0], "label": "car, from the table"}),
                ):
                    across = [1e3 * point[right] for point in points.values()]
                    upward = [1e3 * point[up] for point in points.values()]
                    axis.scatter(across, upward, s=26, zorder=3, **style)
                for name, point in {**kept, **of_table}.items():
                    if name in template:
                        ends = [[1e3 * at[index] for at in (template[name], point)] for index in (right, up)]
                        axis.plot(*ends, color="#9a9a9a", linewidth=0.6)
                    axis.annotate(name, (1e3 * point[right], 1e3 * point[up]), xytext=(4, 3), fontsize=6.5, color=INK,
                                  textcoords="offset points")  # fmt: skip
                axis.set(title=f"{axle}, {view}", xlabel=f"{NAMES[right]} [mm]", ylabel=f"{NAMES[up]} [mm]")
                axis.set_aspect("equal", adjustable="datalim")
        rows[0][0].legend(loc="best")
