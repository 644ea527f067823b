"""A parameter between two values: varied evenly in a sample, or fitted from a start."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle.errors import ConfigurationError


@dataclass(frozen=True, kw_only=True, slots=True)
class Range:
    """A parameter with its limits.

    A sample fills a range evenly. A fit needs a start and moves on a logarithmic scale: u = ln(value / start).

    Args:
        path: of the parameter, as of `vehicle.model.parameters.paths`.
        low: smallest value; above 0 with a start.
        high: largest value.
        start: where a fit begins, between both; NaN for a sample.
        reason: why these limits.

    Raises:
        ConfigurationError: limits that are not finite or out of order, or a start outside of them.
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
        """Half the distance of the limits on the logarithmic scale [-]."""
        return 0.5 * math.log(self.high / self.low)

    def value(self, logarithm: float) -> float:
        """Value at u = ln(value / start)."""
        return self.start * math.exp(logarithm)


def checked_ranges(ranges: Sequence[Range]) -> tuple[Range, ...]:
    """The parameters of a fit.

    Raises:
        ConfigurationError: there is none, one has no start, or a path is there twice.
    """
    paths = [one.path for one in ranges]
    if not paths:
        raise ConfigurationError("parameters: none to fit; give at least one with its bounds")
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"parameter {twice}: given {paths.count(twice)} times; give each once")
    without = next((one.path for one in ranges if math.isnan(one.start)), None)
    if without is not None:
        raise ConfigurationError(f"parameter {without}: has no start; give where its fit begins")
    return tuple(ranges)
