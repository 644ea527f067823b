"""Range of a parameter: sampled uniformly, or fitted from a start value."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle.errors import ConfigurationError


@dataclass(frozen=True, kw_only=True, slots=True)
class Range:
    """Limits of a parameter.

    A sample is uniform in the range. A fit needs a start value and is logarithmic: u = ln(value / start).

    Args:
        path: path of the parameter, see `vehicle.model.parameters.paths`.
        low: minimum; above 0 for a fit.
        high: maximum.
        start: start value of a fit, between both; NaN for a sample.
        reason: reason of the limits.

    Raises:
        ConfigurationError: limits that are not finite or not ascending, or a start value outside the limits.
    """

    path: str
    low: float
    high: float
    start: float = math.nan
    reason: str = ""

    def __post_init__(self) -> None:
        if not math.isnan(self.start) and not 0.0 < self.low < self.start < self.high < math.inf:
            raise ConfigurationError(
                f"parameter {self.path}: found bounds {self.low:g} and {self.high:g}, start {self.start:g}; needed "
                "is 0 < lower < start < upper, all finite (the fit moves on a logarithmic scale; a parameter that may "
                "be zero needs a small positive bound)"
            )
        if not -math.inf < self.low < self.high < math.inf:
            raise ConfigurationError(f"range of {self.path}: found {self.low!r} to {self.high!r}, must be ascending")

    @property
    def half_width(self) -> float:
        """Half the logarithmic distance of the limits [-]."""
        return 0.5 * math.log(self.high / self.low)

    def value(self, logarithm: float) -> float:
        """Return the value at u = ln(value / start)."""
        return self.start * math.exp(logarithm)


def checked_ranges(ranges: Sequence[Range]) -> tuple[Range, ...]:
    """Check and return the parameters of a fit.

    Raises:
        ConfigurationError: no parameter, a parameter without a start value, or a path that occurs twice.
    """
    paths = [parameter.path for parameter in ranges]
    if not paths:
        raise ConfigurationError("parameters: none to fit; set at least one with its bounds")
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"parameter {twice}: given {paths.count(twice)} times; set each once")
    without = next((parameter.path for parameter in ranges if math.isnan(parameter.start)), None)
    if without is not None:
        raise ConfigurationError(f"parameter {without}: has no start value; set one")
    return tuple(ranges)
