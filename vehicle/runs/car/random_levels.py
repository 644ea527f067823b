"""FRFs of a car at levels of a random input: best linear approximation, and the distortion around it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.steady.level_states import PeriodicCar
from vehicle.engines.steady.random_states import RandomStates, random_states
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.channel_words import channels_named
from vehicle.names import channel_units
from vehicle.runs.car.level_inputs import LevelInput, Shares, plate_input
from vehicle.runs.car.levels import LOWEST_ROLLING, ascending, require_nonlinear

BAND = (0.5, 40.0)
"""Band of the input [Hz]; for rolling tyres from `LOWEST_ROLLING` on."""

PERIOD, SAMPLES = 8.0, 4096
"""Period [s] and samples of a realisation: the RMS of a car with four dampers is then within 0.1 % of a run in
time."""

LINEAR_FROM = 3e-3
"""Lowest level with statistical linearisation [m]: around the level at which dampers begin to slip the velocity of a
damper is far from Gaussian, and the RMS is up to 26 % too high."""

FEWEST, MOST = 4, 1000
"""Number of realisations: with three the scatter itself scatters by a half."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RandomLevelMap(RandomStates):
    """FRFs of a car on random plates; the arrays of `RandomStates`, and what they belong to.

    Attributes:
        car: the car.
        driven: the input.
        level: RMS of the plates with the share 1 [m]; (l,).
        channels: names of the channels.
        dampers: names of the dampers.
    """

    car: Any
    driven: LevelInput
    level: Vector
    channels: tuple[str, ...]
    dampers: tuple[str, ...]

    def __repr__(self) -> str:
        """One line."""
        lines, realisations = len(self.frequency), self.ended.shape[1]
        return f"RandomLevelMap({self.car.vehicle.name}, {lines} lines, {len(self.level)} levels, {realisations} each)"

    @property
    def units(self) -> dict[str, str]:
        """Return the unit of each channel."""
        return channel_units(self.channels)

    @property
    def mean_rms(self) -> tuple[Vector, Vector]:
        """Return RMS and standard error of each channel over all realisations; (c, l) each."""
        power = self.rms**2
        mean = np.sqrt(power.mean(axis=-1))
        return mean, power.std(axis=-1, ddof=1) / (2.0 * mean * np.sqrt(self.ended.shape[1]))

    @property
    def error(self) -> Vector:
        """Return the standard error of each FRF value; (c, m, l)."""
        return np.asarray(self.scatter / np.sqrt(self.ended.shape[1]))

    @property
    def distortion(self) -> Vector:
        """Return the scatter over the FRF; (c, m, l)."""
        return np.asarray(self.scatter / np.abs(self.frf))

    @property
    def notices(self) -> list[str]:
        """Return messages about the limits of the results."""
        left = int(np.sum(~self.ended))
        if not left:
            return []
        return [f"{left} of {self.ended.size} realisations did not converge; their levels have no result"]


def flat_velocity(frequency: Vector, low: float, high: float) -> Vector:
    """Return the amplitudes of lines of a displacement with the RMS 1 and a flat velocity spectrum in a band; (k,).

    Each line has the power of 1/f^2 in its cell, half a line to both sides and inside the band. An RMS then means the
    same density as without lines.

    Args:
        frequency: equidistant lines [Hz]; (k,).
        low, high: the band [Hz].
    """
    half = 0.5 * (frequency[1] - frequency[0])
    begin, end = (np.clip(frequency + side, low, high) for side in (-half, half))
    return np.asarray(np.sqrt(2.0 * (1.0 / begin - 1.0 / end) / (1.0 / low - 1.0 / high)))


def car_random_levels(
    car: Any,
    *,
    level: npt.ArrayLike,
    plates: Shares = "heave",
    axle_delay: float | None = None,
    channels: str | Sequence[str] = "seat rail z",
    realisations: int = 40,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> RandomLevelMap:
    """Return FRFs of a car at levels of a random input; see `Car.random_levels`."""
    levels = ascending("level", level, "m")
    names = channels_named(channels, (*car.vehicle.channels, *car.vehicle.load_channels))
    driven = plate_input(plates, car.vehicle, "m", axle_delay)
    if not FEWEST <= realisations <= MOST:
        raise ConfigurationError(f"realisations {realisations}: must be {FEWEST} to {MOST}")
    car.check("reduced")
    require_nonlinear(car, driven)
    dampers = car.vehicle.composition.dampers
    periodic = PeriodicCar(
        car.poles,
        [damper.law for damper in dampers],
        tyre_load=car.static.tyre_load,
        loads=car.load_rows,
        channels=names,
        samples=SAMPLES,
        odd=False,
    )
    frequency = periodic.cycle.harmonics / PERIOD
    lowest = LOWEST_ROLLING if periodic.rolling else BAND[0]
    friction = all(damper.law.friction_law != "presliding" for damper in dampers)
    states = random_states(
        periodic,
        period=PERIOD,
        shares=driven.at(frequency),
        amplitudes=flat_velocity(frequency, lowest, BAND[1]),
        level=levels,
        realisations=realisations,
        seed=seed,
        linearised=(levels >= LINEAR_FROM) & friction & (len(periodic.ports) <= len(dampers)),
        progress=progress,
    )
    return RandomLevelMap(
        **{each.name: getattr(states, each.name) for each in fields(states)},
        car=car,
        driven=driven,
        level=levels,
        channels=names,
        dampers=tuple(damper.name for damper in dampers),
    )
