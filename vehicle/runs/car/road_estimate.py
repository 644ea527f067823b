"""Vibration of a passive car on all roads of a class without a run, by statistical linearisation of its dampers.

The dampers become viscous with the constants of a Gaussian velocity
(`vehicle.engines.reduced.statistical_linearisation`), and the mean squares of the linear car are closed integrals over
the spectrum of the class (`vehicle.engines.reduced.road_expectation`). The value has no scatter. The linearisation has
an error (docs/theory/estimate.md). Cars on which this error is large or unknown are rejected
(`vehicle.runs.car.estimate_limits`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.engines.reduced.linear_twin import LinearTwin, linear_twin
from vehicle.engines.reduced.road_expectation import (
    Lines,
    band_width,
    damper_speeds,
    density,
    integral_lines,
    track_sources,
    weighting_width,
)
from vehicle.engines.reduced.statistical_linearisation import LineSegments, line_segments, linearised_damping
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import AXES
from vehicle.runs.car.estimate_limits import LOCKED, require_class, require_contact, require_laws, require_motion
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.ride_comfort import (
    SEAT_PREFIX,
    SEAT_VALUE,
    UNWEIGHTED,
    WEIGHTED,
    PointComfort,
    point_comfort,
)
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad
from vehicle.signals.excitation.recorded_road import RecordedDrive
from vehicle.signals.excitation.road_drive import RoadDrive

LAW_NUMBERS = (
    *("viscous", "degressive_viscous", "degressive_velocity", "coulomb_friction", "smoothing"),
    *("stribeck_friction", "stribeck_velocity", "stribeck_exponent"),
)
"""Parameters of a damper that change its force over velocity alone, neither preloads nor other elements."""


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class RoadEstimate:
    """Vibration of a car on all roads of a class, estimated without a run: comfort, tyre loads, RMS accelerations.

    Attributes:
        car: name of the car.
        road: class and speed, for example "road_C_80".
        lines: lines of the integrals over frequency.
        densities: channel to its density [(m/s2)^2/Hz, N^2/Hz]; (m,).
        static_load: static load of each tyre [N].
        damping: viscous constant of each damper [N s/m].
    """

    car: str
    road: str
    lines: Lines
    densities: Mapping[str, Vector]
    static_load: Mapping[str, float]
    damping: Mapping[str, float]

    def rms(
        self, channels: str | Sequence[str], *, band: tuple[float, float] | None = None, weighting: str = ""
    ) -> float:
        """Return the RMS of accelerations, the root of the sum of their mean squares [m/s2].

        Args:
            channels: name of an acceleration channel, or several.
            band: lowest and highest frequency [Hz]; all by default.
            weighting: frequency weighting, for example "Wk".
        """
        names = [channels] if isinstance(channels, str) else channels
        width = self.lines.width if band is None else band_width(self.lines, band)
        if weighting:
            width = width * weighting_width(self.lines, weighting) / self.lines.width
        return float(np.sqrt(sum(float(self.densities[name] @ width) for name in names)))

    @cached_property
    def tyre_load(self) -> dict[str, float]:
        """Return the RMS of the dynamic load of each tyre [N]."""
        return {
            wheel: float(np.sqrt(self.densities[f"tyre_{wheel}_force_z"] @ self.lines.width))
            for wheel in self.static_load
        }

    @cached_property
    def values(self) -> dict[str, float]:
        """Return the comfort values by their names in sweeps: overall and by axis, at rail and cushion, SEAT value."""
        values = self._point("seat_rail", "")
        if f"seat_acc_{AXES[2]}" in self.densities:
            values |= self._point("seat", SEAT_PREFIX)
            values[SEAT_VALUE] = values[f"{SEAT_PREFIX}{WEIGHTED}_z"] / values[f"{WEIGHTED}_z"]
        return values

    @property
    def comfort(self) -> PointComfort:
        """Return the comfort at the seat rail."""
        return point_comfort("seat rail", self.values, COMFORT_BAND)

    @property
    def cushion(self) -> PointComfort | None:
        """Return the comfort on the cushion, or None for a car without a seat."""
        return point_comfort("cushion", self.values, COMFORT_BAND, SEAT_PREFIX) if SEAT_VALUE in self.values else None

    def _point(self, point: str, prefix: str) -> dict[str, float]:
        """Return both comfort values of a point, overall and by axis."""
        seat, values = application("seat"), dict[str, float]()
        for name in (UNWEIGHTED, WEIGHTED):
            weighted = name == WEIGHTED
            factors, band = (seat.comfort_factors, None) if weighted else ((1.0, 1.0, 1.0), COMFORT_BAND)
            total = 0.0
            for axis, curve, factor in zip(AXES, seat.weightings, factors, strict=True):
                value = self.rms(f"{point}_acc_{axis}", band=band, weighting=curve if weighted else "")
                values[f"{prefix}{name}_{axis}"] = value
                total += (factor * value) ** 2
            values[f"{prefix}{name}"] = float(np.sqrt(total))
        return values

    def __repr__(self) -> str:
        """Return the values, a line each."""
        points = [self.comfort, *([self.cushion] if self.cushion else [])]
        loads = ", ".join(f"{wheel} {number(load, 4)} N" for wheel, load in self.tyre_load.items())
        lines = [f"{self.car} on {self.road}, estimated without a run (docs/theory/estimate.md)", *map(repr, points)]
        if SEAT_VALUE in self.values:
            lines.append(f"SEAT value {number(self.values[SEAT_VALUE], 4)}")
        return "\n".join([*lines, f"RMS of the dynamic tyre load: {loads}"])


class _LinearPart(NamedTuple):
    """Linear part of cars that differ in the force laws of their dampers alone, on a road."""

    lines: Lines
    twin: LinearTwin  # channels, then the displacements of the nonlinear laws


class _Itself:
    """A car as a key of a cache: the object, not its parameters, whose comparison takes longer than an estimate."""

    def __init__(self, car: Any) -> None:
        self.car = car

    def __hash__(self) -> int:
        return id(self.car)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Itself) and other.car is self.car


def road_estimate(car: Any, drive: RoadDrive | RecordedDrive, channels: Iterable[str] = ()) -> RoadEstimate:
    """Estimate the vibration of a car on all roads of a class; see `Car.estimate`.

    Args:
        car: the car.
        drive: road and speed.
        channels: further acceleration channels.
    """
    road = require_class(drive)
    vehicle = car.vehicle
    points = ("seat_rail", "seat") if vehicle.seated else ("seat_rail",)
    accelerations = tuple(dict.fromkeys([*(f"{point}_acc_{axis}" for point in points for axis in AXES), *channels]))
    vehicle.require_channels(accelerations, vehicle.acceleration_channels)
    dampers = vehicle.composition.dampers
    reference = _reference(*_split(car), road.overrides)
    model = reference.poles
    require_laws(dampers, model)
    loads = tuple(f"tyre_{wheel}_force_z" for wheel in model.matrices.system.inputs)
    part = _linear_part(_Itself(reference), _of_all_roads(road), (*accelerations, *loads))
    laws = [_segments(damper.law) for damper in dampers]
    damping, _ = linearised_damping(part.twin, part.lines, laws)
    names = (*accelerations, *loads)
    densities = density(part.twin.responses(damping))
    displacements = np.sqrt(densities[len(names) :] @ part.lines.width)
    locked = np.full(len(dampers), LOCKED)
    require_motion(dampers, locked * damper_speeds(part.twin, locked, part.lines), model.laws, displacements)
    estimate = RoadEstimate(
        car=vehicle.name,
        road=road.name,
        lines=part.lines,
        densities=dict(zip(names, densities, strict=False)),
        static_load={wheel: reference.static.tyre_load[wheel] for wheel in model.matrices.system.inputs},
        damping=dict(zip((damper.name for damper in dampers), damping.tolist(), strict=True)),
    )
    require_contact(estimate.static_load, estimate.tyre_load)
    return estimate


def _split(car: Any) -> tuple[_Itself, tuple[str, ...]]:
    """Return a car, and the changes of parameters that make the linear part of `car` of it."""
    if car._base is None:
        return _Itself(car), ()
    of_dampers = [text for text in car._step if _key_of_damper(text)]
    if not all(_key_of_damper(text) in LAW_NUMBERS for text in of_dampers):
        return _Itself(car._base), car._step  # another law, which is incomplete without its numbers
    return _Itself(car._base), tuple(text for text in car._step if text not in of_dampers)


def _key_of_damper(text: str) -> str:
    """Return the parameter of a damper that "path=value" sets; empty for another path."""
    path = text.partition("=")[0].strip().split(".")
    return path[-1] if path[-2:-1] == ["damper"] else ""


def _of_all_roads(drive: RoadDrive) -> RoadDrive:
    """Return a drive without the parameters that distinguish roads of one class."""
    return replace(drive, seed=1, tagged=False, duration=None, driving=None, start=None, period=None)


# The cars of a study share a few linear parts if its dampers vary.
@lru_cache(maxsize=32)
def _reference(base: _Itself, changes: tuple[str, ...], by_road: tuple[str, ...]) -> Any:
    """Return a base car with changes, of which those by the road come last; checked for stability."""
    texts = [*changes, *by_road]
    car = base.car.with_(texts) if texts else base.car
    car.check("reduced")
    return car


@lru_cache(maxsize=32)
def _linear_part(car: _Itself, drive: RoadDrive, channels: tuple[str, ...]) -> _LinearPart:
    """Return the responses of a car to the two sources of a class."""
    model, speed = car.car.poles, drive.speed / 3.6
    road = IsoRoad(
        level=CLASSES[str(drive.road)],
        seed=drive.seed,
        track=drive.track,
        coherence=drive.coherence,
        patch=drive.patch,
        envelope=drive.envelope,
    )
    placed = {wheel: (behind, side) for wheel, behind, side in drive.wheels}
    wheels = {wheel: placed[wheel] for wheel in model.matrices.system.inputs}
    lines = integral_lines(road, speed, drive.rate)
    sources = track_sources(road, speed, wheels, lines.frequency)
    return _LinearPart(lines, linear_twin(model, channels, lines.frequency, sources, further=model.law_outputs))


@lru_cache(maxsize=256)
def _segments(law: Damper) -> LineSegments:
    return line_segments(law)
