"""Compare measured channels with their simulated counterparts: detect faults of clock, sign and unit."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.signals.analysis.samples import Complex
from vehicle.signals.analysis.time_shift import TimeShift, time_shift
from vehicle.signals.formats.table import Record
from vehicle.signals.formats.units import STANDARD_GRAVITY
from vehicle.signals.records.finding import Finding
from vehicle.signals.records.resampled import at_times

SAME_MOTION = 0.7
"""Minimum |correlation| of two records of the same motion, for which sign, unit and clock can be checked [-]."""

FACTOR_RANGE = 1.5
"""Maximum ratio to 9.81 or 1000 of a wrong unit [-]: the level of a model with the same motion is closer than that."""

SHARE_OF_STEP = 0.25
"""Minimum time shift over the sampling interval for a message [-]; the estimate is accurate to 0.1."""

SIGNIFICANT = 4.0
"""Minimum ratio of a significant shift or drift to its standard error [-]."""

PARTS = 1e6
"""Parts per million."""

UNITS: Mapping[tuple[str, float], str] = {
    ("m/s2", STANDARD_GRAVITY): "m/s2 (not g)",
    ("m/s2", 1.0 / STANDARD_GRAVITY): "g",
    ("m/s2", 1e3): "mm/s2",
    ("m/s2", 1e-3): "m/s2 (not mm/s2)",
    ("m", 1e3): "mm",
    ("m", 1e-3): "m (not mm)",
    ("m/s", 1e3): "mm/s",
    ("m/s", 1e-3): "m/s (not mm/s)",
    ("N", 1e3): "N (not kN)",
    ("N", 1e-3): "kN",
}
"""SI unit and ratio of measured to true values -> actual unit of the measured values."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Counterpart:
    """Comparison of a measured time history with the simulated one.

    Attributes:
        channel: channel name in the model.
        unit: SI unit of both time histories.
        shift: time shift of the simulated record, positive for a late one; None for constant channels.
    """

    channel: str
    unit: str
    shift: TimeShift | None

    def later(self, lag: float) -> "Counterpart":
        """Return the comparison with a run that is later by a time [s]."""
        return replace(self, shift=replace(self.shift, shift=self.shift.shift + lag)) if self.shift and lag else self

    @property
    def reliable_shift(self) -> TimeShift | None:
        """Time shift if |correlation| is at least `SAME_MOTION`, else None."""
        return self.shift if self.shift is not None and abs(self.shift.correlation) >= SAME_MOTION else None


def run_times(measured: Record, delay: float, drift: float, begin: float = 0.0) -> Vector:
    """Return the times of a measurement on the clock of the run: t = t_m (1 + drift) + delay [s], (n,).

    Args:
        delay: time of the run at the beginning of the measurement [s].
        drift: relative slowness of the clock of the measurement [-].
        begin: first time in the file, subtracted from all its times [s].
    """
    return np.asarray((measured.time - begin) * (1.0 + drift) + delay)


def counterparts(measured: Record, simulated: Record, times: Vector) -> list[Counterpart]:
    """Estimate the time shift of each channel contained in both records, at the lower of their sampling rates.

    Args:
        measured: measured record; `times` replace its times.
        times: times of the measured samples on the clock of the run [s], (n,).
    """
    step = max(float(times[-1] - times[0]) / (times.size - 1), simulated.step)
    start = simulated.time[0]
    first = math.ceil((times[0] - start) / step - 1e-6)
    grid = start + step * np.arange(first, math.floor((times[-1] - start) / step + 1e-6) + 1)
    simulated_grid = start + step * np.arange(math.floor((simulated.time[-1] - start) / step + 1e-6) + 1)
    pairs: list[Counterpart] = []
    guess: TimeShift | None = None
    for name, values in measured.channels.items():
        if name not in simulated.channels:
            continue
        measured_curve = at_times(times, values, np.clip(grid, times[0], times[-1]), step)
        simulated_curve = at_times(
            simulated.time, simulated.channels[name], np.clip(simulated_grid, start, simulated.time[-1]), step
        )
        shift = time_shift(measured_curve, simulated_curve, step, start - float(grid[0]), guess)
        pairs.append(Counterpart(channel=name, unit=measured.units[name], shift=shift and shift.later(float(grid[0]))))
        if shift is not None and abs(shift.correlation) > abs(guess.correlation if guess else SAME_MOTION):
            guess = shift
    return pairs


