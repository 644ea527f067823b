"""Channels of a measurement that the user chose, and what is done to them before they are used."""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.records.channel import Channel, Measurement, uniform_axis
from vehicle.signals.records.channel_faults import MOTIONS, faults
from vehicle.signals.records.clock import clock_options, is_uniform, longest_step, without_rounding
from vehicle.signals.records.resampled import resampled
from vehicle.signals.records.table import USABLE, Vector
from vehicle.signals.records.units import allowed_units, find_ratio, find_unit


@dataclass(frozen=True, kw_only=True, slots=True)
class Choice:
    """Choice of channels, units, rate and excerpt of a measurement file.

    Attributes:
        channels: role, such as a wheel, to number, exact name, or pattern with * and ? that hits one channel; the role
            "time" names a channel that holds the times.
        units: role to unit, against what the file tells; "" for every role.
        rate: samples a second [Hz], in place of the times of the file.
        first, last: excerpt [s], in the times of the file.
        detrend: subtract the straight line of least squares.
        highpass: corner frequency [Hz]; needed to integrate velocities and accelerations.
        databases: files of the form DBC, which decode the log of a CAN bus.
        resample: sampling rate [Hz] to which the record is brought before anything else is done to it.
    """

    channels: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    rate: float | None = None
    first: float | None = None
    last: float | None = None
    detrend: bool = False
    highpass: float | None = None
    databases: tuple[Path, ...] = ()
    resample: float | None = None

    def __post_init__(self) -> None:
        for name, value in (("--rate", self.rate), ("--highpass", self.highpass), ("--resample", self.resample)):
            if value is not None and not 0.0 < value < math.inf:
                raise ConfigurationError(f"{name} {value:g} Hz: allowed is above 0")
        for name, value in (("--from", self.first), ("--to", self.last)):
            if value is not None and not math.isfinite(value):
                raise ConfigurationError(f"{name} {value:g} s: allowed is a finite time")
        if self.first is not None and self.last is not None and self.first >= self.last:
            raise ConfigurationError(f"--from {self.first:g} --to {self.last:g}: the excerpt must end after it begins")
        for unit in self.units.values():
            if find_ratio(unit) is None:
                raise ConfigurationError(f"--unit {unit}: not known; allowed are {allowed_units()}")

    @property
    def empty(self) -> bool:
        """Whether nothing is asked."""
        return self == Choice()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Chosen:
    """Chosen channels over one uniform time.

    Attributes:
        time: [s], (n,), in the times of the file.
        values: role to samples in SI, (n,).
        quantities: role to what they are.
        notices: a sentence for everything that was done.
        highest: highest frequency that the samples hold [Hz]: `USABLE` of the lower of the rates before and after
            resampling.
    """

    time: Vector
    values: Mapping[str, Vector]
    quantities: Mapping[str, str]
    notices: tuple[str, ...]
    highest: float

    def require_uniform(self, where: object) -> None:
        """Check that the times are uniform.

        Args:
            where: file, for the message.

        Raises:
            DataError: with the options that make them uniform.
        """
        if not is_uniform(self.time):
            steps = np.diff(self.time)
            jitter = 100.0 * float(np.max(np.abs(steps / np.median(steps) - 1.0)))
            raise DataError(
                f"{where}: times are not uniform, steps deviate by up to {jitter:.3g} % of the median; set "
                f"{' '.join(clock_options(self.time))}, or --rate HZ if the samples are uniform and their stamps are "
                "not"
            )


def pairs(option: str, texts: Sequence[str], role: str) -> dict[str, str]:
    """ROLE=VALUE of a repeated option.

    Args:
        option: for messages.
        texts: as given.
        role: of a text without "=".

    Raises:
        ConfigurationError: a role twice, or an empty value.
    """
    found: dict[str, str] = {}
    for text in texts:
        name, sign, value = text.partition("=")
        name, value = (name.strip(), value.strip()) if sign else (role, text.strip())
        if not value or name in found:
            raise ConfigurationError(f"{option} {text!r}: needed is ROLE=VALUE, each role once")
        found[name] = value
    return found


