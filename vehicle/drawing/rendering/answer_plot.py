"""Pictures on the first screen of a report: changes of comfort and loads, and bands of the weighted acceleration."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.drawing.rendering.figure import (
    COLOURS,
    COMFORT_TICKS,
    INK,
    PAGE_WIDTH,
    frequency_ticks,
    saved_figure,
    wrapped,
)
from vehicle.drawing.rendering.tornado_plot import ROUGHER, SMOOTHER
from vehicle.signals.analysis.samples import Vector

BETTER, WORSE, NEUTRAL = SMOOTHER, ROUGHER, "#9aa5b1"
"""Colours of a change: smaller vibration or load, larger vibration or load, no rating."""

FULL_PANEL = 1.0
"""Smallest change [%] that fills a panel; a smaller change is a short bar."""


@dataclass(frozen=True, slots=True)
class Change:
    """Change of a number between two runs.

    Attributes:
        label: number in words, with values and unit.
        percent: change [%].
        rated: True if a smaller number is better; False for a number without a rating.
    """

    label: str
    percent: float
    rated: bool = True


def plot_changes(path: Path, changes: Mapping[str, Sequence[Change]], title: str, caption: str) -> None:
    """Plot the changes of numbers as bars, a panel for each run, one below the other.

    Args:
        changes: name of the run to its changes against the first run; equal labels in all runs are not needed.
    """
    highest = max(len(of_run) for of_run in changes.values())
    height = 0.7 + len(changes) * (0.6 + (0.27 if len(changes) == 1 else 0.22) * highest)
    with saved_figure(path, (PAGE_WIDTH, height), title, caption) as figure:
        axes = figure.subplots(len(changes), 1, squeeze=False)[:, 0]
        for axis, (name, of_run) in zip(axes, changes.items(), strict=True):
            percent = np.array([change.percent for change in of_run])
            colours = [NEUTRAL if not change.rated else BETTER if change.percent < 0.0 else WORSE for change in of_run]
            rows = np.arange(len(of_run))
            axis.barh(rows, percent, color=colours, height=0.7)
            axis.axvline(0.0, color=INK, linewidth=0.8)
            texts = [f"{value:+.1f} %" if abs(value) < 10.0 else f"{value:+.0f} %" for value in percent]
            # A phone shows the labels without scrolling, the bars not.
            labels = [f"{change.label}: {text}" for change, text in zip(of_run, texts, strict=True)]
            axis.set_yticks(rows, labels)
            axis.invert_yaxis()
            room = 0.05 * max(float(np.max(np.abs(percent), initial=0.0)), FULL_PANEL)
            axis.set_xlim(
                min(float(percent.min()), -0.2 * FULL_PANEL) - room, max(float(percent.max()), 0.2 * FULL_PANEL) + room
            )
            axis.set_xlabel("change [%]")
            if len(changes) > 1:
                axis.set_title(name)
            axis.grid(visible=False, axis="y")


def plot_bands(
    path: Path, edges: Vector, powers: Mapping[str, Vector], modes: Mapping[str, float], caption: str, width: float
) -> None:
    """Plot the share of each third octave in the weighted acceleration, stacked by axis.

    Args:
        edges: edges of the bands [Hz]; (b + 1,).
        powers: axis to the mean square in each band [(m/s2)^2]; (b,).
        modes: short names of natural modes to their frequencies [Hz], marked above the bars.
        width: width of the figure [inch].
    """
    total = sum(float(power.sum()) for power in powers.values()) or 1.0
    title = "Frequencies in the weighted acceleration of the seat rail"
    with saved_figure(path, (width, 3.6), title, wrapped(caption, width)) as figure:
        axis: Any = figure.subplots()
        base = np.zeros(edges.size - 1)
        for (name, power), colour in zip(powers.items(), COLOURS, strict=False):
            share = 100.0 * power / total
            axis.bar(edges[:-1], share, np.diff(edges), base, align="edge", color=colour, label=name, linewidth=0.0)
            base = base + share
        highest = float(base.max())
        for name, frequency in modes.items():
            band = int(np.clip(np.searchsorted(edges, frequency) - 1, 0, base.size - 1))
            axis.annotate(
                name, (frequency, base[band]), (0, 12), textcoords="offset points", ha="center", fontsize=8, color=INK,
                arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.7},
            )  # fmt: skip
        axis.set(xscale="log", xlim=(edges[0], edges[-1]), ylim=(0.0, 1.25 * highest if highest else 1.0))
        axis.set(xlabel="frequency [Hz]", ylabel="share of the weighted\nmean square [%]")
        frequency_ticks(axis, COMFORT_TICKS)
        axis.legend(title="axis", loc="upper left")
