"""Delays of groups of channels within a measurement, for example of filtered sensors or a second logger, taken out.

A channel with the delay d shows at the time t_m of the file what happened at t_m - d. On the clock of the run

    t = t_m (1 + drift) + begin - d,

with `begin` the start of the record after the start of the run. The number without a group is `begin`: it moves all
channels alike and changes no FRF. Only differences of delays change FRFs: H_file(f) = H(f) exp(-2 pi i f (d_y - d_x))
for an output y and an input x.
"""

import fnmatch
import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import channel_units
from vehicle.signals.formats.frf_file import FrfData
from vehicle.signals.records.choice import Chosen, pairs
from vehicle.signals.records.resampled import DEGREE

PLATES = "plates"
"""Group of the inputs, to which the delays of the other groups refer."""

GROUPS = {"m/s2": "accelerations", "m/s": "velocities", "m": "displacements", "N": "forces"}
"""Unit of a channel -> group."""

Delay = float | Mapping[str, float]
"""Seconds from the start of the run to that of the record; or these for RECORD and delays of groups and channels [s].
"""

RECORD = "record"
"""Key of the start of the record among the delays of groups."""

UNITS = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6}
"""Unit of a delay as text -> seconds."""


def group_of(channel: str) -> str:
    """Return the group of a channel of the model: its quantity, or "plates"."""
    return PLATES if channel.startswith("plate_") else GROUPS.get(channel_units([channel])[channel], "others")


def parsed_delays(texts: Sequence[str]) -> dict[str, float]:
    """Return the values of the option --delay: RECORD, group, channel or pattern -> delay [s].

    Args:
        texts: for example "0.2", "accelerations=12.3ms" or "seat_*=400us".
    """
    delays = {}
    for name, text in pairs("--delay", texts, RECORD).items():
        match = re.fullmatch(r"([-+.\deE]*[.\d])\s*([a-z]*)", text)
        try:
            delays[name] = float(match[1]) * UNITS[match[2]] if match else math.nan
        except (KeyError, ValueError):
            delays[name] = math.nan
        if not math.isfinite(delays[name]):
            raise ConfigurationError(
                f"--delay {name}={text}: must be a finite number of seconds, or with the unit ms or us, for example "
                "12.3ms"
            )
    return delays


def split_delay(delay: Delay) -> tuple[float, dict[str, float]]:
    """Return the start of the record after the run [s], and the delays of groups, channels or patterns [s]."""
    delays = dict(delay) if isinstance(delay, Mapping) else {RECORD: float(delay)}
    for name, value in delays.items():
        if not math.isfinite(value):
            raise ConfigurationError(f"--delay {name}={value:g}: must be a finite number of seconds")
    return delays.pop(RECORD, 0.0), delays


def channel_delays(channels: Collection[str], delays: Mapping[str, float]) -> dict[str, float]:
    """Return the delays of channels by name, pattern or group, in this priority [s].

    Args:
        channels: names of channels of the model.
        delays: channel, pattern or group -> delay [s].
    """
    delay_of: dict[str, float] = {}
    for name in sorted(delays, key=lambda name: (name in channels, "*" in name or "?" in name)):
        chosen = [channel for channel in channels if group_of(channel) == name or fnmatch.fnmatchcase(channel, name)]
        if not chosen:
            groups = ", ".join(dict.fromkeys(group_of(channel) for channel in channels)) or "none"
            raise ConfigurationError(
                f"--delay {name}=...: is not a channel or group of the measurement; groups are {groups}; "
                f"channels {', '.join(channels) or 'none'}"
            )
        delay_of |= dict.fromkeys(chosen, delays[name])
    return delay_of


def without_delays(chosen: Chosen, delays: Mapping[str, float]) -> Chosen:
    """Return channels at the times at which their values happened, over their common time.

    The value at t is that of the file at t + d, by a spline of degree 7 through the samples.

    Args:
        chosen: channels at uniform times.
        delays: role -> delay d [s].
    """
    if not any(delays.values()):
        return chosen
    every = [delays.get(role, 0.0) for role in chosen.values]
    inside = (chosen.time >= chosen.time[0] - min(every)) & (chosen.time <= chosen.time[-1] - max(every))
    if np.count_nonzero(inside) <= DEGREE:
        raise DataError(
            f"--delay: {min(every):.3g} to {max(every):.3g} s leave no common time of the record of "
            f"{chosen.time[-1] - chosen.time[0]:.4g} s; correct them"
        )
    start, time = chosen.time[0], chosen.time[inside]
    values: dict[str, Vector] = {}
    for (role, samples), delay in zip(chosen.values.items(), every, strict=True):
        curve = scipy.interpolate.make_interp_spline(chosen.time - start, samples, k=DEGREE)
        values[role] = np.asarray(curve(time - start + delay)) if delay else samples[inside]
    return replace(chosen, time=time, values=values, notices=(*chosen.notices, *_notices(delays)))


def responses_without_delays(frf: FrfData, delays: Mapping[str, float]) -> FrfData:
    """Return FRFs H_file(f) exp(2 pi i f d) of accelerations with delays d against the plates.

    Args:
        delays: channel -> delay against the plates [s].
    """
    lags = np.array([delays.get(channel, 0.0) for channel in frf.channels])
    turned = frf.response * np.exp(2j * np.pi * lags[:, None] * frf.frequency)
    return replace(frf, response=turned)


def _notices(delays: Mapping[str, float]) -> list[str]:
    return [f"{name}: delay of {1e3 * value:.4g} ms removed, as requested" for name, value in delays.items() if value]
