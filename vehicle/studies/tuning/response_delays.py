"""Delays of measured responses against the input of the model: known, or an unknown of the fit for each group."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.signals.records.delays import PLATES, channel_delays, group_of
from vehicle.signals.records.measured import Measured

HALF_RANGE = 0.02
"""Half the range of a delay around its start [s]: half a period at 25 Hz. It starts at the delay of best agreement with
the car before the fit, so that the fit only has to follow the phases of the car."""

MILLISECOND = 1e-3
"""Unit of the coordinate of a delay in a fit [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ResponseDelays:
    """Delays of the channels of a measurement."""

    known: Mapping[str, float] = field(default_factory=dict)  # channel to known delay [s]
    fitted: Mapping[str, str] = field(default_factory=dict)  # channel to the group whose delay is an unknown of the fit

    @property
    def groups(self) -> tuple[str, ...]:
        """Return the groups with an unknown delay."""
        return tuple(dict.fromkeys(self.fitted.values()))

    def of(self, channels: Sequence[str], groups: Mapping[str, float], lags: Mapping[str, float]) -> Vector:
        """Return the delay of each channel [s], (k,): known or of its group, 0 for a missing one, and a further lag."""
        return np.array(
            [
                self.known.get(name, groups.get(self.fitted.get(name, ""), 0.0)) + lags.get(name, 0.0)
                for name in channels
            ]
        )

    def settled(self, groups: Mapping[str, float]) -> ResponseDelays:
        """Return the delays with known values for all groups."""
        fitted = {channel: groups.get(group, 0.0) for channel, group in self.fitted.items()}
        return ResponseDelays(known={**self.known, **fitted})


@dataclass(frozen=True, kw_only=True, slots=True)
class DelayRange:
    """Delay of a group of channels as an unknown of a fit, with the coordinate u = (value - start) / 1 ms."""

    path: str  # name of the unknown, for messages
    group: str  # group of channels
    target: int  # index of the measurement
    start: float  # delay at the start of the fit [s]

    @property
    def low(self) -> float:
        """Minimum [s]."""
        return self.start - HALF_RANGE

    @property
    def high(self) -> float:
        """Maximum [s]."""
        return self.start + HALF_RANGE

    @property
    def half_width(self) -> float:
        """Return half the distance of the limits of u [-]."""
        return HALF_RANGE / MILLISECOND

    def value(self, u: float) -> float:
        """Return the delay at a coordinate u [s]."""
        return self.start + MILLISECOND * u

    def coordinate(self, value: float) -> float:
        """Return u of a delay [-]."""
        return (value - self.start) / MILLISECOND

    def slope(self, _: float) -> float:
        """Return d value / d u at a value [s]."""
        return MILLISECOND

    def option(self, delay: float) -> str:
        """Return the option that removes a delay [s]."""
        return f"--delay {self.group}={1e3 * delay:.5g}ms"


def start_delay(delays: Sequence[float], errors: Sequence[float]) -> float:
    """Return the start of a delay [s]: the median of the channels, or 0 without channels.

    Of two channels, the delay with the smaller error is the start.
    """
    if not delays:
        return 0.0
    if len(delays) == 2:
        return float(delays[int(np.argmin(np.nan_to_num(errors, nan=math.inf)))])
    return float(np.median(delays))


def response_delays(
    measured: Measured, channels: Sequence[str], delays: Mapping[str, float], *, contained: bool
) -> ResponseDelays:
    """Return the known delays of channels against the input, and the groups of the others.

    Args:
        delays: group, channel or pattern to delay [s].
        contained: the plates of the measurement are the input; otherwise another file has the input.
    """
    every = [*(measured.record.channels if measured.record else ()), *(measured.frf.channels if measured.frf else ())]
    delay_of = channel_delays(tuple(dict.fromkeys([*every, *channels])), delays)
    plates = {delay_of.get(name, 0.0) for name in every if group_of(name) == PLATES} if contained else {0.0}
    if len(plates) > 1:
        raise ConfigurationError(
            f"--delay: the plates have different delays {sorted(plates)} s, but need a common one; set --delay "
            "plates=TIME"
        )
    base = max(plates, default=0.0)
    return ResponseDelays(
        known={name: delay_of[name] - base for name in channels if name in delay_of},
        fitted={name: group_of(name) for name in channels if name not in delay_of},
    )
