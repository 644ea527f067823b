"""Plot of FRFs over each other: magnitude, phase and coherence."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, LINES, frf_axes, saved_figure, wrapped_phase
from vehicle.signals.analysis.frf import FrequencyResponse


def plot_response(
    path: Path, response: FrequencyResponse, names: Sequence[str], title: str = "", caption: str = ""
) -> None:
    """Plot several FRFs in the same axes.

    Args:
        path: PNG or SVG file.
        response: FRFs to the plate displacement [m/s2 per m].
        names: names of the rows.
        title, caption: above and below the figure.
    """
    with saved_figure(path, (8.0, 7.2), title, caption) as figure:
        axes = figure.subplots(3, 1, sharex=True, height_ratios=(2.2, 1.0, 0.9), squeeze=False)
        for row, (name, colour, line) in enumerate(zip(names, cycle(COLOURS), cycle(LINES), strict=False)):
            style = {"color": colour, "linestyle": line}
            magnitude, phase, coherence = axes[:, 0]
            magnitude.plot(response.frequency, np.abs(response.response[row]), label=name, **style)
            phase.plot(response.frequency, wrapped_phase(response.response[row]), **style)
            coherence.plot(response.frequency, response.coherence[row], **style)
        frf_axes(figure, axes, (0, 0.25, 0.5, 0.75, 1))
        if len(names) <= 12:
            axes[0, 0].legend(loc="upper left")
