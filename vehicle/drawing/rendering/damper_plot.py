"""Picture of a fitted damper: force over velocity and over displacement, measured and fitted, for each test."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, LINES, saved_figure
from vehicle.signals.analysis.samples import Vector

MOST_POINTS = 6000
"""Maximum number of points of a line; more are not visible in a picture of this size."""


class DamperLoop(NamedTuple):
    """Measured and fitted force of one test.

    Attributes:
        label: name and errors of the test.
        displacement, velocity: motion [m], [m/s]; (n,).
        measured, fitted: forces [N]; (n,).
    """

    label: str
    displacement: Vector
    velocity: Vector
    measured: Vector
    fitted: Vector


def plot_damper(path: Path, loops: Sequence[DamperLoop], title: str = "", caption: str = "") -> None:
    """Write the picture of a fitted damper, a row for each test."""
    with saved_figure(path, (9.0, 1.0 + 3.0 * len(loops)), title, caption) as figure:
        grid = figure.subplots(len(loops), 2, squeeze=False, sharey="row")
        for (left, right), loop in zip(grid, loops, strict=True):
            thin = slice(None, None, 1 + loop.measured.size // MOST_POINTS)
            for axis, motion in ((left, loop.velocity), (right, loop.displacement)):
                for number, (force, name) in enumerate(((loop.measured, "measured"), (loop.fitted, "fitted"))):
                    axis.plot(1e3 * motion[thin], force[thin], color=COLOURS[number], linewidth=0.9, label=name)
            left.set(ylabel="force [N]", title=loop.label)
        grid[-1, 0].set(xlabel="velocity [mm/s]")
        grid[-1, 1].set(xlabel="displacement [mm]")
        grid[0, 0].legend(loc="upper left")


def plot_settings(
    path: Path, curves: Sequence[tuple[str, Vector, Vector]], settings: Mapping[str, tuple[float, float]]
) -> None:
    """Write the picture of a damper over its conditions: force over velocity, damping and friction.

    Args:
        curves: words of the condition, velocities [m/s] and forces [N] of each condition.
        settings: words of the condition to damping [N s/m] and friction [N].
    """
    with saved_figure(path, (9.0, 3.6)) as figure:
        left, middle, right = figure.subplots(1, 3, width_ratios=(2.0, 1.0, 1.0))
        for number, (condition, velocity, force) in enumerate(curves):
            style = {"color": COLOURS[number % len(COLOURS)], "linestyle": LINES[number // len(COLOURS) % len(LINES)]}
            left.plot(1e3 * velocity, force, label=condition, **style)
        left.set(xlabel="velocity [mm/s]", ylabel="force of curve and friction [N]")
        left.legend(loc="upper left")
        labels = ("damping [N s/m]", "friction [N]")
        for axis, label, values in zip((middle, right), labels, zip(*settings.values(), strict=True), strict=True):
            axis.plot(list(settings), values, "o-", color=COLOURS[0])
            axis.set(ylabel=label, ylim=(0.0, None))
            axis.tick_params(axis="x", labelrotation=30)


def plot_band(path: Path, band: tuple[Vector, Vector, Vector, Vector], tested: tuple[float, float]) -> None:
    """Write the picture of the force over the velocity with its band.

    Args:
        band: velocity [m/s], force, lowest and highest force [N]; (n,) each.
        tested: highest velocities of the slowest and of the fastest test [m/s].
    """
    velocity, force, lowest, highest = band
    with saved_figure(path, (9.0, 4.2)) as figure:
        titles = {tested[0]: "up to the slowest test", velocity[-1]: "up to twice the fastest test"}
        for axis, (top, title) in zip(figure.subplots(1, 2), titles.items(), strict=True):
            # Friction jumps at rest: each side has its own line.
            for sign in (-1.0, 1.0):
                shown = (sign * velocity > 0.0) & (np.abs(velocity) <= 1.0001 * top)
                axis.fill_between(1e3 * velocity[shown], lowest[shown], highest[shown], color=COLOURS[0], alpha=0.25,
                                  linewidth=0.0, label="band of all accepted laws" if sign > 0.0 else None)  # fmt: skip
                axis.plot(1e3 * velocity[shown], force[shown], color=COLOURS[0],
                          label="chosen law" if sign > 0.0 else None)  # fmt: skip
                if top > tested[1]:
                    axis.axvline(1e3 * sign * tested[1], color=COLOURS[1], linestyle=LINES[1], linewidth=0.9,
                                 label="fastest test" if sign > 0.0 else None)  # fmt: skip
            axis.set(xlabel="velocity [mm/s]", title=title)
            axis.legend(loc="upper left")
        figure.axes[0].set(ylabel="force of curve and sliding friction [N]")
