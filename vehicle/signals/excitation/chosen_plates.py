"""Plates driven by chosen channels of a measurement file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import CORNERS, is_wheel
from vehicle.signals.records.channel import Channel
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.integration import displacement
from vehicle.signals.records.reader import read_record
from vehicle.signals.records.table import TIME, USABLE, Header, Table

WHEEL_REMEDY = "pass wheel='fl' (of a car: wheel=car.vehicle.shaker_wheel), or name the column displacement_fl"
"""Remedy for a plate displacement without a wheel, read from Python; a command takes the wheel of its car."""


def _moves(channel: Channel) -> bool:
    """A run records the plate that it did not drive, too."""
    return not channel.name.startswith("plate_") or bool(np.ptp(channel.values) > 0.0)


def chosen_plates(path: Path, choice: Choice | None, wheel: str | None) -> tuple[Table, float]:
    """Displacements of plates as a table with the heads `time [s]`, `displacement_fr [m]`.

    Args:
        path: the file, of any format.
        choice: channels for wheels, and what is done to them; None, or no channel, where the file holds
            one time history alone.
        wheel: wheel driven by a displacement channel without a wheel in its name; None if there is no such channel.

    Returns:
        The table, and the sampling rate that its band stands for [Hz]: the lower of those before and after resampling.

    Raises:
        ConfigurationError: no such file, or a role that is no wheel.
        DataError: bad data, or nothing chosen among several channels.
    """
    choice = Choice() if choice is None else choice
    measurement = read_record(path, choice.databases)
    unknown = next((role for role in choice.channels if role != "time" and not is_wheel(role)), None)
    if unknown is not None:
        raise ConfigurationError(f"--channel {unknown}=...: allowed are {', '.join(CORNERS.values())} and time")
    if not any(role != "time" for role in choice.channels):
        wheels = CORNERS.values()
        named = {f"displacement_{one}": one for one in wheels} | {f"plate_{one}_displacement": one for one in wheels}
        found = {named[one.name]: one.name for one in measurement.channels if one.name in named and _moves(one)}
        plain = [one for one in measurement.channels if one.name == "displacement"] or measurement.channels
        if not found and (plain[0].name == "displacement" or len(plain) == 1):
            if wheel is None:
                raise DataError(f"{path}: channel {plain[0].name!r} names no wheel; {WHEEL_REMEDY}")
            found = {wheel: "1" if len(measurement.channels) == 1 else plain[0].name}
        if not found:
            names = ", ".join(f"{n} {one.name!r} [{one.unit}]" for n, one in enumerate(measurement.channels[:20], 1))
            raise DataError(
                f"{path}: {len(measurement.channels)} channels: {names}; say which one drives the plate: --channel "
                f"{wheel or 'fl'}=NAME, with its number, exact name, or a pattern with *"
            )
        choice = replace(choice, channels={**choice.channels, **found})
    chosen = choose(measurement, choice)
    columns, notices = displacement(chosen, choice, str(path))
    header = Header(path=path, line=0, cells=(TIME, *(f"displacement_{role} [m]" for role in columns)))
    table = Table(
        header=header,
        key=0,
        values=np.column_stack([chosen.time, *columns.values()]),
        lines=np.arange(1, chosen.time.size + 1),
        notices=(*chosen.notices, *notices),
        sha256=measurement.sha256,
    )
    return table, chosen.highest / USABLE
