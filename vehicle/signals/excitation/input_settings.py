"""Settings of the input of a run: a file of signals, or a road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS
from vehicle.settings import Settings, part
from vehicle.signals.excitation.road_settings import RoadSettings
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.signals.excitation.signal import Signal
    from vehicle.signals.records.choice import Choice


def on_road(roads: Sequence[str], files: Sequence[str]) -> bool:
    """Return True if roads move the plates, and False for files of signals.

    Args:
        roads: values of --road.
        files: values of --input.
    """
    if roads and files:
        named = " ".join(f"--road {road}" for road in roads)
        raise ConfigurationError(f"{named} and --input exclude each other; leave one of them out")
    if not roads and not files:
        raise ConfigurationError("the input is missing; set --input FILE, or a road, for example --road C --speed 80")
    return bool(roads)


@dataclass(frozen=True, kw_only=True, slots=True)
class PlateSettings(Settings):
    """Settings of a file of signals.

    Attributes:
        input: file, or the name of a shipped file.
        wheel: moves by a column without a wheel in its name; by default as in the vehicle file.
        any_level: accept levels beyond a shaker, and plates so similar that their FRFs cannot be separated.
        interpolate: fill gaps in the displacement by interpolation.
        remove_mean: subtract the mean of the displacement.
        record: channels, units and times of the file.
    """

    input: str = ""
    wheel: str | None = None
    any_level: bool = False
    interpolate: bool = False
    remove_mean: bool = False
    record: RecordSettings = part(RecordSettings)

    def corner(self, default: str) -> str:
        """Return the name of the wheel, by default as in the vehicle file."""
        return CORNERS[self.wheel] if self.wheel else default

    def signal(self, wheel: str, choice: Choice | None = None) -> Signal:
        """Return the signals of the plates.

        Args:
            wheel: wheel of a column without a wheel in its name.
            choice: channels, units and times; those of `record`.
        """
        from vehicle.signals.excitation.input_files import find_input
        from vehicle.signals.excitation.signal_file import read_signal

        return read_signal(
            find_input(self.input),
            wheel=wheel,
            interpolate=self.interpolate,
            remove_mean=self.remove_mean,
            accept_implausible=self.any_level,
            choice=choice,
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class DriveInput(Settings):
    """Settings of a drive on a road.

    Attributes:
        road: class of ISO 8608, file of a measured road, an obstacle, or "level"; a path is always a file.
        speed: speed of the car [km/h], or "channel:NAME" for a road recorded over time.
        settings: further settings.
        record: channels, units and times of a road recorded over time.
    """

    road: str | Path = ""
    speed: float | str | None = None
    settings: RoadSettings = part(RoadSettings)
    record: RecordSettings = part(RecordSettings)

    def choice(self, *, others: bool = False) -> Choice | None:
        """Return the channels of a road recorded over time, or None.

        The rate is that of the run; the times are those of the file.
        """
        record = replace(self.record, rate=None)
        return record.choice("height", further=("speed",), others=others) if self.over_time else None

    @property
    def over_time(self) -> bool:
        """True if the road was recorded over time, with its speed."""
        return isinstance(self.speed, str)

    def require_speed(self) -> float | str:
        """Return the speed."""
        if self.speed is None:
            raise ConfigurationError("the speed on the road is missing; give it in km/h, for example --speed 80")
        return self.speed
