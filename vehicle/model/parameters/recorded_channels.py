"""Channels that a run records besides those of every run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.wording import did_you_mean

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle


def recorded_channels(text: str, vehicle: Vehicle) -> tuple[str, ...]:
    """Return the channels that a run records: the default channels, then those of a text.

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
            nearest = did_you_mean(name, (*more, *vehicle.channels), cutoff=0.6)
            raise ConfigurationError(
                f"--channels: the car has no channel {name!r}; give loads, all, or names, for example "
                f"{vehicle.load_channels[0]},{vehicle.load_channels[-1]}{nearest}"
            )
    return (*vehicle.channels, *(name for name in more if name in names))
