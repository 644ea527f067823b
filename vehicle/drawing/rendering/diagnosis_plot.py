"""Picture of a diagnosis: distribution of the force of each damper over nominal, with its median and 90 % interval."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure

HEIGHT = 0.8
"""Height of the highest distribution, in rows."""


class UnknownShape(NamedTuple):
    """Distribution of an unknown.

    Attributes:
        label: its name.
        edges, shares: edges of the classes (k + 1,) and probabilities in them (k,).
        low, middle, high: 5 %, 50 % and 95 % quantiles.
        worn: True if it is stated to be below the limit.
    """

    label: str
    edges: Vector
    shares: Vector
    low: float
    middle: float
    high: float
    worn: bool


def plot_diagnosis(path: Path, shapes: Sequence[UnknownShape], limit: float, title: str, caption: str) -> None:
    """Write the picture of a diagnosis.

    Args:
        path: PNG or SVG file.
        shapes: distributions, the first on top.
        limit: value below which a damper counts as worn.
        title, caption: above and below the figure.
    """
    highest = max(float(np.max(shape.shares)) for shape in shapes)
    with saved_figure(path, (8.0, 1.9 + 0.75 * len(shapes)), title, caption) as figure:
        axis = figure.subplots()
        for row, shape in enumerate(shapes):
            base = len(shapes) - 1.0 - row
            colour = COLOURS[3] if shape.worn else COLOURS[0]
            axis.stairs(base + HEIGHT * shape.shares / highest, shape.edges, baseline=base, fill=True, color=colour,
                        alpha=0.6)  # fmt: skip
            axis.plot([shape.low, shape.high], [base - 0.08] * 2, color=INK, linewidth=2.0)
            axis.plot(shape.middle, base - 0.08, marker="o", color=INK, markersize=5)
        axis.axvline(limit, color=INK, linestyle="--", linewidth=1.0)
        axis.axvline(1.0, color=INK, linewidth=0.6)
        axis.set_yticks([len(shapes) - 1.0 - row for row in range(len(shapes))], [shape.label for shape in shapes])
        axis.set(xlabel="force of the damper over nominal [-]", ylim=(-0.3, len(shapes)))
