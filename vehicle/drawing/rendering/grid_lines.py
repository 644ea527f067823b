"""Grid lines as one collection for each axes, and ticks only at labels.

A tick of matplotlib consists of three lines and two texts. Most ticks of a picture with shared scales have only a grid
line; five artists for each tick were most of the cost of these pictures.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes

Group = Literal["major", "minor"]

GROUPS: tuple[Group, Group] = ("major", "minor")
NO_VALUES = (0.1, 1.0)
"""Limits of a logarithmic axis without a positive value, as of a response that is defined nowhere."""
SIDES = {"x": ("bottom", "top"), "y": ("left", "right")}


def bared(axes: Axes) -> dict[str, list[Group]]:
    """Remove grid lines from ticks, and marks from ticks without a label, so that empty ticks are not created.

    Args:
        axes: axes with final limits, before the layout is computed.

    Returns:
        "x" and "y" to the groups of ticks that had grid lines.
    """
    from matplotlib.ticker import NullLocator

    grid: dict[str, list[Group]] = {name: [] for name in SIDES}
    if not (axes.axison and axes.get_visible()):
        return grid
    for name, sides in SIDES.items():
        axis = getattr(axes, f"{name}axis")
        if axis.get_scale() == "log" and getattr(axes, f"get_autoscale{name}_on")():
            sharing = getattr(axes, f"get_shared_{name}_axes")().get_siblings(axes)
            if not any(np.isfinite(getattr(each, f"{name}axis").get_minpos()) for each in sharing):
                getattr(axes, f"set_{name}lim")(NO_VALUES)
        for group in GROUPS:
            if isinstance(getattr(axis, f"get_{group}_locator")(), NullLocator):
                continue
            look: dict[str, Any] = axis.get_tick_params(group)
            if look["gridOn"]:
                grid[name].append(group)
            labelled = any(look.get(f"label{side}", True) for side in sides)
            # Minor ticks of a short logarithmic scale have labels.
            if labelled and group == "minor":
                labelled = any(axis.get_minor_formatter().format_ticks(axis.get_minorticklocs()))
            parts = () if labelled else (*sides, *(f"label{side}" for side in sides))
            axis.set_tick_params(group, gridOn=False, **dict.fromkeys(parts, False))
    return grid


def draw_grid(axes: Axes, grid: Mapping[str, Sequence[Group]]) -> None:
    """Draw the lines of `bared` over the whole axes.

    Args:
        axes: axes with final position and size, which determine automatic ticks.
    """
    from matplotlib import rcParams
    from matplotlib.collections import LineCollection

    for name, groups in grid.items():
        if not groups:
            continue
        axis = getattr(axes, f"{name}axis")
        along = np.repeat(np.concatenate([getattr(axis, f"get_{group}ticklocs")() for group in groups]), 2)
        across = np.tile([0.0, 1.0], along.size // 2)
        ends = np.stack([along, across] if name == "x" else [across, along], axis=-1).reshape(-1, 2, 2)
        lines = LineCollection(
            list(ends),
            colors=rcParams["grid.color"],
            linewidths=rcParams["grid.linewidth"],
            linestyles=rcParams["grid.linestyle"],
            capstyle="projecting",
            transform=getattr(axes, f"get_{name}axis_transform")(),
            zorder=0.5,  # as ticks below the data
        )
        axes.add_collection(lines, autolim=False)
