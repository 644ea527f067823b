"""Drawing of a car with dimensions: side view, and each axle from behind with its roll centre and swing arms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.arrays import Mask
from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure, wrapped
from vehicle.drawing.rendering.wireframe import GROUPS, CarWireframe
from vehicle.signals.analysis.samples import Vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHADES = {"body": "#c4c4c4", "mass": "#a5a5a5", "link": "#3a3a3a", "spring": "#8a8a8a", "wheel": "#5a6b7a"}
"""Colour of the lines of each group; plates are not drawn, but the ground."""

CONSTRUCTION, STEERING, CENTRE = COLOURS[0], COLOURS[1], COLOURS[2]
"""Colours of swing arms, steering axes and roll centres."""

REACH = 0.5
"""Largest distance of a drawn point from the plane of its axle [m]."""

ARM = 1.2
"""Drawn length of a line from a contact point to a swing centre that lies farther away [m]."""

OVER_LINES = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}
"""White behind a text that may lie over lines."""


def plot_car(path: Path, wire: CarWireframe, data: Any, size: tuple[float, float] = (11.0, 8.0)) -> None:
    """Write the drawing of a car.

    Args:
        data: a `vehicle.runs.car.car_data.CarData` of the same car.
    """
    count = max(1, len(data.axles))
    caption = (
        "blue: lines from the contact points to the swing centres, cut at 1.2 m; red: steering axis; "
        "green: roll centre; black and white: centre of gravity. Dimensions in mm"
    )
    with saved_figure(path, size, f"{data.name}: {data.mass_kg:.0f} kg", wrapped(caption, size[0])) as figure:
        grid = figure.add_gridspec(2, count, height_ratios=(1.15, 1.0))
        _side_view(figure.add_subplot(grid[0, :]), wire, data)
        for column, axle in enumerate(data.axles):
            _axle_view(figure.add_subplot(grid[1, column]), wire, data, axle)


def _ground(data: Any) -> float:
    """Return the height of the ground [m]."""
    return float(data.cog_m[2] - data.cog_height_m)


def _lines(axes: Axes, wire: CarWireframe, across: tuple[int, int], chosen: Mask, left: float) -> None:
    """Draw the chosen lines of a wireframe over two coordinates, the first with the factor `left`."""
    from matplotlib.collections import LineCollection

    flat = wire.points[:, across] * [left, 1.0]
    for group, colour in SHADES.items():
        ours = chosen & (wire.groups == GROUPS.index(group))
        width = 0.5 if group == "body" else 1.0
        axes.add_collection(LineCollection(flat[wire.lines[ours]].tolist(), colors=colour, linewidths=width))


def _side_view(axes: Axes, wire: CarWireframe, data: Any) -> None:
    """Draw the car from its left side: front on the left."""
    ground, (x, _, z) = _ground(data), data.cog_m
    _lines(axes, wire, (0, 2), np.ones(len(wire.lines), dtype=bool), 1.0)
    axes.axhline(ground, color=INK, linewidth=0.8)
    _cog(axes, x, z)
    _dimension(axes, (x, ground), (x, z), f"{1e3 * data.cog_height_m:.0f}")
    level, ends = ground - 0.14, list(wire.points[:, 0])
    for axle in data.axles:
        geometry, at = axle.geometry, np.array([axle.x_m, ground])
        towards = 1.0 if axle.front else -1.0
        if math.isfinite(geometry.side_swing_arm_m):
            centre = np.array([axle.x_m + towards * geometry.side_swing_arm_m, ground + geometry.side_swing_height_m])
            end = _arm(axes, at, centre)
            ends.append(float(end[0]))
            angle = f"brake support {geometry.brake_support_deg:.1f}°"
            axes.annotate(angle, (end[0], end[1]), (0.0, 6.0), textcoords="offset points", color=CONSTRUCTION,
                          ha="center", fontsize=8, bbox=OVER_LINES)  # fmt: skip
        load = f"{axle.name} {sum(axle.load_n.values()):.0f} N"
        axes.annotate(load, (axle.x_m, level), (-6.0 * towards, -3.0), textcoords="offset points", fontsize=8,
                      ha="right" if axle.front else "left", color=INK)  # fmt: skip
        if math.isfinite(geometry.caster_deg):
            foot = at - [geometry.caster_trail_m, 0.0]
            slope = math.tan(math.radians(geometry.caster_deg))
            _steering(axes, foot, foot + np.array([slope, 1.0]) * 0.9, f"caster {geometry.caster_deg:.1f}°")
    if len(data.axles) == 2:
        first, second = (axle.x_m for axle in data.axles)
        _dimension(axes, (first, level), (x, level), f"{1e3 * (x - first):.0f}")
        _dimension(axes, (x, level), (second, level), f"{1e3 * (second - x):.0f}")
        _dimension(axes, (first, level - 0.17), (second, level - 0.17), f"wheelbase {1e3 * data.wheelbase_m:.0f}")
    elif data.axles:
        _dimension(axes, (data.axles[0].x_m, level), (x, level), f"{1e3 * data.cog_behind_front_m:.0f}")
    axes.set_title("from the left")
    _finish(axes, np.array(ends), wire.points[:, 2], ground - 0.5)


def _axle_view(axes: Axes, wire: CarWireframe, data: Any, axle: Any) -> None:
    """Draw an axle from behind: right side of the car on the right."""
    ground, geometry = _ground(data), axle.geometry
    near = np.abs(wire.points[wire.lines][:, :, 0] - axle.x_m).max(axis=1) < REACH
    chosen = near & (wire.groups != GROUPS.index("mass")) & (wire.groups != GROUPS.index("body"))
    _lines(axes, wire, (1, 2), chosen, 1.0)
    axes.axhline(ground, color=INK, linewidth=0.8)
    half = 0.5 * axle.track_m
    if math.isfinite(geometry.roll_centre_height_m):
        centre = np.array([geometry.roll_centre_lateral_m, ground + geometry.roll_centre_height_m])
        for side in (1.0, -1.0):
            _arm(axes, np.array([side * half, ground]), centre, whole=True)
        axes.plot(*centre, "o", color=CENTRE, markersize=6)
        axes.annotate(f"roll centre {1e3 * geometry.roll_centre_height_m:.0f}", (centre[0], centre[1]), (0.0, 9.0),
                      textcoords="offset points", ha="center", color=CENTRE, fontsize=8, bbox=OVER_LINES)  # fmt: skip
    if math.isfinite(geometry.caster_deg):
        for side in (1.0, -1.0):
            foot = np.array([side * (half - geometry.scrub_radius_m), ground])
            slope = -side * math.tan(math.radians(geometry.kingpin_inclination_deg))
            name = f"inclination {geometry.kingpin_inclination_deg:.1f}°" if side > 0.0 else ""
            _steering(axes, foot, foot + np.array([slope, 1.0]) * 0.9, name)
    level = ground - 0.14
    _dimension(axes, (-half, level), (half, level), f"track {1e3 * axle.track_m:.0f}")
    axes.set_title(f"{axle.name} axle ({axle.template}) from behind")
    points = wire.points[np.unique(wire.lines[chosen])] if chosen.any() else wire.points
    _finish(axes, points[:, 1], points[:, 2], ground - 0.3)


def _cog(axes: Axes, x: float, z: float) -> None:
    """Draw the symbol of a centre of gravity: a circle of four quarters."""
    from matplotlib.patches import Circle, Wedge

    axes.add_patch(Circle((x, z), 0.05, facecolor="white", edgecolor="black", linewidth=1.0, zorder=4))
    for start in (0.0, 180.0):
        axes.add_patch(Wedge((x, z), 0.05, start, start + 90.0, facecolor="black", zorder=5))


def _arm(axes: Axes, start: Vector, centre: Vector, *, whole: bool = False) -> Vector:
    """Draw the line from a contact point to a centre, cut at `ARM` unless `whole`, and return its end."""
    away = centre - start
    length = float(np.linalg.norm(away))
    end = centre if whole or length < ARM else start + away * ARM / length
    axes.plot(*np.stack([start, end], axis=1), "--", color=CONSTRUCTION, linewidth=1.0)
    if not whole and length < ARM:
        axes.plot(*centre, "o", color=CONSTRUCTION, markersize=4)
    return end


def _steering(axes: Axes, foot: Vector, top: Vector, name: str) -> None:
    """Draw a steering axis from the ground upwards, with a name at its upper end."""
    axes.plot(*np.stack([foot, top], axis=1), color=STEERING, linewidth=1.0)
    axes.annotate(
        name, (top[0], top[1]), (0.0, 3.0), textcoords="offset points", ha="center", color=STEERING, fontsize=8
    )


def _dimension(axes: Axes, first: tuple[float, float], second: tuple[float, float], text: str) -> None:
    """Draw a dimension between two points, with its text in the middle."""
    axes.annotate("", second, first, arrowprops={"arrowstyle": "<->", "color": INK, "linewidth": 0.8, "shrinkA": 0,
                                                 "shrinkB": 0})  # fmt: skip
    upright = first[0] == second[0]
    middle = (0.5 * (first[0] + second[0]), 0.5 * (first[1] + second[1]))
    offset = (4.0, 0.0) if upright else (0.0, 2.0)
    axes.annotate(text, middle, offset, textcoords="offset points", fontsize=8, color=INK,
                  ha="left" if upright else "center", va="center" if upright else "bottom")  # fmt: skip


def _finish(axes: Axes, across: Vector, upwards: Vector, bottom: float) -> None:
    """Set equal scales and limits around the drawn points, without grid and axes."""
    axes.set_aspect("equal")
    axes.set_xlim(float(across.min()) - 0.25, float(across.max()) + 0.25)
    axes.set_ylim(bottom, float(upwards.max()) + 0.12)
    axes.grid(visible=False, which="both")
    axes.axis("off")
