"""Read the acceleration of one point in up to three axes from a record, and check its level."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import beside_limit
from vehicle.errors import DataError
from vehicle.names import AXES
from vehicle.signals.formats.reader import is_table, read_columns, read_record
from vehicle.signals.formats.table import Record
from vehicle.signals.formats.units import STANDARD_GRAVITY
from vehicle.signals.records.channel_findings import channel_findings
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.integration import filtered
from vehicle.signals.records.rare_events import rare_events

UNITS = {"m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": STANDARD_GRAVITY}
"""Accepted units of acceleration and their values in m/s2."""

LARGEST_ACCELERATION = 50.0
"""Maximum deviation from the mean [m/s2]; a larger one indicates a wrong unit."""

ALIASED_SHARE = 0.05
"""Minimum share of the variance above 0.8 of the Nyquist frequency for an aliasing notice [-]."""


def _notices(xyz: Mapping[str, Vector], rate: float) -> tuple[str, ...]:
    """Return notices on constant axes and on content near the Nyquist frequency."""
    notices = []
    for axis, record in xyz.items():
        power = np.abs(np.fft.rfft(record - record.mean())) ** 2
        total = float(power.sum())
        if np.ptp(record) == 0.0:
            notices.append(f"{axis}: constant at {record[0]:.3g} m/s2; is the sensor missing?")
        elif total > 0.0:
            share = float(power[int(0.8 * power.size) :].sum()) / total
            if share > ALIASED_SHARE:
                notices.append(
                    f"{axis}: {100 * share:.0f} % of the variance lies above {0.4 * rate:g} Hz (0.8 of half the "
                    "sampling rate); was it recorded without an anti-alias filter?"
                )
    return tuple(notices)


def _chosen(path: Path, choice: Choice, names: list[str]) -> Record:
    """Read the chosen channels of a measurement file as accelerations [m/s2]."""
    measurement = read_record(path, choice.databases)
    roles = {role: wanted for role, wanted in choice.channels.items() if role != "time"}
    names_in_file = {channel.name for channel in measurement.channels}
    if not roles:
        roles = {axis: name for axis, name in zip(AXES, names, strict=True) if name in names_in_file}
    if not roles or not set(roles) <= set(AXES):
        raise DataError(
            f"{path}: which channels are the axes? set --channel x=NAME, y=NAME or z=NAME, NAME a number, an exact "
            f"name or a pattern with *; the file has {measurement.listed()}"
        )
    chosen = choose(measurement, replace(choice, channels={**choice.channels, **roles}))
    wrong = next((role for role, quantity in chosen.quantities.items() if quantity != "acceleration"), None)
    if wrong is not None:
        raise DataError(
            f"{path}: channel {roles[wrong]!r} for {wrong} is a {chosen.quantities[wrong]} but must be an "
            "acceleration; "
            f"choose another channel, or set --unit {wrong}=m/s2 or {wrong}=g if the unit in the file is wrong"
        )
    chosen.require_uniform(path)
    values, notices = dict(chosen.values), chosen.notices
    if choice.highpass is not None:
        values, notices = filtered(chosen, choice.highpass)
    channels = {name: values[axis] for name, axis in zip(names, AXES, strict=True) if axis in values}
    return Record(
        time=chosen.time,
        channels=channels,
        units=dict.fromkeys(channels, "m/s2"),
        notices=notices,
        highest=chosen.highest,
    )


def read_acceleration(path: str | Path, point: str | None = None, choice: Choice | None = None) -> Record:
    """Read the acceleration of a point in x, y and z, or in the measured axes only.

    Args:
        path: table with a time column, or measurement file; see `read_columns` and `read_record`.
        point: point of a run, such as "seat_rail", for the channels `seat_rail_acc_x|y|z`; None for columns x, y, z.
        choice: channels for at least one of the roles x, y, z, and their preprocessing; for measurement files.

    Returns:
        Channels x, y, z [m/s2], as far as measured, with notices on suspicious values.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: not a record, a missing channel, a unit other than acceleration, or an implausible level.
    """
    file = Path(path)
    axes = [axis if point is None else f"{point}_acc_{axis}" for axis in AXES]
    needed = f"time [s], {', '.join(f'{name} [m/s2]' for name in axes)} (or [g])"
    plain = choice is None and is_table(file)
    if plain:
        try:
            record = read_columns(file, needed)
        except DataError as error:  # perhaps of a column that is not needed
            try:
                record, plain = _chosen(file, Choice(), axes), False
            except DataError:
                raise error from None
    else:
        record = _chosen(file, choice or Choice(), axes)
    # A record of z only is common; any other missing axis is accepted only if `choice` assigns axes.
    present = [name for name in axes if name in record.channels]
    partial = present == axes[2:] or (choice is not None and bool({*AXES} & {*choice.channels}))
    xyz: dict[str, Vector] = {}
    events = []
    for axis, name in zip(AXES, axes, strict=True):
        if name not in record.channels and partial:
            continue
        if name not in record.channels:
            points = dict.fromkeys(channel[:-6] for channel in record.channels if channel.endswith("_acc_x"))
            points_shown = f"; set --channel POINT, one of {', '.join(points)}" if points else ""
            shown = ", ".join(list(record.channels)[:6])
            raise DataError(f"{file}: column {name} is missing; expected {needed}, found {shown}{points_shown}")
        if (unit := record.units[name]) not in UNITS:
            raise DataError(
                f"{file}: column {name!r} has the unit {unit!r} but must have one of "
                f"{', '.join(f'[{allowed}]' for allowed in UNITS)}; write the header as {needed}"
            )
        values = record.channels[name] * UNITS[unit]
        deviation = np.abs(values - values.mean())
        largest = float(deviation.max())
        shown, limit = beside_limit(largest, LARGEST_ACCELERATION)
        if largest > LARGEST_ACCELERATION and rare_events(deviation, LARGEST_ACCELERATION):
            events.append(
                f"{axis}: deviates by {shown} m/s2 from its mean at {record.time[int(np.argmax(deviation))]:.6g} s, "
                f"usually at most {limit} m/s2: a pothole, or a spike of the logger?"
            )
        elif largest > LARGEST_ACCELERATION:
            raise DataError(
                f"{file}: column {name!r} deviates by {shown} m/s2 from its mean but must deviate by at most "
                f"{limit}; is it in mm/s2, or is there a spike? Correct the header or the record"
            )
        xyz[axis] = values
    # `choose` checks its channels before they are filtered.
    units = {axis: record.units[name] for axis, name in zip(AXES, axes, strict=True) if axis in xyz}
    channel_notices = channel_findings(file, record.time, xyz, units) if plain else []
    notices = (*record.notices, *events, *channel_notices, *_notices(xyz, 1.0 / record.step))
    return Record(
        time=record.time, channels=xyz, units=dict.fromkeys(xyz, "m/s2"), notices=notices, highest=record.highest
    )
