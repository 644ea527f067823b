"""What is wanted of a car: parameters with bounds, numbers to minimise or maximise, numbers with a limit."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range

Vector = npt.NDArray[np.float64]

MEAN, WORST = "mean", "worst"
"""Behind the @: over all inputs."""

FINEST = 1e-4
"""Values are tried in decimal steps of at most this share of their range: what is found can be typed, and is then the
same car."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wish:
    """A number of the ride on an input, or over all of them, that should be small or large.

    Attributes:
        number: as of `ride.KINDS`.
        place: name of an input, `MEAN` or `WORST`; empty for the only one.
        sense: 1 for small, -1 for large.
        limit: what the number must not pass; NaN where it is to be as small or large as can be.
        unit: of the number.
    """

    number: str
    place: str = ""
    sense: float = 1.0
    limit: float = math.nan
    unit: str = ""

    @property
    def label(self) -> str:
        """The number and its place: "comfort@road_A_120"."""
        return f"{self.number}@{self.place}" if self.place else self.number

    @property
    def is_limit(self) -> bool:
        """Whether it is a limit, and not an objective."""
        return not math.isnan(self.limit)

    @property
    def words(self) -> str:
        """The wish as its option has it."""
        return f"{self.label}{'<=' if self.sense > 0 else '>='}{self.limit:g}" if self.is_limit else self.label

    def of(self, values: Vector, inputs: Sequence[str]) -> Vector:
        """The number over the inputs.

        Args:
            values: of the number; (..., inputs).
            inputs: their names.

        Returns:
            (...).
        """
        if self.place in inputs:
            return np.asarray(values[..., inputs.index(self.place)])
        if self.place == MEAN:
            return np.asarray(np.mean(values, axis=-1))
        return np.asarray(self.sense * np.max(self.sense * values, axis=-1))

    def excess(self, value: Vector) -> Vector:
        """How far a number is beyond its limit, over the limit where it is not 0; at most 0 where it is kept [-]."""
        return self.sense * (value - self.limit) / (abs(self.limit) or 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Tolerance:
    """How far a parameter of a made car may be from its value, evenly likely anywhere in between.

    Attributes:
        path: of the parameter.
        width: half of the band; a share of the value, or in its unit.
        relative: which of them.
    """

    path: str
    width: float
    relative: bool

    def around(self, value: float, place: float) -> float:
        """Value at a place from -1 to 1 of the band."""
        return value * (1.0 + place * self.width) if self.relative else value + place * self.width


@dataclass(frozen=True, kw_only=True, slots=True)
class Problem:
    """A search.

    Attributes:
        ranges: the parameters.
        places: whole paths that each of them sets; several for "*.damper.viscous".
        units: theirs.
        base: values of the car as it is; NaN where the places of one have different values.
        wishes: objectives first, then limits.
        inputs: names.
    """

    ranges: tuple[Range, ...]
    places: tuple[tuple[str, ...], ...]
    units: tuple[str, ...]
    base: tuple[float, ...]
    wishes: tuple[Wish, ...]
    inputs: tuple[str, ...]

    @property
    def goals(self) -> tuple[Wish, ...]:
        """The objectives."""
        return tuple(wish for wish in self.wishes if not wish.is_limit)

    @property
    def limits(self) -> tuple[Wish, ...]:
        """The limits."""
        return self.wishes[len(self.goals) :]

    def point(self, shares: Vector) -> Vector:
        """Values of the parameters, rounded, at shares of their ranges; (n, p) of (n, p)."""
        low, high = np.array([(one.low, one.high) for one in self.ranges]).T
        exact = low + shares * (high - low)
        places = [math.ceil(-math.log10(FINEST * (one.high - one.low))) for one in self.ranges]
        rounded = [[round(value, place) for value, place in zip(row, places, strict=True)] for row in exact.tolist()]
        return np.clip(np.array(rounded).reshape(exact.shape), low, high)

    def share(self, values: Vector) -> Vector:
        """Places of values in their ranges, 0 to 1 inside; (..., p)."""
        low, high = np.array([(one.low, one.high) for one in self.ranges]).T
        return np.asarray((values - low) / (high - low))

    def changes(self, point: Sequence[float]) -> dict[str, float]:
        """Whole path to value of what a point changes; a NaN leaves its parameter as it is."""
        pairs = zip(self.places, point, strict=True)
        return {place: float(value) for places, value in pairs for place in places if not math.isnan(value)}

    def costs(self, values: Vector) -> Vector:
        """Objectives so that less is better; (n, goals) of (n, wishes)."""
        return np.asarray(values[:, : len(self.goals)] * np.array([goal.sense for goal in self.goals]))

    def excesses(self, values: Vector) -> Vector:
        """How far each limit is passed, as of `Wish.excess`; (n, limits) of (n, wishes)."""
        goals = len(self.goals)
        found = [limit.excess(values[:, goals + index]) for index, limit in enumerate(self.limits)]
        return np.array(found).reshape(len(self.limits), len(values)).T


def parsed_wishes(
    minimise: Sequence[str], maximise: Sequence[str], limits: Sequence[str], inputs: Sequence[str]
) -> tuple[Wish, ...]:
    """Objectives and limits of options.

    Args:
        minimise, maximise: NUMBER or NUMBER@INPUT.
        limits: the same with <=VALUE or >=VALUE behind.
        inputs: names.

    Raises:
        ConfigurationError: a text is none of these, an input has no such name, or something is there twice.
    """
    found = [_wish("--minimise", text, 1.0, math.nan, inputs) for text in minimise]
    found += [_wish("--maximise", text, -1.0, math.nan, inputs) for text in maximise]
    if not found:
        raise ConfigurationError("nothing to optimise; give --minimise comfort, or another number, once or more")
    for text in limits:
        parts = re.fullmatch(r"(.+?)\s*(<=|>=)\s*(.+)", text)
        bound = _number(parts[3]) if parts else math.nan
        if parts is None or not math.isfinite(bound):
            raise ConfigurationError(f"--limit {text}: needed is NUMBER<=VALUE or NUMBER>=VALUE, as travel<=0.06")
        found.append(_wish("--limit", parts[1], 1.0 if parts[2] == "<=" else -1.0, bound, inputs))
    seen = [(one.label, one.sense if one.is_limit else 0.0) for one in found]
    twice = next((one for one, key in zip(found, seen, strict=True) if seen.count(key) > 1), None)
    if twice is not None:
        raise ConfigurationError(f"{twice.words}: asked for twice; give it once")
    return tuple(found)


def _wish(option: str, text: str, sense: float, limit: float, inputs: Sequence[str]) -> Wish:
    number, at, place = (part.strip() for part in text.partition("@"))
    places = [*inputs, MEAN, WORST]
    if at and place not in places:
        raise ConfigurationError(f"{option} {text}: no input {place!r}; behind the @ stands {', '.join(places)}")
    if not at and len(inputs) > 1:
        if math.isnan(limit):
            ways = ", ".join(f"{number}@{one}" for one in places)
            raise ConfigurationError(f"{option} {text}: there are {len(inputs)} inputs; say which: {ways}")
        place = WORST
    return Wish(number=number, place=place, sense=sense, limit=limit)


def parsed_range(text: str) -> Range:
    """A parameter between bounds, of an option.

    Raises:
        ConfigurationError: the text is not PATH=LOW:HIGH with two ascending numbers.
    """
    path, _, bounds = (part.strip() for part in text.partition("="))
    low, _, high = bounds.partition(":")
    if not path or not math.isfinite(_number(low)) or not math.isfinite(_number(high)):
        raise ConfigurationError(f"--vary {text}: needed is PATH=LOW:HIGH, as in front.damper.viscous=800:4000")
    if not _number(low) < _number(high):
        raise ConfigurationError(f"--vary {text}: the lower bound must be below the upper one")
    return Range(path=path, low=_number(low), high=_number(high))


def parsed_tolerance(text: str) -> Tolerance:
    """A tolerance of an option.

    Raises:
        ConfigurationError: the text is not PATH=NUMBER or PATH=NUMBER% with a number above 0.
    """
    path, _, size = (part.strip() for part in text.partition("="))
    width = _number(size.removesuffix("%"))
    if not path or not (math.isfinite(width) and width > 0.0):
        raise ConfigurationError(
            f"--tolerance {text}: needed is PATH=NUMBER in the unit of the parameter, or PATH=NUMBER%, above 0: half "
            "of the band, as front.damper.coulomb_friction=20%"
        )
    relative = size.endswith("%")
    return Tolerance(path=path, width=width / 100.0 if relative else width, relative=relative)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
