"""Ride figure: one record with name, meaning, unit, what it reads and how it is reduced to a number."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car.run_twin import TwinLines
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.samples import Complex, Vector

Better = Literal["less", "more", ""]
"""Direction of a better ride; empty for a figure without one."""


class Values(NamedTuple):
    """Values of a figure on r runs."""

    value: Vector
    """Values, NaN where undefined; (r,)."""
    error: Vector | None = None
    """Standard errors in the unit of the value, (r,); None if unknown."""
    waves: Complex | None = None
    """Slow variations of an RMS for the error of a difference, see `comfort_error`; (r, `WAVES` + 1)."""
    explained: Vector | None = None
    """Share of the scatter that the linear twin explains [-]; (r,); None without twins."""

    def first(self) -> tuple[float, float | None]:
        """Return value and standard error of the first run; None for an unknown or undefined error."""
        error = math.nan if self.error is None else float(self.error[0])
        return float(self.value[0]), error if math.isfinite(error) else None


class TwinValues(NamedTuple):
    """Values of a figure of r linear twins."""

    value: Vector
    """Values; (r,)."""
    waves: Complex
    """Their slow variations; (r, `WAVES` + 1)."""
    expected: Vector
    """Their means over the phases of this road, up to what the exchange of its tracks changes; (r,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Details:
    """Channels, wheels, band and other details of a figure.

    Attributes:
        channels, over: names or words of recorded channels, as "seat rail z".
        band: lowest and highest frequency [Hz].
        weighting: frequency weighting of all channels, as "Wk", or "seat".
        wheels: wheels, as "fr"; all by default.
        axis: "x", "y" or "z"; all by default.
        order: multiple of the speed of a turning part.
        angle: "crank", a wheel, or a force with a frequency; by default that of the first force.
        motion: "heave", "pitch", "roll", "front wheel hop" or another of `motion_figures`, with "stuck" at the end for
            dampers that stick.
    """

    channels: tuple[str, ...] = ()
    over: tuple[str, ...] = ()
    band: tuple[float, ...] | None = None
    weighting: str = ""
    wheels: tuple[str, ...] = ()
    axis: str = ""
    order: float | None = None
    angle: str = ""
    motion: str = ""


def _no_lines(_: object, runs: Runs, twin: TwinLines) -> Complex:
    """Return no lines, for a reduction that reads the twins itself."""
    return np.empty((len(runs.vehicles), 0, twin.frequency.size), dtype=np.complex128)


@dataclass(frozen=True, kw_only=True, slots=True)
class Rows:
    """Time histories that a figure reads.

    Attributes:
        channels: names of the recorded channels for details and a car.
        of: histories of r runs from the start of the evaluation on, (r, rows, n).
        page: name of the histories in the page with sliders (`trial_worker.js`); empty for others.
        lines: the same of the linear twins as lines, (r, rows, m); for reductions that have lines.
    """

    channels: Callable[[Details, Vehicle], tuple[str, ...]]
    of: Callable[[Details, Runs], Vector]
    page: str = ""
    lines: Callable[[Details, Runs, TwinLines], Complex] = _no_lines


@dataclass(frozen=True, kw_only=True, slots=True)
class Reduction:
    """Reduction of histories (r, rows, n) to a number for each run.

    Attributes:
        of: values for histories, details and runs.
        page: name of the reduction in the page with sliders (`trial_worker.js`); empty for others.
        lines: value and waves of the linear twins from lines (r, rows, m); None for a number without waves.
    """

    of: Callable[[Vector, Details, Runs], Values]
    page: str = ""
    lines: Callable[[Complex, Details, Runs, TwinLines], TwinValues] | None = None


def _accept(*_: object) -> None:
    """Accept all details."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Figure:
    """Figure of a ride.

    Attributes:
        words: name on pages, as "tyre load variation".
        meaning: definition with the unit; U is that of the channels.
        unit: unit; empty for that of the channels.
        reads: histories that it reads.
        reduces: reduction to a number.
        better: direction of a better ride.
        needs: required details.
        takes: further details.
        of_car: required part of the car, "seat" or "damper"; empty without one.
        companion: figure in the next column of a table.
        alone: True for a figure of single runs in double precision, not of batches.
        certain: True for a standard error that is also known on one event.
        exact: True for a number of the car itself, which has no standard error.
        of_unit: required unit of the channels; empty for any.
        require: checks the details for a car; raises ConfigurationError.
        on_input: checks the details for a car on an input, with the time at which it leaves an obstacle [s] or None;
            raises ConfigurationError.
    """

    words: str
    meaning: str
    reads: Rows
    reduces: Reduction
    unit: str = ""
    better: Better = "less"
    needs: tuple[str, ...] = ()
    takes: tuple[str, ...] = ()
    of_car: str = ""
    companion: str = ""
    alone: bool = False
    certain: bool = False
    exact: bool = False
    of_unit: str = ""
    require: Callable[[Details, Vehicle], None] = _accept
    on_input: Callable[[Details, Vehicle, float | None], object] = _accept

    @property
    def asks_input(self) -> bool:
        """Return True for a figure that exists only on some inputs."""
        return self.on_input is not _accept

    @property
    def keys(self) -> tuple[str, ...]:
        """Return the names of all details in the order of a text."""
        return (*self.needs, *self.takes)
