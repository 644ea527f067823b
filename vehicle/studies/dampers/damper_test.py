"""Records of a damper on a test machine: time, displacement, force and velocity, with the conditions of the test."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Indices, Mask, Vector
from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose, pick
from vehicle.signals.records.finding import findings_of
from vehicle.studies.dampers.condition_values import condition_values
from vehicle.studies.dampers.damper_force import Motion
from vehicle.studies.dampers.damper_setting import Setting
from vehicle.studies.dampers.record_checks import require_damping, require_sensors, usable_velocity
from vehicle.studies.dampers.waveform import Waveform, reversal_times, reversals, waveform_of

ROLES = ("displacement", "force", "velocity")
"""Roles of the channels, named as the quantities of their units."""

WINDOW, CUBIC = 5, 3
"""Samples and degree of the polynomial of the Savitzky-Golay filter that differentiates a displacement."""

GAIN_ERROR = 0.01
"""Error of the gain of this filter that is printed with its frequency."""

CONSISTENT = 0.02
"""Maximum RMS difference of a measured velocity from the derivative of the displacement, over its RMS: twice the
calibration error of a good sensor. Above it the derivative is used."""

STEPS = 200
"""Minimum number of steps of a cycle in the solution of a series stiffness."""

FINE, COARSE = (1e-8, 0.15, 64), (4e-8, 0.3, 32)
"""Of a test, and of one with means for the comparison of laws: travel [m] in the first step after a reversal, length of
the further steps over the time since then, and maximum number of steps between two samples. Dry friction turns while
the machine deflects by twice its force over the stiffness, 4 um for 50 N on 2.5e7 N/m, in 1 ms at 8 mm and 4 Hz: with
steps of 1 ms the stiffness was 8 % low."""

SMALLEST_TURN = 0.01
"""Smallest swing between two reversals, over the stroke."""

HEADLESS = {3: ("displacement", "force"), 4: ("displacement", "velocity", "force")}
"""Roles of the columns after the time in a file without a header, by the number of columns."""

HEADLESS_UNITS = {"time": "s", "displacement": "mm", "velocity": "mm/s", "force": "N"}
"""Units of these columns, as test machines write them."""

LONGEST_STROKE = 1.0
"""Largest displacement of a damper [m]: a column with more in a file without units is in millimetres."""

LEAST_SAMPLES = 50
"""Minimum number of samples of a test."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DamperTest:
    """Record of a test, positive in extension."""

    name: str  # name of the file without its ending
    time: Vector  # times [s]; (n,)
    displacement: Vector  # displacement, velocity, force: measured motion [m], [m/s] and force [N]; (n,)
    velocity: Vector
    force: Vector
    waveform: Waveform  # of the displacement, with the samples that are fitted
    conditions: Mapping[str, float]  # name of a condition to its value
    notices: tuple[str, ...]  # messages on what was done to the record
    traces: Mapping[str, Vector] = field(default_factory=dict)  # conditions from channels over time; (n,) each
    setting: Setting | None = None  # condition that changes during the tests of its group
    coarse: bool = False  # True for means over samples, see `averaged`

    @cached_property
    def motion(self) -> Motion:
        """Motion for `force_and_slopes`, with steps for a cycle and for the turn of dry friction at its reversals."""
        x, v, steps = self.displacement, self.velocity, np.diff(self.time)
        turns = reversals(x, v, SMALLEST_TURN)[1:-1]
        rise = (v[turns + 1] - v[turns]) / steps[turns]
        times = np.concatenate([[-np.inf], reversal_times(self.time, v, turns), [np.inf]])
        travel, growth, maximum = COARSE if self.coarse else FINE
        first = np.concatenate([[np.inf], np.sqrt(2.0 * travel / np.abs(rise)), [np.inf]])
        middle = self.time[:-1] + 0.5 * steps
        after = np.searchsorted(times, middle)
        swings = reversals(x, v)
        longest = (np.diff(self.time[swings]) / (0.5 * STEPS))[self._strokes(swings)[:-1]]
        for turn in (after - 1, after):
            longest = np.minimum(longest, np.maximum(first[turn], growth * np.abs(middle - times[turn])))
        parts = np.minimum(np.ceil(steps / longest - 1e-6).astype(int), maximum)
        return Motion(self.time, x, v, float(self.force[0]), parts, self.setting)

    @property
    def settled(self) -> Mask:
        """True for the samples that are fitted: all but run-up and run-down of equal swings; (n,)."""
        return self.waveform.settled

    @cached_property
    def weights(self) -> Vector:
        """Weight of the error of each sample: its time step, with velocity steps over the time of its stroke; (n,)."""
        steps = np.gradient(self.time)
        if not self.waveform.steps:
            return np.asarray(steps)
        turns = reversals(self.displacement, self.velocity)
        return np.asarray(steps / np.diff(self.time[turns])[self._strokes(turns)])

    def _strokes(self, turns: Indices) -> Indices:
        """Return the number of the stroke between two reversals that contains each sample; (n,)."""
        return np.clip(np.searchsorted(turns, np.arange(self.time.size), side="right") - 1, 0, turns.size - 2)

    @property
    def cycle_rows(self) -> list[Indices]:
        """Settled samples of each cycle; of halves of the test where it has less than two cycles."""
        rows = np.flatnonzero(self.settled)
        starts = np.searchsorted(rows, reversals(self.displacement, self.velocity)[2:-1:2])
        starts = starts[(starts > 0) & (starts < rows.size)]
        return np.split(rows, starts) if starts.size else np.array_split(rows, 2)

    @cached_property
    def scale(self) -> float:
        """Standard deviation of the force over time [N], to which errors are related."""
        share = np.gradient(self.time)
        return float(np.sqrt(np.average((self.force - np.average(self.force, weights=share)) ** 2, weights=share)))

    @property
    def cycle(self) -> float:
        """Duration of a cycle [s]: twice the median swing between reversals."""
        return 2.0 * float(np.median(np.diff(self.time[reversals(self.displacement, self.velocity)])))

    def averaged(self, first: Indices, last: int) -> DamperTest:
        """Return the test with means over groups of samples: the first of each group, and the number of samples."""
        size = np.diff(first, append=last)

        def mean(values: Vector) -> Vector:
            return np.asarray(np.add.reduceat(values[:last], first) / size)

        settled = np.logical_and.reduceat(self.settled[:last], first)
        return dataclasses.replace(
            self, coarse=True, setting=self.setting and self.setting.averaged(first, last),
            waveform=self.waveform._replace(settled=settled), time=mean(self.time),
            displacement=mean(self.displacement), velocity=mean(self.velocity), force=mean(self.force),
        )  # fmt: skip

    @property
    def caption(self) -> str:
        """Description of the test in a line."""
        stroke, speed = 1e3 * np.ptp(self.displacement), 1e3 * np.max(np.abs(self.velocity))
        waveform, duration = self.waveform.words, self.time[-1] - self.time[0]
        return f"{waveform}, stroke {stroke:.3g} mm, up to {speed:.3g} mm/s, {duration:.3g} s"


