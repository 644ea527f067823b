"""Spectra of the evaluated part of a run or of a file of time histories, with the level of its road."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.road_level import RoadLevel, road_level
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.vibration_spectra import RANGE, ChannelSpectrum, vibration_spectra
from vehicle.signals.formats.reader import read_columns, read_record, time_file
from vehicle.signals.records.choice import Choice, choose, matching, pick
from vehicle.signals.records.run_summary import available_summary

SEAT = "seat_acc_[xyz]"
"""Channels of the seat, evaluated for a car with a seat; without, this point belongs to the body."""

BY_DEFAULT = ("seat_rail_acc_[xyz]", r"knuckle_\w+_acc_z")
"""Channels without a choice, as regular expressions."""


class TimeHistories(Protocol):
    """Time histories of a run, as a file or a recording has them."""

    @property
    def time(self) -> Vector:
        """Return the sample times [s]; (n,)."""

    @property
    def channels(self) -> Mapping[str, Vector]:
        """Return name to time history; (n,)."""

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordSpectra:
    """Spectra of a run.

    Attributes:
        name: short name in legends.
        caption: input, evaluated span and tyres.
        channels: spectra of the channels, unweighted and weighted.
        road_levels: wheel to the level of the road under it; empty for a run on plates.
        notices: messages on the record of a measurement file.
    """

    name: str
    caption: str
    channels: tuple[ChannelSpectrum, ...]
    road_levels: Mapping[str, RoadLevel]
    notices: tuple[str, ...] = ()

    def highest_band(self, spectrum: ChannelSpectrum) -> tuple[float, float]:
        """Return nominal midband frequency [Hz] and RMS of the highest third octave of a channel."""
        rms = np.nan_to_num(spectrum.third_octaves.rms, nan=-1.0)
        index = int(np.argmax(rms))
        return float(spectrum.third_octaves.nominal[index]), float(rms[index])

    def median_frequency(self, spectrum: ChannelSpectrum) -> float:
        """Return the frequency [Hz] that halves the mean square of a channel; NaN for a channel at rest."""
        if spectrum.rms == 0.0:
            return float("nan")
        return float(np.interp(np.sqrt(0.5) * spectrum.rms, spectrum.cumulative_rms, spectrum.frequency))


def record_spectra(
    path: Path,
    channels: Sequence[str] | None = None,
    frequency_range: tuple[float, float] = RANGE,
    choice: Choice | None = None,
) -> RecordSpectra:
    """Read a run or a measurement file and return the spectra of its evaluated span, in SI units.

    Args:
        path: folder of a run, or a measurement file of any format.
        channels: names of acceleration channels; by default seat rail, seat and the vertical motion of the knuckles,
            of a file without these all accelerations.
        frequency_range: lowest and highest frequency [Hz].
        choice: channels of a measurement file by the names that they get here, their units, and the excerpt.

    Raises:
        ConfigurationError: the run or the channel does not exist, or is not an acceleration.
        DataError: a damaged file, a missing channel, or a record too short for the range.
    """
    source = time_file(path)
    if not path.is_dir():
        return _file_spectra(source, channels, frequency_range, choice or Choice())
    record, summary = read_columns(source), available_summary(source.parent)
    if summary is None:
        return recorded_spectra(record, path.name, source.name, channels, frequency_range=frequency_range)
    tyres = f", tyres {summary.tyre}" if summary.tyre else ""
    span = f"{summary.evaluated_from:g} to {record.time[-1]:g} s"
    return recorded_spectra(
        record,
        path.resolve().name,
        f"{Path(summary.input.file).name}, {span}{tyres}",
        channels,
        begin=summary.evaluated_from,
        seated=summary.seat_value is not None,
        road=summary.input.road,
        frequency_range=frequency_range,
    )


def _file_spectra(
    path: Path, channels: Sequence[str] | None, frequency_range: tuple[float, float], choice: Choice
) -> RecordSpectra:
    """Return the spectra of a measurement file; arguments and errors: see `record_spectra`."""
    measurement = read_record(path, choice.databases)
    # The channels of a run have the names of the model already.
    names = {channel.name for channel in measurement.channels}
    roles = {
        role: role if role in names and not matching(measurement, name, lambda channel: True) else name
        for role, name in choice.channels.items()
        if role != "time"
    }
    if channels is None and not roles:
        inside = [
            channel.name
            for channel in measurement.channels
            if channel.quantity == "acceleration" and channel.function == "time history"
        ]
        usual = re.compile("|".join((SEAT, *BY_DEFAULT)))
        channels = [name for name in inside if usual.fullmatch(name)] or inside
    for name in channels or ():
        if name not in roles:
            roles[name] = measurement.channels[pick(measurement, name, option="--channels")].name
    if not roles:
        raise ConfigurationError(
            f"{path}: no channel has a unit of acceleration; set --channel seat_rail_acc_z=NAME and --unit m/s2 or "
            f"--unit g; the file has {measurement.listed()}"
        )
    chosen = choose(measurement, replace(choice, channels={**choice.channels, **roles}))
    if other := next((role for role, quantity in chosen.quantities.items() if quantity != "acceleration"), None):
        raise ConfigurationError(
            f"{path.name}: {roles[other]} is a {chosen.quantities[other]}; spectra are of accelerations [m/s2]"
        )
    chosen.require_uniform(path)
    return RecordSpectra(
        name=path.name,
        caption=f"{path.name}, {chosen.time[0]:g} to {chosen.time[-1]:g} s",
        channels=vibration_spectra(chosen.step, chosen.values, dict.fromkeys(roles, "m/s2"), frequency_range),
        road_levels={},
        notices=chosen.notices,
    )


def recorded_spectra(
    record: TimeHistories,
    name: str,
    caption: str,
    channels: Sequence[str] | None = None,
    *,
    begin: float = 0.0,
    seated: bool = True,
    road: Mapping[str, object] | None = None,
    frequency_range: tuple[float, float] = RANGE,
    accelerations: bool = True,
) -> RecordSpectra:
    """Return the spectra of the time histories of a run; further arguments and errors like `record_spectra`.

    Args:
        record: time histories with their units.
        name, caption: see `RecordSpectra`.
        channels, frequency_range: see `record_spectra`.
        begin: beginning of the evaluated span [s].
        seated: True if the point "seat" is on a seat.
        road: road of the run, as in `summary.json`; None for a run on plates.
        accelerations: refuse channels of another unit.
    """
    step = float(record.time[-1] - record.time[0]) / (record.time.size - 1)
    evaluated = evaluated_span(record.time.size, step, max(begin - float(record.time[0]), 0.0) if begin else 0.0)
    names = _chosen(channels, record.units, name, (*([SEAT] if seated else []), *BY_DEFAULT), accelerations)
    histories = {name: record.channels[name][evaluated] for name in names}
    return RecordSpectra(
        name=name,
        caption=caption,
        channels=vibration_spectra(step, histories, record.units, frequency_range),
        road_levels=_road_levels(road, step, record.channels, evaluated),
    )


def _chosen(
    channels: Sequence[str] | None, units: Mapping[str, str], name: str, by_default: Sequence[str], accelerations: bool
) -> list[str]:
    """Return the channels whose spectra are computed."""
    if channels is None:
        pattern = re.compile("|".join(by_default))
        if names := [channel for channel in units if pattern.fullmatch(channel)]:
            return names
        raise ConfigurationError(
            f"{name}: contains no acceleration of a seat or knuckle; name channels with --channels"
        )
    if missing := next((channel for channel in channels if channel not in units), None):
        raise ConfigurationError(f"{name} has no channel {missing!r}; choose from {', '.join(units)}")
    if accelerations and (other := next((channel for channel in channels if units[channel] != "m/s2"), None)):
        raise ConfigurationError(
            f"{name}: {other} is in {units[other] or 'no unit'}; spectra are of accelerations [m/s2]"
        )
    return list(dict.fromkeys(channels))


def _road_levels(
    road: Mapping[str, object] | None, step: float, channels: Mapping[str, Vector], evaluated: slice
) -> dict[str, RoadLevel]:
    """Return the level of the road under the front wheels; the rear wheels follow in their tracks.

    An obstacle is a single event, which has no class.
    """
    speed = road.get("speed_kmh") if road and not road.get("obstacle") else None
    if not isinstance(speed, int | float):
        return {}
    levels = {}
    for wheel in ("fr", "fl"):
        if f"plate_{wheel}_displacement" in channels:
            try:
                levels[wheel] = road_level(step, channels[f"plate_{wheel}_displacement"][evaluated], speed / 3.6)
            except DataError:  # too short for a class: the spectra of the car do not depend on it
                continue
    return levels
