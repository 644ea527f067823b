"""Pictures of spectra of one or several runs over each other: accelerations, and roads against ISO 8608."""

from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.figure import (
    COMFORT_TICKS,
    INK,
    PAGE_WIDTH,
    frequency_ticks,
    looks,
    power_of_ten,
    saved_figure,
    wrapped,
)
from vehicle.drawing.rendering.open_axes import label_once
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.road_level import CLASS_WIDTH, CLASSES, REFERENCE, RoadLevel
from vehicle.signals.analysis.vibration_spectra import ChannelSpectrum

WEIGHTED = {"alpha": 0.55, "linewidth": 2.2}
"""Style of weighted spectra, in the colour of the run."""

SHOWN = (0.01, 5.0)
"""Wavenumbers of a picture of roads [cycles/m]."""

NAME_WIDTH = 36
"""Largest number of letters of a line in a legend, so that it fits its column."""

DECADES = 1e5
"""Range of a density in a picture, from its largest value."""


def plot_spectra(
    path: Path,
    runs: Mapping[str, Sequence[ChannelSpectrum]],
    channels: Mapping[str, str],
    title: str = "",
    caption: str = "",
    max_width: float = 13.0,
) -> None:
    """Plot densities, third octaves and cumulative RMS, a column for each channel.

    Columns of one unit have the same scale, so that channels and runs can be compared.

    Args:
        runs: name to the spectra of a run.
        channels: channel that is in all runs to the title of its column.
        max_width: maximum width [inch].
    """
    size = (min(max(7.0, 1.6 + 3.8 * len(channels)), max_width), 8.6 if max_width > PAGE_WIDTH else 6.6)
    with saved_figure(path, size, title, wrapped(caption, size[0])) as figure:
        axes = figure.subplots(3, len(channels), sharex=True, height_ratios=(2.0, 1.3, 1.3), squeeze=False)
        draw_spectra(axes, runs, channels)


def draw_spectra(
    axes: npt.NDArray[Any], runs: Mapping[str, Sequence[ChannelSpectrum]], channels: Mapping[str, str]
) -> None:
    """Draw densities, third octaves and cumulative RMS, a column for each channel; columns of one unit share a scale.

    Args:
        axes: axes, (3, channels), with a shared frequency.
    """
    first, largest = dict[str, npt.NDArray[Any]](), dict[str, float]()
    drawn = sum(line.get_alpha() is None for line in axes[0, 0].lines)  # those of the weighted spectra are pale
    for column, (channel, heading) in zip(axes.T, channels.items(), strict=True):
        unit = next(spectrum.unit for spectra in runs.values() for spectrum in spectra if spectrum.name == channel)
        for axis, label, leader in zip(column, _labels(unit), first.setdefault(unit, column), strict=True):
            if leader is axis:
                axis.set_ylabel(label)
            elif not axis.get_shared_y_axes().joined(axis, leader):
                axis.sharey(leader)
                axis.tick_params(labelleft=False)
        for (name, spectra), look in zip(runs.items(), islice(looks(), drawn, None), strict=False):
            for spectrum in (spectrum for spectrum in spectra if spectrum.name == channel):
                label = fill(f"{name}, weighted", NAME_WIDTH) if spectrum.weighting else fill(name, NAME_WIDTH)
                style = look | (WEIGHTED if spectrum.weighting else {})
                bands = spectrum.third_octaves
                column[0].plot(spectrum.frequency, spectrum.density, **style)
                column[1].stairs(bands.rms, bands.edges, baseline=None, **style)
                column[2].plot(spectrum.frequency, spectrum.cumulative_rms, label=label, **style)
                largest[unit] = max(largest.get(unit, 0.0), float(spectrum.density.max()))
        column[0].set_title(heading)
        column[2].set_xlabel("frequency [Hz]")
    axes[2, 0].legend(loc="upper left")
    for axis in axes[0]:
        axis.set(xscale="log", yscale="log", xlim=_limits(runs))
    for unit, column in first.items():
        if largest[unit] > 0.0:
            column[0].set_ylim(largest[unit] / DECADES, 2.0 * largest[unit])
        column[0].yaxis.set_major_formatter(power_of_ten)
        for axis in column[1:]:
            axis.set_ylim(bottom=0.0)
    for axis in axes[2]:
        frequency_ticks(axis, COMFORT_TICKS)
        axis.set_xlim(_limits(runs))
    axes[0, 0].figure.align_ylabels(axes[:, 0])


