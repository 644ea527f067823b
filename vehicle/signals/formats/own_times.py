"""Times of channels that share the rows of a table and not their clock: pairs of columns, or cells left blank."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.clock import clock_of_rounded, is_uniform
from vehicle.signals.formats.clock_text import epoch_seconds
from vehicle.signals.formats.heads import TIME_NAME
from vehicle.signals.formats.units import seconds_in

EQUAL_SPANS = 0.01
"""Maximum relative difference of the spans of two clocks of the same rows, for example logger and satellite [-]."""

BLANK_SHARE, UNEVEN = 0.3, 1.5
"""Minimum share of blank cells [-], and maximum step over the median step [-], of a jittered channel among
rasters: a lost sample makes a step of 2."""

RISING = 0.25
"""Minimum share of rising steps of a clock [-]: times of 400 Hz rounded to 10 ms rise in every fourth row."""

_CLOCKS = re.compile(r"gps|gnss|utc|local|system|device|log|epoch|unix|elapsed|rel|abs|pc|host|daq|ecu", re.IGNORECASE)
"""Beginning of words for the clocks of a logger, which count the same rows."""


def time_pairs(columns: Sequence[str]) -> dict[int, int]:
    """Return the time column of each channel, if every time column of a table has channels.

    Args:
        columns: "time", "channel", or another word for a column that is neither.

    Returns:
        Column of a channel -> column of its times; empty unless time columns and channels take turns.
    """
    times, channels = ([n for n, each in enumerate(columns) if each == word] for word in ("time", "channel"))
    if len(times) < 2 or not channels:
        return {}
    before = {n: max((t for t in times if t < n), default=-1) for n in channels}
    if set(before.values()) == set(times):
        return before
    after = {n: min((t for t in times if t > n), default=-1) for n in channels}
    return after if set(after.values()) == set(times) else {}


def is_time(name: str, unit: str) -> bool:
    """Return True if name and unit of a column mean a time; pandas writes a repeated name as "Time.1".

    Without a unit the name must contain a word for time: "T Oil" is a temperature.
    """
    named = TIME_NAME.fullmatch(re.sub(r"[._ ]?\d+$", "", name.strip()))
    return bool(named and (seconds_in(unit) > 0.0 if unit else re.search("time|zeit", name, re.IGNORECASE)))


def rises(times: Vector) -> bool:
    """Return True if a column (n,) rises, by at least `RISING` of its steps, and never falls: no duration of a lap."""
    steps = np.diff(times[np.isfinite(times)])
    return bool((steps >= 0).all() and np.count_nonzero(steps) >= RISING * steps.size)


def own_times(
    where: object, names: Sequence[str], units: Sequence[str], pairs: Mapping[int, int], columns: Sequence[Vector]
) -> dict[int, Vector]:
    """Return the times of each channel of `time_pairs` [s]; NaN where its row is blank.

    Two clocks of the same rows, for example of a logger and a satellite receiver, have equal spans, also in the rows
    that they share, and the word of a clock in their names; the result is then empty. It is also empty if a column of
    the same rows is no clock, see `rises`.

    Args:
        where: file, for messages.
        columns: numbers of all columns, (n,) each.
    """
    times = list(dict.fromkeys(pairs.values()))
    rows = [np.isfinite(columns[t]) for t in times]
    shared = np.logical_and.reduce(rows)
    if all((each == shared).all() for each in rows) and not all(rises(columns[t]) for t in times):
        return {}
    different = False
    for masks in (rows, [shared] * len(rows)):
        masked = [(columns[t][mask], t) for t, mask in zip(times, masks, strict=True) if mask.any()]
        spans = [float(np.ptp(values)) * _factor(units, t, times) for values, t in masked]
        different |= len(spans) < 2 or max(spans) > (1.0 + EQUAL_SPANS) * min(spans)
    if not different and any(_CLOCKS.match(word) for time in times for word in re.findall(r"[^\W\d_]+", names[time])):
        return {}
    if not all(_factor(units, time, times) for time in times):
        shown = ", ".join(repr(names[time]) for time in times)
        raise DataError(f"{where}: each channel has a time column ({shown}) without a known unit; write it ([s])")
    factors = {time: _factor(units, time, times) for time in times}
    first = columns[times[0]] * factors[times[0]]
    zero = 0.0
    if epoch_seconds(first[np.isfinite(first)], "s") is not None:  # counts since 1970
        zero = min(float(np.nanmin(columns[time])) * factors[time] for time in times)
    origins = {
        time: columns[time].dtype.type(zero / factors[time]) for time in times
    }  # counts of ns need whole numbers
    seconds = {time: (columns[time] - origins[time]) * factors[time] for time in times}
    for channel, time in pairs.items():
        lost = np.flatnonzero(~np.isfinite(seconds[time]) & np.isfinite(columns[channel]))
        if lost.size:
            raise DataError(
                f"{where}: column {names[channel]!r} has a value in row {lost[0] + 1} of the numbers, but its time "
                f"column {names[time]!r} has none; correct or remove the row"
            )
    for time in times[1:]:
        if np.array_equal(seconds[time], seconds[times[0]]):
            seconds[time] = seconds[times[0]]  # one axis
    return {channel: seconds[time] for channel, time in pairs.items()}


def _factor(units: Sequence[str], time: int, times: Sequence[int]) -> float:
    """Return the unit of a time column [s]; without a unit, that of the first time column; 0 if unknown."""
    return seconds_in(units[time] or units[times[0]])


def with_own_rasters(channels: Sequence[Channel]) -> list[Channel]:
    """Return the channels of a table, each at the times of its values if rows of other rasters lie between them.

    Rows in which a channel is blank and another is not, and between which its own times are regular, are rows of that
    other one. A lost sample leaves a gap in the regular times, so that channel is returned with its missing value. Rows
    without a time belong to other channels, see `own_times`.
    """
    return [_with_own_raster(channel, channels) for channel in channels]


def _with_own_raster(channel: Channel, channels: Sequence[Channel]) -> Channel:
    """Return a channel at the times of its values if these are regular; see `with_own_rasters`."""
    if channel.axis is None or channel.kind != "time":
        return channel
    timed = ~np.isnan(channel.axis)
    axis, values = channel.axis[timed], channel.values[timed]
    whole = channel if timed.all() else replace(channel, values=values, axis=axis)
    rows = np.flatnonzero(~np.isnan(values))
    if rows.size < 3 or rows[-1] - rows[0] + 1 == rows.size:
        return whole
    blank = np.isnan(channel.values)
    others = (other.values for other in channels if other.axis is channel.axis and other is not channel)
    time = axis[rows]
    steps = np.diff(time)
    if not any(np.isfinite(other[blank]).any() for other in others) or not (steps > 0.0).all():
        return whole
    share = 1.0 - rows.size / (rows[-1] - rows[0] + 1)
    jittered = share >= BLANK_SHARE and float(steps.max()) <= UNEVEN * float(np.median(steps))
    if not (is_uniform(time) or clock_of_rounded(time) is not None or jittered):
        return whole
    return replace(channel, values=values[rows], axis=time)
