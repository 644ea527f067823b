"""Drawing of FRFs over each other: magnitude, phase and coherence."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle, islice
from typing import Any

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, LINES, frf_axes, wrapped_phase
from vehicle.drawing.rendering.open_axes import Axes
from vehicle.signals.analysis.frf import FrequencyResponse

MOST_NAMED = 12
"""Maximum number of curves with a legend."""


def draw_response(axes: Axes, response: FrequencyResponse, names: Sequence[str]) -> None:
    """Draw several FRFs in the same axes; curves that the axes already have stay.

    Args:
        axes: axes of magnitude, phase and coherence, (3, 1); or of the magnitude alone, (1, 1).
        response: FRFs to the plate displacement [m/s2 per m].
    """
    drawn = len(axes[0, 0].lines)
    looks = islice(cycle(zip(COLOURS, LINES, strict=True)), drawn, None)
    for row, (name, (colour, line)) in enumerate(zip(names, looks, strict=False)):
        style: dict[str, Any] = {"color": colour, "linestyle": line, "linewidth": 1.1}
        axes[0, 0].plot(response.frequency, np.abs(response.response[row]), label=name, **style)
        if len(axes) > 1:
            axes[1, 0].plot(response.frequency, wrapped_phase(response.response[row]), **style)
            axes[2, 0].plot(response.frequency, response.coherence[row], **style)
    if len(axes) > 1:
        frf_axes(axes[0, 0].figure, axes, (0, 0.25, 0.5, 0.75, 1))
    else:
        axes[0, 0].set(xscale="log", yscale="log", xlabel="frequency [Hz]")
        axes[0, 0].set_ylabel("acceleration / plate displacement [(m/s²)/m]")
    if drawn + len(names) <= MOST_NAMED:
        axes[0, 0].legend(loc="upper left", fontsize=8)
