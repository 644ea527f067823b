"""What is wrong with a measured channel, told from its simulated counterpart: clock, sign, unit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.time_shift import TimeShift, time_shift
from vehicle.signals.records.resampled import at_times
from vehicle.signals.records.table import Record, Vector
from vehicle.signals.records.units import STANDARD_GRAVITY

Complex = npt.NDArray[np.complex128]

SAME_MOTION = 0.7
"""Correlation of size from which on two records show one motion, so that sign, unit and clock can be judged [-]."""
FACTOR_RANGE = 1.5
"""A ratio within this factor of 9.81 or 1000 is that of a unit: a model that moves alike is nearer."""
SHARE_OF_STEP = 0.25
"""Time shift over the sampling interval from which on it is worth a sentence [-]; it is found within a tenth."""
SIGNIFICANT = 4.0
"""Standard errors beyond which a shift or a drift is one."""
PARTS = 1e6
"""Parts per million."""

UNITS: Mapping[tuple[str, float], str] = {
    ("m/s2", STANDARD_GRAVITY): "m/s2 though the file says g",
    ("m/s2", 1.0 / STANDARD_GRAVITY): "g",
    ("m/s2", 1e3): "mm/s2",
    ("m/s2", 1e-3): "m/s2 though the file says mm/s2",
    ("m", 1e3): "mm",
    ("m", 1e-3): "m though the file says mm",
    ("m/s", 1e3): "mm/s",
    ("m/s", 1e-3): "m/s though the file says mm/s",
    ("N", 1e3): "N though the file says kN",
    ("N", 1e-3): "kN",
}
"""SI unit and the ratio of measured over true values to the unit that the values have."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Counterpart:
    """A measured time history against the simulated one.

    Attributes:
        channel: name in the model.
        unit: SI unit of both.
        found: time shift of the simulated record, positive where it is late; None where nothing moves.
    """

    channel: str
    unit: str
    found: TimeShift | None

    @property
    def known(self) -> TimeShift | None:
        """The time shift, where both records show one motion."""
        return self.found if self.found is not None and abs(self.found.correlation) >= SAME_MOTION else None


def run_times(measured: Record, delay: float, drift: float, begin: float = 0.0) -> Vector:
    """Return the times of a measurement on the clock of the run: t = t_m (1 + drift) + delay [s], (n,).

    Args:
        measured: the measurement.
        delay: time of the run at which the measurement began [s].
        drift: by which the clock of the measurement is slow [-].
        begin: time at which the file begins, from which its times are counted [s].
    """
    return np.asarray((measured.time - begin) * (1.0 + drift) + delay)


def counterparts(measured: Record, simulated: Record, times: Vector) -> list[Counterpart]:
    """Return the time shift of each channel that both have, at the lower rate of both.

    Args:
        measured: its channels at other times than its own.
        simulated: the run.
        times: of the measured samples on the clock of the run [s], (n,).
    """
    step = max(float(times[-1] - times[0]) / (times.size - 1), simulated.step)
    start = simulated.time[0]
    first = math.ceil((times[0] - start) / step - 1e-6)
    grid = start + step * np.arange(first, math.floor((times[-1] - start) / step + 1e-6) + 1)
    other = start + step * np.arange(math.floor((simulated.time[-1] - start) / step + 1e-6) + 1)
    found: list[Counterpart] = []
    guess: TimeShift | None = None
    for name, values in measured.channels.items():
        if name not in simulated.channels:
            continue
        truth = at_times(times, values, np.clip(grid, times[0], times[-1]), step)
        curve = at_times(simulated.time, simulated.channels[name], np.clip(other, start, simulated.time[-1]), step)
        one = time_shift(truth, curve, step, start - float(grid[0]), guess)
        found.append(Counterpart(channel=name, unit=measured.units[name], found=one and one.later(float(grid[0]))))
        if one is not None and abs(one.correlation) > abs(guess.correlation if guess else SAME_MOTION):
            guess = one
    return found


