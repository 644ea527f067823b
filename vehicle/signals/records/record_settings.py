"""Settings of a measurement file: channels, units, times and filters, each declared once."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.settings import Settings, setting

if TYPE_CHECKING:
    from vehicle.signals.records.choice import Choice

ABOVE_0 = "(0, inf)"


@dataclass(frozen=True, kw_only=True, slots=True)
class RecordSettings(Settings):
    """Settings of a measurement file.

    Attributes:
        picks: channels, "ROLE=NAME"; a text without "=" has the role of the reader.
        units: units, "ROLE=UNIT", or "UNIT" for all channels.
        databases: DBC files that decode the log of a CAN bus.
    """

    picks: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    databases: tuple[Path, ...] = ()
    rate: float | None = setting(
        "sampling rate [Hz], replaces the times of the file", within=ABOVE_0, type=float, metavar="HZ"
    )
    first: float | None = setting("use the file from this time on [s]", flag="--from", type=float, metavar="S")
    last: float | None = setting("use the file up to this time [s]", flag="--to", type=float, metavar="S")
    resample: float | None = setting(
        "resample the record at this rate first [Hz], with an anti-alias filter; for irregular times",
        within=ABOVE_0, type=float, metavar="HZ"
    )  # fmt: skip
    detrend: bool = setting("subtract the best straight line (offset and drift)", False, action="store_true")
    highpass: float | None = setting(
        "corner frequency of a high-pass without phase shift [Hz]; needed to integrate velocities and accelerations",
        within=ABOVE_0, type=float, metavar="HZ"
    )  # fmt: skip

    def choice(self, role: str, further: Collection[str] = (), *, others: bool = False) -> Choice | None:
        """Return the choice of channels, units and times; None if it has only defaults.

        Args:
            role: role of a channel without ROLE=.
            further: roles without a channel that a unit may name.
            others: True if units without a channel of their role belong to another file, as the measured one.
        """
        from vehicle.signals.records.choice import Choice, pairs

        channels = pairs("--channel", self.picks, role)
        asked = pairs("--unit", self.units, "")
        units = {name: unit for name, unit in asked.items() if not name or name in channels or name in further}
        unknown = next((name for name in asked if name not in units), None)
        if unknown is not None and not others:
            raise ConfigurationError(
                f"--unit {unknown}=...: there is no --channel {unknown}=NAME, only "
                f"{', '.join(filter(None, channels)) or 'none'}; use one of these names, or --unit UNIT for all "
                "channels"
            )
        choice = Choice(
            channels=channels,
            units=units,
            rate=self.rate,
            first=self.first,
            last=self.last,
            detrend=self.detrend,
            highpass=self.highpass,
            databases=self.databases,
            resample=self.resample,
        )
        return None if choice.empty else choice
