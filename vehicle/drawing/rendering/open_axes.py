"""Axes of a figure that a user of Python edits: a new figure in the style of the program, or the axes of the user."""

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.figure import STYLE
from vehicle.errors import ConfigurationError

Axes = npt.NDArray[Any]
"""Array of matplotlib axes, (rows, columns)."""


def open_axes(
    ax: Any, size: tuple[float, float], rows: int = 1, columns: int = 1, title: str = "", **options: Any
) -> Axes:
    """Return the axes to draw on.

    Args:
        ax: axes or an array of axes of the user; None for a new figure of `matplotlib.pyplot`, which a notebook shows.
        size: width and height of a new figure [inch].
        rows, columns: number of axes of the plot.
        options: options of `matplotlib.pyplot.subplots` for a new figure.

    Returns:
        The axes, (rows, columns).

    Raises:
        ConfigurationError: the plot needs another number of axes.
    """
    if ax is not None:
        axes = np.array(ax, dtype=object).ravel()
        if axes.size != rows * columns:
            raise ConfigurationError(
                f"ax: found {axes.size} axes, must be {rows * columns}: {rows} rows in {columns} columns"
            )
        return axes.reshape(rows, columns)
    from matplotlib import pyplot, rc_context

    # The backend of the user stays: only the style is set while the axes are made.
    with rc_context(STYLE):
        figure, axes = pyplot.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained", **options)
    if title:
        figure.suptitle(title, fontsize=11)
    return np.asarray(axes, dtype=object)


def label_once(axis: Any, label: str) -> None:
    """Label the vertical axis with a quantity and its unit in brackets.

    Raises:
        ConfigurationError: the axes show curves in another unit.
    """
    present, new = (re.search(r"\[(.*)\]", text, re.DOTALL) for text in (axis.get_ylabel(), label))
    if axis.lines and present and new and present[1] != new[1]:
        raise ConfigurationError(
            f"ax: shows curves in {present[1]}, but the new curves are in {new[1]}; give other axes"
        )
    axis.set_ylabel(label)


def plain(axes: Axes) -> Any:
    """Return a single axes as itself, a column or row as (n,), other arrays unchanged."""
    return axes.item() if axes.size == 1 else axes.ravel() if 1 in axes.shape else axes