def pick(
    measurement: Measurement,
    wanted: str,
    *,
    option: str = "--channel",
    allowed: Callable[[Channel], bool] = lambda channel: True,
) -> int:
    """Index of the one channel that a number, an exact name, a pattern, or a place with its direction means.

    Args:
        measurement: the file.
        wanted: what the user gave; `12+Z` and `Dof 12 +Z` are the channel at node 12 in that direction.
        option: for messages.
        allowed: which channels are asked for; the others keep their numbers.

    Raises:
        DataError: it hits none or several; all channels are listed.
    """
    channels = [(index, one) for index, one in enumerate(measurement.channels) if allowed(one)]
    found = [index for index, one in channels if one.name == wanted]
    if not found and wanted.isdecimal() and int(wanted) - 1 in dict(channels):
        return int(wanted) - 1
    if not found:
        found = [index for index, one in channels if fnmatch.fnmatchcase(one.name.lower(), wanted.lower())]
    if not found:
        point = "".join(wanted.lower().removeprefix("dof").split())
        found = [index for index, one in channels if one.direction and (one.place + one.direction).lower() == point]
    if len(found) == 1:
        return found[0]
    hits = f"hits {len(found)} channels ({', '.join(str(n + 1) for n in found[:8])})" if found else "hits no channel"
    listed = ", ".join(f"{index + 1} {one.name!r} [{one.unit}]" for index, one in channels[:40])
    more = f" and {len(channels) - 40} more" if len(channels) > 40 else ""
    raise DataError(
        f"{measurement.path}: {option} {wanted!r} {hits}; give a number, an exact name, or a pattern with * that hits "
        f"one of: {listed}{more}"
    )


def choose(measurement: Measurement, choice: Choice) -> Chosen:
    """Take the channels, their units and the excerpt as asked; nothing is guessed.

    Args:
        measurement: the file.
        choice: at least one role beside "time".

    Raises:
        DataError: a channel that is not there, of unknown unit, without times, with a pause, or with missing values.
    """
    path, notices = measurement.path, list(measurement.notices)
    roles = {role: pick(measurement, wanted) for role, wanted in choice.channels.items() if role != "time"}
    channels = {role: measurement.channels[index] for role, index in roles.items()}
    for role, index in roles.items():
        one = channels[role]
        unit = choice.units.get(role, choice.units.get("", ""))
        if unit:
            if one.unit and one.unit != unit:
                notices.append(f"{role}: unit [{unit}] on request; the file says [{one.unit}]")
            channels[role] = one = replace(one, unit=unit, remark="")
        where = f"{path}: channel {index + 1} {one.name!r}"
        if find_unit(one.unit) is None:
            found = f"the unit {one.unit!r}, which is not known" if one.unit else one.remark or "no unit"
            raise DataError(f"{where} has {found}; give --unit {role}=UNIT with one of {allowed_units()}")
        if one.kind != "time" or np.iscomplexobj(one.values):
            raise DataError(f"{where} is no time history but a {one.function}; choose another")
        if one.name != role or one.unit != one.si_unit or one.remark:
            notices.append(
                f"{role}: channel {index + 1} {one.name!r} [{one.unit}]" + (f"; {one.remark}" if one.remark else "")
            )
    if len({one.values.size for one in channels.values()}) > 1:
        sizes = ", ".join(f"{role} {one.values.size}" for role, one in channels.items())
        raise DataError(f"{path}: channels of different length ({sizes}); choose those of one rate, or one of them")
    time = _times(measurement, choice, next(iter(channels.values())), notices)
    told = choice.rate is None and "time" not in choice.channels
    nearly = 1e-3 * float(np.median(np.diff(time)))
    for role, one in channels.items():
        if told and (one.axis is None or not np.allclose(one.axis, time, rtol=0.0, atol=nearly)):
            raise DataError(f"{path}: {role} has other times than the first channel; choose channels of one rate")
    kept = np.ones(time.size, dtype=bool)
    if choice.first is not None or choice.last is not None:
        kept = (time >= (-np.inf if choice.first is None else choice.first)) & (
            time <= (np.inf if choice.last is None else choice.last)
        )
        if np.count_nonzero(kept) < 3:
            raise DataError(f"{path}: the excerpt holds {np.count_nonzero(kept)} samples; the record goes from "
                            f"{time[0]:.6g} to {time[-1]:.6g} s")  # fmt: skip
        time = time[kept]
        notices.append(f"excerpt from {time[0]:.6g} to {time[-1]:.6g} s")
    values = {role: np.asarray(one.si_values, dtype=np.float64)[kept] for role, one in channels.items()}
    for role, samples in values.items():
        missing = np.count_nonzero(~np.isfinite(samples))
        if missing:
            at = time[np.flatnonzero(~np.isfinite(samples))[0]]
            raise DataError(f"{path}: {role}: {missing} missing values, the first at {at:.6g} s; cut them off with "
                            "--from and --to, or repair the file")  # fmt: skip
    time = _uniform(path, time, notices)
    motions = {role: one for role, one in values.items() if channels[role].quantity in MOTIONS}
    notices += faults(motions, time, moving=[role for role in motions if channels[role].quantity == "acceleration"])
    highest = USABLE / float(np.median(np.diff(time)))
    if choice.resample is not None and not _has_rate(time, choice.resample):
        values, said = resampled(
            time, values, choice.resample, lambda row: f"{path}: sample {row + 1}", is_uniform(time)
        )
        notices.append(said)
        time = uniform_axis(next(iter(values.values())).size, 1.0 / choice.resample, float(time[0]))
        highest = min(highest, USABLE * choice.resample)
    for role in values:
        if choice.detrend:
            count = np.arange(time.size)
            line = np.polynomial.Polynomial.fit(count, values[role], 1)(count)
            notices.append(f"{role}: straight line from {line[0]:.4g} to {line[-1]:.4g} "
                           f"{channels[role].si_unit} subtracted on request")  # fmt: skip
            values[role] = values[role] - line
    return Chosen(
        time=time,
        values=values,
        quantities={role: one.quantity for role, one in channels.items()},
        notices=tuple(notices),
        highest=highest,
    )


