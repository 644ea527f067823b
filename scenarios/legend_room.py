"""Space for the legend of a panel above its curves."""

from typing import Any

import numpy as np

from vehicle.arrays import Vector

GAP = 0.03
"""Space between legend and curves, as a share of the height of the panel."""

SAMPLES = 200
"""Number of positions along the legend at which the curves are compared with it."""


def make_room(panel: Any) -> None:
    """Raise the upper limit of a final panel before the layout until no curve is behind a legend at its upper edge."""
    legend = panel.get_legend()
    if legend is None:
        return
    low, high = panel.yaxis.get_transform().transform(np.array(panel.get_ylim()))
    panel.get_xlim()  # automatic limits are set at the first request
    frame = panel.get_window_extent()
    box = legend.get_window_extent()
    if box.y1 < frame.y1 - 0.1 * frame.height:
        return
    curves = [line for line in panel.lines if line.get_transform() == panel.transData]  # no lines across the panel
    highest = min(max((_highest(line, box.x0, box.x1) for line in curves), default=-np.inf), frame.y1)
    if highest <= box.y0 - GAP * frame.height:
        return
    share = (box.y0 - GAP * frame.height - frame.y0) / (highest - frame.y0)
    top = np.array([low + (high - low) / share])
    panel.set_ylim(top=float(panel.yaxis.get_transform().inverted().transform(top)[0]))


def _highest(line: Any, left: float, right: float) -> float:
    """Return the highest point of a line between two horizontal positions [dots]; -inf without one."""
    points: Vector = line.get_transform().transform(np.asarray(line.get_xydata(), dtype=float))
    points = points[np.isfinite(points).all(axis=1)]
    if not points.size:
        return -np.inf
    x, y = points.T
    inside = y[(x >= left) & (x <= right)]
    if np.all(np.diff(x) > 0.0):
        between = np.linspace(max(left, x[0]), min(right, x[-1]), SAMPLES)
        inside = np.append(inside, np.interp(between, x, y)) if between[0] <= between[-1] else inside
    return float(inside.max(initial=-np.inf))