def clock_advice(
    parts: Sequence[Counterpart], step: float, delay: float, drift: float, command: str = ""
) -> list[Finding]:
    """Return a finding if another delay and drift is the best fit of most channels; else [].

    Args:
        parts: comparisons returned by `counterparts`.
        step: sampling interval of the comparison [s].
        delay, drift: current values, used for `parts` [s], [-].
        command: command with the options --delay and --drift; empty for the running command.
    """
    reliable = [part for part in parts if part.reliable_shift]
    if not reliable:
        return []
    middle = float(np.median([part.shift.middle for part in reliable if part.shift]))
    lags = np.array([part.shift.at(middle) for part in reliable if part.shift])
    errors = np.array([np.nan_to_num(part.shift.shift_error, posinf=step) for part in reliable if part.shift])
    alike = np.abs(lags - np.median(lags)) <= np.maximum(step, SIGNIFICANT * errors)
    if 2 * np.count_nonzero(alike) <= len(reliable):
        return []
    weight = 1.0 / (errors[alike] + 1e-3 * step) ** 2
    lag, error = float(np.average(lags[alike], weights=weight)), 1.0 / math.sqrt(float(weight.sum()))
    shifts = [part.shift for part, agrees in zip(reliable, alike, strict=True) if agrees and part.shift]
    slope, spread = _common_drift(shifts)
    span = max(shift.span for shift in shifts)
    drifts = abs(slope) > SIGNIFICANT * spread and abs(slope) * span > 2.0 * SHARE_OF_STEP * step
    if not drifts:
        slope = 0.0
    late = abs(lag) > SHARE_OF_STEP * step and abs(lag) > SIGNIFICANT * error
    if not (drifts or late):
        return []
    # t' = t + lag(t) with t = t_m (1 + drift) + delay.
    ahead = lag - slope * middle
    new_delay, new_drift = (1.0 + slope) * delay + ahead, (1.0 + slope) * (1.0 + drift) - 1.0
    agreement = (
        "in all channels" if alike.all() and len(alike) == len(parts) else f"in {len(shifts)} of {len(parts)} channels"
    )
    arguments = ["--delay", f"{round(new_delay, 7):.10g}"]
    if drifts or drift:
        arguments += ["--drift", f"{new_drift * PARTS:.7g}"]
    options = f"{' '.join(arguments)} to {command}" if command else " ".join(arguments)
    if drifts:
        low, high = middle - 0.5 * span, middle + 0.5 * span
        message = (
            f"the clock of the measurement is {100 * abs(slope):.3g} % {'slow' if slope > 0 else 'fast'}: the run lags "
            f"it by {1e3 * (lag + slope * (low - middle)):.3g} ms at {low:.3g} s and by "
            f"{1e3 * (lag + slope * (high - middle)):.3g} ms at {high:.3g} s {agreement}; set {options}"
        )
    else:
        message = (
            f"the measurement is {number(1e3 * abs(lag), 3)} ms {'early' if lag > 0.0 else 'late'} {agreement}; if the "
            f"records began at different times, set {options}"
        )
    periods = {round(shift.period, 6) for shift in shifts if shift.period is not None}
    if len(periods) and all(shift.period is not None for shift in shifts):
        message += (
            f" (the records repeat every {min(periods):.4g} s: a shift by whole periods fits as well; start at an "
            "event that occurs once)"
        )
    return [Finding(message, "clock", () if command else arguments)]


def _common_drift(shifts: Sequence[TimeShift]) -> tuple[float, float]:
    """Return the mean drift, weighted by the standard errors, and its standard error (infinite without drifts)."""
    with_drift = [shift for shift in shifts if math.isfinite(shift.drift_error)]
    if not with_drift:
        return 0.0, math.inf
    errors = np.array([shift.drift_error for shift in with_drift])
    weight = 1.0 / (errors + 1e-9) ** 2
    values = np.array([shift.drift for shift in with_drift])
    mean = float(np.average(values, weights=weight))
    scatter = math.sqrt(float(np.average((values - mean) ** 2, weights=weight)))
    return mean, max(1.0 / math.sqrt(float(weight.sum())), scatter)


def sign_and_unit(parts: Sequence[Counterpart]) -> list[Finding]:
    """Return one finding for each inverted channel and each wrong unit among the result of `counterparts`."""
    messages: list[Finding] = []
    for part in parts:
        shift = part.reliable_shift
        if shift is None:
            continue
        if shift.correlation < 0.0:
            messages.append(_inverted(part.channel, f"correlation {shift.correlation:.3f}"))
        messages += _unit(part.channel, part.unit, abs(shift.gain / shift.correlation))
    return messages


def response_faults(channel: str, measured: Complex, simulated: Complex, weight: Vector) -> list[Finding]:
    """Return findings on a measured frequency response that is inverted or has a wrong unit at all frequencies.

    Args:
        measured, simulated: frequency responses [m/s2 per m], (m,); NaN if undefined.
        weight: weight of each line [-], (m,).
    """
    usable = np.isfinite(measured) & np.isfinite(simulated) & (weight > 0.0) & (np.abs(measured) > 0.0)
    usable &= np.abs(simulated) > 0.0
    if np.count_nonzero(usable) < 3:
        return []
    ratio, share = measured[usable] / simulated[usable], weight[usable] / weight[usable].sum()
    messages: list[Finding] = []
    if float(share @ (ratio / np.abs(ratio)).real) < -SAME_MOTION:
        phase = math.degrees(math.sqrt(float(share @ np.angle(-ratio) ** 2)))
        messages.append(_inverted(channel, f"phase 180 degrees, RMS deviation {number(phase, 2)} degrees"))
    level = np.log(np.abs(ratio))
    mean = float(share @ level)
    if math.sqrt(float(share @ (level - mean) ** 2)) < math.log(2.0):
        messages += _unit(channel, "m/s2", math.exp(mean))
    return messages


def _inverted(channel: str, why: str) -> Finding:
    remedy = f"if its sensor points the other way, set --turn {channel}"
    text = f"{channel} is inverted relative to the run ({why}); {remedy}"
    return Finding(text, "sign", ("--turn", channel))


def _unit(channel: str, unit: str, ratio: float) -> list[Finding]:
    for (si, factor), unit_text in UNITS.items():
        if si == unit and abs(math.log(ratio / factor)) < math.log(FACTOR_RANGE):
            name, *remark = unit_text.split(" ", 1)
            size = f"{ratio:.3g} times" if ratio > 1.0 else f"1/{1.0 / ratio:.3g} of"
            full_text = f"{name} {remark[0]}" if remark else name
            text = (
                f"{channel}: {size} the simulated level, close to the unit factor {max(factor, 1.0 / factor):.4g}; if "
                f"the values are in {full_text}, set --unit {channel}={name}"
            )
            return [Finding(text, "unit", ("--unit", f"{channel}={name}"))]
    return []
