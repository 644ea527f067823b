"""Read plate displacements from selected channels of a measurement file."""

import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import CORNERS, is_wheel
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.table import TIME, USABLE, Header, Table
from vehicle.signals.records.channel_words import suggested_channels
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.finding import Finding, FindingError
from vehicle.signals.records.integration import displacement

WHEEL_REMEDY = "pass wheel='fl' (of a car: wheel=car.vehicle.shaker_wheel), or name the column displacement_fl"
"""Remedy for a plate displacement without a wheel, read from Python; a command takes the wheel of its car."""


def chosen_plates(path: Path, choice: Choice | None, wheel: str | None) -> tuple[Table, float]:
    """Read plate displacements as a table with the headers `time [s]`, `displacement_fr [m]`.

    Args:
        path: measurement file of any format.
        choice: channel of each wheel, and preprocessing; may be None or without channels if channel names identify the
            plates, or for a file with a single channel.
        wheel: wheel driven by a displacement channel without a wheel in its name; None if there is no such channel.

    Returns:
        Table, and sampling rate that limits its band [Hz]: the lower rate before and after resampling.

    Raises:
        ConfigurationError: unknown file, or a role that is not a wheel.
        DataError: bad data, or no plate identified among several channels.
    """
    choice = Choice() if choice is None else choice
    measurement = read_record(path, choice.databases)
    unknown = next((role for role in choice.channels if role != "time" and not is_wheel(role)), None)
    if unknown is not None:
        raise ConfigurationError(f"--channel {unknown}=...: must be one of {', '.join(CORNERS.values())}, time")
    if not any(role != "time" for role in choice.channels):
        forms = ("displacement_{}", "plate_{}_displacement")
        named = {form.format(corner): corner for form in forms for corner in CORNERS.values()}
        assigned = {
            named[channel.name]: channel.name
            for channel in measurement.channels
            # a run records undriven plates too
            if channel.name in named and (channel.name.startswith("displacement") or np.ptp(channel.values) > 0.0)
        }
        plain = [channel for channel in measurement.channels if channel.name == "displacement"] or measurement.channels
        if not assigned and (plain[0].name == "displacement" or len(plain) == 1):
            if wheel is None:
                raise DataError(f"{path}: the name of channel {plain[0].name!r} contains no wheel; {WHEEL_REMEDY}")
            assigned = {wheel: "1" if len(measurement.channels) == 1 else plain[0].name}
        if not assigned:
            options = tuple(
                word
                for role, name in suggested_channels(measurement.channels).items()
                if role.startswith("plate_")
                for word in ("--channel", f"{role.split('_')[1]}={name}")
            )
            text = (
                f"which of the {len(measurement.channels)} channels is the plate? set --channel {wheel or 'fl'}=NAME "
                f"with a number, exact name or pattern with *; the file has {measurement.listed()}"
                + (f"; their names suggest {shlex.join(options)}" if options else "")
            )
            raise FindingError(path, [Finding(text, "unmapped", options)])
        choice = replace(choice, channels={**choice.channels, **assigned})
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
