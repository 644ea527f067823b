"""Pictures of periodic states over frequency and level: map with FRFs, and damping over level."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.arrays import Mask, Vector
from vehicle.digits import number
from vehicle.drawing.rendering.figure import COLOURS, INK, power_of_ten, saved_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIZE = (12.0, 5.9)
"""Width and height of the map with its FRFs [inch]."""

PRONOUNCED = 1.12
"""Minimum height of a peak over its valleys [-]: 1 dB."""

LINKED = 0.12
"""Largest change of ln f from one level to the next along the line of a peak."""

ON_MAP = ("#ffb000", "#ff9ecb", "#ffffff", "#9ee6ff", "#c8ff7a", "#ffb08a")
"""Colours of the dampers on a map: bright, for a dark ground."""

TICKS = (0.2, 0.3, 0.5, 0.7, 1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100)
"""Frequencies with a label [Hz]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelPicture:
    """Data of the pictures.

    Attributes:
        frequency: frequencies [Hz]; (f,).
        level: levels; (l,).
        amplitude: quantity and unit of the levels.
        size: magnitude of the FRF; (f, l), NaN without a result.
        label: quantity and unit of the magnitude.
        slipping: level at which each damper begins to slip, by its name in words; (f,) each.
        outside: True where the linear geometry is not valid; (f, l).
    """

    frequency: Vector
    level: Vector
    amplitude: str
    size: Vector
    label: str
    slipping: Mapping[str, Vector]
    outside: Mask


def plot_level_map(path: Path, data: LevelPicture, rows: Sequence[int], title: str, caption: str) -> None:
    """Write the map of the FRF over frequency and level, and the FRFs at some levels.

    Args:
        path: PNG or SVG file.
        data: the map.
        rows: indices of the levels of the FRFs.
        title, caption: above and below the figure.
    """
    from matplotlib import colormaps

    with saved_figure(path, SIZE, title, caption) as figure:
        left, right = figure.subplots(1, 2, gridspec_kw={"width_ratios": (1.12, 1.0)})
        figure.colorbar(_map(left, data, data.size, "viridis"), ax=left, pad=0.015)
        for index, line in enumerate(ridges(data.frequency, data.size)):
            at, levels = line
            left.plot(
                at, data.level[levels], color="black", linewidth=1.5, label="peaks of the FRF" if not index else None
            )
        _slip_lines(left, data)
        _legend(left)
        colours = colormaps["plasma"](np.linspace(0.0, 0.88, len(rows)))
        for row, colour in zip(rows, colours, strict=True):
            right.plot(data.frequency, data.size[:, row], color=colour, label=number(data.level[row]), linewidth=1.3)
        right.set(xscale="log", yscale="log", xlim=data.frequency[[0, -1]], xlabel="frequency [Hz]", ylabel=data.label)
        right.yaxis.set_major_formatter(power_of_ten)
        frequency_ticks(right, data.frequency)
        right.legend(title=data.amplitude, loc="best", ncols=1 + (len(rows) > 5))


def plot_level_damping(
    path: Path,
    data: LevelPicture,
    *,
    band: tuple[float, float],
    peaks: tuple[Vector, Vector],
    mode: tuple[Vector, Vector],
    damping: Mapping[str, Vector],
    viscous: Mapping[str, float],
    distortion: Vector,
    title: str,
    caption: str,
) -> None:
    """Write peak, damping ratio, damping constants over the level, and the map of the distortion.

    Args:
        path: PNG or SVG file.
        data: the map.
        band: band of the peak [Hz].
        peaks: frequency [Hz] and height of the highest FRF value in the band; (l,) each.
        mode: frequency [Hz] and damping ratio [-] of the mode; (l,) each.
        damping: damping constants of the same energy by damper [N s/m]; (l,) each.
        viscous: slopes of the laws without friction by damper [N s/m].
        distortion: RMS of the higher harmonics over the first; (f, l).
        title, caption: above and below the figure.
    """
    with saved_figure(path, (12.0, 8.4), title, caption) as figure:
        (first, second), (third, last) = figure.subplots(2, 2)
        for axes, (frequency, values), heading, label in (
            (first, peaks, f"Highest peak, {number(band[0])} to {number(band[1])} Hz", data.label),
            (second, (mode[0], 100.0 * mode[1]), "Mode with viscous dampers of the same energy", "damping ratio [%]"),
        ):
            axes.plot(data.level, values, color="black", linewidth=1.8)
            axes.set(xscale="log", yscale="log", title=heading, ylabel=label)
            beside = axes.twinx()
            beside.plot(data.level, frequency, color=COLOURS[1], linewidth=1.3)
            beside.set_ylabel("its frequency [Hz]", color=COLOURS[1])
            beside.tick_params(axis="y", labelcolor=COLOURS[1])
            beside.grid(visible=False)
            _plain_log(axes.yaxis, values)
        for (name, values), colour in zip(damping.items(), COLOURS, strict=False):
            third.plot(data.level, values, color=colour, linewidth=1.8, label=name)
            third.axhline(viscous[name], color=colour, linestyle=":", linewidth=1.0)
        smallest = min((value for value in viscous.values() if value > 0.0), default=1.0)
        third.set(xscale="log", yscale="log", title="Damping constant of the same energy; dotted: without friction")
        third.set(ylabel="damping constant [N s/m]", ylim=(0.5 * smallest, 500.0 * smallest))
        third.yaxis.set_major_formatter(power_of_ten)
        third.legend(loc="upper right")
        shown = 100.0 * np.clip(distortion, 1e-3, 1.0)
        image = _map(last, data, shown, "magma_r")
        bar = figure.colorbar(image, ax=last, pad=0.015)
        bar.set_label("RMS of the higher harmonics over the first [%]")
        _plain_log(bar.ax.yaxis, shown)
        last.set_title("Distortion")
        _slip_lines(last, data, COLOURS)
        _legend(last)
        for axes in (first, second, third):
            axes.set(xlim=data.level[[0, -1]], xlabel=data.amplitude)
            _plain_log(axes.xaxis, data.level)


