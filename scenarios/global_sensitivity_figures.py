"""Figures of the global sensitivity: bars of the indices, effects against their scatter, a scatter of all runs."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from vehicle.output.folder import write_whole
from vehicle.parameters.paths import unit_of
from vehicle.parameters.ranges import Range
from vehicle.parameters.vehicle import Vehicle
from vehicle.rendering.figure import COLOURS, saved_figure
from vehicle.sweeps.indices import MorrisEffects, SobolIndices

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw_sobol(path: Path, found: SobolIndices, caption: str) -> None:
    """Bars of first-order and total indices with their 95 % intervals, the largest on top."""
    order = np.argsort(found.total)
    place = np.arange(len(order))

    def draw(temporary: Path) -> None:
        with saved_figure(temporary, (9.0, 5.6)) as figure:
            axes = figure.add_subplot()
            for values, errors, shift, label, colour in (
                (found.first, found.first_error, -0.2, "S1, alone", COLOURS[0]),
                (found.total, found.total_error, 0.2, "ST, with all interactions", COLOURS[3]),
            ):
                axes.barh(place - shift, values[order], 0.38, xerr=errors[order], label=label, color=colour, capsize=2)
            axes.set_yticks(place, [_short(found.paths[i]) for i in order])
            axes.set_xlabel("share of the variance of the comfort value [-]")
            axes.axvline(0.0, color="#444444", linewidth=0.8)
            axes.grid(axis="x", alpha=0.3)
            axes.legend(loc="lower right")
            _caption(figure, caption + "; whiskers: 95 % intervals (bootstrap)")

    write_whole(path, draw)


def draw_morris(path: Path, found: MorrisEffects, caption: str) -> None:
    """Scatter of the elementary effects over their mean size."""

    def draw(temporary: Path) -> None:
        with saved_figure(temporary, (9.0, 5.6)) as figure:
            axes = figure.add_subplot()
            axes.errorbar(
                found.mean_size, found.scatter, xerr=found.mean_size_error, fmt="o", color=COLOURS[0], capsize=2
            )
            for name, x, y in zip(found.paths, found.mean_size, found.scatter, strict=True):
                axes.annotate(_short(name), (x, y), xytext=(6, 4), textcoords="offset points", fontsize=8)
            axes.set_xlabel("mu*, mean size of the effect over the whole range [m/s2]")
            axes.set_ylabel("sigma, scatter of the effect: interaction and curvature [m/s2]")
            axes.margins(0.15)
            axes.grid(alpha=0.3)
            _caption(figure, caption + "; whiskers: 95 % intervals (bootstrap)")

    write_whole(path, draw)


def draw_scatter(
    path: Path, ranges: Sequence[Range], points: npt.NDArray[np.float64], comfort: npt.NDArray[np.float64], caption: str
) -> None:
    """Comfort value of every run over each parameter."""

    def draw(temporary: Path) -> None:
        columns = 5
        rows = -(-len(ranges) // columns)
        with saved_figure(temporary, (13.0, 2.8 * rows + 0.6)) as figure:
            panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
            for index, one in enumerate(ranges):
                axes = panels[index // columns][index % columns]
                axes.plot(points[:, index], comfort, ".", markersize=3, color=COLOURS[0])
                axes.set_xlabel(f"{_short(one.path)} [{unit_of(Vehicle, one.path)}]", fontsize=7)
                axes.tick_params(labelsize=7)
                axes.grid(alpha=0.3)
            for row in panels:
                row[0].set_ylabel("comfort value [m/s2]", fontsize=8)
            _caption(figure, caption)

    write_whole(path, draw)


def _short(path: str) -> str:
    return path.removeprefix("bushings.")


def _caption(figure: Figure, text: str) -> None:
    """Caption below everything, as the layout's own label."""
    figure.supxlabel(textwrap.fill(text, 120), fontsize=7, color="#444444", x=0.01, ha="left")
