"""Records of a damper on a test machine: time, displacement, force and velocity, with the conditions of the test."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice, choose, pick
from vehicle.studies.dampers.damper_force import Motion

Vector = npt.NDArray[np.float64]

ROLES = ("displacement", "force", "velocity")
"""Roles of the channels, named as the quantities of their units."""

WINDOW, CUBIC = 5, 3
"""Samples and degree of the polynomial of the Savitzky-Golay filter that differentiates a displacement."""

GAIN_ERROR = 0.01
"""Error of the gain of this filter that is printed with its frequency."""

CONSISTENT = 0.02
"""Maximum RMS difference of a measured velocity from the derivative of the displacement, over its RMS: twice the
calibration error of a good sensor. Above it the derivative is used."""

FULL = 0.95
"""Minimum swing of a settled cycle, over the median swing: smaller swings at both ends are run-up and run-down."""

EQUAL = 0.05
"""Maximum relative standard deviation of the settled swings of a sine test."""

STEPS = 200
"""Minimum number of steps of a cycle in the solution of a series stiffness: with 83, the force of a friction of 60 N
behind 2e7 N/m at 12 Hz is 2 % off, with 167 0.5 %."""

HEADLESS = {3: ("displacement", "force"), 4: ("displacement", "velocity", "force")}
"""Roles of the columns behind the time in a file without a header, by the number of its columns."""

HEADLESS_UNITS = {"time": "s", "displacement": "mm", "velocity": "mm/s", "force": "N"}
"""Units of these columns, as test machines write them."""

LONGEST_STROKE = 1.0
"""Largest displacement of a damper [m]: a column with more in a file without units is in millimetres."""

LEAST_SAMPLES = 50
"""Minimum number of samples of a test."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DamperTest:
    """Record of a test, positive in extension.

    Attributes:
        name: name of the file without its ending.
        time: times [s]; (n,).
        displacement, velocity, force: measured motion [m], [m/s] and force [N]; (n,).
        settled: True for the samples that are fitted: all but run-up and run-down of a sine test; (n,).
        sine: True for a sine test, with settled cycles of equal size.
        conditions: name of a condition to its value.
        notices: messages on what was done to the record.
    """

    name: str
    time: Vector
    displacement: Vector
    velocity: Vector
    force: Vector
    settled: npt.NDArray[np.bool_]
    sine: bool
    conditions: Mapping[str, float]
    notices: tuple[str, ...]

    @property
    def motion(self) -> Motion:
        """Motion for `force_and_slopes`."""
        of_cycle = self.time.size * self.cycle / (self.time[-1] - self.time[0])
        parts = max(1, int(np.ceil(STEPS / of_cycle)))
        return Motion(self.time, self.displacement, self.velocity, float(self.force[0]), parts)

    @property
    def intervals(self) -> Vector:
        """Time step around each sample [s], the weight of the error of that sample; (n,)."""
        return np.asarray(np.gradient(self.time))

    @property
    def scale(self) -> float:
        """Standard deviation of the force [N], to which errors are related."""
        return float(np.std(self.force))

    @property
    def cycle(self) -> float:
        """Duration of a cycle [s]: twice the median swing between reversals."""
        return 2.0 * float(np.median(np.diff(self.time[_reversals(self.displacement, self.velocity)])))

    def part(self, chosen: slice | npt.NDArray[Any]) -> DamperTest:
        """Return the test with some of its samples."""
        names = ("time", "displacement", "velocity", "force", "settled")
        return dataclasses.replace(self, **{name: getattr(self, name)[chosen] for name in names})

    @property
    def caption(self) -> str:
        """Description of the test in a line."""
        stroke, speed = 1e3 * np.ptp(self.displacement), 1e3 * np.max(np.abs(self.velocity))
        waveform = "no sine"
        if self.sine:
            waveform = f"sine, {number(1.0 / self.cycle, 2)} Hz"
        return f"{waveform}, stroke {stroke:.3g} mm, up to {speed:.3g} mm/s, {self.time[-1] - self.time[0]:.3g} s"


