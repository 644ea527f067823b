"""Channels that a run records on request."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle


def recorded_channels(text: str, vehicle: Vehicle) -> tuple[str, ...]:
    """Return the channels that a run records: the default channels, then the channels of a text.

    Args:
        text: "loads", "all", or names separated by commas.

    Raises:
        ConfigurationError: the car has no channel of this name.
    """
    more = vehicle.requested_channels
    if text in ("loads", "all"):
        return (*vehicle.channels, *(vehicle.load_channels if text == "loads" else more))
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in vehicle.channels and name not in more:
            close = get_close_matches(name, (*more, *vehicle.channels), n=1)
            nearest = f"; did you mean {close[0]}?" if close else ""
            raise ConfigurationError(
                f"--channels: the car has no channel {name!r}; give loads, all, or names, for example "
                f"{vehicle.load_channels[0]},{vehicle.load_channels[-1]}{nearest}"
            )
    return (*vehicle.channels, *(name for name in more if name in names))
