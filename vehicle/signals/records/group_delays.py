"""Delays of the groups of channels of a measurement against its plates, from the lag of each channel against a run."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.digits import number
from vehicle.signals.records.counterpart import SHARE_OF_STEP, SIGNIFICANT, Counterpart
from vehicle.signals.records.delays import PLATES, group_of
from vehicle.signals.records.finding import Finding

RUN = "run"
"""Reference of the first group: its lag contains the start of the record."""

LATE_SENSORS, LEAST_ALIKE = 5e-3, 3
"""Delay [s] and number of channels, all alike, from which sensors are late: a wrong friction law or mount shifts the
response by 0.5 to 2.5 ms (examples of the documentation), and each channel by another time where it shifts more."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ChannelLag:
    """Lag of a measured channel against the run, in which both agree best.

    Attributes:
        channel: channel name in the model.
        lag: lag in the file, before any delay is taken out [s].
        error: standard error [s].
        taken_out: delay that was taken out [s].
    """

    channel: str
    lag: float
    error: float
    taken_out: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class GroupDelay:
    """Delay of a group of channels of a measurement.

    The delay is that of best agreement with the run. It is the delay of the sensors as far as the car of the run has
    the phases of the measured one; a fit (`tune`) has both as unknowns.

    Attributes:
        group: plates, accelerations, velocities, displacements, forces or others.
        against: group or "run" to which the delay refers.
        delay: delay in the file [s]; NaN where the channels of the group disagree.
        error: standard error, from the channels and their scatter [s].
        taken_out: part of the delay that was taken out [s].
        agreeing: number of channels with this delay.
        channels: number of channels with a known lag.
        unlike: channels with another delay that was not taken out, and their delays in the file [s].
        spread: smallest and largest remaining delay of the channels [s].
    """

    group: str
    against: str
    delay: float
    error: float
    taken_out: float
    agreeing: int
    channels: int
    unlike: Mapping[str, float] = field(default_factory=dict)
    spread: tuple[float, float] = (0.0, 0.0)

    def summary(self) -> dict[str, Any]:
        """Return the entry of `compare.json`."""
        finite = math.isfinite(self.delay)
        return {
            "group": self.group,
            "against": self.against,
            "delay_s": self.delay if finite else None,
            "delay_error_s": self.error if finite else None,
            "taken_out_s": self.taken_out,
            "agreeing": self.agreeing,
            "channels": self.channels,
        }

    def advice(self, step: float, command: str = "") -> list[Finding]:
        """Return findings on the rest of the delays, without an option that is accepted; [] without a significant rest.

        Args:
            step: sampling interval of the comparison [s].
            command: command with the option; empty for the running command.
        """
        remainder = self.delay - self.taken_out
        after = f" of {command}" if command else ""
        others = 0.0 if self.against == RUN else self.delay
        separate = [
            Finding(
                f"{channel} {'lags' if delay > others else 'leads'} the other {self.group} by "
                f"{1e3 * abs(delay - others):.3g} ms: wrong parameters of the car or a late sensor; only if you know "
                f"that it lags, set --delay {channel}={1e3 * delay:.5g}ms{after}",
                "delay",
            )
            for channel, delay in self.unlike.items()
        ]
        low, high = sorted(self.spread, key=abs)
        if (
            self.against != RUN
            and not math.isfinite(self.delay)
            and low * high > 0.0
            and abs(low) > SHARE_OF_STEP * step
        ):
            return [
                Finding(
                    f"the {self.group} {'lag' if low > 0.0 else 'lead'} the {self.against} by {1e3 * abs(low):.3g} to "
                    f"{1e3 * abs(high):.3g} ms: late sensors and wrong parameters of the car; fit both with `tune`",
                    "delay",
                )
            ]
        if self.against == RUN or not abs(remainder) > max(SHARE_OF_STEP * step, SIGNIFICANT * self.error):
            return separate
        option = f"{self.group}={1e3 * self.delay:.5g}ms"
        text = (
            f"the {self.group} {'lag' if self.delay > 0.0 else 'lead'} the {self.against} by "
            f"{1e3 * abs(self.delay):.3g} ms (+- {number(1e3 * self.error, 1)} ms) in {self.agreeing} of "
            f"{self.channels} channels"
        )
        if abs(remainder) >= LATE_SENSORS and self.agreeing == self.channels >= LEAST_ALIKE:
            cure = f": late sensors; set --delay {option}{after}"
            return [*separate, Finding(text + cure, "delay", ("--delay", option))]
        cure = (
            ": wrong parameters of the car or late sensors; fit both with `tune`; only if you know that the sensors "
            f"lag, set --delay {option}{after}"
        )
        return [*separate, Finding(text + cure, "delay")]


