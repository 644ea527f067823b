"""`python -m vehicle loads`: what recorded loads do to parts, rainflow counts and spectra of the channels of a run."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.parameters.vehicle import Vehicle


def recorded_channels(text: str, vehicle: Vehicle) -> tuple[str, ...]:
    """Channels that --channels asks a run to record: the default ones, and more behind them.

    Args:
        text: "loads", "all", or names with commas between.
        vehicle: the car.

    Raises:
        ConfigurationError: the car has no such channel.
    """
    if text in ("loads", "all"):
        return (*vehicle.channels, *vehicle.load_channels)
    names = [name.strip() for name in text.split(",")]
    for name in names:
        if name not in vehicle.channels and name not in vehicle.load_channels:
            close = get_close_matches(name, (*vehicle.load_channels, *vehicle.channels), n=1)
            nearest = f"; did you mean {close[0]}?" if close else ""
            raise ConfigurationError(
                f"--channels: no channel {name!r}; give loads, all, or names of channels as "
                f"{vehicle.load_channels[0]},{vehicle.load_channels[-1]}{nearest}"
            )
    return (*vehicle.channels, *(name for name in vehicle.load_channels if name in names))
