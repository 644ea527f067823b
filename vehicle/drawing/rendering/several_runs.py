"""Comparison of the FRFs of several runs."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.figure import FADED, fading, frf_axes, looks, saved_figure, wrapped, wrapped_phase
from vehicle.drawing.rendering.recorded_run import RecordedRun
from vehicle.signals.analysis.frf import FrequencyResponse


def plot_responses(
    path: Path,
    runs: Mapping[str, tuple[RecordedRun, FrequencyResponse]],
    channels: Mapping[str, str],
    title: str = "",
    size: tuple[float, float] = (13.0, 7.6),
) -> None:
    """Plot FRFs of several runs over each other, with a column for each channel.

    Args:
        runs: name to run and FRFs of all its acceleration channels.
        channels: channel recorded in all runs to the title of its column.
    """
    with saved_figure(path, size, title, wrapped(FADED, size[0])) as figure:
        axes = figure.subplots(
            3, len(channels), sharex=True, sharey="row", height_ratios=(2.2, 1.0, 0.9), squeeze=False
        )
        for (channel, title_of_column), column in zip(channels.items(), axes.T, strict=True):
            for (name, (run, response)), style in zip(runs.items(), looks(), strict=False):
                row = run.car.model.vehicle.acceleration_channels.index(channel)
                magnitude = np.abs(response.response[row])
                fading(column[0], response.frequency, magnitude, response.coherence[row], name, **style)
                column[1].plot(response.frequency, wrapped_phase(response.response[row]), **style)
                column[2].plot(response.frequency, response.coherence[row], **style)
            column[0].set_title(title_of_column)
        axes[0, 0].legend(loc="upper left")
        frf_axes(figure, axes, (0, 0.25, 0.5, 0.75, 1))


def shared_channels(runs: Sequence[RecordedRun], wanted: Mapping[str, str]) -> dict[str, str]:
    """Return the requested channels common to all runs."""
    return {name: label for name, label in wanted.items() if all(name in run.recording.channels for run in runs)}
