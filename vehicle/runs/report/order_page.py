"""Orders over speed as sentences, a table of peaks, pictures, and a page."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.order_plot import plot_campbell, plot_order_cuts
from vehicle.model.parameters.applied_force import CRANK
from vehicle.names import channel_words
from vehicle.runs.car.order_points import NamedMode, OrderPoints
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing

fill = templates(__file__)

HEADS = ("order", "largest [m/s²]", "at", "frequency [Hz]", "dampers stick [m/s²]", "without friction [m/s²]", "slip")

LARGEST_SHARE = 1.5
"""Share of a mode above which it is not named: others cancel a third of it or more."""


def order_rows(orders: OrderPoints) -> list[tuple[str, ...]]:
    """Return a row for each order with the cells of `HEADS`: its largest amplitude, where, and both limits there."""
    rows = []
    for row, order in enumerate(orders.orders):
        top = int(np.argmax(np.abs(orders.amplitude[row])))
        limits = (number(float(values[row, top])) if np.isfinite(values[row, top]) else "–"
                  for values in (orders.stuck, orders.free))  # fmt: skip
        rows.append(
            (
                f"{order:g}",
                number(float(np.abs(orders.amplitude[row, top]))),
                f"{orders.points[top]:g} {orders.point_unit}",
                number(float(order * orders.turns[top])),
                *limits,
                f"{100.0 * orders.slip[top]:.0f} %",
            )
        )
    return rows


def order_points_sentences(orders: OrderPoints) -> list[str]:
    """Return text on the peak of each order with a force, the largest first."""
    where, sentences = channel_words(orders.channel), []
    tops = np.argmax(np.abs(orders.amplitude), axis=1)
    peaks = np.abs(orders.amplitude[np.arange(len(tops)), tops])
    for row in np.argsort(-peaks).tolist():
        top, order = int(tops[row]), float(orders.orders[row])
        if not np.isfinite(orders.stuck[row, top]):
            continue
        frequency = order * float(orders.turns[top])
        single = len(orders.points) == 1
        edge = top in (0, len(orders.points) - 1)
        mode = _part_words(orders.parts[row])
        slip = f"a damper slips {100.0 * orders.slip[top]:.0f} % of the time" if orders.slip[top] else "no damper slips"
        error = float(orders.error[row, top])
        size = number(float(peaks[row])) + (f" ± {number(error, 2)}" if error > 0.01 * peaks[row] else "")
        sentences.append(
            f"Order {order:g}{'' if single else ' is largest'} at {orders.points[top]:g} {orders.point_unit} "
            f"({number(frequency)} Hz{mode}){', the end of the range' if edge and not single else ''}: "
            f"{where} {size} m/s² (amplitude). "
            f"There {slip}; dampers that stick would give {number(float(orders.stuck[row, top]))} m/s², dampers "
            f"without friction {number(float(orders.free[row, top]))} m/s²."
        )
    return sentences


def _part_words(parts: Sequence[NamedMode]) -> str:
    """Return text on the mode with the largest share and the one in resonance; empty without one."""
    text = ""
    for name, part in zip(("largest part", "in resonance"), parts, strict=False):
        against = ", others act against it" if part.share > 1.0 else ""
        share = f"{100.0 * part.share:.0f} %{against}"
        text += f"; {name}, {share}: {part.name}, natural frequency {number(part.frequency)} Hz"
    return "; no mode decides, large parts cancel" if parts and parts[0].share > LARGEST_SHARE else text


def draw_cuts(path: Path, orders: OrderPoints, name: str, caption: str) -> None:
    """Write the order cuts as a picture; arguments as in `order_page`."""
    curves = [np.abs(orders.amplitude), orders.stuck, orders.free]
    title = f"{name}: {channel_words(orders.channel)}, orders of {_of(orders)}"
    plot_order_cuts(path, orders.points, orders.turns, orders.orders, curves, _labels(orders), title, caption)


def draw_map(path: Path, orders: OrderPoints, name: str, caption: str) -> None:
    """Write the Campbell map as a picture; arguments as in `order_page`."""
    modes = [(mode.frequency, mode.name) for mode in orders.modes]
    spectra = (orders.frequency, orders.spectrum)
    title = f"{name}: {channel_words(orders.channel)}, Campbell map; the modes are computed with stuck dampers"
    plot_campbell(path, orders.points, orders.turns, orders.orders, *spectra, modes, _labels(orders), title, caption)


def _labels(orders: OrderPoints) -> tuple[str, str]:
    crank = orders.angle == CRANK
    return ("crankshaft [1/min]" if crank else "speed [km/h]", "amplitude [m/s²]")


def _of(orders: OrderPoints) -> str:
    return "the crankshaft" if orders.angle == CRANK else orders.angle.replace("_", " ")


def order_page(channels: Sequence[OrderPoints], name: str, caption: str, *, command: str) -> str:
    """Return the report of orders over speed as one HTML document.

    Args:
        channels: the amplitudes of each channel; at least two points.
        caption: road, length of the runs and engine.
        command: command line that made them.
    """
    repeat = Markup("<p>{}</p><pre>{}</pre>").format(caption, command)
    parts = [_part(orders, name, caption, several=len(channels) > 1) for orders in channels]
    parts.append(("How to repeat it", "repeat", repeat))
    return document(f"Orders of {name}", (f"{name}; {caption}", head_line()), parts)


def _part(orders: OrderPoints, name: str, caption: str, *, several: bool) -> tuple[str, str, Markup]:
    """Return title, anchor and content of the part of a channel."""
    cuts = drawing(lambda path: draw_cuts(path, orders, name, caption), "Order cuts")
    campbell = drawing(lambda path: draw_map(path, orders, name, caption), "Campbell map")
    modes = [(number(mode.frequency), number(100.0 * mode.damping_ratio, 2), mode.name) for mode in orders.modes]
    result = fill("orders", sentences=order_points_sentences(orders), cuts=cuts, campbell=campbell, heads=HEADS,
                  rows=order_rows(orders), modes=modes)  # fmt: skip
    if not several:
        return "Orders", "orders", result
    return f"Orders, {channel_words(orders.channel)}", f"orders_{orders.channel}", result
