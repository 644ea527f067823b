"""Optimisation problem: parameters with bounds, objectives, and limits."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number_in
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range

MEAN, WORST = "mean", "worst"
"""Texts after the @ that combine the values of all inputs."""

FINEST = 1e-4
"""Maximum decimal step of a parameter over its range [-]: a rounded value can be typed, and gives the same car."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Criterion:
    """Objective or limit: a figure of the ride on an input or over all inputs."""

    number: str  # name of the figure, see `vehicle.runs.figures.chosen_figure`
    input_name: str = ""  # name of an input, `MEAN` or `WORST`; empty for a single input
    sense: float = 1.0  # 1 to minimise or for an upper limit, -1 to maximise or for a lower limit
    limit: float = math.nan  # limit of the quantity; NaN for an objective
    unit: str = ""  # unit of the quantity

    @property
    def option(self) -> str:
        """Return the option of the criterion."""
        return "--limit" if self.is_limit else "--minimise" if self.sense > 0 else "--maximise"

    @property
    def label(self) -> str:
        """Return quantity and input, e.g. "unweighted@road_A_120"."""
        return f"{self.number}@{self.input_name}" if self.input_name else self.number

    @property
    def is_limit(self) -> bool:
        """Return True for a limit, False for an objective."""
        return not math.isnan(self.limit)

    @property
    def expression(self) -> str:
        """Return the criterion in the syntax of its option."""
        return f"{self.label}{'<=' if self.sense > 0 else '>='}{self.limit:g}" if self.is_limit else self.label

    def of(self, values: Vector, inputs: Sequence[str]) -> Vector:
        """Reduce the values on the inputs to the value of the criterion.

        Args:
            values: values of the quantity; (..., inputs).
            inputs: names of the inputs.

        Returns:
            Value on one input, mean, or worst; (...).
        """
        if self.input_name in inputs:
            return np.asarray(values[..., inputs.index(self.input_name)])
        if self.input_name == MEAN:
            return np.asarray(np.mean(values, axis=-1))
        return np.asarray(self.sense * np.max(self.sense * values, axis=-1))

    def excess(self, value: Vector) -> Vector:
        """Return the relative violation of the limit, absolute for a limit of 0; at most 0 if satisfied [-]."""
        return self.sense * (value - self.limit) / (abs(self.limit) or 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Tolerance:
    """Production tolerance of a parameter, uniformly distributed about its value."""

    path: str  # path of the parameter
    width: float  # half width of the band, as a share of the value or in the unit of the parameter
    relative: bool  # True if `width` is a share of the value

    def value_at(self, value: float, position: float) -> float:
        """Return the value at a position from -1 to 1 in the band, in the unit of the parameter."""
        return value * (1.0 + position * self.width) if self.relative else value + position * self.width


Tolerances = Mapping[str, float | str] | Sequence[Tolerance]
"""Path to half of the band: in the unit of the parameter, or as "15%"."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Problem:
    """Optimisation problem."""

    ranges: tuple[Range, ...]  # parameters with bounds
    paths: tuple[tuple[str, ...], ...]  # full paths set by each parameter; several for "*.damper.viscous"
    units: tuple[str, ...]  # units of the parameters
    # parameter values of the unmodified car; NaN for a parameter whose paths have different values
    base: tuple[float, ...]
    criteria: tuple[Criterion, ...]  # objectives first, then limits
    inputs: tuple[str, ...]  # names of the inputs

    @property
    def goals(self) -> tuple[Criterion, ...]:
        """Return the objectives."""
        return tuple(criterion for criterion in self.criteria if not criterion.is_limit)

    @property
    def limits(self) -> tuple[Criterion, ...]:
        """Return the limits."""
        return self.criteria[len(self.goals) :]

    def point(self, shares: Vector) -> Vector:
        """Return rounded parameter values (n, p) at shares (n, p) of the ranges."""
        low, high = np.array([(bounds.low, bounds.high) for bounds in self.ranges]).T
        exact = low + shares * (high - low)
        decimals = [math.ceil(-math.log10(FINEST * (bounds.high - bounds.low))) for bounds in self.ranges]
        rounded = [
            [round(value, digits) for value, digits in zip(row, decimals, strict=True)] for row in exact.tolist()
        ]
        return np.clip(np.array(rounded).reshape(exact.shape), low, high)

    def share(self, values: Vector) -> Vector:
        """Return parameter values as shares of the ranges, 0 to 1 inside; (..., p)."""
        low, high = np.array([(bounds.low, bounds.high) for bounds in self.ranges]).T
        return np.asarray((values - low) / (high - low))

    def changes(self, point: Sequence[float]) -> dict[str, float]:
        """Return full path to value for the parameters of a point; parameters with NaN are left out."""
        pairs = zip(self.paths, point, strict=True)
        return {path: float(value) for paths, value in pairs for path in paths if not math.isnan(value)}

    def costs(self, values: Vector) -> Vector:
        """Return the objectives as costs, less is better; (n, goals) of (n, criteria)."""
        return np.asarray(values[:, : len(self.goals)] * np.array([goal.sense for goal in self.goals]))

    def excesses(self, values: Vector) -> Vector:
        """Return the violation of each limit, see `Criterion.excess`; (n, limits) of (n, criteria)."""
        goals = len(self.goals)
        excesses = [limit.excess(values[:, goals + index]) for index, limit in enumerate(self.limits)]
        return np.array(excesses).reshape(len(self.limits), len(values)).T


def parsed_criteria(
    minimise: Sequence[str], maximise: Sequence[str], limits: Sequence[str], inputs: Sequence[str]
) -> tuple[Criterion, ...]:
    """Parse objectives and limits from the texts of options.

    Args:
        minimise, maximise: NUMBER or NUMBER@INPUT.
        limits: NUMBER<=VALUE, NUMBER@INPUT<=VALUE, or the same with >=.
        inputs: names of the inputs.
    """
    criteria = [_criterion("--minimise", text, 1.0, math.nan, inputs) for text in minimise]
    criteria += [_criterion("--maximise", text, -1.0, math.nan, inputs) for text in maximise]
    if not criteria:
        raise ConfigurationError("no objective; add --minimise unweighted, or another figure")
    for text in limits:
        parts = re.fullmatch(r"(.+?)\s*(<=|>=)\s*(.+)", text)
        bound = number_in(parts[3]) if parts else math.nan
        if parts is None or not math.isfinite(bound):
            raise ConfigurationError(f"--limit {text}: must be NUMBER<=VALUE or NUMBER>=VALUE, e.g. travel<=0.06")
        criteria.append(_criterion("--limit", parts[1], 1.0 if parts[2] == "<=" else -1.0, bound, inputs))
    keys = [(criterion.label, criterion.sense if criterion.is_limit else 0.0) for criterion in criteria]
    twice = next((criterion for criterion, key in zip(criteria, keys, strict=True) if keys.count(key) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"{twice.expression}: specified more than once; remove the repetition")
    return tuple(criteria)


def _criterion(option: str, text: str, sense: float, limit: float, inputs: Sequence[str]) -> Criterion:
    """Parse an objective or a limit."""
    number, at, input_name = (part.strip() for part in text.partition("@"))
    allowed = [*inputs, MEAN, WORST]
    if at and input_name not in allowed:
        raise ConfigurationError(f"{option} {text}: no input {input_name!r}; use one of {', '.join(allowed)} after @")
    if not at and len(inputs) > 1:
        if math.isnan(limit):
            choices = ", ".join(f"{number}@{name}" for name in allowed)
            raise ConfigurationError(f"{option} {text}: there are {len(inputs)} inputs; choose one of {choices}")
        input_name = WORST
    return Criterion(number=number, input_name=input_name, sense=sense, limit=limit)


def parsed_tolerance(text: str) -> Tolerance:
    """Parse a tolerance from the text of an option."""
    path, _, size = (part.strip() for part in text.partition("="))
    width = number_in(size.removesuffix("%"))
    if not path or not (math.isfinite(width) and width > 0.0):
        raise ConfigurationError(
            f"--tolerance {text}: must be PATH=NUMBER in the unit of the parameter, or PATH=NUMBER%, above 0: half the "
            "width of the band, e.g. front.damper.coulomb_friction=20%"
        )
    relative = size.endswith("%")
    return Tolerance(path=path, width=width / 100.0 if relative else width, relative=relative)
