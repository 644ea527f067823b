"""Drawing of FRFs and of time histories over the curves in the same axes."""

from collections.abc import Mapping, Sequence
from itertools import cycle, islice

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, frf_axes, looks, wrapped_phase
from vehicle.drawing.rendering.open_axes import Axes, label_once
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.samples import Vector

MOST_NAMED = 12
"""Maximum number of curves with a legend."""


def draw_response(axes: Axes, response: FrequencyResponse, labels: Sequence[str]) -> None:
    """Draw several FRFs in the same axes; curves that the axes already have stay.

    Args:
        axes: axes of magnitude, phase and coherence, (3, 1); or of the magnitude alone, (1, 1).
        response: FRFs to the plate displacement [m/s2 per m].
        labels: texts of the legend.
    """
    if len(axes) == 1:
        label_once(axes[0, 0], "acceleration / plate displacement [(m/s²)/m]")
    drawn = len(axes[0, 0].lines)
    for row, (name, look) in enumerate(zip(labels, islice(looks(), drawn, None), strict=False)):
        style = look | {"linewidth": 1.1}
        axes[0, 0].plot(response.frequency, np.abs(response.response[row]), label=name, **style)
        if len(axes) > 1:
            axes[1, 0].plot(response.frequency, wrapped_phase(response.response[row]), **style)
            axes[2, 0].plot(response.frequency, response.coherence[row], **style)
    if len(axes) > 1:
        frf_axes(axes[0, 0].figure, axes, (0, 0.25, 0.5, 0.75, 1))
    else:
        axes[0, 0].set(xscale="log", yscale="log", xlabel="frequency [Hz]")
    if drawn + len(labels) <= MOST_NAMED:
        axes[0, 0].legend(loc="upper left", fontsize=8)


def draw_histories(axes: Axes, time: Vector, histories: Mapping[str, tuple[Vector, str]], label: str) -> None:
    """Draw time histories; curves that the axes already have stay.

    Args:
        axes: axes, (channels, 1).
        time: sample times [s], (n,).
        histories: name of the channel to its samples, (n,), and their unit.
        label: text of the legend, which the first axes get with their second curve.
    """
    for axis, (name, (values, unit)) in zip(axes[:, 0], histories.items(), strict=True):
        (colour,) = islice(cycle(COLOURS), len(axis.lines), len(axis.lines) + 1)
        label_once(axis, f"{name}\n[{unit.replace('m/s2', 'm/s²')}]")
        axis.plot(time, values, linewidth=0.7, color=colour, label=label)
        axis.set_xlim(time[0], time[-1])
    if len(axes[0, 0].lines) > 1:
        axes[0, 0].legend(loc="upper right", fontsize=8)
    axes[-1, 0].set_xlabel("time [s]")