def _times(measurement: Measurement, choice: Choice, channel: Channel, notices: list[str]) -> Vector:
    """Times of the samples: of the request, of a channel, or of the file."""
    path = measurement.path
    if choice.rate is not None:
        told = channel.rate
        if told is not None and abs(told / choice.rate - 1.0) > 1e-6:
            notices.append(f"rate {choice.rate:g} Hz on request; the file says {told:.9g} Hz")
        else:
            notices.append(f"rate {choice.rate:g} Hz on request")
        return np.arange(channel.values.size) / choice.rate
    if "time" in choice.channels:
        one = measurement.channels[pick(measurement, choice.channels["time"])]
        unit = choice.units.get("time", one.unit)
        known = find_unit(unit)
        if known is None or known.quantity != "time":
            raise DataError(f"{path}: channel {one.name!r} has the unit {unit!r}; give --unit time=s, or ms, us, min")
        return np.asarray(one.values, dtype=np.float64) * known.factor
    if channel.axis is None:
        raise DataError(
            f"{path}: channel {channel.name!r} has no times; give --rate HZ, or --channel time=NAME for the channel "
            "that "
            "holds them, with --unit time=s"
        )
    return channel.axis


def _has_rate(time: Vector, rate: float) -> bool:
    """True if times [s], shape (n,), are uniform at a rate [Hz]."""
    return is_uniform(time) and abs((time.size - 1) / float(time[-1] - time[0]) / rate - 1.0) < 1e-9


def _uniform(path: object, time: Vector, notices: list[str]) -> Vector:
    """Times without rounding; refused where they pause or go back."""
    steps = np.diff(time)
    if not np.isfinite(time).all() or not (steps > 0.0).all():
        at = int(np.flatnonzero(~(steps > 0.0))[0]) + 1
        raise DataError(
            f"{path}: sample {at + 1}: the time {time[at]:.9g} s does not follow {time[at - 1]:.9g} s; times must "
            "increase; cut with --from and --to"
        )
    median = float(np.median(steps))
    worst = int(np.argmax(steps))
    if steps[worst] > longest_step(median):
        raise DataError(
            f"{path}: the record pauses for {steps[worst]:.6g} s, from {time[worst]:.9g} to {time[worst + 1]:.9g} s; "
            f"nothing is filled in; take the part before it (--to {time[worst]:.9g}) or after it "
            f"(--from {time[worst + 1]:.9g})"
        )
    found, rounded = without_rounding(time)
    notices.extend(rounded)
    return found