def _labels(unit: str) -> tuple[str, str, str]:
    """Return the labels of density, third octaves and cumulative RMS."""
    shown = unit.replace("m/s2", "m/s²")
    square = f"({shown})²" if "/" in shown or " " in shown else f"{shown}²"
    return f"density [{square}/Hz]", f"RMS in third\noctaves [{shown}]", f"cumulative RMS\n[{shown}]"


def draw_densities(axis: Any, spectra: Sequence[ChannelSpectrum], car: str) -> None:
    """Draw the densities of several channels on the same axes; curves that the axes already have stay.

    Raises:
        ConfigurationError: the channels, or the curves on the axes, have several units.
    """
    if len(units := sorted({spectrum.unit for spectrum in spectra})) > 1:
        raise ConfigurationError(f"ax: the channels are in {', '.join(units)}; plot each unit on axes of its own")
    label_once(axis, _labels(units[0])[0])
    for spectrum, look in zip(spectra, islice(looks(), len(axis.lines), None), strict=False):
        axis.plot(spectrum.frequency, spectrum.density, label=f"{car}: {spectrum.label}", **look)
    axis.set(xscale="log", yscale="log", xlabel="frequency [Hz]", xlim=_limits({"": spectra}))
    frequency_ticks(axis, COMFORT_TICKS)
    drawn = np.concatenate([line.get_ydata() for line in axis.lines])
    if drawn.size and drawn.max() > 0.0:
        axis.set_ylim(drawn.max() / DECADES, 2.0 * drawn.max())
    axis.legend()


def _limits(runs: Mapping[str, Sequence[ChannelSpectrum]]) -> tuple[float, float]:
    """Return the range of the frequency axis [Hz]: the bands of all runs."""
    edges = [spectrum.third_octaves.edges[[0, -1]] for spectra in runs.values() for spectrum in spectra]
    return float(min(pair[0] for pair in edges)), float(max(pair[1] for pair in edges))


def plot_road_levels(path: Path, levels: Mapping[str, RoadLevel], title: str = "", caption: str = "") -> None:
    """Plot the density of road heights over the wavenumber, with the limits of the classes of ISO 8608.

    Args:
        levels: name of the run and wheel to the level of its road.
    """
    with saved_figure(path, (7.6, 6.0), title, caption) as figure:
        axis: Any = figure.subplots()
        for (name, level), look in zip(levels.items(), looks(), strict=False):
            label = f"{name}: class {level.letter}, G(n₀) = {1e6 * level.reference_density:.3g}·10⁻⁶ m³"
            axis.plot(level.wavenumber, level.density, label=label, **look)
        shown = np.array(SHOWN)
        fitted = np.concatenate(
            [
                level.density[(level.wavenumber >= level.fitted[0]) & (level.wavenumber <= level.fitted[1])]
                for level in levels.values()
            ]
        )
        low, high = 0.1 * float(fitted.min()), 10.0 * float(fitted.max())
        for letter, mean in CLASSES.items():
            limit = CLASS_WIDTH * mean * (shown / REFERENCE) ** -2.0
            axis.plot(shown, limit, color=INK, linewidth=0.7, linestyle=":")
            middle = mean * (shown[0] / REFERENCE) ** -2.0
            if low < middle < high:
                axis.annotate(f" {letter}", (shown[0], middle), fontsize=9, color=INK, va="center")
        axis.set(xscale="log", yscale="log", xlabel="wavenumber [cycles/m]", ylabel="density of the height [m³]")
        axis.set(xlim=SHOWN, ylim=(low, high))
        axis.xaxis.set_major_formatter(power_of_ten)
        axis.yaxis.set_major_formatter(power_of_ten)
        axis.legend(loc="upper right")
