"""History of a force from a measurement file or from Python: a cubic spline through its samples, as of a plate."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.spline import CubicSpline
from vehicle.signals.excitation.iso_road import RISE_S
from vehicle.signals.excitation.rest import half_cosine_at
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.units import find_unit
from vehicle.signals.records.choice import Choice, choose, pick

UNITS = {"N": "N, kN or lbf", "N m": "N m or kN m"}
"""Units of a file for a force and for a moment or torque."""

AT_REST = 0.01
"""Value at an end over the RMS [-] up to which a force is at rest there."""

HIDDEN = 0.01
"""RMS above the highest frequency over the whole RMS [-]."""

FEWEST = 32
"""Minimum number of samples."""


@dataclass(frozen=True, slots=True)
class ForceRecord:
    """Force or moment of a file, or given in Python.

    Attributes:
        path: path of the force in the vehicle file, for messages.
        file: measurement file of any format of `vehicle.signals.formats`.
        channel: number, exact name or pattern of the channel; empty for the only one of this quantity.
        unit: unit of the channel that replaces the unit of the file; empty for none.
        needed: "N" or "N m".
        ends_at_zero: the force is zero after the end of the file.
        given: history from Python, in place of a file.
    """

    path: str
    file: str
    channel: str
    unit: str
    needed: str
    ends_at_zero: bool
    given: RecordedForce | None = None

    def values(self, time: Vector) -> Vector:
        """Return the force at some times [s], (...): 0 before t = 0; after the end 0 or the last value.

        A record that does not begin at rest rises within the first second, like a road.
        """
        history = self.read()
        inside = history.spline(np.clip(time, 0.0, history.duration))
        if not history.rests:
            inside = inside * half_cosine_at(time, RISE_S)
        beyond = time > history.duration if self.ends_at_zero else np.zeros_like(time, dtype=bool)
        return np.where((time < 0.0) | beyond, 0.0, inside)

    def read(self) -> RecordedForce:
        """Return the history.

        Raises:
            ConfigurationError: the file does not exist.
            DataError: the channel is missing or has another quantity, the times are not uniform, the record has a gap,
                or its last value is not zero although the force ends with zero.
        """
        if self.given is not None:
            return self.given
        file = Path(self.file)
        changed = file.stat().st_mtime_ns if file.is_file() else 0
        return _history(self, changed)

    def require_length(self, duration: float) -> None:
        """Check that the record lasts for a run of this length [s]."""
        history = self.read()
        if history.duration < duration - 1e-6 and not self.ends_at_zero:
            raise DataError(
                f"{self.file}: the force lasts {history.duration:.6g} s, less than the run, {duration:.6g} s; "
                f"set --duration {history.duration:.4g}, use a longer file, or set {self.path}.ends_at_zero = "
                "true for a force that is zero after its end"
            )


@dataclass(frozen=True, slots=True, eq=False)
class RecordedForce:
    """History of a force.

    Attributes:
        spline: force over time [N or N m].
        duration: last time [s].
        rests: the force begins at rest.
        highest: frequency [Hz] above which less than `HIDDEN` of its RMS lies.
        notices: messages on the file.
    """

    spline: CubicSpline
    duration: float
    rests: bool
    highest: float
    notices: tuple[str, ...]


@lru_cache(maxsize=16)
def _history(record: ForceRecord, changed: int) -> RecordedForce:
    where = record.path
    measurement = read_record(record.file)
    channel = _channel(record, measurement)
    chosen = choose(
        measurement, Choice(channels={where: str(channel + 1)}, units={where: record.unit} if record.unit else {})
    )
    time, values = chosen.time - chosen.time[0], chosen.values[where]
    if time.size < FEWEST:
        raise DataError(f"{record.file}: has {time.size} samples, but at least {FEWEST} are needed")
    steps = np.diff(time)
    # Times with six decimals give steps 1e-6 s off; a step above 1 s may be 1e-6 of its length off.
    if np.max(np.abs(steps / np.mean(steps) - 1.0)) > 1e-6 * max(1.0, 1.0 / float(np.mean(steps))):
        raise DataError(f"{record.file}: times are not uniform; resample the record of {where} to a uniform grid")
    size = float(np.sqrt(np.mean(values**2)))
    if size == 0.0:
        raise DataError(f"{record.file}: the force of {where} is zero throughout; choose another channel")
    notices = [notice for notice in chosen.notices if not notice.startswith(f"{where}: channel")]
    if chosen.time[0] != 0.0:
        notices.append(f"time of {record.file} begins at {chosen.time[0]:.6g} s and was shifted to 0")
    if record.ends_at_zero and abs(values[-1]) > AT_REST * size:
        raise DataError(
            f"{where}.ends_at_zero: the last value of {record.file} is {values[-1]:.4g} {record.needed}, not 0; "
            "let the record end at zero, or leave ends_at_zero out"
        )
    return recorded_force(where, record.needed, time, values, notices)


def recorded_force(path: str, unit: str, time: Vector, values: Vector, notices: Iterable[str] = ()) -> RecordedForce:
    """Return the history of a force through samples; it rises within the first second if it does not begin at rest.

    Args:
        path: path of the force in the vehicle file, for messages.
        unit: "N" or "N m".
        time: uniform times from 0 on [s]; (n,).
        values: force at these times; (n,).
        notices: messages on its source.
    """
    messages = list(notices)
    rests = bool(abs(values[0]) <= AT_REST * np.sqrt(np.mean(values**2)))
    if not rests:
        messages.append(
            f"{path} does not begin at zero but at {values[0]:.4g} {unit}; the simulation fades it in over the "
            f"first {RISE_S:g} s"
        )
    return RecordedForce(
        spline=CubicSpline(time, values),
        duration=float(time[-1]),
        rests=rests,
        highest=_highest(values, float(time[1] - time[0])),
        notices=tuple(messages),
    )


def _channel(record: ForceRecord, measurement: Measurement) -> int:
    """Return the index of the channel of a force, with a unit of its quantity."""
    quantity = find_unit(record.needed)
    assert quantity is not None
    if record.channel:
        index = pick(measurement, record.channel, option=f"{record.path}.channel")
    else:
        units = [find_unit(channel.unit or record.unit) for channel in measurement.channels]
        named = [number for number, unit in enumerate(units) if unit and unit.quantity == quantity.quantity]
        if len(named) != 1:
            listed = ", ".join(
                f"{n} {channel.name!r} [{channel.unit}]" for n, channel in enumerate(measurement.channels, 1)
            )
            raise DataError(
                f"{record.file}: {len(named)} channels have the unit {UNITS[record.needed]}, but one channel is "
                f"needed; set {record.path}.channel to a number or name of: {listed}"
            )
        (index,) = named
    channel = measurement.channels[index]
    unit = find_unit(record.unit or channel.unit)
    where = f"{record.file}: channel {index + 1} {channel.name!r}"
    if unit is None:
        text = f"the unknown unit {record.unit or channel.unit!r}" if record.unit or channel.unit else "no unit"
        raise DataError(f"{where} has {text}; set {record.path}.unit to {UNITS[record.needed]}")
    if unit.quantity != quantity.quantity:
        raise DataError(
            f"{where} is a {unit.quantity} in [{record.unit or channel.unit}]; {record.path} needs "
            f"{UNITS[record.needed]}; choose another channel, or define it as a {unit.quantity} in the vehicle "
            "file"
        )
    return index


def _highest(values: Vector, interval: float) -> float:
    """Return the frequency [Hz] above which less than `HIDDEN` of the RMS lies; with a Hann window."""
    # A record with zeros at both ends continues itself without a step, so it needs no window.
    window = np.hanning(values.size) if max(abs(values[0]), abs(values[-1])) > 0.0 else np.ones(values.size)
    power = np.abs(np.fft.rfft(window * (values - values.mean()))) ** 2
    # Power from each line to the last; negative below, because searchsorted needs rising values.
    above = np.cumsum(power[::-1])[::-1]
    line = int(np.searchsorted(-above, -(HIDDEN**2) * max(above[0], np.finfo(float).tiny)))
    return min(line, power.size - 1) / (values.size * interval)