def channel_lags(parts: Sequence[Counterpart], taken_out: Mapping[str, float]) -> list[ChannelLag]:
    """Return the lags of time histories with a reliable shift, in the middle of their common time.

    Args:
        parts: comparisons returned by `counterparts`.
        taken_out: channel -> delay that was taken out [s].
    """
    shifts = [(part.channel, part.reliable_shift) for part in parts]
    estimates = [(channel, shift) for channel, shift in shifts if shift is not None]
    middle = float(np.median([shift.middle for _, shift in estimates])) if estimates else 0.0
    lags = []
    for channel, shift in estimates:
        out = taken_out.get(channel, 0.0)
        error = float(np.nan_to_num(shift.shift_error, posinf=0.0))
        lags.append(ChannelLag(channel=channel, lag=out - shift.at(middle), error=error, taken_out=out))
    return lags


def group_delays(lags: Sequence[ChannelLag], step: float, reference: str = "") -> tuple[GroupDelay, ...]:
    """Return the delay of each group: the weighted mean of the lags of its channels, less that of the reference.

    Channels that differ from the median by more than a sampling interval and four standard errors do not count; if
    they are half of a group or more, the group has no delay.

    Args:
        step: sampling interval of the comparison [s].
        reference: group with the lag 0; by default the plates, or else the first group, whose own delay is its lag
            against the run.
    """
    groups: dict[str, list[ChannelLag]] = {}
    for each in lags:
        groups.setdefault(group_of(each.channel), []).append(each)
    if not groups:
        return ()
    first = reference or (PLATES if PLATES in groups else next(iter(groups)))
    base = _mean(groups[first], step) if first in groups else (0.0, 0.0, 0.0, 0)
    delays = []
    for group in sorted(groups, key=lambda name: name != first):
        lag, error, out, agreeing = _mean(groups[group], step)
        is_first = group == first
        zero = lag if is_first else base[0]
        remainders = {each: (each.lag - each.taken_out) - (lag - out) for each in groups[group]}
        delays.append(
            GroupDelay(
                group=group,
                against=RUN if is_first else first,
                delay=lag if is_first else lag - base[0],
                error=error if is_first else math.hypot(error, base[1]),
                taken_out=out if is_first else out - base[2],
                agreeing=agreeing,
                channels=len(groups[group]),
                unlike={
                    each.channel: each.lag - zero
                    for each, remainder in remainders.items()
                    if abs(remainder) > max(step, SIGNIFICANT * each.error)
                },
                spread=_ends(
                    [each.lag - zero - (each.taken_out - (0.0 if is_first else base[2])) for each in groups[group]]
                ),
            )
        )
    return tuple(delays)


def _ends(values: Sequence[float]) -> tuple[float, float]:
    return min(values), max(values)


def _mean(lags: Sequence[ChannelLag], step: float) -> tuple[float, float, float, int]:
    """Return mean, standard error, mean of the delays taken out, and number of agreeing channels."""
    values, errors, out = (np.array([getattr(lag, name) for lag in lags]) for name in ("lag", "error", "taken_out"))
    alike = np.abs(values - np.median(values)) <= np.maximum(step, SIGNIFICANT * errors)
    count = int(np.count_nonzero(alike))
    if 2 * count <= len(lags):
        return math.nan, math.nan, float(np.mean(out)), count
    weight = 1.0 / (errors[alike] + 1e-3 * step) ** 2
    mean = float(np.average(values[alike], weights=weight))
    scatter = float(np.average((values[alike] - mean) ** 2, weights=weight)) / max(count - 1, 1)
    error = math.sqrt(max(scatter, 1.0 / float(weight.sum())))
    return mean, error, float(np.mean(out[alike])), count
