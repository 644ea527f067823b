"""Orders over speed as sentences, a table of peaks, pictures, and a page."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.order_plot import plot_campbell, plot_order_cuts
from vehicle.model.parameters.applied_force import CRANK
from vehicle.names import channel_words
from vehicle.runs.car.order_points import LARGEST_SHARE, NamedMode, OrderPoints
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing

fill = templates(__file__)

HEADS = ("order", "largest [m/s²]", "at", "frequency [Hz]", "friction holds [m/s²]", "without friction [m/s²]", "slip")


def order_rows(orders: OrderPoints) -> list[tuple[str, ...]]:
    """Return a row for each order with the cells of `HEADS`: its largest amplitude, where, and both limits there.

    An order below the accuracy of the engine at all points has only this bound.
    """
    rows = []
    for row, order in enumerate(orders.orders):
        top = int(np.argmax(np.abs(orders.amplitude[row])))
        if not _is_result(orders, row):
            rows.append((f"{order:g}", f"< {number(float(orders.floor.max()), 1)}", *["–"] * 5))
            continue
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


def _is_result(orders: OrderPoints, row: int) -> bool:
    """Return True if an order is above the accuracy of the engine at some point."""
    return bool(np.any(np.abs(orders.amplitude[row]) > orders.floor))


def order_points_sentences(orders: OrderPoints) -> list[str]:
    """Return text on the peak of each order with a force, the largest first."""
    where, sentences = channel_words(orders.channel), []
    tops = np.argmax(np.abs(orders.amplitude), axis=1)
    peaks = np.abs(orders.amplitude[np.arange(len(tops)), tops])
    for row in np.argsort(-peaks).tolist():
        top, order = int(tops[row]), float(orders.orders[row])
        if not np.isfinite(orders.stuck[row, top]) or not _is_result(orders, row):
            continue
        frequency = order * float(orders.turns[top])
        single = len(orders.points) == 1
        edge = top in (0, len(orders.points) - 1)
        mode = _part_words(orders.parts[row])
        slip = (
            f"a damper slips for {100.0 * orders.slip[top]:.0f} % of the time"
            if orders.slip[top]
            else "no damper slips"
        )
        error = float(orders.error[row, top])
        size = number(float(peaks[row])) + (f" ± {number(error, 2)}" if error > 0.01 * peaks[row] else "")
        sentences.append(
            f"Order {order:g}{'' if single else ' is largest'} at {orders.points[top]:g} {orders.point_unit} "
            f"({number(frequency)} Hz{mode}){', the end of the range' if edge and not single else ''}: "
            f"{where} {size} m/s² (amplitude). "
            f"There {slip}; {orders.frictions} that stick would give {number(float(orders.stuck[row, top]))} m/s², "
            f"{orders.frictions} without friction {number(float(orders.free[row, top]))} m/s²."
        )
    return sentences


def _part_words(parts: Sequence[NamedMode]) -> str:
    """Return text on the mode in resonance, otherwise on that with the largest share; empty without one."""
    if not parts:
        return ""
    part = parts[0]
    if part.share > LARGEST_SHARE:
        return "; no mode dominates; large parts cancel"
    # A share above the whole, which others reduce, would only puzzle.
    share = f", {100.0 * part.share:.0f} %" if part.share <= 1.0 else ""
    role = f"in resonance{share}" if part.resonant else f"no mode is in resonance, largest part{share}"
    return f"; {role}: {part.name}, natural frequency {number(part.frequency)} Hz"


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
