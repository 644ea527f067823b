"""Heights under the wheels of a car in the page, and the same road at another speed.

A track is a row of heights. A plate reads one track, later than the foremost wheel by the distance between both
wheels. With the ratio r of the speed to that of the run, and the distance b in samples of the run, the height of the
plate at sample k is

    z_k = s(r k - b),  0 before the beginning of the track,

with the cubic spline s through the heights (not-a-knot). Plates that follow no common road have a track each.
"""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.handover.page.packed_numbers import integers, track
from vehicle.runs.car import Car
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.spline import CubicSpline
from vehicle.signals.excitation.signal import Signal

LONGEST = 30.0
"""Maximum length of the record in the page [s]."""

SAME_ROAD = 1e-3
"""Maximum difference of the height of a wheel from that of the wheel before it, d / V earlier, over the peak. On roads
of a class it is 5e-5, from the interpolation between samples."""

SPEEDS = (0.75, 1.0, 1.25)
"""Speeds of the slider over the speed of the run."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RunRoad:
    """Road of a run at constant speed."""

    road_class: str | None  # class of ISO 8608; None for another road
    speed: float  # speed V [km/h]
    behind: Mapping[str, float]  # distance between each wheel and the foremost wheel [m]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PageInput:
    """Input of a car in the page."""

    signal: Signal  # heights of the plates from their first samples, not rounded
    tracks: tuple[Vector, ...]  # heights of each track at the samples of the run [m]
    # wheels, index of their track, distance b behind its begin [samples of the run]
    wheels: tuple[tuple[str, int, float], ...]
    road: RunRoad | None  # road of the run; None for plates without a common road

    @property
    def interval(self) -> float:
        """Return the time between two samples [s]."""
        return self.signal.timestep

    def speeds(self) -> dict[float, float]:
        """Return the speeds of the slider [km/h], to three digits, with their ratios to that of the run."""
        if self.road is None:
            return {}
        speed = self.road.speed
        chosen = [speed if ratio == 1.0 else float(f"{ratio * speed:.3g}") for ratio in SPEEDS]
        return {value: value / speed for value in chosen}

    def at_ratio(self, ratio: float = 1.0) -> Signal:
        """Return the plate signals as the page has them: heights rounded, and at a ratio of the speed.

        Args:
            ratio: speed over the speed of the run; the record ends with the track, and after `LONGEST`.
        """
        samples = self.signal.time.size
        count = min(int((samples - 1) / ratio + 1e-9) + 1, samples)
        position, displacement = ratio * np.arange(count), dict[str, Vector]()
        for wheel, index, behind in self.wheels:
            samples_of_track, step = integers(self.tracks[index])
            z = step * samples_of_track
            if ratio != 1.0 or behind != 0.0:
                spline = CubicSpline(np.arange(samples, dtype=np.float64), np.asarray(z, dtype=np.float64))
                z = np.where(position > behind, spline(np.maximum(position - behind, 0.0)), 0.0)
            displacement[wheel] = np.asarray(z, dtype=np.float64)
        return dataclasses.replace(self.signal, time=self.signal.time[:count], displacement=displacement, profile={})

    def data(self, plates: tuple[str, ...]) -> dict[str, Any]:
        """Return tracks and wheels for the page.

        Args:
            plates: wheels in the order of the plates of the car.
        """
        wheels = [[plates.index(wheel), index, behind] for wheel, index, behind in self.wheels]
        return {"tracks": [track(profile) for profile in self.tracks], "wheels": wheels}


def page_input(car: Car, signal: Signal, road: RunRoad | None = None) -> PageInput:
    """Return the input of a car in the page: at most `LONGEST` seconds, from the height of the first sample.

    Args:
        road: road of the run; None for another input.
    """
    count = min(signal.time.size, round(LONGEST / signal.timestep) + 1)
    moving = {wheel: z[:count] - z[0] for wheel, z in signal.displacement.items() if np.any(z[:count] != z[0])}
    short = dataclasses.replace(signal, time=signal.time[:count], displacement=moving, profile={})
    if road is not None and (common := _common_road(car, short, road)) is not None:
        return common
    wheels = tuple((wheel, index, 0.0) for index, wheel in enumerate(moving))
    return PageInput(signal=short, tracks=tuple(moving.values()), wheels=wheels, road=None)


def _common_road(car: Car, signal: Signal, road: RunRoad) -> PageInput | None:
    """Return the input with a track for each side; None if the heights are not those of one road."""
    sides = {wheel.name: wheel.side > 0.0 for wheel in car.vehicle.composition.wheels}
    first = {side: wheel for wheel, side in sides.items() if road.behind.get(wheel) == 0.0}
    if set(sides) != set(signal.displacement) or set(first) != set(sides.values()):
        return None
    order, samples = list(first), road.speed / 3.6 * signal.timestep
    tracks = tuple(signal.displacement[first[side]] for side in order)
    wheels = tuple((wheel, order.index(side), road.behind[wheel] / samples) for wheel, side in sides.items())
    result = PageInput(signal=signal, tracks=tracks, wheels=wheels, road=road)
    for wheel, z in result.at_ratio().displacement.items():
        if np.max(np.abs(z - signal.displacement[wheel])) > SAME_ROAD * np.max(np.abs(z)):
            return None
    return result
