"""Picture of FRFs at levels of a random input, with the distortion around them."""

from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.drawing.rendering.figure import power_of_ten, saved_figure
from vehicle.drawing.rendering.level_plot import SIZE, frequency_ticks


def plot_random_levels(
    path: Path,
    *,
    frequency: Vector,
    level: Vector,
    size: Vector,
    distortion: Vector,
    linearised: Vector,
    label: str,
    title: str,
    caption: str,
) -> None:
    """Write the FRFs, and the scatter of a realisation over them.

    Args:
        path: PNG or SVG file.
        frequency: lines [Hz]; (m,).
        level: RMS of the plates [mm]; (l,).
        size: magnitude of the FRF; (m, l).
        distortion: scatter over the FRF; (m, l).
        linearised: magnitude by statistical linearisation, NaN without it; (m, l).
        label: quantity and unit of the magnitude.
        title, caption: above and below the figure.
    """
    from matplotlib import colormaps

    with saved_figure(path, SIZE, title, caption) as figure:
        left, right = figure.subplots(1, 2)
        colours = colormaps["plasma"](np.linspace(0.0, 0.88, len(level)))
        for row, colour in enumerate(colours):
            left.plot(frequency, size[:, row], color=colour, linewidth=1.3, label=number(level[row]))
            left.plot(frequency, linearised[:, row], "--", color=colour, linewidth=1.0)
            right.plot(frequency, 100.0 * distortion[:, row], color=colour, linewidth=1.3)
        for axes in (left, right):
            axes.set(xscale="log", yscale="log", xlim=frequency[[0, -1]], xlabel="frequency [Hz]")
            axes.yaxis.set_major_formatter(power_of_ten)
            frequency_ticks(axes, frequency)
        left.set_ylabel(label)
        right.set_ylabel("scatter of a realisation over the FRF [%]")
        right.set_ylim(bottom=max(0.1, 100.0 * float(np.nanmin(distortion, initial=1.0))))
        left.legend(title="RMS of the plates [mm]", loc="best", ncols=1 + (len(level) > 5))
