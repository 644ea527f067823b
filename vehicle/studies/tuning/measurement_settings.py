"""Measurement files of a fit with the settings of all, and their targets."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road, named_road
from vehicle.settings import part
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.measured_settings import MeasuredSettings
from vehicle.signals.records.record_settings import RecordSettings
from vehicle.studies.tuning.fit_settings import HistorySettings, LevelSettings, MeasurementFile, ResponseSettings
from vehicle.studies.tuning.measured_targets import (
    MeasuredTarget,
    measured_histories,
    measured_levels,
    measured_responses,
)

ROAD_ROLES = ("left", "right", "height")
"""Roles of --map and --unit that name the heights of a road over time; --unit speed=UNIT belongs to its speed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MeasurementSettings:
    """Measurement files of a fit."""

    files: tuple[MeasurementFile, ...]  # the files, each with its own settings
    measured: MeasuredSettings = part(MeasuredSettings)  # channels, their directions, clock and delays
    record: RecordSettings = part(RecordSettings)  # units, times and filters
    responses: ResponseSettings = part(ResponseSettings)  # settings of FRFs
    # settings of time histories, and of their classes of the input level
    histories: LevelSettings = part(LevelSettings)
    channels: tuple[str, ...] = ()  # channels of the model to fit; empty for all
    any_level: bool = False  # accept plates and accelerations beyond a real shaker

    @property
    def protected(self) -> tuple[Path, ...]:
        """Files of the measurements, signals and roads, which must not be replaced."""
        named = (name for each in self.files for name in (each.signal, each.road) if name is not None)
        return (*(each.file for each in self.files), *map(Path, named))

    def targets(self, car: Car) -> list[MeasuredTarget]:
        """Return the targets of a fit of a car.

        Raises:
            ConfigurationError, DataError: see `measured_responses`, `measured_histories` and `measured_levels`.
        """
        whole = replace(self.measured.choice(self.record), any_level=self.any_level)
        of_road = replace(
            whole,
            channels={role: name for role, name in whole.channels.items() if role in (*ROAD_ROLES, "time")},
            units={role: unit for role, unit in whole.units.items() if role in (*ROAD_ROLES, "speed", "time")},
            resample=None,
        )
        choice = replace(
            whole,
            channels={role: name for role, name in whole.channels.items() if role not in ROAD_ROLES},
            units={role: unit for role, unit in whole.units.items() if role not in (*ROAD_ROLES, "speed")},
        )
        delay, drift = self.measured.clock()
        shared: dict[str, Any] = {"choice": choice, "inverted": self.measured.turned, "fitted": self.channels}
        responses = replace(self.responses, **shared)
        histories = replace(self.histories, **shared, delay=delay, drift=drift)
        return [
            _responses(car, each, responses) if each.content == "frf" else _histories(car, each, histories, of_road)
            for each in self.files
        ]


def _responses(car: Car, each: MeasurementFile, settings: ResponseSettings) -> MeasuredTarget:
    """Return the target of a file of FRFs."""
    settings = replace(settings, signal=each.signal, stuck=each.stuck)
    return measured_responses(car, each.file, **settings.given())


def _histories(car: Car, each: MeasurementFile, settings: LevelSettings, of_road: Choice) -> MeasuredTarget:
    """Return the target of a file of time histories; `of_road` are the channels of a road recorded over time."""
    settings = replace(settings, signal=_road(each, of_road) or each.signal)
    if each.levels is not None:
        settings = replace(settings, levels=each.levels, reference=each.reference)
        return measured_levels(car, each.file, **settings.given())
    if each.reference is not None:
        raise ConfigurationError(f"--reference {each.reference}: belongs to --levels N")
    of_histories = {name: value for name, value in settings.given().items() if name in HistorySettings.declared()}
    return measured_histories(car, each.file, **of_histories)


def _road(each: MeasurementFile, choice: Choice) -> Road | None:
    """Return the road of a measurement file, and None without one."""
    if each.road is None:
        for name in ("speed", "contact"):
            if getattr(each, name) is not None:
                raise ConfigurationError(f"--{name}: belongs to --road; add --road FILE after --record {each.file}")
        return None
    if each.signal is not None:
        raise ConfigurationError(
            f"--road {each.road} and --signal {each.signal} exclude each other; leave one of them out"
        )
    if each.speed is None:
        raise ConfigurationError(
            f"--road {each.road}: the speed is missing; add --speed KM/H, for example --speed 80, or --speed "
            "channel:NAME"
        )
    return Road(named_road(each.road), speed=each.speed, contact=each.contact, choice=choice)
