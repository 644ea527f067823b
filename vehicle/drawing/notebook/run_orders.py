"""Amplitudes of a run at orders of a turning part, with the names of their channels."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from vehicle.drawing.notebook.frames import plain_frame
from vehicle.signals.analysis.order_cut import OrderCut
from vehicle.signals.analysis.order_lines import OrderLines


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class RunOrders(OrderLines):
    """Amplitudes of channels at orders.

    Attributes:
        names, units: channels of the rows, and their units.
        angle: what turns.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    angle: str

    def __repr__(self) -> str:
        """Return the largest amplitude of each of up to three channels."""
        texts = []
        for row, name in enumerate(self.names[:3]):
            top = int(np.argmax(np.abs(self.amplitude[row])))
            size = abs(self.amplitude[row, top])
            texts.append(f"{name} {size:.3g} {self.units[row]} in order {self.orders[top]:g}")
        return f"Orders of {self.angle} at {self.frequency[0] / self.orders[0]:.4g} Hz: {', '.join(texts)}"

    def to_dataframe(self) -> Any:
        """Return a pandas table: a row for each channel and order, with amplitude, phase [deg] and standard error."""
        count = len(self.orders)
        return plain_frame(
            {
                "channel": np.repeat(self.names, count),
                "unit": np.repeat(self.units, count),
                "order": np.tile(self.orders, len(self.names)),
                "frequency_hz": np.tile(self.frequency, len(self.names)),
                "amplitude": np.abs(self.amplitude).ravel(),
                "phase_deg": np.degrees(np.angle(self.amplitude)).ravel(),
                "standard_error": self.error.ravel(),
            }
        )


def named_orders(lines: OrderLines, names: tuple[str, ...], units: tuple[str, ...], angle: str) -> RunOrders:
    """Return order lines with the names [-] and units of their channels."""
    numbers = {field.name: getattr(lines, field.name) for field in fields(OrderLines)}
    return RunOrders(**numbers, names=names, units=units, angle=angle)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class RunOrderCut(OrderCut):
    """Amplitudes of channels at orders of the crankshaft over its speed.

    Attributes:
        names, units: channels of the rows, and their units.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]

    def __repr__(self) -> str:
        """Return the peak of each order of the first channel."""
        texts = []
        for row, order in enumerate(self.orders):
            top = int(np.argmax(np.abs(self.amplitude[0, row])))
            texts.append(
                f"{np.abs(self.amplitude[0, row, top]):.3g} in order {order:g} at {60.0 * self.turns[top]:.4g}/min"
            )
        return f"Order cut of {self.names[0]} [{self.units[0]}]: {', '.join(texts)}"

    def to_dataframe(self) -> Any:
        """Return a pandas table: a row for each channel, order and speed, with amplitude and phase [deg]."""
        shape = self.amplitude.shape
        return plain_frame(
            {
                "channel": np.repeat(self.names, shape[1] * shape[2]),
                "unit": np.repeat(self.units, shape[1] * shape[2]),
                "order": np.tile(np.repeat(self.orders, shape[2]), shape[0]),
                "rpm": np.tile(60.0 * self.turns, shape[0] * shape[1]),
                "amplitude": np.abs(self.amplitude).ravel(),
                "phase_deg": np.degrees(np.angle(self.amplitude)).ravel(),
            }
        )


def named_cut(cut: OrderCut, names: tuple[str, ...], units: tuple[str, ...]) -> RunOrderCut:
    """Return an order cut with the names [-] and units of its channels."""
    numbers = {field.name: getattr(cut, field.name) for field in fields(OrderCut)}
    return RunOrderCut(**numbers, names=names, units=units)
