"""What a measurement file holds: channels with their names, units, places and axes."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.signals.records.clock import clock_of_rounded, is_uniform, longest_step
from vehicle.signals.records.geometry import Geometry, ModeShape
from vehicle.signals.records.table import Vector
from vehicle.signals.records.units import find_ratio

Values = NDArray[np.float64] | NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Channel:
    """One channel, as found.

    Attributes:
        name: as found; it may be empty, and two channels may share one.
        values: samples or spectral lines in the unit as found, (n,); NaN where the file tells none.
        unit: as found; empty where the file tells none, or contradicts itself.
        axis: times [s] or frequencies [Hz], (n,); None where the file tells none.
        kind: what the axis is.
        function: time history, frequency response, coherence, or what else the file calls it.
        place: point of the measurement, as a node or a sensor; empty where the file tells none.
        direction: signed axis, as +Z.
        reference: place and direction of the input of a frequency response.
        remark: what a reader must know of this channel.
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

    @property
    def quantity(self) -> str:
        """What its unit measures; empty where that is open."""
        unit = find_ratio(self.unit)
        return unit.quantity if unit is not None else ""

    @property
    def si_unit(self) -> str:
        """SI unit of `si_values`; empty where the unit is open."""
        unit = find_ratio(self.unit)
        return unit.si if unit is not None else ""

    @property
    def si_values(self) -> Values:
        """Values in SI; as found where the unit is open."""
        unit = find_ratio(self.unit)
        return self.values if unit is None or unit.factor == 1.0 else self.values * unit.factor

    @property
    def rate(self) -> float | None:
        """Samples a second [Hz]: of the clock, also a rounded one, between pauses; else of the median step; None "
        "without times."""
        if self.kind != "time" or self.axis is None or self.axis.size < 2:
            return None
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
        return clock[0] if clock is not None else 1.0 / median


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Measurement:
    """A file.

    Attributes:
        path: the file.
        format: its name.
        channels: in the order of the file; the number of a channel is its place in it, from 1.
        sha256: hexadecimal digest of its bytes.
        program: what wrote it; empty where the file does not tell.
        start: date and time of the first sample, as the file tells it.
        notices: what was accepted although it is unusual.
        geometry: points and lines, where the file holds them.
        shapes: mode shapes, where the file holds them.
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


def exact_rate(rate: float) -> float:
    """A rate without what binary numbers leave of a whole one [Hz]."""
    whole = round(rate)
    return float(whole) if whole > 0 and abs(rate - whole) < 1e-9 * rate else rate


def uniform_axis(count: int, step: float, start: float = 0.0) -> Vector:
    """Times or frequencies start + i step, (count,)."""
    return start + np.arange(count, dtype=np.float64) * step


def even_step(axis: Vector) -> float | None:
    """Step of an axis, (n,), whose values lie within a hundredth of a step of even ones; None of any other."""
    step = float(axis[-1] - axis[0]) / max(axis.size - 1, 1)
    away = np.max(np.abs(axis - uniform_axis(axis.size, step, float(axis[0]))))
    return step if away <= 1e-2 * abs(step) else None


def clock_step(step: float, digits: int = 6) -> tuple[float, str]:
    """The step behind one that a program rounded to significant digits: 1.52588e-05 s is 1/65536 s.

    Args:
        step: as written [s].
        digits: of the rounding.

    Returns:
        The step 1/f of the whole rate f that is written alike, and a remark; else the step itself without one.
    """
    form = f".{digits - 1}e"
    rate = round(1.0 / step) if 0.0 < step < 1.0 else 0
    rounded = abs(float(f"{step:{form}}") - step) <= 1e-7 * step  # also where single precision has written it
    if rate < 1 or not rounded or f"{1.0 / rate:{form}}" != f"{step:{form}}":
        return step, ""
    if abs(step * rate - 1.0) < 1e-12:
        return step, ""
    return 1.0 / rate, f"time step {step:.9g} s is rounded: taken as a clock of {rate} Hz"


def check_length(path: Path, claimed: float, held: float, what: str) -> None:
    """Refuse a file that claims more data than it holds, before memory is taken for them.

    Args:
        path: the file.
        claimed: bytes that its header promises.
        held: bytes that are there.
        what: the part that claims it.

    Raises:
        DataError: it claims more, or a negative number.
    """
    if claimed < 0 or claimed > held:
        raise DataError(
            f"{path}: {what} claims {claimed:.0f} bytes of data, the file holds {held:.0f}; it was cut off or damaged; "
            "export it again"
        )