def read_test(path: Path, choice: Choice | None = None, *, compression: bool = False,
              conditions: Mapping[str, str] | None = None, pattern: str = "") -> DamperTest:  # fmt: skip
    """Read the record of a test.

    Args:
        path: measurement file of any format.
        choice: channels of the roles "displacement", "force", "velocity" and "time", units and excerpt; a role without
            a channel is the channel with its name, or the only channel of its quantity.
        compression: displacement, velocity and force of the file are positive in compression.
        conditions: name of a condition to a number, or to "channel:NAME", whose mean value is taken.
        pattern: pattern of the file name with conditions in braces, as "*Hz{current}A".

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
            raise DataError(f"{path}: the channel of the {role} is a {quantity}; set --channel {role}=NAME to another")
    time, sign = chosen.time, -1.0 if compression else 1.0
    if time.size < LEAST_SAMPLES:
        raise DataError(f"{path}: {time.size} samples, must be at least {LEAST_SAMPLES}; record a longer test")
    x, force = sign * chosen.values["displacement"], sign * chosen.values["force"]
    measured = sign * chosen.values["velocity"] if "velocity" in chosen.values else None
    velocity = _velocity(x, measured, float(np.mean(np.diff(time))), notices)
    if np.sum(force * velocity) < 0.0:
        force = -force
        notices.append("the force is opposite to the velocity, as that of a damper on its machine: sign inverted")
    settled, sine = settled_part(x, velocity)
    if not settled.all():
        notices.append(f"fitted from {time[settled][0]:.3g} to {time[settled][-1]:.3g} s, without run-up and run-down")
    return DamperTest(
        name=path.stem, time=time, displacement=x, velocity=velocity, force=force, settled=settled, sine=sine,
        conditions=_conditions(path, measurement, conditions or {}, pattern), notices=tuple(notices),
    )  # fmt: skip


def _headless(measurement: Measurement, choice: Choice, notices: list[str]) -> Choice:
    """Return the choice with the columns of a file without a header, and with the units of columns by role.

    Raises:
        DataError: the file has no units, and a displacement that may be in metres.
    """
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
                    f"{measurement.path}: no header, and a displacement of up to {number(largest)}, in m or in mm; set "
                    "--unit displacement=m or --unit displacement=mm"
                )
        units = assumed | units
        columns_text = ", ".join(f"{role} [{units[role]}]" for role in channels)
        notices.append(f"no header: columns taken as {columns_text}; --channel and --unit change it")
    return dataclasses.replace(choice, channels=channels, units=units)


def _units_by_role(measurement: Measurement, channels: Mapping[str, str], units: Mapping[str, str]) -> dict[str, str]:
    """Return the units by the roles of the channels, those of the number or the name of a column among them."""
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
                f"{measurement.path}: {len(matches) or 'no'} channels may be the {role}; set --channel {role}=NAME, "
                f"and --unit {role}=UNIT where the file has none, to one of: {listed}"
            )
    units = _units_by_role(measurement, channels, choice.units)
    unknown = next((name for name in units if name not in ("", "time", *ROLES)), None)
    if unknown is not None:
        raise ConfigurationError(
            f"--unit {unknown}={units[unknown]}: {unknown!r} is neither a column of the test nor a role; the roles are "
            f"time, {', '.join(ROLES)}"
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
        late = f"; it is {1e3 * step * delays[best]:.3g} ms late" if errors[best] < 0.5 * errors[20] else ""
        notices.append(f"the measured velocity differs by {number(100.0 * difference / size, 2)} % from the derivative "
                       f"of the displacement, which is used{late}")  # fmt: skip
    weights = scipy.signal.savgol_coeffs(WINDOW, CUBIC, deriv=1, use="dot")
    omega = np.linspace(0.01, np.pi, 2000)
    gain = np.abs(np.exp(1j * np.outer(omega, np.arange(WINDOW) - WINDOW // 2)) @ weights) / omega
    limit = omega[np.argmax(np.abs(gain - 1.0) > GAIN_ERROR)] / (2.0 * np.pi * step)
    notices.append(f"velocity from the displacement, Savitzky-Golay filter of {WINDOW} samples: no delay, within "
                   f"{100.0 * GAIN_ERROR:.0f} % up to {limit:.3g} Hz")  # fmt: skip
    return np.asarray(derivative)


def _reversals(x: Vector, velocity: Vector) -> npt.NDArray[np.intp]:
    """Return the samples at reversals with swings of at least a tenth of the stroke, and both ends."""
    smallest_swing = 0.1 * np.ptp(x)
    turns = [0]
    for at in np.flatnonzero(np.diff(np.sign(velocity)) != 0.0):
        if abs(x[at] - x[turns[-1]]) >= smallest_swing:
            turns.append(int(at))
    return np.array([*turns, x.size - 1])


def settled_part(x: Vector, velocity: Vector) -> tuple[npt.NDArray[np.bool_], bool]:
    """Return True for the samples without run-up and run-down, (n,), and True if the test is a sine."""
    turns = _reversals(x, velocity)
    swings = np.abs(np.diff(x[turns]))
    full = np.flatnonzero(swings >= FULL * np.median(swings))
    inner = swings[full[0] : full[-1] + 1]
    sine = inner.size >= 4 and float(np.std(inner)) <= EQUAL * float(np.mean(inner))
    settled = np.zeros(x.size, dtype=bool)
    first, last = (turns[full[0]], turns[full[-1] + 1]) if sine else (0, x.size - 1)
    settled[first : last + 1] = True
    return settled, bool(sine)


def _conditions(path: Path, measurement: Measurement, typed: Mapping[str, str], pattern: str) -> dict[str, float]:
    """Return the conditions of a test: typed, the mean of a channel, or from the name of the file."""
    values: dict[str, float] = {}
    for name, text in typed.items():
        if text.startswith("channel:"):
            chosen = choose(measurement, Choice(channels={name: text.removeprefix("channel:")}))
            values[name] = float(f"{np.mean(chosen.values[name]):.3g}")
        else:
            values[name] = _number(text, f"--condition {name}={text}")
    if pattern:
        names = re.findall(r"\{(\w+)\}", pattern)
        parts = re.split(r"(\{\w+\}|\*)", pattern)
        form = "".join(
            ".*?" if part == "*" else r"(-?\d+(?:[.x,]\d+)?)" if part.startswith("{") else re.escape(part)
            for part in parts
        )
        match = re.fullmatch(form, path.stem)
        if not names or match is None:
            raise ConfigurationError(
                f"--pattern {pattern}: {'has no {condition}' if not names else f'does not match {path.stem}'}; set the "
                "name of the file with a condition in braces and * for the rest, as '*Hz{current}A'"
            )
        values |= {
            n: _number(re.sub("[x,]", ".", text), pattern) for n, text in zip(names, match.groups(), strict=True)
        }
    return values


def _number(text: str, where: str) -> float:
    """Return a number; raise ConfigurationError with the option."""
    try:
        return float(text)
    except ValueError:
        raise ConfigurationError(f"{where}: must be a number, or channel:NAME") from None


def by_conditions(tests: Sequence[DamperTest]) -> dict[tuple[tuple[str, float], ...], list[DamperTest]]:
    """Return the tests in groups with the same conditions, sorted by them."""
    groups: dict[tuple[tuple[str, float], ...], list[DamperTest]] = {}
    for test in tests:
        groups.setdefault(tuple(test.conditions.items()), []).append(test)
    return dict(sorted(groups.items(), key=lambda entry: [value for _, value in entry[0]]))
