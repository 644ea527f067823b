"""Periodic states of a car on its plates over frequency and level: FRFs at every level, and where the dampers slip."""

from __future__ import annotations

import cmath
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Mask, Vector
from vehicle.digits import beside_limit, number
from vehicle.engines.reduced.validity import LARGEST_ANGLE
from vehicle.engines.steady.car_ports import car_ports
from vehicle.engines.steady.equivalent_mode import ACCURACY, followed, strongest
from vehicle.engines.steady.level_states import LevelStates, level_states
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.channel_words import channels_named
from vehicle.names import axle_and_side, channel_units

Plates = str | Mapping[str, complex]
"""Motion of the plates: a name, shares as text, or the share of each wheel as a complex number."""

MOTIONS = ("heave", "pitch", "roll", "warp")
"""Names of motions of all plates."""

LOWEST_ROLLING = 1.0
"""Minimum frequency for rolling tyres [Hz]: at lower frequencies a rolling car may amplify its motion."""

LEAST_SAMPLES, MOST_SAMPLES = 32, 8192
"""Samples of a period."""

MOST = 100_000
"""Maximum number of points."""

UNRESOLVED = 0.05
"""Share of the RMS in the upper half of the harmonics from which a channel needs more samples: the half above that then
has about 1 % of the mean square."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelMap(LevelStates):
    """Periodic states of a car whose plates move as a sine; the arrays of `LevelStates`, and what they belong to.

    Attributes:
        car: the car.
        plates: share of the level of each plate, with its phase.
        frequency: frequencies [Hz]; (f,).
        level: amplitudes of the plates with the share 1 [m]; (l,).
        channels: names of the channels.
        dampers: names of the dampers.
    """

    car: Any
    plates: dict[str, complex]
    frequency: Vector
    level: Vector
    channels: tuple[str, ...]
    dampers: tuple[str, ...]

    def __repr__(self) -> str:
        """One line."""
        name, left = self.car.vehicle.name, int(np.sum(~self.ended))
        return (
            f"LevelMap({name}, {len(self.frequency)} frequencies, {len(self.level)} levels"
            f"{f', {left} points without a result' if left else ''})"
        )

    @property
    def units(self) -> dict[str, str]:
        """Return the unit of each channel."""
        return channel_units(self.channels)

    @property
    def outside(self) -> Mask:
        """Return True where a part rotates too far for the linear geometry, or a linear tyre pulls; (f, l)."""
        return np.asarray((self.angle > LARGEST_ANGLE) | (self.load < 0.0))

    @property
    def unsticking(self) -> Vector:
        """Return the level at which each damper begins to slip [m]; NaN outside the levels; (d, f).

        The first damper of a frequency has it in closed form. While others slip already, it is where the force of the
        stuck damper, continued from the last two levels, reaches its friction limit.
        """
        result = np.full(self.first.shape, np.nan)
        for damper, line in enumerate(self.first):
            for column, closed in enumerate(line):
                others = self.first[:, column]
                if np.isfinite(closed) and not np.any(others < closed):
                    result[damper, column] = closed
                elif np.isfinite(closed):
                    result[damper, column] = crossing(self.level, self.effort[damper, column])
        return result

    def peaks(self, low: float, high: float, channel: str | None = None) -> tuple[Vector, Vector]:
        """Return frequency [Hz] and magnitude of the highest FRF value of each level in a band; (l,) each.

        Between frequencies the logarithm of the magnitude is a parabola. A peak at an end of the band is NaN.

        Args:
            low, high: the band [Hz].
            channel: name; by default the first.
        """
        inside = np.flatnonzero((self.frequency >= low) & (self.frequency <= high))
        if len(inside) < 3:
            raise ConfigurationError(f"peaks: {low:g} to {high:g} Hz has fewer than three of the frequencies; widen it")
        size = np.abs(self.frf[0 if channel is None else self.channels.index(channel)])
        result = np.full((2, len(self.level)), np.nan)
        for column, values in enumerate(size[inside].T):
            if np.isfinite(values).all() and 0 < (top := int(np.argmax(values))) < len(values) - 1:
                result[:, column] = _vertex(self.frequency[inside[top - 1 : top + 2]], values[top - 1 : top + 2])
        return result[0], result[1]

    def mode(self, near: float, channel: str | None = None) -> tuple[Vector, Vector]:
        """Return frequency [Hz] and damping ratio [-] of a mode at each level; (l,) each.

        Viscous dampers with the constants `equivalent` at this frequency and level replace the dampers. At the
        lowest level it is the mode with the largest part of the response of the channel; from there it is followed, to
        NaN where it no longer oscillates.

        Args:
            near: frequency of a peak at the lowest level [Hz].
            channel: name of an acceleration; by default the first.

        Raises:
            ConfigurationError: a damper has presliding friction, which is a spring before it is a damper.
        """
        if any(damper.law.friction_law == "presliding" for damper in self.car.vehicle.composition.dampers):
            raise ConfigurationError("mode: a damper with presliding friction is a spring too, not a viscous damper")
        model, shares = self.car.poles, np.array(list(self.plates.values()))
        row = model.outputs([channel or self.channels[0]]).poles[0]
        damping = self._damping(0, near)
        pole, result = strongest(model, damping, row, shares, near), np.full((2, len(self.level)), np.nan)
        for column in range(len(self.level)):
            last = self._damping(column, near)
            pole, damping = followed(model, pole, damping, last), last
            # Without an oscillation a pole has no mode.
            if not pole.imag > ACCURACY * abs(pole):
                break
            result[:, column] = abs(pole.imag) / (2.0 * np.pi), -pole.real / abs(pole)
        return result[0], result[1]

    def _damping(self, column: int, frequency: float) -> Vector:
        """Return the equivalent damping constants at a level, interpolated over the frequency; (d,)."""
        position = np.log(self.frequency)
        values = [np.interp(np.log(frequency), position, np.log(each[:, column])) for each in self.equivalent]
        return np.exp(values)

    @property
    def notices(self) -> list[str]:
        """Return messages about the limits of the results."""
        left, texts = int(np.sum(~self.ended)), []
        if left:
            texts.append(f"{left} of {self.ended.size} points have no result: the iteration did not end there")
        if (turned := float(np.nanmax(self.angle, initial=0.0))) > LARGEST_ANGLE:
            angle, limit = beside_limit(np.degrees(turned), np.degrees(LARGEST_ANGLE))
            points = int(np.sum(self.angle > LARGEST_ANGLE))
            texts.append(
                f"a part rotates by up to {angle} deg (at {points} points by more than {limit} deg, the limit of the "
                "linear geometry): check such points with Car.run and MuJoCo"
            )
        lifting = int(np.sum(self.load < 0.0)) if set(self.plates) - self.car.matrices.one_sided else 0
        if lifting:
            texts.append(
                f"at {lifting} points a tyre would pull in place of lifting off; set one_sided = true for the tyres"
            )
        for name, share in zip(self.channels, self.unresolved, strict=True):
            if (worst := float(np.nanmax(share, initial=0.0))) > UNRESOLVED:
                texts.append(
                    f"{name}: up to {number(100.0 * worst, 2)} % of its RMS are in the upper half of the harmonics; "
                    "double the samples and compare"
                )
        return texts

    def at(self, frequency: float) -> LevelMap:
        """Return the states at one frequency [Hz] and the same levels, computed there."""
        return car_levels(self.car, plates=self.plates, frequency=[frequency], level=self.level, channels=self.channels)


def crossing(level: Vector, effort: Vector) -> float:
    """Return the level at which an effort reaches 1, continued from the last two levels below; NaN outside the levels.

    Args:
        level: ascending levels; (l,).
        effort: force of a stuck damper over its limit; (l,).
    """
    above = np.flatnonzero(effort >= 1.0)
    if not above.size or above[0] == 0 or not np.isfinite(effort[above[0] - 1]):
        return float("nan")
    low, high = int(above[0]) - 1, int(above[0])
    slope = 1.0
    if low > 0 and np.isfinite(effort[low - 1]) and effort[low - 1] > 0.0:
        slope = float(np.log(effort[low] / effort[low - 1]) / np.log(level[low] / level[low - 1]))
    estimate = level[low] * effort[low] ** (-1.0 / slope) if slope > 0.0 else level[high]
    return float(np.clip(estimate, level[low], level[high]))


def _vertex(frequency: Vector, values: Vector) -> tuple[float, float]:
    """Return the vertex of the parabola through three points of ln y over ln x."""
    a, b, c = np.polyfit(np.log(frequency / frequency[1]), np.log(values), 2)
    vertex = -0.5 * b / a
    return float(frequency[1] * np.exp(vertex)), float(np.exp(c + 0.5 * b * vertex))


def car_levels(
    car: Any,
    *,
    plates: Plates = "heave",
    frequency: npt.ArrayLike,
    level: npt.ArrayLike,
    channels: str | Sequence[str] = "seat rail z",
    samples: int = 128,
    progress: Callable[[float], None] | None = None,
) -> LevelMap:
    """Return the periodic states of a car whose plates move as a sine; see `Car.levels`."""
    names = channels_named(channels, (*car.vehicle.channels, *car.vehicle.load_channels))
    lines, levels = _ascending("frequency", frequency, "Hz"), _ascending("level", level, "m")
    if len(lines) * len(levels) > MOST:
        raise ConfigurationError(f"levels: {len(lines) * len(levels)} points, must be at most {MOST}; take fewer")
    if samples % 2 or not LEAST_SAMPLES <= samples <= MOST_SAMPLES:
        raise ConfigurationError(f"samples {samples}: must be an even number from {LEAST_SAMPLES} to {MOST_SAMPLES}")
    shares = plate_shares(plates, car.vehicle.wheels)
    if car.matrices.slope.size and lines[0] < LOWEST_ROLLING:
        raise ConfigurationError(
            f"frequency {lines[0]:g} Hz: must be at least {LOWEST_ROLLING:g} Hz for rolling tyres, which may amplify "
            "slower motion; raise it, or set driving.speed=0"
        )
    dampers = car.vehicle.composition.dampers
    car.check("reduced")
    if not car_ports(car.poles, [damper.law for damper in dampers]).ports:
        raise ConfigurationError("levels: the car is linear, so its FRFs hold at every level; take Car.matrix_frf")
    states = level_states(
        car.poles,
        [damper.law for damper in dampers],
        tyre_load=car.static.tyre_load,
        loads=car.load_rows,
        plates=np.array(list(shares.values())),
        frequency=lines,
        level=levels,
        channels=names,
        samples=samples,
        progress=progress,
    )
    return LevelMap(
        **{each.name: getattr(states, each.name) for each in fields(states)},
        car=car,
        plates=shares,
        frequency=lines,
        level=levels,
        channels=names,
        dampers=tuple(damper.name for damper in dampers),
    )


def _ascending(name: str, values: npt.ArrayLike, unit: str) -> Vector:
    """Return numbers above zero in ascending order; (n,)."""
    numbers = np.atleast_1d(np.asarray(values, dtype=float))
    if numbers.ndim != 1 or not numbers.size or not (np.isfinite(numbers) & (numbers > 0.0)).all():
        raise ConfigurationError(f"{name}: must be finite numbers above 0 {unit}")
    if (np.diff(numbers) <= 0.0).any():
        raise ConfigurationError(f"{name}: must ascend, each {name} once")
    return numbers


def plate_shares(plates: Plates, wheels: Sequence[str]) -> dict[str, complex]:
    """Return the share of each plate in the level, in the order of the wheels.

    Args:
        plates: heave, pitch (front axle up, others down), roll (left up, right down), warp (both), a wheel, shares with
            their phases in degrees as "fl=1,fr=1@90", or a dictionary of complex numbers.
        wheels: names of the wheels.

    Raises:
        ConfigurationError: another word or wheel, no motion, or pitch or warp of a single axle.
    """
    if isinstance(plates, str):
        plates = _named_shares(plates.strip(), wheels)
    if unknown := [wheel for wheel in plates if wheel not in wheels]:
        raise ConfigurationError(f"plates: the car has no wheel {unknown[0]!r}; choose from {', '.join(wheels)}")
    shares = {wheel: complex(plates.get(wheel, 0.0)) for wheel in wheels}
    if not any(shares.values()) or not all(map(cmath.isfinite, shares.values())):
        raise ConfigurationError("plates: must have finite shares, at least one of them not 0")
    return shares


SHARE = re.compile(r"\s*(\w+)\s*=\s*([-+.\deE]+)\s*(?:@\s*([-+.\deE]+)\s*)?")
"""Share of a plate, with its phase [deg]."""


def _named_shares(text: str, wheels: Sequence[str]) -> dict[str, complex]:
    """Return the shares of a text."""
    axles = list(dict.fromkeys(axle_and_side(wheel)[0] for wheel in wheels))
    if text in MOTIONS:
        if text in ("pitch", "warp") and len(axles) < 2:
            raise ConfigurationError(f"plates {text}: the car has plates under one axle only; choose heave or roll")
        signs = {wheel: (1.0 if axle == axles[0] else -1.0, 1.0 if side == "left" else -1.0)
                 for wheel in wheels for axle, side in [axle_and_side(wheel)]}  # fmt: skip
        factors = {"heave": (0, 0), "pitch": (1, 0), "roll": (0, 1), "warp": (1, 1)}[text]
        return {wheel: complex(by_axle ** factors[0] * by_side ** factors[1])
                for wheel, (by_axle, by_side) in signs.items()}  # fmt: skip
    if text in wheels:
        return {text: 1.0 + 0.0j}
    shares = {}
    for part in text.split(","):
        try:
            wheel, size, phase = SHARE.fullmatch(part).groups()  # type: ignore[union-attr]
            shares[wheel] = cmath.rect(float(size), np.radians(float(phase or 0.0)))
        except (AttributeError, ValueError):
            raise ConfigurationError(
                f"plates {text!r}: must be {', '.join(MOTIONS)}, a wheel ({', '.join(wheels)}), or shares with phases "
                "in degrees, for example fl=1,fr=1@90"
            ) from None
    return shares
