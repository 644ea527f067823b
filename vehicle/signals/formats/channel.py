"""Contents of a measurement file: channels with names, units, measurement points and axes."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.samples import Complex
from vehicle.signals.formats.clock import clock_of_rounded, clock_of_stamps, is_uniform, longest_step, typical_rate
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.units import find_ratio

Values = Vector | Complex

ROAD_PROFILE = "road profile"
"""Function of heights over the distance, and of the distance itself."""

OVER_DISTANCE, OVER_ANGLE = "function of distance", "function of angle"
"""Functions of other channels over a distance or an angle."""

NOT_OVER_TIME = frozenset((ROAD_PROFILE, OVER_DISTANCE, OVER_ANGLE))
"""Functions of channels without times, which are no time histories at any rate."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Channel:
    """Channel of a measurement file, with name, unit and values unchanged.

    Attributes:
        name: name in the file; may be empty or shared with another channel.
        values: samples or spectral lines in `unit`, (n,); NaN for missing values.
        unit: unit in the file; empty if missing or contradictory.
        axis: times [s] or frequencies [Hz], (n,); None if missing.
        kind: quantity of the axis.
        function: time history, frequency response, coherence, or another name from the file.
        place: measurement point, for example a node or a sensor; empty if missing.
        direction: signed axis, as +Z.
        reference: point and direction of the input of a frequency response.
        remark: note on this channel for the reader.
    """

    name: str
    values: Values
    unit: str = ""
    axis: Vector | None = None
    kind: Literal["time", "frequency"] = "time"
    function: str = "time history"
    place: str = ""
    direction: str = ""
    reference: str = ""
    remark: str = ""

    def __repr__(self) -> str:
        """Return name, unit, number of values and rate in a line."""
        rate = f", {self.rate:g} Hz" if self.rate else ""
        return f"Channel({self.name!r} [{self.unit}], {self.values.size} values{rate})"

    @property
    def quantity(self) -> str:
        """Physical quantity of the unit; empty if the unit is missing or unknown."""
        unit = find_ratio(self.unit)
        return unit.quantity if unit is not None else ""

    @property
    def si_unit(self) -> str:
        """SI unit of `si_values`; empty if the unit is missing or unknown."""
        unit = find_ratio(self.unit)
        return unit.si if unit is not None else ""

    @property
    def si_values(self) -> Values:
        """Values converted to SI units; unchanged if the unit is missing or unknown."""
        unit = find_ratio(self.unit)
        return self.values if unit is None or unit.factor == 1.0 else self.values * unit.factor

    @property
    def rate(self) -> float | None:
        """Sampling rate [Hz] of the longest part without a pause; None without times.

        Rate of the uniform or rounded clock if there is one, of the samples if their stamps do not show it, else the
        number of samples over their span.
        """
        if self.kind != "time" or self.axis is None or self.axis.size < 2:
            return None
        stamps = clock_of_stamps(self.axis)
        if stamps is not None:
            return stamps.rate
        steps = np.diff(self.axis)
        median = float(np.median(steps))
        if not (steps > 0.0).all():
            return 1.0 / median if median > 0.0 else None
        ends = np.concatenate([[0], np.flatnonzero(steps > longest_step(median)) + 1, [self.axis.size]])
        longest = int(np.argmax(np.diff(ends)))
        axis = self.axis[ends[longest] : ends[longest + 1]]
        if axis.size > 2 and is_uniform(axis):
            return exact_rate((axis.size - 1) / float(axis[-1] - axis[0]))
        clock = clock_of_rounded(axis) if axis.size > 2 else None
        return clock[0] if clock is not None else typical_rate(axis)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Measurement:
    """Contents of a measurement file.

    Attributes:
        path: measurement file.
        format: name of the file format.
        channels: channels in the order of the file, which numbers them from 1.
        sha256: hexadecimal digest of the bytes of the file; `read_record` adds it.
        program: program that wrote the file; empty if unknown.
        start: date and time of the first sample in the words of the file.
        notices: messages on unusual content that was accepted.
        geometry: points and lines; empty if the file has none.
        shapes: mode shapes; empty if the file has none.
    """

    path: Path
    format: str
    channels: tuple[Channel, ...]
    sha256: str = ""
    program: str = ""
    start: str = ""
    notices: tuple[str, ...] = field(default=())
    geometry: Geometry = field(default_factory=Geometry)
    shapes: tuple[ModeShape, ...] = ()

    def __repr__(self) -> str:
        """Return file, format and the first channels in a line."""
        names = ", ".join(channel.name for channel in self.channels[:3])
        more = f" and {len(self.channels) - 3} more" if len(self.channels) > 3 else ""
        return f"Measurement({self.path.name}, {self.format}, {len(self.channels)} channels: {names}{more})"

    def listed(self) -> str:
        """Return number, name and unit of up to twenty channels, for messages."""
        return ", ".join(f"{n} {channel.name!r} [{channel.unit}]" for n, channel in enumerate(self.channels[:20], 1))

    def __getitem__(self, name: str) -> Channel:
        """Return the channel with a name.

        Raises:
            ConfigurationError: no channel or several channels have this name.
        """
        matches = [channel for channel in self.channels if channel.name == name]
        if len(matches) != 1:
            names = ", ".join(dict.fromkeys(channel.name for channel in self.channels))
            raise ConfigurationError(f"{self.path}: {len(matches)} channels are named {name!r}; choose from {names}")
        return matches[0]


def exact_rate(rate: float) -> float:
    """Round a rate [Hz] to a whole number if it differs only by floating-point error."""
    whole = round(rate)
    return float(whole) if whole > 0 and abs(rate - whole) < 1e-9 * rate else rate


def uniform_axis(count: int, step: float, start: float = 0.0) -> Vector:
    """Return times or frequencies start + i * step, (count,)."""
    return start + np.arange(count, dtype=np.float64) * step


def even_step(axis: Vector) -> float | None:
    """Return the step of an axis, (n,), that is even within a hundredth of a step; None for an uneven axis."""
    step = float(axis[-1] - axis[0]) / max(axis.size - 1, 1)
    away = np.max(np.abs(axis - uniform_axis(axis.size, step, float(axis[0]))))
    return step if away <= 1e-2 * abs(step) else None


def clock_step(step: float, digits: int = 6) -> tuple[float, str]:
    """Recover the exact time step from a step rounded to significant digits: 1.52588e-05 s is 1/65536 s.

    Args:
        step: time step written in the file [s].
        digits: number of significant digits in the file.

    Returns:
        Step 1/f of the whole rate f that rounds to `step`, and a remark; without a whole f, `step` and "".
    """
    form = f".{digits - 1}e"
    rate = round(1.0 / step) if 0.0 < step < 1.0 else 0
    rounded = abs(float(f"{step:{form}}") - step) <= 1e-7 * step  # tolerance for values stored in single precision
    if rate < 1 or not rounded or f"{1.0 / rate:{form}}" != f"{step:{form}}":
        return step, ""
    if abs(step * rate - 1.0) < 1e-12:
        return step, ""
    return 1.0 / rate, f"time step {step:.9g} s is rounded; the sampling rate is assumed to be {rate} Hz"


def check_length(path: Path, claimed: float, available: float, part: str) -> None:
    """Reject a file whose header claims more data than the file contains, before memory is allocated."""
    if claimed < 0 or claimed > available:
        raise DataError(
            f"{path}: {part} states {claimed:.0f} bytes of data, but the file has only {available:.0f}; it "
            "is truncated or damaged: export it again"
        )