def ridges(frequency: Vector, size: Vector) -> list[tuple[Vector, Any]]:
    """Return the lines of the peaks of an FRF over the levels: frequencies and indices of the levels of each line.

    Args:
        frequency: frequencies [Hz]; (f,).
        size: magnitude; (f, l).
    """
    lines: list[list[tuple[float, int]]] = []
    for row, values in enumerate(size.T):
        for peak in peaks_of(values):
            centre = float(frequency[peak])
            near = [line for line in lines if line[-1][1] == row - 1 and abs(np.log(centre / line[-1][0])) < LINKED]
            if near:
                min(near, key=lambda line: abs(np.log(centre / line[-1][0]))).append((centre, row))
            else:
                lines.append([(centre, row)])
    return [(np.array([at for at, _ in line]), [row for _, row in line]) for line in lines if len(line) > 2]


def peaks_of(values: Vector) -> list[int]:
    """Return the indices of the maxima that exceed both of their valleys by `PRONOUNCED`."""
    inner = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    indices = []
    for index in inner.tolist():
        higher = np.flatnonzero(values > values[index])
        low, high = higher[higher < index], higher[higher > index]
        before = values[(low[-1] if low.size else 0) : index].min()
        after = values[index + 1 : (high[0] + 1 if high.size else len(values))].min()
        if values[index] > PRONOUNCED * max(before, after):
            indices.append(index)
    return indices


def _map(axes: Axes, data: LevelPicture, values: Vector, colours: str) -> Any:
    """Draw a map on logarithmic scales; points without a result are grey."""
    from matplotlib import colormaps
    from matplotlib.colors import LogNorm

    table = colormaps[colours].with_extremes(bad="#b0b0b0")
    low, high = np.nanmin(values), np.nanmax(values)
    norm = LogNorm(low, max(high, 1.001 * low))
    # Interpolate the colours, unless a point has no result.
    smooth = bool(np.isfinite(values).all()) and min(values.shape) > 1
    x, y = (data.frequency, data.level) if smooth else (_edges(data.frequency), _edges(data.level))
    image = axes.pcolormesh(
        x, y, np.ma.masked_invalid(values.T), cmap=table, norm=norm, rasterized=True,
        shading="gouraud" if smooth else "flat",
    )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="frequency [Hz]", ylabel=data.amplitude)
    axes.set(xlim=data.frequency[[0, -1]], ylim=data.level[[0, -1]])
    axes.grid(visible=False)
    frequency_ticks(axes, data.frequency)
    _plain_log(axes.yaxis, data.level)
    axes.set_facecolor("#b0b0b0")
    if data.outside.any():
        axes.contour(data.frequency, data.level, data.outside.T.astype(float), [0.5], colors=INK, linestyles=":")
        axes.plot([], [], ":", color=INK, label="above: outside the linear geometry")
    if not np.isfinite(values).all():
        axes.plot([], [], "s", color="#b0b0b0", label="no result")
    return image


def _slip_lines(axes: Axes, data: LevelPicture, colours: Sequence[str] = ON_MAP) -> None:
    """Draw the levels at which the dampers begin to slip, with a dark edge for bright maps."""
    from matplotlib.patheffects import withStroke

    outlined = [withStroke(linewidth=3.6, foreground="#222222")] if colours is ON_MAP else []
    for (name, line), colour in zip(data.slipping.items(), colours, strict=False):
        axes.plot(data.frequency, line, color=colour, linewidth=1.9, path_effects=outlined, label=name)


def _legend(axes: Axes) -> None:
    """Explain the lines below the map, where they hide nothing."""
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.11), ncols=2, framealpha=0.0)


def _edges(centres: Vector) -> Vector:
    """Return the edges of cells around places on a logarithmic scale; (n + 1,)."""
    if len(centres) == 1:
        return np.asarray(centres[0] * np.array([0.97, 1.03]))
    middle = np.sqrt(centres[1:] * centres[:-1])
    return np.concatenate([[centres[0] ** 2 / middle[0]], middle, [centres[-1] ** 2 / middle[-1]]])


def frequency_ticks(axes: Axes, frequency: Vector) -> None:
    """Label frequencies [Hz] on a logarithmic axis."""
    ticks = [tick for tick in TICKS if frequency[0] <= tick <= frequency[-1]]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)


def _plain_log(axis: Any, values: Vector) -> None:
    """Set tick labels of a logarithmic axis, more in each decade of a short axis."""
    finite = values[np.isfinite(values) & (values > 0.0)]
    if not finite.size:
        return
    low, high = float(finite.min()), float(finite.max())
    decades = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
    span = np.log10(high / low)
    steps = (1, 3) if span > 2.0 else (1, 2, 5) if span > 0.8 else (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)
    ticks = [step * 10.0**decade for decade in decades for step in steps]
    ticks = [tick for tick in ticks if 0.999 * low <= tick <= 1.001 * high]
    axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
    axis.set_ticks([], minor=True)
