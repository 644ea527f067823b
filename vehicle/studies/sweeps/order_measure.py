"""Measure of a sweep: the amplitude of a channel at an order of a turning part."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from vehicle.errors import ConfigurationError
from vehicle.names import channel_units
from vehicle.runs.car import Run

FORM = "order:N:CHANNEL[:ANGLE]"
"""Form of the measure as a text."""


@dataclass(frozen=True, kw_only=True, slots=True)
class OrderMeasure:
    """Amplitude of an order, and its standard error; see `Run.orders`.

    Attributes:
        order: multiple of the angle.
        channel: name of an acceleration channel.
        angle: "crank", a wheel, or a force with a frequency; by default that of the first force.
        skip: excluded time at the beginning [s].
    """

    order: float
    channel: str
    angle: str | None = None
    skip: float = 0.0

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        return (self.channel,)

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        unit, name = channel_units([self.channel])[self.channel], f"order_{self.order:g}_{self.channel}"
        return {name: unit, f"{name}_error": unit, "order_frequency": "Hz"}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        lines = replace(run, skip=self.skip).orders(self.channel, angle=self.angle, orders=[self.order])
        values = abs(lines.amplitude[0, 0]), lines.error[0, 0], lines.frequency[0]
        return dict(zip(self.units, map(float, values), strict=True))


def order_measure(text: str, skip: float) -> OrderMeasure:
    """Return the measure of a text `FORM`.

    Args:
        text: of the option --measure, as "order:1:seat_rail_acc_z".
        skip: excluded time at the beginning [s].

    Raises:
        ConfigurationError: another form, or an order that is not positive.
    """
    prefix, _, text_of_order = text.partition(":")
    order, _, text_of_channel = text_of_order.partition(":")
    channel, _, angle = text_of_channel.partition(":")
    try:
        value = float(order)
    except ValueError:
        value = 0.0
    if prefix != "order" or not 0.0 < value <= 100.0 or not channel:
        raise ConfigurationError(f"--measure {text!r}: needed is {FORM}, as order:1:seat_rail_acc_z")
    return OrderMeasure(order=value, channel=channel, angle=angle or None, skip=skip)
