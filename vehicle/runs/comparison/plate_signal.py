"""Plate displacement of a measurement: in the measurement file, or in another file, with chosen channels of both."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.names import CORNERS
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import ForeignTableError, read_signal
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.channel_words import map_options, suggested_channels
from vehicle.signals.records.choice import Choice, matching
from vehicle.signals.records.measured import PLATE_CHANNEL, Measured


def plate_choices(asked: Choice, file: Path, signal: object) -> tuple[Choice, Choice | None]:
    """Return the choice for a measurement file, and for the file of its signal; None without chosen plates there.

    The channel name of a plate selects it in both files if they contain it; a number is of the measurement file.
    """
    plates = {role: wanted for role, wanted in asked.channels.items() if PLATE_CHANNEL.fullmatch(role)}
    named = {role: wanted for role, wanted in plates.items() if not wanted.isdecimal()}
    if not isinstance(signal, str | Path) or not named:
        return asked, None
    measurement, other = read_record(file, asked.databases), read_record(_input_file(signal))
    driving = {role: wanted for role, wanted in named.items() if matching(other, wanted, _is_history)}
    elsewhere = {role for role in driving if not matching(measurement, plates[role], _is_history)}
    roles = {role: wanted for role, wanted in asked.channels.items() if role not in elsewhere}
    units = {role: unit for role, unit in asked.units.items() if role not in elsewhere}
    wheels = {role: role.removeprefix("plate_").removesuffix("_displacement") for role in driving}
    of_signal = Choice(
        channels={wheels[role]: wanted for role, wanted in driving.items()},
        units={wheels[role]: unit for role, unit in asked.units.items() if role in driving},
    )
    return replace(asked, channels=roles, units=units), of_signal if driving else None


def _is_history(channel: Channel) -> bool:
    return channel.kind == "time"


def _input_file(name: Path | str) -> Path:
    """Return the path of a file, or of a shipped input, with or without its ending."""
    return find_input(name if "." in str(name) else f"{name}.csv")


def plate_signal(
    source: Signal | Path | str | None,
    car: Car,
    path: Path,
    measured: Measured,
    asked: Choice,
    inverted: Collection[str],
    chosen: Choice | None,
) -> Signal:
    """Return the plate signal: a signal, a file, the name of a shipped file, or None for the plate in the measurement.

    A file with one plate is read for the shaker wheel; `chosen` selects the plates of a file, see `plate_choices`.
    """
    if isinstance(source, Signal):
        return source
    if source is not None:
        try:
            signal = read_signal(
                _input_file(source),
                wheel=car.vehicle.shaker_wheel,
                choice=chosen,
                accept_implausible=asked.any_level,
            )
        except ForeignTableError:
            channels = read_record(_input_file(source)).channels
            named = {role: name for role, name in suggested_channels(channels).items() if PLATE_CHANNEL.fullmatch(role)}
            options = map_options(named) or "--map plate_fl_displacement=NAME"
            listed = ", ".join(repr(channel.name) for channel in channels[:20])
            raise DataError(
                f"--signal {source}: no column is named after a plate; set {options} (columns: {listed})"
            ) from None
        return _turned(signal, inverted) if chosen is not None else signal
    plates = {} if measured.record is None else measured.record.channels
    names = {wheel: f"plate_{wheel}_displacement" for wheel in CORNERS.values()}
    names = {wheel: name for wheel, name in names.items() if name in plates and np.ptp(plates[name]) > 0.0}
    if not names:
        raise DataError(
            f"{path}: contains no moving plate; set --map plate_fl_displacement=NAME for its channel, or "
            "--signal FILE if the plate was recorded in another file"
        )
    units = {wheel: asked.units[name] for wheel, name in names.items() if name in asked.units}
    units |= {role: unit for role, unit in asked.units.items() if role in ("", "time")}
    roles = {wheel: asked.channels.get(name, name) for wheel, name in names.items()}
    roles |= {role: name for role, name in asked.channels.items() if role == "time"}
    choice = replace(asked, channels=roles, units=units)
    return _turned(read_signal(path, choice=choice, accept_implausible=asked.any_level), inverted)


def _turned(signal: Signal, inverted: Collection[str]) -> Signal:
    """Return a signal with the sign of the plates changed whose channels are in `inverted`."""
    turned = {
        wheel: -values if f"plate_{wheel}_displacement" in inverted else values
        for wheel, values in signal.displacement.items()
    }
    return replace(signal, displacement=turned)
