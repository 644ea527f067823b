"""Pictures of orders over speed: order cuts with their limits, and a Campbell map with the modes by name."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS, INK, saved_figure

DEEPEST = 60.0
"""Range of the colours of a map below its largest amplitude [dB]."""

APART = 0.032
"""Smallest distance of two names of modes, over the height of the map."""

LABEL = 44
"""Maximum length of the name of a mode."""


def plot_order_cuts(
    path: Path,
    points: Vector,
    turns: Vector,
    orders: Vector,
    curves: Sequence[Vector],
    labels: tuple[str, str],
    title: str,
    caption: str,
) -> None:
    """Write order cuts: amplitude over the speed, a panel for each order.

    Args:
        points: speeds; (k,).
        turns: turns per second [Hz]; (k,).
        curves: amplitudes of the runs, with friction that holds and without friction; (o, k) each.
    """
    names = (("run", "o-"), ("friction holds", "--"), ("without friction", ":"))
    with saved_figure(path, (9.5, 1.4 + 2.4 * len(orders)), title, caption) as figure:
        panels = figure.subplots(len(orders), 1, sharex=True, squeeze=False)[:, 0]
        for row, (axes, order) in enumerate(zip(panels, orders, strict=True)):
            for (name, style), curve, colour in zip(names, curves, COLOURS, strict=False):
                if np.isfinite(curve[row]).any():
                    axes.plot(points, curve[row], style, color=colour, markersize=3, label=name)
            axes.set_ylim(0.0, None)
            axes.set_ylabel(f"order {order:g}\n{labels[1]}")
            above = axes.secondary_xaxis("top", functions=_conversion(points, order * turns))
            above.set_xlabel(f"frequency of order {order:g} [Hz]")
        panels[0].legend()
        panels[-1].set_xlabel(labels[0])


def _conversion(points: Vector, frequency: Vector):  # type: ignore[no-untyped-def]
    """Return the functions from speed to frequency and back; both are proportional."""
    ratio = float(frequency[-1] / points[-1])
    return (lambda speed: speed * ratio, lambda frequencies: frequencies / ratio)


def plot_campbell(
    path: Path,
    points: Vector,
    turns: Vector,
    orders: Vector,
    frequency: Vector,
    spectrum: Vector,
    modes: Sequence[tuple[float, str]],
    labels: tuple[str, str],
    title: str,
    caption: str,
) -> None:
    """Write a Campbell map: amplitude over speed and frequency, lines of the orders, modes by name.

    Args:
        points: speeds; (k,).
        turns: turns per second [Hz]; (k,).
        frequency: frequencies [Hz]; (f,).
        spectrum: amplitudes; (k, f).
        modes: frequency [Hz] and name of each mode.
    """
    from matplotlib.patheffects import withStroke

    top = float(np.max(spectrum[:, 1:]))
    decibel = 20.0 * np.log10(np.maximum(spectrum / top, 10.0 ** (-DEEPEST / 20.0)))
    with saved_figure(path, (9.5, 6.2), title, caption) as figure:
        axes = figure.subplots()
        middles = 0.5 * (points[1:] + points[:-1])
        edges = np.concatenate([[2.0 * points[0] - middles[0]], middles, [2.0 * points[-1] - middles[-1]]])
        half = 0.5 * (frequency[1] - frequency[0])
        image = axes.pcolormesh(
            edges, np.append(frequency - half, frequency[-1] + half), decibel.T, cmap="viridis", rasterized=True
        )
        bar = figure.colorbar(image, ax=axes, location="left", pad=0.09, shrink=0.8)
        bar.set_label(f"{labels[1]}, dB below {top:.3g}")
        outlined = [withStroke(linewidth=2.4, foreground="#222222")]  # white is not seen on yellow
        top_line = float(frequency[-1])
        for order in orders:
            slope = order * turns[-1] / points[-1]
            axes.plot(edges[[0, -1]], slope * edges[[0, -1]], "--", color="white", linewidth=0.9, path_effects=outlined)
            if slope * edges[0] < top_line:
                end = min(edges[-1], top_line / slope)
                axes.annotate(
                    f"order {order:g}", (end, slope * end), color="white", fontsize=9, path_effects=outlined,
                    xytext=(-8, -12), textcoords="offset points", ha="right",
                )  # fmt: skip
        axes.set(xlim=edges[[0, -1]], ylim=(0.0, float(frequency[-1])), xlabel=labels[0], ylabel="frequency [Hz]")
        axes.grid(visible=False)
        height = -1.0
        for value, name in sorted(modes):
            axes.axhline(value, color="#dddddd", linewidth=0.7)
            height = max(value / float(frequency[-1]), height + APART)
            short = name if len(name) <= LABEL else f"{name[: LABEL - 1]}…"
            axes.annotate(
                f"{value:.1f} Hz {short}", (1.0, value / float(frequency[-1])), xycoords="axes fraction",
                xytext=(1.015, height), textcoords="axes fraction", fontsize=8, color=INK, va="center",
                annotation_clip=False,
            )  # fmt: skip
