"""Picture of a fitted mount: dynamic stiffness and loss angle over frequency, measured points and curves."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, LINES, saved_figure
from vehicle.signals.analysis.samples import Complex, Vector

MARKERS = ("o", "s", "^", "D", "v")
"""Markers of the points, one for each colour."""


class MountCurve(NamedTuple):
    """Measured points and fitted curve of one amplitude.

    Attributes:
        label: name of the amplitude.
        frequency, measured: frequencies [Hz] and complex stiffness [N/m] of the points; (m,).
        line, fitted: frequencies [Hz] and complex stiffness [N/m] of the curve; (k,).
    """

    label: str
    frequency: Vector
    measured: Complex
    line: Vector
    fitted: Complex


def plot_mount(path: Path, curves: Sequence[MountCurve], title: str, caption: str) -> None:
    """Write the picture of a fitted mount."""
    with saved_figure(path, (9.0, 7.5), title, caption) as figure:
        upper, lower = figure.subplots(2, 1, sharex=True)
        for number, curve in enumerate(curves):
            colour, line = COLOURS[number % len(COLOURS)], LINES[number % len(LINES)]
            points = {"color": colour, "marker": MARKERS[number % len(MARKERS)], "markersize": 4, "linestyle": "none"}
            pairs = zip((upper, lower), _shown(curve.measured), _shown(curve.fitted), strict=True)
            for axis, measured, fitted in pairs:
                axis.plot(curve.frequency, measured, **points, label=f"{curve.label}, measured")
                axis.plot(curve.line, fitted, color=colour, linestyle=line, label=f"{curve.label}, fitted")
        upper.set(ylabel="dynamic stiffness [N/mm]", ylim=(0.0, None))
        lower.set(ylabel="loss angle [deg]", xlabel="frequency [Hz]")
        upper.legend(ncols=2)


def _shown(stiffness: Complex) -> tuple[Vector, Vector]:
    """Return the dynamic stiffness [N/mm] and the loss angle [deg]."""
    return 1e-3 * np.abs(stiffness), np.degrees(np.angle(stiffness))
