"""Picture of the Pareto front of a search: pairs of objectives, and parameters relative to their bounds."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure
from vehicle.signals.analysis.samples import Vector

MARKS, DOTS = "*DsP^v", "os^vDP"
"""Markers of the named cars, and of parameters."""

BELOW: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.14)}
"""Position of the legends outside of the axes, where they cover no cars."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FrontPicture:
    """Data of a picture of a Pareto front.

    Attributes:
        objectives: labels of the objectives with units.
        tried: objectives of all cars within the limits; (n, goals).
        front: objectives of the front, sorted by the first objective; (f, goals).
        base: objectives of the base car; (goals,).
        named: label to objectives of the named cars.
        other: label and front of another search, or None.
        parameters: labels of the parameters with units.
        shares: parameters of the cars of the front relative to their bounds, 0 to 1; (f, p).
        base_shares: parameters of the base car relative to their bounds, NaN if undefined; (p,).
    """

    objectives: Sequence[str]
    tried: Vector
    front: Vector
    base: Vector
    named: Mapping[str, Vector]
    other: tuple[str, Vector] | None
    parameters: Sequence[str]
    shares: Vector
    base_shares: Vector


def plot_front(path: Path, picture: FrontPicture, caption: str) -> None:
    """Write the picture."""
    pairs = list(combinations(range(len(picture.objectives)), 2))
    panels = len(pairs) + 1 if pairs else 2
    columns = math.ceil(math.sqrt(panels))
    rows = math.ceil(panels / columns)
    title = "Compromises that no other car beats" if pairs else "The best car"
    with saved_figure(path, (5.6 * columns, 5.2 * rows + 0.4), title, caption) as figure:
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for axis in axes[panels:]:
            axis.remove()
        if pairs:
            for axis, pair in zip(axes, pairs, strict=False):
                _objectives(axis, picture, *pair)
            axes[0].legend(**BELOW, ncols=3)
            _along(axes[panels - 1], picture)
        else:
            _course(axes[0], picture)
            _bars(axes[1], picture)


def draw_first(axis: Any, picture: FrontPicture) -> None:
    """Draw the cars over the first two objectives, or the convergence of a single objective."""
    if len(picture.objectives) > 1:
        _objectives(axis, picture, 0, 1)
        axis.legend(**BELOW, ncols=3)
    else:
        _course(axis, picture)


def _objectives(axis: Any, picture: FrontPicture, x: int, y: int) -> None:
    """Plot two objectives against each other."""
    axis.plot(*picture.tried[:, [x, y]].T, ".", color="#c9c9c9", markersize=3, zorder=1, label="cars tried")
    line = "-" if len(picture.objectives) == 2 else ""
    axis.plot(
        *picture.front[:, [x, y]].T,
        f"o{line}",
        color=COLOURS[0],
        markersize=3.5,
        linewidth=0.8,
        zorder=3,
        label="front",
    )
    if picture.other is not None:
        label, other = picture.other
        axis.plot(*other[:, [x, y]].T, "x", color=COLOURS[2], markersize=4, zorder=2, label=label)
    base = picture.base[[x, y]]
    axis.plot(*base, "o", color="white", markeredgecolor=COLOURS[1], markeredgewidth=1.6, markersize=9, zorder=5)
    if np.all(np.isfinite(base)):
        axis.annotate("base car", base, (7, 7), textcoords="offset points", color=COLOURS[1], zorder=6)
    for mark, (label, values) in zip(MARKS, picture.named.items(), strict=False):
        axis.plot(*values[[x, y]], mark, color=COLOURS[1], markersize=8, zorder=4, label=label)
    # Poor cars of the first generations would compress the front into a corner.
    shown = np.concatenate([picture.front, picture.base[None], *([picture.other[1]] if picture.other else [])])
    shown = shown[np.all(np.isfinite(shown), axis=1)]  # a base car that cannot be run has no objectives
    for column, limits in ((x, axis.set_xlim), (y, axis.set_ylim)):
        low, high = np.min(shown[:, column]), np.max(shown[:, column])
        margin = 0.15 * (high - low) or 0.05 * abs(high) or 1.0
        limits(low - margin, high + margin)
    axis.set(xlabel=squared(picture.objectives[x]), ylabel=squared(picture.objectives[y]))


def _along(axis: Any, picture: FrontPicture) -> None:
    """Plot the parameters of the front relative to their bounds, over the first objective."""
    for number, label in enumerate(picture.parameters):
        look = {"color": COLOURS[number % len(COLOURS)], "marker": DOTS[number % len(DOTS)]}
        axis.plot(picture.front[:, 0], picture.shares[:, number], linestyle="", markersize=4, label=label, **look)
        axis.plot(
            picture.base[0], picture.base_shares[number], linestyle="", markersize=8, markerfacecolor="white", **look
        )
    axis.set(xlabel=squared(picture.objectives[0]), ylabel="place between the bounds [-]", ylim=(-0.03, 1.03))
    axis.set_title("parameters along the Pareto front (hollow marker: base car)", color=INK)
    axis.legend(**BELOW, ncols=2)


def _course(axis: Any, picture: FrontPicture) -> None:
    """Plot the convergence of a single objective."""
    values, best = picture.tried[:, 0], picture.front[0, 0]
    number = np.arange(1, len(values) + 1)
    so_far = np.minimum.accumulate(np.abs(values - best)) * np.sign(np.mean(values) - best) + best
    axis.plot(number, values, ".", color="#c9c9c9", markersize=3, label="cars tried")
    axis.step(number, so_far, where="post", color=COLOURS[0], label=f"best so far, at the end {best:.4g}")
    axis.axhline(picture.base[0], color=COLOURS[1], linestyle="--", label=f"base car {picture.base[0]:.4g}")
    axis.set(xlabel="cars that keep the limits [-]", ylabel=squared(picture.objectives[0]))
    axis.legend(**BELOW, ncols=3)


def _bars(axis: Any, picture: FrontPicture) -> None:
    """Plot the parameters of the best car relative to their bounds as bars."""
    rows = np.arange(len(picture.parameters))
    axis.barh(rows, picture.shares[0], color=COLOURS[0], height=0.4, label="best car")
    axis.plot(picture.base_shares, rows, "o", color="white", markeredgecolor=COLOURS[1], markersize=8, label="base car")
    axis.set_yticks(rows, picture.parameters)
    axis.set(xlim=(0.0, 1.0), ylim=(-0.6, len(rows) - 0.4), xlabel="place between the bounds [-]")
    axis.legend(**BELOW, ncols=2)


def squared(label: str) -> str:
    """Replace the unit m/s2 in a label by m/s²."""
    return label.replace("m/s2", "m/s²")
