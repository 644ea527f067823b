"""Periodic states of a car on its plates or a force: FRFs at every level, and where the dampers slip."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Mask, Vector
from vehicle.digits import beside_limit, number
from vehicle.drawing.rendering.level_plot import peaks_of
from vehicle.engines.linear.load_rows import load_rows
from vehicle.engines.reduced.pole_model import PoleModel, pole_model
from vehicle.engines.reduced.validity import LARGEST_ANGLE
from vehicle.engines.steady.car_ports import car_ports
from vehicle.engines.steady.equivalent_mode import ACCURACY, followed, strongest
from vehicle.engines.steady.level_states import LevelStates, level_states
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.channel_words import channels_named
from vehicle.names import channel_units
from vehicle.runs.car.level_inputs import LevelInput, Shares, force_input, plate_input

FREQUENCY, LEVEL = np.geomspace(1.0, 30.0, 100), np.geomspace(1e-5, 1e-2, 24)
"""Frequencies [Hz] and amplitudes of plates [m] of reports and figures, the defaults of `vehicle levels`."""

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
    """Periodic states of a car on a sinusoidal input; the arrays of `LevelStates`, and what they belong to.

    Attributes:
        car: the car.
        driven: the input.
        frequency: frequencies [Hz]; (f,).
        level: amplitudes of the plates or forces with the share 1, in the unit of the input; (l,).
        channels: names of the channels.
        dampers: names of the dampers.
    """

    car: Any
    driven: LevelInput
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
        """Return the level of first slip of each damper; NaN outside the levels; (d, f).

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

    def falling_peak(self, low: float = 0.0, high: float = np.inf) -> float:
        """Return the frequency of the peak of the first channel that falls most from the lowest to the highest level.

        Args:
            low, high: band of the peak at the lowest level [Hz].
        """
        frequency, size = self.frequency, np.nan_to_num(np.abs(self.frf[0]), nan=1e-30)
        inside = (frequency >= low) & (frequency <= high)
        if chosen := [index for index in peaks_of(size[:, 0]) if inside[index]]:
            fall = size[:, 0] / size[:, -1]
            return float(frequency[max(chosen, key=lambda index: float(fall[index]))])
        return float(frequency[int(np.argmax(np.where(inside, size[:, 0], -1.0)))])

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
        model, shares = driven_poles(self.car, self.driven), self.driven.at(np.array([near]))[0]
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
        lifting = int(np.sum(self.load < 0.0)) if {*self.car.vehicle.wheels} - self.car.matrices.one_sided else 0
        if lifting:
            texts.append(
                f"at {lifting} points a tyre would pull in place of lifting off; set one_sided = true for the tyres"
            )
        if several := int(np.sum(self.several)):
            low, high = self.frequency[self.several.any(axis=1)][[0, -1]]
            texts.append(
                f"at {several} of {self.several.size} points ({low:.3g} to {high:.3g} Hz) the car has two periodic "
                "states, one reached from lower and one from higher levels: `branches` has the response of both, the "
                "map shows one of them"
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
        return level_map(
            self.car, self.driven, frequency=np.array([frequency]), level=self.level, channels=self.channels
        )


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
    plates: Shares = "heave",
    force: Shares | None = None,
    axle_delay: float | None = None,
    frequency: npt.ArrayLike,
    level: npt.ArrayLike,
    level_unit: str | None = None,
    channels: str | Sequence[str] = "seat rail z",
    samples: int = 128,
    progress: Callable[[float], None] | None = None,
) -> LevelMap:
    """Return the periodic states of a car on a sinusoidal input; see `Car.levels`."""
    if force is None:
        driven = plate_input(plates, car.vehicle, level_unit or "m", axle_delay)
    elif plates != "heave" or axle_delay is not None:
        raise ConfigurationError("force: acts in place of the plates; leave out plates and axle_delay")
    else:
        driven = force_input(force, car.vehicle.composition.forces)
        if level_unit not in (None, driven.unit):
            raise ConfigurationError(f"level: unit {level_unit!r}, must be {driven.unit!r} for this force")
    names = channels_named(channels, (*car.vehicle.channels, *car.vehicle.load_channels))
    lines, levels = ascending("frequency", frequency, "Hz"), ascending("level", level, driven.unit)
    if len(lines) * len(levels) > MOST:
        raise ConfigurationError(f"levels: {len(lines) * len(levels)} points, must be at most {MOST}; take fewer")
    if samples % 2 or not LEAST_SAMPLES <= samples <= MOST_SAMPLES:
        raise ConfigurationError(f"samples {samples}: must be an even number from {LEAST_SAMPLES} to {MOST_SAMPLES}")
    if car.matrices.slope.size and lines[0] < LOWEST_ROLLING:
        raise ConfigurationError(
            f"frequency {lines[0]:g} Hz: must be at least {LOWEST_ROLLING:g} Hz for rolling tyres, which may amplify "
            "slower motion; raise it, or set driving.speed=0"
        )
    car.check("reduced")
    require_nonlinear(car, driven)
    return level_map(car, driven, frequency=lines, level=levels, channels=names, samples=samples, progress=progress)


def require_nonlinear(car: Any, driven: LevelInput) -> None:
    """Check that the steady engine takes the laws of a car, and that the car is not linear.

    Raises:
        ConfigurationError: see `car_ports`; the car is linear.
    """
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    if not car_ports(car.poles.without_forces() if driven.forces else car.poles, laws).ports:
        way = "Car.force_frf" if driven.forces else "Car.matrix_frf"
        raise ConfigurationError(f"levels: the car is linear, so its FRFs hold at every level; take {way}")


def driven_poles(car: Any, driven: LevelInput) -> PoleModel:
    """Return the poles of a car with its plates or with the forces of an input as inputs."""
    return pole_model(car.matrices.with_unit_forces(driven.forces)) if driven.forces else car.poles


def level_map(
    car: Any,
    driven: LevelInput,
    *,
    frequency: Vector,
    level: Vector,
    channels: tuple[str, ...],
    samples: int = 128,
    progress: Callable[[float], None] | None = None,
) -> LevelMap:
    """Return the periodic states of a car; frequencies and levels ascend, and all channels are names of channels."""
    model, dampers = driven_poles(car, driven), car.vehicle.composition.dampers
    states = level_states(
        model,
        [damper.law for damper in dampers],
        tyre_load=car.static.tyre_load,
        loads=load_rows(car.model, model.matrices) if driven.forces else car.load_rows,
        shares=driven.at(frequency),
        frequency=frequency,
        level=level,
        channels=channels,
        samples=samples,
        progress=progress,
    )
    return LevelMap(
        **{each.name: getattr(states, each.name) for each in fields(states)},
        car=car,
        driven=driven,
        frequency=frequency,
        level=level,
        channels=channels,
        dampers=tuple(damper.name for damper in dampers),
    )


def ascending(name: str, values: npt.ArrayLike, unit: str) -> Vector:
    """Return numbers above zero in ascending order; (n,)."""
    numbers = np.atleast_1d(np.asarray(values, dtype=float))
    if numbers.ndim != 1 or not numbers.size or not (np.isfinite(numbers) & (numbers > 0.0)).all():
        raise ConfigurationError(f"{name}: must be finite numbers above 0 {unit}")
    if (np.diff(numbers) <= 0.0).any():
        raise ConfigurationError(f"{name}: must ascend, each {name} once")
    return numbers
