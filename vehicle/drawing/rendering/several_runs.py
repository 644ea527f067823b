"""Comparison of several runs: FRFs, and acceleration densities on a road."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.figure import (
    COLOURS,
    FRF_BAND,
    FRF_TICKS,
    LINES,
    fading,
    frf_axes,
    saved_figure,
    wrapped_phase,
)
from vehicle.drawing.rendering.recorded_run import RecordedRun
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.spectra import power_spectral_density

WINDOW, AVERAGES = 4.0, 4.0
"""Length of the windows of a density [s]; a shorter record has this many windows' length in it."""


def plot_responses(
    path: Path,
    runs: Mapping[str, tuple[RecordedRun, FrequencyResponse]],
    channels: Mapping[str, str],
    title: str = "",
    caption: str = "",
) -> None:
    """Plot FRFs of several runs over each other, with a column for each channel.

    Args:
        path: PNG or SVG file.
        runs: name to run and FRFs of all its acceleration channels.
        channels: channel recorded in all runs to the title of its column.
        title, caption: above and below the figure.
    """
    with saved_figure(path, (13.0, 7.6), title, caption) as figure:
        axes = figure.subplots(
            3, len(channels), sharex=True, sharey="row", height_ratios=(2.2, 1.0, 0.9), squeeze=False
        )
        for (channel, title_of_column), column in zip(channels.items(), axes.T, strict=True):
            for (name, (run, response)), colour, line in zip(runs.items(), cycle(COLOURS), cycle(LINES), strict=False):
                row = run.car.model.vehicle.acceleration_channels.index(channel)
                style = {"color": colour, "linestyle": line}
                size = np.abs(response.response[row])
                fading(column[0], response.frequency, size, response.coherence[row], name, **style)
                column[1].plot(response.frequency, wrapped_phase(response.response[row]), **style)
                column[2].plot(response.frequency, response.coherence[row], **style)
            column[0].set_title(title_of_column)
        axes[0, 0].legend(loc="upper left")
        frf_axes(figure, axes, (0, 0.25, 0.5, 0.75, 1))


def plot_densities(
    path: Path,
    runs: Mapping[str, RecordedRun],
    channels: Mapping[str, str],
    title: str = "",
    caption: str = "",
) -> None:
    """Plot power spectral densities of accelerations of one or several runs.

    Args:
        path: PNG or SVG file.
        runs: name to run.
        channels: channel recorded in all runs to the title of its panel.
        title, caption: above and below the figure.
    """
    with saved_figure(path, (13.0, 4.2), title, caption) as figure:
        axes = figure.subplots(1, len(channels), sharex=True, squeeze=False)[0]
        for axis, (channel, title_of_panel) in zip(axes, channels.items(), strict=True):
            for (name, run), colour, line in zip(runs.items(), cycle(COLOURS), cycle(LINES), strict=False):
                recording = run.recording
                window = min(WINDOW, float(recording.time[-1]) / AVERAGES)
                densities = power_spectral_density(recording.timestep, recording[channel][None], window_s=window)
                inside = (densities.frequency >= FRF_BAND[0]) & (densities.frequency <= FRF_BAND[1])
                axis.plot(
                    densities.frequency[inside], densities.density[0, inside], color=colour, linestyle=line, label=name
                )
            axis.set(xscale="log", yscale="log", xlim=FRF_BAND, title=title_of_panel, xlabel="frequency [Hz]")
            axis.set_xticks(FRF_TICKS, [str(tick) for tick in FRF_TICKS])
            axis.set_xticks([], minor=True)
        axes[0].set_ylabel("density of the acceleration [(m/s²)²/Hz]")
        if len(runs) > 1:
            axes[0].legend(loc="lower left")


def shared_channels(runs: Sequence[RecordedRun], wanted: Mapping[str, str]) -> dict[str, str]:
    """Return the requested channels that are in all runs.

    Args:
        runs: the runs.
        wanted: channel to its label.
    """
    return {name: label for name, label in wanted.items() if all(name in run.recording.channels for run in runs)}
