"""Parameters of a car that a slider can change, with their ranges."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from vehicle.model.parameters.parameter_list import Parameter
from vehicle.names import AXES
from vehicle.runs.car import Car

FACTOR = 4.0
"""Ratio of the limits of a slider to the value."""

SHIFT = 0.05
"""A slider moves a point by up to this length [m] in each direction."""

FROM_ZERO = {"N": 500.0, "N s/m": 2000.0, "N m/rad": 1000.0, "s": 0.05}
"""Upper limit of the slider of a zero, by unit; 1 for another unit. Assumed: usual sizes of a small element."""

STEPS = 400
"""Positions of a slider."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Setting:
    """Number of a car that a slider changes."""

    path: str  # path for `--set`; of a component of a vector with its axis
    value: float  # value of the unchanged car
    low: float  # low, high: range of the slider
    high: float
    unit: str  # SI unit, "-" for none
    meaning: str  # one line

    @property
    def step(self) -> float:
        """Distance of two positions of the slider [`unit`]: a power of ten, at least `STEPS` positions in the range."""
        step = (self.high - self.low) / STEPS
        return float(10.0 ** math.floor(math.log10(step)))

    def accepts(self, value: float) -> bool:
        """Return True if a value is in the range of the slider; False for NaN."""
        slack = 1e-9 * (self.high - self.low)
        return self.low - slack <= value <= self.high + slack


def settings(car: Car) -> dict[str, Setting]:
    """Return the numbers of a car that a slider can change, by path, in the order of the vehicle file.

    A vector of three components (e.g. a point) is three settings. Tables of curves, names, counts, truth
    values and steps of the solver have none.
    """
    return {
        setting.path: setting
        for parameter in car.search()
        if not parameter.path.startswith("solver.")
        for setting in _settings(parameter, car.vehicle.quantity_of(parameter.path))
    }


def _settings(parameter: Parameter, declared: Mapping[str, Any]) -> Iterator[Setting]:
    value = parameter.value
    if isinstance(value, list | tuple):
        if len(value) == len(AXES) and all(isinstance(number, int | float) for number in value):
            for axis, number in zip(AXES, value, strict=True):
                yield from _range(parameter, f"{parameter.path}.{axis}", float(number), declared)
    elif isinstance(value, float):
        yield from _range(parameter, parameter.path, value, declared)


def _range(parameter: Parameter, path: str, value: float, declared: Mapping[str, Any]) -> Iterator[Setting]:
    """Yield the setting of a number; a number whose range has no extent has no setting."""
    is_point = isinstance(parameter.value, list | tuple) and parameter.unit == "m"
    low, high = sorted((value / FACTOR, value * FACTOR)) if not is_point else (value - SHIFT, value + SHIFT)
    low, high = (round(end, 4) if is_point else float(f"{end:.2g}") for end in (low, high))
    if value == 0.0 and not is_point:
        high = FROM_ZERO.get(parameter.unit, 1.0)
        low = 0.0 if declared.get("at_least") is not None else -high
    if declared.get("at_least") == 0.0 and not is_point:
        low = 0.0
    minimum, above, maximum = (declared.get(key) for key in ("at_least", "above", "at_most"))
    low = max(low, minimum) if minimum is not None else low
    low = max(low, above + (value - above) / STEPS) if above is not None and value > above else low
    high = min(high, maximum) if maximum is not None else high
    if math.isfinite(low) and math.isfinite(high) and high > low and low <= value <= high:
        yield Setting(path=path, value=value, low=low, high=high, unit=parameter.unit, meaning=parameter.meaning)
