"""Settings of a measurement that is compared with a run: file, channels, directions and clock."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.settings import Settings, setting
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.signals.formats.channel import Measurement
    from vehicle.signals.records.choice import Choice
    from vehicle.signals.records.measured import Measured


@dataclass(frozen=True, kw_only=True, slots=True)
class MeasuredSettings(Settings):
    """Settings of a measurement that is compared with a run.

    Attributes:
        measured: file; None without a measurement.
        mapping: channels, "CHANNEL=NAME", the name of the model first.
        turned: channels that are measured in the opposite direction.
        delay: start of the measurement after the run, "S", and delays of groups of channels, "GROUP=TIME".
    """

    measured: Path | None = None
    mapping: tuple[str, ...] = ()
    turned: tuple[str, ...] = ()
    delay: tuple[str, ...] = ()
    drift: float = setting(
        "correct a slow clock of the measurement by these parts per million: times are multiplied by 1 + "
        "PPM / 1e6, then --delay is added; default: 0",
        0.0, within="[-100000, 100000]", type=float, metavar="PPM"
    )  # fmt: skip

    def clock(self) -> tuple[float, float]:
        """Return the start of the measurement after the run [s], and by which share its clock is slow [-]."""
        from vehicle.signals.records.counterpart import PARTS
        from vehicle.signals.records.delays import parsed_delays, split_delay

        return split_delay(parsed_delays(self.delay))[0], self.drift / PARTS

    def choice(self, record: RecordSettings, input_names: Container[str] = ()) -> Choice:
        """Return the choice of channels, units, times and delays of the measurement.

        Args:
            record: units, times and filters.
            input_names: names of units that belong to the input.
        """
        from vehicle.signals.records.choice import Choice, pairs
        from vehicle.signals.records.delays import parsed_delays, split_delay

        channels = pairs("--map", self.mapping, "")
        if "" in channels:
            raise ConfigurationError(f"--map {channels['']}: must be CHANNEL=NAME, for example knuckle_fr_acc_z=3")
        units = {name: unit for name, unit in pairs("--unit", record.units, "").items() if name not in input_names}
        chosen = replace(record, picks=(), units=()).choice("") or Choice()
        return replace(chosen, channels=channels, units=units, delays=split_delay(parsed_delays(self.delay))[1])

    def read(
        self,
        channels: tuple[str, ...],
        choice: Choice,
        *,
        window: float | None = None,
        measurement: Measurement | None = None,
    ) -> Measured:
        """Return the measurement, see `read_measured`."""
        from vehicle.signals.records.measured import read_measured

        assert self.measured is not None
        return read_measured(
            self.measured, channels, choice, inverted=self.turned, window=window, measurement=measurement
        )
