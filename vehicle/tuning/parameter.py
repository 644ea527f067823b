"""A parameter that is fitted: its path, its bounds, where the fit begins, and how it gets into a vehicle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.parameters.number_paths import value_of
from vehicle.parameters.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True, slots=True)
class Parameter:
    """One unknown of a fit, which moves on a logarithmic scale: u = ln(value / start).

    Args:
        path: dotted path as in the vehicle file; a component of a vector has its axis behind it, as in
            "bushings.suspension_mount.stiffness.z".
        lower: smallest value allowed, above 0.
        upper: largest value allowed.
        start: where the fit begins, between both.

    Raises:
        ConfigurationError: bounds that are not finite, not positive or out of order, or a start outside of them.
    """

    path: str
    lower: float
    upper: float
    start: float

    def __post_init__(self) -> None:
        if not 0.0 < self.lower < self.start < self.upper < math.inf:
            raise ConfigurationError(
                f"parameter {self.path}: found bounds {self.lower:g} and {self.upper:g}, start {self.start:g}; needed "
                "is 0 < lower < start < upper, all finite (the fit moves on a logarithmic scale; a parameter that may "
                "be zero needs a small positive bound)"
            )

    @property
    def half_width(self) -> float:
        """Half the distance of the bounds on the logarithmic scale [-]."""
        return 0.5 * math.log(self.upper / self.lower)

    def value(self, logarithm: float) -> float:
        """Value at u = ln(value / start)."""
        return self.start * math.exp(logarithm)


def checked_parameters(parameters: Sequence[Parameter]) -> tuple[Parameter, ...]:
    """The parameters, refused if there is none or a path appears twice.

    Raises:
        ConfigurationError: none, or a path twice.
    """
    paths = [parameter.path for parameter in parameters]
    if not paths:
        raise ConfigurationError("parameters: none to fit; give at least one with its bounds")
    twice = next((path for path in paths if paths.count(path) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"parameter {twice}: given {paths.count(twice)} times; give each once")
    return tuple(parameters)


def overrides_of(vehicle: Vehicle, values: Mapping[str, float]) -> tuple[str, ...]:
    """Overrides "path=value" that put fitted values into a vehicle.

    Args:
        vehicle: the car they are for.
        values: path of `Parameter` to value.

    Returns:
        Texts for `Car.load`.

    Raises:
        ConfigurationError: a path that is no number of a vehicle.
    """
    for path in values:
        value_of(vehicle, path)
    return tuple(f"{path}={float(value)!r}" for path, value in values.items())
