"""Picture of modal participation: contributions to an acceleration over frequency, and their shares at one line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, FRF_TICKS, INK, frequency_ticks, name_bars, saved_figure
from vehicle.signals.analysis.samples import Vector

if TYPE_CHECKING:
    from matplotlib.axes import Axes

OTHERS = "#bdbdbd"
"""Colour of the sum of contributions without a separate colour."""

HATCHES = ("", "//", "..", "\\\\", "xx")
"""Hatches in addition to the colours, to distinguish areas in black-and-white print."""

MOST_BARS = 10


def plot_participation(
    path: Path,
    channel: str,
    frequency: Vector,
    parts: Mapping[str, Vector],
    at: float,
    shares: Mapping[str, float],
    driven: tuple[str, Mapping[str, float]],
    description: str,
) -> None:
    """Write the picture of modal participation.

    Args:
        frequency: lines [Hz], (m,).
        parts: contributions in phase with their sum [m/s2 per m], (m,) each; they add up to its magnitude.
        at: frequency of the bars [Hz].
        shares: shares of the contributions at that frequency [-].
        driven: name of a mode, and the shares of the attachments in its modal force at that frequency [-].
    """
    total = np.sum(list(parts.values()), axis=0)
    # Colour the contributions that are largest where the response is large.
    weight = {name: float(np.sum(np.abs(part) * total)) for name, part in parts.items()}
    largest = sorted(weight, key=lambda name: -weight[name])[: len(COLOURS)]
    areas = {name: parts[name] for name in largest}
    areas["all others"] = total - np.sum(list(areas.values()), axis=0)
    colours = dict(zip(areas, (*COLOURS, OTHERS), strict=False)) | {"all others": OTHERS}
    hatches = dict(zip(largest, HATCHES, strict=False))
    caption = f"{description}; in phase with the sum: Re(c conj(a)) / |a|, below zero what works against it"
    with saved_figure(path, (11.0, 9.0), f"What makes {channel} loud", caption) as figure:
        halves: Any = figure.subfigures(2, 1, height_ratios=(1.25, 1.0))
        above, below = halves
        upper = above.add_subplot()
        left, right = (below.add_subplot(1, 2, number) for number in (1, 2))
        for sign in (1.0, -1.0):
            bottom = np.zeros_like(frequency)
            for name, part in areas.items():
                height = np.maximum(sign * part, 0.0)
                upper.fill_between(
                    frequency,
                    sign * bottom,
                    sign * (bottom + height),
                    facecolor=colours[name],
                    edgecolor="#ffffff",
                    hatch=hatches.get(name, ""),
                    linewidth=0.0,
                    label=name if sign > 0.0 else None,
                )
                bottom = bottom + height
        upper.plot(frequency, total, color="black", label="sum: magnitude of the FRF")
        upper.axhline(0.0, color=INK, linewidth=0.6)
        upper.axvline(at, color="black", linestyle="--", linewidth=0.8, label=f"{at:g} Hz")
        upper.set(xscale="log", xlim=(frequency[0], frequency[-1]), xlabel="frequency [Hz]")
        upper.set(ylabel="contribution in phase with the sum [(m/s²)/m]")
        frequency_ticks(upper, FRF_TICKS)
        upper.legend(loc="upper left")
        _bars(left, shares, colours, f"share in the sum at {at:g} Hz [%]")
        mode, forces = driven
        _bars(right, forces, {}, f"at {at:g} Hz: share in the force [%] on\n{mode}")


def _bars(axis: Axes, shares: Mapping[str, float], colours: Mapping[str, str], label: str) -> None:
    """Draw bars of the largest shares and a bar of the sum of the others."""
    order = sorted(shares, key=lambda name: -abs(shares[name]))
    shown = {name: shares[name] for name in order[:MOST_BARS]}
    if order[MOST_BARS:]:
        shown[f"the other {len(order) - MOST_BARS}"] = sum(shares[name] for name in order[MOST_BARS:])
    values = [100.0 * share for share in shown.values()]
    rows = np.arange(len(values))
    axis.barh(rows, values, color=[colours.get(name, OTHERS) for name in shown])
    axis.axvline(0.0, color=INK, linewidth=0.6)
    axis.set_yticks(rows, list(shown))
    axis.invert_yaxis()
    axis.grid(visible=False, axis="y")
    axis.margins(x=0.18)
    axis.set(xlabel=label)
    name_bars(axis, values, [f"{round(value) + 0:+d}" for value in values], 3)
