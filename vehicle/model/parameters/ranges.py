"""Range of a parameter: sampled uniformly, or fitted from a start value; and the texts of values and ranges."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from vehicle.digits import number_in
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import meant
from vehicle.names import AXES

LENGTH_OF_ONE = 0.05
"""Shift of a coordinate [m] that counts as u = 1. A ratio of coordinates depends on the origin; with this length 10 mm
count as much as 20 % of another parameter (assumed, as the shift of a point in `sweep --each 20%`)."""


def is_coordinate(vehicle: Any, path: str) -> bool:
    """Return True for a component of a point or of an offset: a length that may have either sign.

    Args:
        vehicle: the vehicle.
        path: path of a component, for example "front.hardpoints.strut_top.z".

    Raises:
        ConfigurationError: the path does not lead to a quantity.
    """
    if path.rpartition(".")[2] not in AXES:
        return False
    declared = vehicle.quantity_of(path) or vehicle.quantity_of(meant(vehicle.table, path)[0])
    limits = declared.get("above"), declared.get("at_least")
    return declared.get("unit") == "m" and limits == (None, None)


@dataclass(frozen=True, kw_only=True, slots=True)
class Range:
    """Limits of a parameter.

    A sample is uniform in the range. A fit needs a start value and is logarithmic: u = ln(value / start); for a
    coordinate it is linear: u = (value - start) / length.

    Args:
        path: path of the parameter, see `vehicle.model.parameters.paths`.
        low: minimum; above 0 for a logarithmic fit.
        high: maximum.
        start: start value of a fit, between both; NaN for a sample.
        reason: reason of the limits.
        length: for a coordinate, the shift that counts as u = 1 [m], see `LENGTH_OF_ONE`; otherwise NaN.

    Raises:
        ConfigurationError: limits that are not finite or not ascending, or a start value outside the limits.
    """

    path: str
    low: float
    high: float
    start: float = math.nan
    reason: str = ""
    length: float = math.nan

    def __post_init__(self) -> None:
        least = 0.0 if math.isnan(self.length) else -math.inf
        if not math.isnan(self.start) and not least < self.low < self.start < self.high < math.inf:
            if least < 0.0:
                raise ConfigurationError(
                    f"parameter {self.path}: found bounds {self.low:g} and {self.high:g} and start {self.start:g}, "
                    "must be lower < start < upper"
                )
            raise ConfigurationError(
                f"parameter {self.path}: found bounds {self.low:g} and {self.high:g} and start {self.start:g}, "
                "must be 0 < lower < start < upper (the fit uses a logarithmic scale); for a parameter that may "
                "be zero use a small positive bound"
            )
        if not -math.inf < self.low < self.high < math.inf:
            raise ConfigurationError(f"range of {self.path}: found {self.low!r} to {self.high!r}, must be ascending")

    @property
    def is_linear(self) -> bool:
        """True for a coordinate, whose ratios and percentages have no meaning."""
        return not math.isnan(self.length)

    @property
    def half_width(self) -> float:
        """Half the distance of the limits in u [-]."""
        if self.is_linear:
            return 0.5 * (self.high - self.low) / self.length
        return 0.5 * math.log(self.high / self.low)

    def value(self, u: float) -> float:
        """Return the value at u [-], in the unit of the parameter."""
        return self.start + self.length * u if self.is_linear else self.start * math.exp(u)

    def coordinate(self, value: float) -> float:
        """Return u of a value [-]."""
        return (value - self.start) / self.length if self.is_linear else math.log(value / self.start)

    def slope(self, value: float) -> float:
        """Return d value / d u at a value, in the unit of the parameter."""
        return self.length if self.is_linear else value

    def percent(self, change: float, value: float) -> float:
        """Return a change over a value [%]; NaN for a coordinate."""
        return math.nan if self.is_linear else 100.0 * change / value


@dataclass(frozen=True, kw_only=True, slots=True)
class Variation:
    """Values or bounds of a parameter as the text of an option: `a,b,c`, `a:b:n` or `a:b`.

    Attributes:
        option: the option as typed, for messages.
        path: path of the parameter, see `vehicle.model.parameters.paths`.
        values: values as texts; empty for bounds.
        bounds: lower and upper bound; None for values.
    """

    option: str
    path: str
    values: tuple[str, ...] = ()
    bounds: tuple[float, float] | None = None

    def listed(self) -> tuple[str, ...]:
        """Return the values.

        Raises:
            ConfigurationError: the text contains bounds without a number of values.
        """
        if self.bounds is not None:
            raise ConfigurationError(
                f"{self.option}: contains bounds instead of values; give PATH=A,B,C, or PATH=A:B:N for N equally "
                "spaced "
                f"values, for example {self.path}={self.bounds[0]:g}:{self.bounds[1]:g}:5"
            )
        return self.values

    def range(self) -> Range:
        """Return the range between the bounds, without a start value.

        Raises:
            ConfigurationError: the text contains values.
        """
        if self.bounds is None:
            raise ConfigurationError(
                f"{self.option}: contains values instead of two bounds; give PATH=LOW:HIGH, for example "
                "damper.viscous=800:4000"
            )
        return Range(path=self.path, low=self.bounds[0], high=self.bounds[1])


def parsed_variation(option: str, text: str) -> Variation:
    """Parse the text of an option: `PATH=A,B,C` values, `PATH=A:B:N` equally spaced values, `PATH=A:B` bounds.

    Raises:
        ConfigurationError: an unknown form, descending bounds, or a number of values below 2.
    """
    typed = f"{option} {text}"
    path, separator, content = (part.strip() for part in text.partition("="))
    # Commas within brackets separate the components of a vector.
    items = tuple(item.strip() for item in re.split(r",(?![^\[]*\])", content))
    if not separator or not path or not all(items):
        raise ConfigurationError(
            f"{typed}: must be PATH=A,B,C, PATH=A:B:N or PATH=A:B, for example damper.coulomb_friction=62.5,125; "
            "a component of a vector ends with its axis: bushings.tyre.stiffness.z=2e5,2.5e5"
        )
    parts = [number_in(part) for part in content.split(":")]
    if len(items) > 1 or len(parts) == 1 or all(math.isnan(part) for part in parts):
        return Variation(option=typed, path=path, values=items)
    if len(parts) not in (2, 3) or not all(math.isfinite(part) for part in parts):
        raise ConfigurationError(f"{typed}: must be PATH=LOW:HIGH, or PATH=LOW:HIGH:N with N values; all are numbers")
    low, high = parts[:2]
    if not low < high:
        raise ConfigurationError(f"{typed}: the lower bound must be below the upper one")
    if len(parts) == 2:
        return Variation(option=typed, path=path, bounds=(low, high))
    count = int(parts[2])
    if count != parts[2] or count < 2:
        raise ConfigurationError(f"{typed}: found {parts[2]:g} values, must be a whole number of at least 2")
    # The rounding of the sum must not show in the table: 12 digits.
    spaced = (low + (high - low) * index / (count - 1) for index in range(count))
    return Variation(option=typed, path=path, values=tuple(f"{float(f'{value:.12g}')!r}" for value in spaced))


def checked_ranges(ranges: Sequence[Range]) -> tuple[Range, ...]:
    """Check and return the parameters of a fit.

    Raises:
        ConfigurationError: no parameter, a parameter without a start value, or a path that occurs twice.
    """
    paths = [parameter.path for parameter in ranges]
    if not paths:
        raise ConfigurationError(
            "the parameters to fit are missing; set at least one with its bounds, for example damper.viscous=800:4000"
        )
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"parameter {twice}: given {paths.count(twice)} times; set each once")
    without = next((parameter.path for parameter in ranges if math.isnan(parameter.start)), None)
    if without is not None:
        raise ConfigurationError(f"parameter {without}: has no start value; set its value in the car")
    return tuple(ranges)
