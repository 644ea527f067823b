"""Select channels of a measurement and preprocess them: units, excerpt, resampling, trend removal."""

import fnmatch
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.channel import NOT_OVER_TIME, Channel, Measurement, uniform_axis
from vehicle.signals.formats.clock import clock_of_stamps, clock_options, is_uniform, longest_step, without_rounding
from vehicle.signals.formats.table import USABLE
from vehicle.signals.formats.text import LARGEST
from vehicle.signals.formats.units import allowed_units, find_ratio, find_unit, seconds_in
from vehicle.signals.records.channel_findings import channel_findings
from vehicle.signals.records.common_span import Block, blocks_of, cut, need_resampling
from vehicle.signals.records.finding import Finding, FindingError
from vehicle.signals.records.resampled import resampled


@dataclass(frozen=True, kw_only=True, slots=True)
class Choice:
    """Selection of channels, units, rate and excerpt of a measurement file.

    Attributes:
        channels: role, such as a wheel, to number, exact name, or pattern with * and ? that matches one channel; the
            role "time" selects the channel of the times.
        units: role to unit, overriding the file; "" for all roles.
        rate: sampling rate [Hz], overriding the times of the file.
        first, last: begin and end of the excerpt [s], in the times of the file.
        detrend: subtract the least-squares straight line.
        highpass: corner frequency [Hz]; required to integrate velocities and accelerations.
        databases: DBC files that decode the log of a CAN bus.
        resample: new sampling rate [Hz]; resampling comes before trend removal and integration.
        delays: channel of the model, pattern or group ("accelerations") to delay in the file, which is taken out
            [s]; see `vehicle.signals.records.delays`.
        any_level: accept levels and accelerations of plates beyond a shaker, in a fit.
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
    delays: Mapping[str, float] = field(default_factory=dict)
    any_level: bool = False

    def __post_init__(self) -> None:
        for name, value in (("--rate", self.rate), ("--highpass", self.highpass), ("--resample", self.resample)):
            if value is not None and not 0.0 < value < math.inf:
                raise ConfigurationError(f"{name} {value:g} Hz: must be above 0")
        for name, value in (("--from", self.first), ("--to", self.last)):
            if value is not None and not math.isfinite(value):
                raise ConfigurationError(f"{name} {value:g} s: must be finite")
        if self.first is not None and self.last is not None and self.first >= self.last:
            raise ConfigurationError(f"--from {self.first:g} --to {self.last:g}: --from must be below --to")
        for unit in self.units.values():
            if find_ratio(unit) is None:
                raise ConfigurationError(f"--unit {unit}: unknown unit; must be one of {allowed_units()}")

    @property
    def empty(self) -> bool:
        """True if all attributes have their default values."""
        return self == Choice()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Chosen:
    """Selected channels over a common time axis.

    Attributes:
        time: sample times [s], (n,), in the times of the file.
        values: role to samples in SI units, (n,).
        quantities: role to physical quantity.
        notices: one message per processing step.
        highest: maximum usable frequency [Hz]: `USABLE` times the lower rate before and after resampling.
    """

    time: Vector
    values: Mapping[str, Vector]
    quantities: Mapping[str, str]
    notices: tuple[str, ...]
    highest: float

    @property
    def step(self) -> float:
        """Mean sampling interval [s]."""
        return float(self.time[-1] - self.time[0]) / (self.time.size - 1)

    def require_uniform(self, where: object) -> None:
        """Check that the times are uniform."""
        if not is_uniform(self.time):
            steps = np.diff(self.time)
            jitter = 100.0 * float(np.max(np.abs(steps / np.median(steps) - 1.0)))
            options = clock_options(self.time)
            text = (
                f"times are not uniform: steps deviate from the median by up to {jitter:.3g} %; set "
                f"{' '.join(options)}, or --rate HZ if only the time stamps are irregular"
            )
            raise FindingError(where, [Finding(text, "times", options)])


def pairs(option: str, texts: Sequence[str], role: str) -> dict[str, str]:
    """Parse the values ROLE=VALUE of a repeated option into a dictionary.

    Args:
        role: role for a text without "=".
    """
    values_by_role: dict[str, str] = {}
    for text in texts:
        name, sign, value = text.partition("=")
        name, value = (name.strip(), value.strip()) if sign else (role, text.strip())
        if not value or name in values_by_role:
            raise ConfigurationError(f"{option} {text!r}: must be ROLE=VALUE, each role once")
        values_by_role[name] = value
    return values_by_role


def pick(
    measurement: Measurement,
    wanted: str,
    *,
    option: str = "--channel",
    allowed: Callable[[Channel], bool] = lambda channel: True,
) -> int:
    """Return the index of the only channel that matches a number, exact name, pattern, or point with direction.

    Args:
        wanted: value of the option; `12+Z` and `Dof 12 +Z` match the channel at node 12 in direction +Z.
        option: name of the option, for messages.
        allowed: predicate of the channels to search; all channels keep their numbers.
    """
    matches = matching(measurement, wanted, allowed)
    if len(matches) == 1:
        return matches[0]
    channels = [(index, channel) for index, channel in enumerate(measurement.channels) if allowed(channel)]
    several = f"matches {len(matches)} channels ({', '.join(str(n + 1) for n in matches[:8])})"
    listed = ", ".join(f"{index + 1} {channel.name!r} [{channel.unit}]" for index, channel in channels[:40])
    more = f" and {len(channels) - 40} more" if len(channels) > 40 else ""
    raise DataError(
        f"{measurement.path}: {option} {wanted!r} {several if matches else 'matches no channel'}; give a number, an "
        f"exact name, or a pattern with * that matches one of: {listed}{more}"
    )


def matching(measurement: Measurement, wanted: str, allowed: Callable[[Channel], bool]) -> list[int]:
    """Return the indices of all channels that match the value of an option; arguments: see `pick`."""
    channels = [(index, channel) for index, channel in enumerate(measurement.channels) if allowed(channel)]
    matches = [index for index, channel in channels if channel.name == wanted]
    if not matches and wanted.isdecimal() and int(wanted) - 1 in dict(channels):
        return [int(wanted) - 1]
    if not matches:
        matches = [index for index, channel in channels if fnmatch.fnmatchcase(channel.name.lower(), wanted.lower())]
    if not matches:
        point = "".join(wanted.lower().removeprefix("dof").split())
        matches = [
            index
            for index, channel in channels
            if channel.direction and (channel.place + channel.direction).lower() == point
        ]
    return matches


def choose(measurement: Measurement, choice: Choice) -> Chosen:
    """Return the selected channels of a measurement in SI units, after excerpt, resampling and trend removal.

    Args:
        choice: selection with at least one role other than "time".

    Raises:
        DataError: a channel is missing, has an unknown unit, no times, a pause, or missing values.
    """
    path, notices = measurement.path, list(measurement.notices)
    roles = {role: pick(measurement, wanted) for role, wanted in choice.channels.items() if role != "time"}
    channels = {role: measurement.channels[index] for role, index in roles.items()}
    for role, index in roles.items():
        channel = channels[role]
        unit = choice.units.get(role, choice.units.get("", ""))
        if unit:
            if channel.unit and channel.unit != unit:
                notices.append(f"{role}: unit [{unit}] as requested, not [{channel.unit}] of the file")
            channels[role] = channel = replace(channel, unit=unit, remark="")
        where = f"{path}: channel {index + 1} {channel.name!r}"
        if find_unit(channel.unit) is None:
            remark = f" ({channel.remark})" if channel.remark else ""
            fault = f"the unknown unit {channel.unit!r}" if channel.unit else f"no unit{remark}"
            raise DataError(f"{where} has {fault}; set --unit {role}=UNIT to one of {allowed_units()}")
        if channel.kind != "time" or np.iscomplexobj(channel.values) or channel.function in NOT_OVER_TIME:
            raise DataError(f"{where} is a {channel.function} but must be a time history; choose another channel")
        if channel.direction.startswith("-"):
            notices.append(f"{role}: sign inverted, because it was measured along {channel.direction}")
            channels[role] = channel = replace(channel, values=-channel.values)
        if channel.name != role or channel.unit != channel.si_unit or channel.remark:
            notices.append(
                f"{role}: channel {index + 1} {channel.name!r} [{channel.unit}]"
                + (f"; {channel.remark}" if channel.remark else "")
            )
    blocks = _blocks(measurement, choice, channels, notices)
    parts = [_part(path, block, choice, notices) for block in blocks]
    highest = min(USABLE / float(np.median(np.diff(time))) for time, _ in parts)
    if choice.resample is not None and not (len(parts) == 1 and _has_rate(parts[0][0], choice.resample)):
        parts = [_resampled(path, parts, choice.resample, notices)]
        highest = min(highest, USABLE * choice.resample)
    if len(parts) > 1:
        raise need_resampling(path, blocks)
    time, values = parts[0][0], {role: parts[0][1][role] for role in channels}
    for role in values:
        if choice.detrend:
            count = np.arange(time.size)
            line = np.polynomial.Polynomial.fit(count, values[role], 1)(count)
            notices.append(f"{role}: straight line from {line[0]:.4g} to {line[-1]:.4g} {channels[role].si_unit} "
                "subtracted, as requested")  # fmt: skip
            values[role] = values[role] - line
    return Chosen(
        time=time,
        values=values,
        quantities={role: channel.quantity for role, channel in channels.items()},
        notices=tuple(notices),
        highest=highest,
    )


def _blocks(
    measurement: Measurement, choice: Choice, channels: Mapping[str, Channel], notices: list[str]
) -> list[Block]:
    """Return the channels by their times: one block after a cut to the common span, several if they need resampling."""
    path, selected = measurement.path, dict(channels)
    if "time" in choice.channels:
        selected["time"] = measurement.channels[pick(measurement, choice.channels["time"])]
    blocks: list[Block] = []
    if all(channel.axis is not None for channel in selected.values()):
        blocks, notice = cut(path, blocks_of(selected))
        notices += [notice] if notice else []
        selected = dict(blocks[0].channels) if len(blocks) == 1 else selected
    if choice.rate is None and "time" not in choice.channels:
        if not blocks:
            name = next(channel.name for channel in channels.values() if channel.axis is None)
            raise DataError(
                f"{path}: channel {name!r} has no times; set --rate HZ, or the channel of the times with "
                "--channel time=NAME --unit time=s"
            )
        return blocks
    if len({channel.values.size for channel in selected.values()}) > 1:
        sizes = ", ".join(f"{role} {channel.values.size}" for role, channel in selected.items())
        raise DataError(f"{path}: the channels have different lengths ({sizes}); choose channels of one rate")
    time = _times(path, choice, selected, notices)
    return [Block(time=time, channels={role: selected[role] for role in channels})]


def _part(path: Path, block: Block, choice: Choice, notices: list[str]) -> tuple[Vector, dict[str, Vector]]:
    """Return times and SI values of a block after the excerpt; reject pauses and missing values, notice faults."""
    time, channels = block.time, block.channels
    selected = np.ones(time.size, dtype=bool)
    if choice.first is not None or choice.last is not None:
        first, last = -np.inf if choice.first is None else choice.first, np.inf if choice.last is None else choice.last
        selected = (time >= first) & (time <= last)
        if np.count_nonzero(selected) < 3:
            raise DataError(f"{path}: the part between --from and --to has {np.count_nonzero(selected)} samples, but "
            f"at least 3 are needed; the record is from {time[0]:.6g} to {time[-1]:.6g} s")  # fmt: skip
        time = time[selected]
        notices.append(f"excerpt from {time[0]:.6g} to {time[-1]:.6g} s")
    values = {role: np.asarray(channel.si_values, dtype=np.float64)[selected] for role, channel in channels.items()}
    for role, samples in values.items():
        absurd = np.flatnonzero(np.abs(samples) > LARGEST)
        if absurd.size:
            raise DataError(f"{path}: {role}: {samples[absurd[0]]:.4g} at {time[absurd[0]]:.6g} s is too large for a "
                f"measured value (at most {LARGEST:g}); exclude it with --from and --to, or correct the "
                "file")  # fmt: skip
        missing = np.count_nonzero(~np.isfinite(samples))
        if missing == samples.size:
            channel = channels[role]
            raise DataError(
                f"{path}: {role}: channel {channel.name!r} has no values"
                f"{f' ({channel.remark})' if channel.remark else ''}; choose another channel"
            )
        if missing:
            at, remark = time[np.flatnonzero(~np.isfinite(samples))[0]], channels[role].remark
            raise DataError(f"{path}: {role}: {missing} missing values{f' ({remark})' if remark else ''}, the first at "
                            f"{at:.6g} s; exclude them with --from and --to, or correct the file")  # fmt: skip
    time = _uniform(path, time, notices)
    notices += channel_findings(
        path,
        time,
        values,
        {role: channel.unit for role, channel in channels.items()},
        stated=values if "" in choice.units else choice.units,
        filtered=choice.detrend or choice.highpass is not None,
    )
    return time, values


def _resampled(
    path: Path, parts: Sequence[tuple[Vector, dict[str, Vector]]], rate: float, notices: list[str]
) -> tuple[Vector, dict[str, Vector]]:
    """Interpolate all parts at uniform times of their common span."""
    first, last = max(float(time[0]) for time, _ in parts), min(float(time[-1]) for time, _ in parts)
    if last - first < 2.0 / rate:
        raise DataError(
            f"{path}: the common span of the channels, {first:.6g} to {last:.6g} s, has fewer than three samples "
            f"at {rate:g} Hz; set other --from and --to, or choose channels recorded together"
        )
    values: dict[str, Vector] = {}
    for time, columns in parts:
        new, notice = resampled(
            time, columns, rate, lambda row: f"{path}: sample {row + 1}", is_uniform(time), (first, last)
        )
        values |= new
        notices.append(
            notice if len(parts) == 1 else f"{' and '.join(columns)}: {notice}, from {first:.6g} to {last:.6g} s"
        )
    return uniform_axis(next(iter(values.values())).size, 1.0 / rate, first), values


def _times(path: Path, choice: Choice, channels: Mapping[str, Channel], notices: list[str]) -> Vector:
    """Return the sample times [s] from the requested rate or the chosen channel of the times."""
    first = next(iter(channels.values()))
    if choice.rate is not None:
        rate = first.rate
        other = f"; the file has {rate:.9g} Hz" if rate is not None and abs(rate / choice.rate - 1.0) > 1e-6 else ""
        notices.append(f"sampling rate {choice.rate:g} Hz, as requested{other}")
        return np.arange(first.values.size) / choice.rate
    unit = choice.units.get("time", channels["time"].unit)
    if not (factor := seconds_in(unit)):
        raise DataError(f"{path}: channel {channels['time'].name!r}: unit {unit!r}; set --unit time=s, or ms, us, min")
    return np.asarray(channels["time"].values, dtype=np.float64) * factor


def _has_rate(time: Vector, rate: float) -> bool:
    """True if times [s], shape (n,), are uniform at a rate [Hz]."""
    return is_uniform(time) and abs((time.size - 1) / float(time[-1] - time[0]) / rate - 1.0) < 1e-9


def _uniform(path: object, time: Vector, notices: list[str]) -> Vector:
    """Return times without the rounding of their stamps; reject pauses, decreasing times, and unusable stamps."""
    clock = clock_of_stamps(time)
    if clock is not None:
        raise FindingError(path, [Finding(clock.remedy, "times", ("--rate", clock.option))])
    steps = np.diff(time)
    if not np.isfinite(time).all() or not (steps > 0.0).all():
        at = int(np.flatnonzero(~(steps > 0.0))[0]) + 1
        raise DataError(
            f"{path}: sample {at + 1}: time {time[at]:.9g} s after {time[at - 1]:.9g} s; times must increase; exclude "
            "this "
            "part with --from and --to"
        )
    median = float(np.median(steps))
    index = int(np.argmax(steps))
    if steps[index] > longest_step(median):
        text = (
            f"the record has a gap of {steps[index]:.3g} s, which is not filled; select the part before it (--to "
            f"{time[index]:.9g}) or after it (--from {time[index + 1]:.9g})"
        )
        raise FindingError(path, [Finding(text, "times", clock_options(time))])
    unrounded, rounded = without_rounding(time)
    notices.extend(Finding(text, "times") for text in rounded)
    return unrounded