def clock_advice(parts: Sequence[Counterpart], step: float, delay: float, drift: float, command: str = "") -> list[str]:
    """Return a sentence where most channels agree best at one and the same other delay and drift.

    Args:
        parts: see `counterparts`.
        step: sampling interval of the comparison [s].
        delay, drift: that the counterparts were found with [s], [-].
        command: what has the options --delay and --drift, where it is another command.
    """
    known = [part for part in parts if part.known]
    if not known:
        return []
    middle = float(np.median([part.found.middle for part in known if part.found]))
    lags = np.array([part.found.at(middle) for part in known if part.found])
    errors = np.array([np.nan_to_num(part.found.shift_error, posinf=step) for part in known if part.found])
    alike = np.abs(lags - np.median(lags)) <= np.maximum(step, SIGNIFICANT * errors)
    if 2 * np.count_nonzero(alike) <= len(known):
        return []
    weight = 1.0 / (errors[alike] + 1e-3 * step) ** 2
    lag, error = float(np.average(lags[alike], weights=weight)), 1.0 / math.sqrt(float(weight.sum()))
    shifts = [part.found for part, same in zip(known, alike, strict=True) if same and part.found]
    slope, spread = _common_drift(shifts)
    span = max(one.span for one in shifts)
    drifts = abs(slope) > SIGNIFICANT * spread and abs(slope) * span > 2.0 * SHARE_OF_STEP * step
    if not drifts:
        slope = 0.0
    late = abs(lag) > SHARE_OF_STEP * step and abs(lag) > SIGNIFICANT * error
    if not (drifts or late):
        return []
    # t' = t + lag(t) with t = t_m (1 + drift) + delay.
    ahead = lag - slope * middle
    new_delay, new_drift = (1.0 + slope) * delay + ahead, (1.0 + slope) * (1.0 + drift) - 1.0
    who = "all alike" if alike.all() and len(alike) == len(parts) else f"{len(shifts)} of {len(parts)} alike"
    options = f"--delay {round(new_delay, 7):.10g}"
    if drifts or drift:
        options += f" --drift {new_drift * PARTS:.7g}"
    options = f"{options} to {command}" if command else options
    if drifts:
        low, high = middle - 0.5 * span, middle + 0.5 * span
        said = (
            f"the clock of the measurement is {100 * abs(slope):.4g} % {'slow' if slope > 0 else 'fast'} against the "
            f"run: the simulated time histories are {1e3 * (lag + slope * (low - middle)):.5g} ms late at {low:.4g} s "
            f"and {1e3 * (lag + slope * (high - middle)):.5g} ms at {high:.4g} s, {who}: give {options}"
        )
    else:
        said = (
            f"the simulated time histories are {lag:.6g} s late, {who}: if the records began at different times, give "
            f"{options}"
        )
    periods = {round(one.period, 6) for one in shifts if one.period is not None}
    if len(periods) and all(one.period is not None for one in shifts):
        said += (
            f"; the records repeat themselves every {min(periods):.4g} s, so that whole periods more or less fit as "
            "well: begin at an event that happens once"
        )
    return [said]


def _common_drift(shifts: Sequence[TimeShift]) -> tuple[float, float]:
    """Mean drift by the standard errors, and its standard error; infinite where no channel tells one."""
    told = [one for one in shifts if math.isfinite(one.drift_error)]
    if not told:
        return 0.0, math.inf
    errors = np.array([one.drift_error for one in told])
    weight = 1.0 / (errors + 1e-9) ** 2
    values = np.array([one.drift for one in told])
    mean = float(np.average(values, weights=weight))
    scatter = math.sqrt(float(np.average((values - mean) ** 2, weights=weight)))
    return mean, max(1.0 / math.sqrt(float(weight.sum())), scatter)


def sign_and_unit(parts: Sequence[Counterpart]) -> list[str]:
    """Return a sentence for each inverted channel, and for each one in another unit.

    Args:
        parts: see `counterparts`.
    """
    said: list[str] = []
    for part in parts:
        one = part.known
        if one is None:
            continue
        if one.correlation < 0.0:
            said.append(_inverted(part.channel, f"correlation {one.correlation:.3f}"))
        said += _unit(part.channel, part.unit, abs(one.gain / one.correlation))
    return said


def response_faults(channel: str, measured: Complex, simulated: Complex, weight: Vector) -> list[str]:
    """Return a sentence where a measured response is inverted, or in another unit, at all frequencies alike.

    Args:
        channel: name in the model.
        measured, simulated: responses [m/s2 per m], (m,); NaN where undefined.
        weight: of the lines [-], (m,).
    """
    usable = np.isfinite(measured) & np.isfinite(simulated) & (weight > 0.0) & (np.abs(measured) > 0.0)
    usable &= np.abs(simulated) > 0.0
    if np.count_nonzero(usable) < 3:
        return []
    ratio, share = measured[usable] / simulated[usable], weight[usable] / weight[usable].sum()
    said = []
    if float(share @ (ratio / np.abs(ratio)).real) < -SAME_MOTION:
        phase = math.degrees(math.sqrt(float(share @ np.angle(-ratio) ** 2)))
        said.append(_inverted(channel, f"phase 180 degrees, RMS deviation {phase:.2g} degrees"))
    level = np.log(np.abs(ratio))
    mean = float(share @ level)
    if math.sqrt(float(share @ (level - mean) ** 2)) < math.log(2.0):
        said += _unit(channel, "m/s2", math.exp(mean))
    return said


def _inverted(channel: str, why: str) -> str:
    remedy = f"if it was measured in the other direction, give --turn {channel}"
    return f"{channel} is inverted against the run ({why}): {remedy}"


def _unit(channel: str, unit: str, ratio: float) -> list[str]:
    for (si, factor), true in UNITS.items():
        if si == unit and abs(math.log(ratio / factor)) < math.log(FACTOR_RANGE):
            name, *doubt = true.split(" ", 1)
            size = (
                f"{ratio:.4g} times the simulated one" if ratio > 1.0 else f"1/{1.0 / ratio:.4g} of the simulated one"
            )
            doubted = f"{name} {doubt[0]}" if doubt else name
            return [
                f"{channel}: the measured level is {size}, near the factor {max(factor, 1.0 / factor):.4g} of a unit: "
                f"if its values are in {doubted}, give --unit {channel}={name}"
            ]
    return []