def read_test(path: Path, choice: Choice | None = None, *, compression: bool = False,
              conditions: Mapping[str, str] | None = None, pattern: str = "") -> DamperTest:  # fmt: skip
    """Read the record of a test.

    Args:
        choice: channels of the roles "displacement", "force", "velocity" and "time", units and excerpt; a role without
            a channel is the channel with its name, or the only channel of its quantity.
        compression: displacement, velocity and force of the file are positive in compression.
        conditions: name of a condition to a number, or to "channel:NAME": its mean value, and its values over time.
        pattern: pattern of the file name with conditions in braces, for example "*Hz{current}A".

    Raises:
        ConfigurationError: the file does not exist, a wrong condition or pattern.
        DataError: a missing channel, bad data, or too few samples.
    """
    measurement = read_record(path, choice.databases if choice is not None else ())
    notices: list[str] = []
    complete = _complete(measurement, _headless(measurement, choice or Choice(), notices))
    chosen = choose(measurement, complete)
    chosen.require_uniform(path)
    for role, quantity in chosen.quantities.items():
        if quantity != role:
            raise DataError(
                f"{path}: the channel for the {role} is a {quantity}; choose another with --channel {role}=NAME"
            )
    notices += findings_of(chosen.notices)
    time, sign = chosen.time, -1.0 if compression else 1.0
    if time.size < LEAST_SAMPLES:
        raise DataError(
            f"{path}: contains {time.size} samples, but at least {LEAST_SAMPLES} are needed; record a longer test"
        )
    x, force = sign * chosen.values["displacement"], sign * chosen.values["force"]
    names = {role: measurement.channels[pick(measurement, name)].name for role, name in complete.channels.items()}
    measured_values = {"time": time, **chosen.values}
    require_sensors(path, measured_values, {"time": "time", **names})
    measured = None
    if "velocity" in chosen.values:
        measured = usable_velocity(path, time, x, sign * chosen.values["velocity"], names, notices)
    velocity = _velocity(x, measured, float(np.mean(np.diff(time))), notices)
    require_damping(path, force, velocity, names)
    if np.sum(force * velocity) < 0.0:
        force = -force
        notices.append("the force has the sign of the test machine, opposite to the velocity; it is inverted")
    waveform = waveform_of(time, x, velocity)
    settled = waveform.settled
    if not settled.all():
        notices.append(f"fitted from {time[settled][0]:.3g} to {time[settled][-1]:.3g} s, without run-up and run-down")
    values, traces = condition_values(measurement, complete, conditions or {}, pattern, measured_values)
    return DamperTest(
        name=path.stem, time=time, displacement=x, velocity=velocity, force=force, waveform=waveform,
        conditions=values, traces=traces, notices=tuple(notices),
    )  # fmt: skip


