"""The acceleration of one point in three axes, taken from a record and checked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.names import AXES
from vehicle.signals.records.channel_faults import faults
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.integration import filtered
from vehicle.signals.records.rare_events import rare_events
from vehicle.signals.records.reader import is_table, read_columns, read_record
from vehicle.signals.records.table import Record, Vector
from vehicle.signals.records.units import STANDARD_GRAVITY

UNITS = {"m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": STANDARD_GRAVITY}
"""accepted units of acceleration and their value in m/s2"""
LARGEST_ACCELERATION = 50.0
"""deviation from the mean above which a record is taken for one in a wrong unit (bad-inputs item 7) [m/s2]"""
ALIASED_SHARE = 0.05
"""share of the variance above 0.8 of Nyquist that is worth a notice (bad-inputs item 12) [-]"""


def _notices(xyz: Mapping[str, Vector], rate: float) -> tuple[str, ...]:
    """Return remarks on constant axes and on content near Nyquist."""
    found = []
    for axis, record in xyz.items():
        power = np.abs(np.fft.rfft(record - record.mean())) ** 2
        total = float(power.sum())
        if np.ptp(record) == 0.0:
            found.append(f"{axis}: constant at {record[0]:g} m/s2 (no sensor?)")
        elif total > 0.0:
            share = float(power[int(0.8 * power.size) :].sum()) / total
            if share > ALIASED_SHARE:
                found.append(
                    f"{axis}: {100 * share:.0f} % of the variance lies above {0.4 * rate:g} Hz (0.8 of Nyquist); "
                    "the record may be aliased"
                )
    return tuple(found)


def _chosen(path: Path, choice: Choice, names: list[str]) -> Record:
    """Chosen channels under the names of the axes, in m/s2."""
    measurement = read_record(path, choice.databases)
    roles = {role: wanted for role, wanted in choice.channels.items() if role != "time"}
    held = {one.name for one in measurement.channels}
    if not roles:
        roles = {axis: name for axis, name in zip(AXES, names, strict=True) if name in held}
    if not roles or not set(roles) <= set(AXES):
        listed = ", ".join(f"{n} {one.name!r} [{one.unit}]" for n, one in enumerate(measurement.channels[:20], 1))
        raise DataError(
            f"{path}: needed are the axes: --channel x=NAME --channel y=NAME --channel z=NAME, or one or two of them, "
            f"each a number, exact name or a pattern with *; the file has {listed}"
        )
    chosen = choose(measurement, replace(choice, channels={**choice.channels, **roles}))
    wrong = next((role for role, quantity in chosen.quantities.items() if quantity != "acceleration"), None)
    if wrong is not None:
        raise DataError(
            f"{path}: channel {roles[wrong]!r} for {wrong} is no acceleration but a {chosen.quantities[wrong]}; choose "
            f"another, or give --unit {wrong}=m/s2 or {wrong}=g if the file is wrong"
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


def read_acceleration(path: str | Path, place: str | None = None, choice: Choice | None = None) -> Record:
    """Read the acceleration of a point, in all three axes or in those that were measured.

    Args:
        path: a record, as of `read_columns`.
        place: point of a run, as "seat_rail", for the channels `seat_rail_acc_x|y|z`; None for columns x, y, z.
        choice: channels of a measurement file for the roles x, y and z, one of them or more, and what is done to them.

    Returns:
        Channels x, y, z [m/s2], those that are there, with remarks on what is odd.

    Raises:
        ConfigurationError: no such file.
        DataError: it is no record, a channel is missing or in another unit, or a value is none of a vehicle.
    """
    file = Path(path)
    axes = [axis if place is None else f"{place}_acc_{axis}" for axis in AXES]
    needed = f"time [s], {', '.join(f'{name} [m/s2]' for name in axes)} (or [g])"
    if choice is not None or not is_table(file):
        record = _chosen(file, choice or Choice(), axes)
    else:
        record = read_columns(file, needed)
    # A record of the vertical axis alone is usual; any other missing axis must be meant.
    here = [name for name in axes if name in record.channels]
    partial = here == axes[2:] or (choice is not None and bool({*AXES} & {*choice.channels}))
    xyz: dict[str, Vector] = {}
    events = []
    for axis, name in zip(AXES, axes, strict=True):
        if name not in record.channels and partial:
            continue
        if name not in record.channels:
            places = dict.fromkeys(one[:-6] for one in record.channels if one.endswith("_acc_x"))
            places_shown = f"; give --channel with one of {', '.join(places)}" if places else ""
            shown = ", ".join(list(record.channels)[:6])
            raise DataError(f"{file}: no column {name}; found {shown}; needed are {needed}{places_shown}")
        if (unit := record.units[name]) not in UNITS:
            raise DataError(
                f"{file}: column {name!r} has the unit {unit!r}, allowed are "
                f"{', '.join(f'[{one}]' for one in UNITS)}; write the header as {needed}"
            )
        values = record.channels[name] * UNITS[unit]
        about = np.abs(values - values.mean())
        swing = float(about.max())
        if swing > LARGEST_ACCELERATION and rare_events(about, LARGEST_ACCELERATION):
            events.append(
                f"{axis}: swings by {swing:.4g} m/s2 about its mean at t = {record.time[int(np.argmax(about))]:.6g} s, "
                f"beyond {LARGEST_ACCELERATION:g} m/s2: a pothole, or a spike of the logger?"
            )
        elif swing > LARGEST_ACCELERATION:
            raise DataError(
                f"{file}: column {name!r} swings by {swing:g} m/s2 about its mean, allowed are "
                f"{LARGEST_ACCELERATION:g}; looks like mm/s2 or a spike? correct the unit in the header or the record"
            )
        xyz[axis] = values
    # Chosen channels were judged before they were filtered.
    plain = faults(xyz, record.time, moving=list(xyz)) if choice is None and is_table(file) else []
    notices = (*record.notices, *events, *plain, *_notices(xyz, 1.0 / record.step))
    return Record(
        time=record.time, channels=xyz, units=dict.fromkeys(xyz, "m/s2"), notices=notices, highest=record.highest
    )
