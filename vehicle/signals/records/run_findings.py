"""Findings on a record against a run of the car: exchanged channels, clock, delays, signs, units and offsets."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.signals.formats.table import Record
from vehicle.signals.records.counterpart import Counterpart, clock_advice, counterparts, sign_and_unit
from vehicle.signals.records.delays import PLATES, group_of
from vehicle.signals.records.exchanged import exchange_finding, exchanged_histories, put_right
from vehicle.signals.records.finding import Finding, findings_of
from vehicle.signals.records.gravity import axis_of_role
from vehicle.signals.records.group_delays import GroupDelay, channel_lags, group_delays
from vehicle.signals.records.measured import Measured

LARGEST_OFFSET = 0.3
"""Difference of the means over the standard deviation of the measurement: the RMS ratio is then off by 4 %."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BesideRun:
    """Time histories of a measurement compared with a run.

    Attributes:
        parts: how each channel fits its counterpart, exchanged channels put right.
        delays: delay of each group of channels; the first is the reference of the others.
        findings: findings on the record.
    """

    parts: tuple[Counterpart, ...]
    delays: tuple[GroupDelay, ...]
    findings: tuple[Finding, ...]


def beside_run(
    measured: Measured,
    record: Record,
    simulated: Record,
    times: Vector,
    *,
    delay: float = 0.0,
    drift: float = 0.0,
    parts: list[Counterpart] | None = None,
    sensor_delays: Mapping[str, float] | None = None,
    command: str = "",
) -> BesideRun:
    """Compare a record with a run of the car.

    Args:
        measured: measurement of the record, with its channels in the file.
        record: its time histories, or some of them.
        simulated: time histories of the run.
        times: times of the measured samples on the clock of the run [s], (n,).
        delay, drift: start of the measurement after the run [s] and drift of its clock [-] that `times` contain.
        parts: result of `counterparts`, if already known.
        sensor_delays: channel -> delay that is known, but not taken out of the record [s].
        command: command with the options --delay and --drift for the advice, if the current one lacks them.
    """
    step = max(float(times[-1] - times[0]) / (times.size - 1), simulated.step)
    exchanged = exchanged_histories(record, simulated, times)
    if exchanged or parts is None:
        parts = counterparts(put_right(record, exchanged), simulated, times)
    parts = [part.later((sensor_delays or {}).get(part.channel, 0.0)) for part in parts]
    delays = group_delays(channel_lags(parts, measured.delays), step)
    findings = exchange_finding(exchanged, measured.mapped, complete=measured.by_name)
    without = [part for part in parts if group_of(part.channel) == PLATES]
    if without and not any(part.reliable_shift for part in without):
        # The lag of the other channels would contain the unknown difference of the plates.
        findings.append(
            Finding(
                f"{', '.join(part.channel for part in without)}: unlike the plates of the run (correlation below 0.7), "
                "so clock and delays are not judged; simulate the plates of this measurement",
                "plates",
            )
        )
        delays = ()
    else:
        clock = [part for part in parts if not delays or group_of(part.channel) == delays[0].group]
        findings += clock_advice(clock, step, delay, drift, command)
    findings += [*sign_and_unit(parts), *_offsets(record, simulated, measured.notices)]
    findings += [finding for group in delays for finding in group.advice(step, command)]
    return BesideRun(parts=tuple(parts), delays=delays, findings=tuple(findings))


def _offsets(record: Record, simulated: Record, notices: tuple[str, ...]) -> list[Finding]:
    """Return a finding for each acceleration whose mean differs by more than `LARGEST_OFFSET`, without gravity."""
    named = {name for each in findings_of(notices, kinds=("gravity",)) for name in each.partition(":")[0].split(", ")}
    findings = []
    for name, values in record.channels.items():
        if record.units[name] != "m/s2" or name in named or name not in simulated.channels:
            continue
        means = float(np.mean(values)), float(np.mean(simulated.channels[name]))
        if abs(means[0] - means[1]) > LARGEST_OFFSET * float(np.std(values)):
            horizontal = axis_of_role(name) in ("x", "y")
            cause = "braking, cornering, or an inclined sensor" if horizontal else "the offset of a sensor"
            findings.append(
                Finding(
                    f"{name}: the mean is {means[0]:.3g} m/s2, in the run {number(means[1], 2)} m/s2, which spoils the "
                    f"RMS ratio: {cause}? --detrend or --highpass 0.5 subtracts it",
                    "offset",
                    () if horizontal else ("--detrend",),
                )
            )
    return findings