def _headless(measurement: Measurement, choice: Choice, notices: list[str]) -> Choice:
    """Return the choice with the columns of a file without a header, and with the units of columns by role."""
    columns = measurement.channels
    channels, units = dict(choice.channels), dict(choice.units)
    bare = all(each.name == f"column {i + 1}" and not each.unit for i, each in enumerate(columns))
    roles = HEADLESS.get(len(columns), ()) if bare else ()
    if roles and not channels:
        channels = {"time": "1"} | {role: str(i + 2) for i, role in enumerate(roles)}
    units = _units_by_role(measurement, channels, units)
    if roles and "" not in units:
        assumed = {role: unit for role, unit in HEADLESS_UNITS.items() if role in channels and role not in units}
        if "displacement" in assumed and channels["displacement"].isdecimal():
            largest = float(np.max(np.abs(columns[int(channels["displacement"]) - 1].values)))
            if largest <= LONGEST_STROKE:
                raise DataError(
                    f"{measurement.path}: the displacement, up to {number(largest)}, may be in m or mm: the file has "
                    "no header; set --unit displacement=m or --unit displacement=mm"
                )
        units = assumed | units
        columns_text = ", ".join(f"{role} [{units[role]}]" for role in channels)
        notices.append(
            f"the file has no header; the columns are read as {columns_text}; change this with --channel and --unit"
        )
    return dataclasses.replace(choice, channels=channels, units=units)


def _units_by_role(measurement: Measurement, channels: Mapping[str, str], units: Mapping[str, str]) -> dict[str, str]:
    """Return the units by the roles of the channels; a column may be given by its role, number or name."""
    by_role = dict(units)
    for role, column in channels.items():
        index = pick(measurement, column)
        for name in (str(index + 1), measurement.channels[index].name):
            if name in by_role:
                by_role[role] = by_role.pop(name)
    return by_role


def _complete(measurement: Measurement, choice: Choice) -> Choice:
    """Return the choice with channels for the roles that it leaves out."""
    channels = dict(choice.channels)
    for role in ROLES:
        if role in channels:
            continue
        used = {name for other, name in channels.items() if other != role}
        numbered = [(str(i + 1), each) for i, each in enumerate(measurement.channels) if str(i + 1) not in used]
        named = [column for column, each in numbered if each.name.strip().lower() == role]
        of_quantity = [column for column, each in numbered if each.quantity == role]
        matches = named if len(named) == 1 else of_quantity
        if len(matches) == 1:
            channels[role] = matches[0]
        elif role != "velocity":
            listed = ", ".join(f"{i + 1} {each.name!r} [{each.unit}]" for i, each in enumerate(measurement.channels))
            raise DataError(
                f"{measurement.path}: {len(matches) or 'no'} channels can be the {role}; choose one with --channel "
                f"{role}=NAME, and --unit {role}=UNIT if the file has no unit. The file contains {listed}"
            )
    units = _units_by_role(measurement, channels, choice.units)
    unknown = next((name for name in units if name not in ("", "time", *ROLES)), None)
    if unknown is not None:
        raise ConfigurationError(
            f"--unit {unknown}={units[unknown]}: no channel {unknown!r}; choose a column of the test, or time, "
            f"{', '.join(ROLES)}"
        )
    return dataclasses.replace(choice, channels=channels, units=units)


def _velocity(x: Vector, measured: Vector | None, step: float, notices: list[str]) -> Vector:
    """Return the measured velocity, or the derivative of the displacement [m/s], with a notice."""
    derivative = scipy.signal.savgol_filter(x, WINDOW, CUBIC, deriv=1, delta=step)
    if measured is not None:
        size = float(np.sqrt(np.mean(derivative**2)))
        difference = float(np.sqrt(np.mean((measured - derivative)[WINDOW:-WINDOW] ** 2)))
        if difference <= CONSISTENT * size:
            return measured
        delays = np.arange(-20, 21) / 10.0
        samples = np.arange(x.size)
        errors = [np.std((measured - np.interp(samples - d, samples, derivative))[WINDOW:-WINDOW]) for d in delays]
        best = int(np.argmin(errors))
        late = (
            f"; the measured velocity is {1e3 * step * delays[best]:.3g} ms late"
            if errors[best] < 0.5 * errors[20]
            else ""
        )
        notices.append(f"the measured velocity differs by {number(100.0 * difference / size, 2)} % from the derivative "
                       f"of the displacement, which is used{late}")  # fmt: skip
    weights = scipy.signal.savgol_coeffs(WINDOW, CUBIC, deriv=1, use="dot")
    omega = np.linspace(0.01, np.pi, 2000)
    gain = np.abs(np.exp(1j * np.outer(omega, np.arange(WINDOW) - WINDOW // 2)) @ weights) / omega
    limit = omega[np.argmax(np.abs(gain - 1.0) > GAIN_ERROR)] / (2.0 * np.pi * step)
    notices.append(f"velocity from the displacement, Savitzky-Golay filter of {WINDOW} samples: no delay, within "
                   f"{100.0 * GAIN_ERROR:.0f} % up to {limit:.3g} Hz")  # fmt: skip
    return np.asarray(derivative)
