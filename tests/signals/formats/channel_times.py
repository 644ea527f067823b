"""Times of the channels that readers return."""

from vehicle.arrays import Vector
from vehicle.signals.formats.channel import Channel


def times(channel: Channel) -> Vector:
    """Return the times of a channel that must have them."""
    assert channel.axis is not None
    return channel.axis
