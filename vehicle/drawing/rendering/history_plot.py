"""Drawing of time histories, an axes for each channel."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle, islice

from vehicle.drawing.rendering.figure import COLOURS
from vehicle.drawing.rendering.open_axes import Axes
from vehicle.signals.analysis.samples import Vector


def draw_histories(axes: Axes, time: Vector, histories: Mapping[str, tuple[Vector, str]]) -> None:
    """Draw time histories; curves that the axes already have stay.

    Args:
        axes: axes, (channels, 1).
        time: sample times [s], (n,).
        histories: name of the channel to its samples, (n,), and their unit.
    """
    for axis, (name, (values, unit)) in zip(axes[:, 0], histories.items(), strict=True):
        (colour,) = islice(cycle(COLOURS), len(axis.lines), len(axis.lines) + 1)
        axis.plot(time, values, linewidth=0.7, color=colour, label=name)
        axis.set(ylabel=f"{name}\n[{unit.replace('m/s2', 'm/s²')}]", xlim=(time[0], time[-1]))
    axes[-1, 0].set_xlabel("time [s]")
