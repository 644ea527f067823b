"""Vibration of a passive car on all roads of a class without a run, by statistical linearisation of its dampers.

The dampers become viscous with the constants of a Gaussian velocity
(`vehicle.engines.reduced.statistical_linearisation`), and the mean squares of the linear car are closed integrals over
the spectrum of the class (`vehicle.engines.reduced.road_expectation`). The value has no scatter. The linearisation has
an error (docs/theory/estimate.md). Cars on which this error is large or unknown are rejected
(`vehicle.runs.car.estimate_limits`).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.engines.reduced.road_expectation import Lines, band_width, damper_speeds, density, weighting_width
from vehicle.engines.reduced.statistical_linearisation import LineSegments, line_segments, linearised_damping
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import AXES
from vehicle.runs.car.estimate_limits import LOCKED, require_class, require_contact, require_laws, require_motion
from vehicle.runs.car.linear_part import linear_part
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
from vehicle.signals.excitation.recorded_road import RecordedDrive
from vehicle.signals.excitation.road_drive import RoadDrive


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


def road_estimate(
    car: Any, drive: RoadDrive | RecordedDrive, channels: Iterable[str] = (), *, by_ports: bool = False
) -> RoadEstimate:
    """Estimate the vibration of a car on all roads of a class; see `Car.estimate`.

    Args:
        car: the car.
        drive: road and speed.
        channels: further acceleration channels.
        by_ports: see `vehicle.runs.car.linear_part`.
    """
    road = require_class(drive)
    vehicle = car.vehicle
    points = ("seat_rail", "seat") if vehicle.seated else ("seat_rail",)
    accelerations = tuple(dict.fromkeys([*(f"{point}_acc_{axis}" for point in points for axis in AXES), *channels]))
    vehicle.require_channels(accelerations, vehicle.acceleration_channels)
    dampers = vehicle.composition.dampers
    loads = tuple(f"tyre_{wheel}_force_z" for wheel in vehicle.wheels)
    names = (*accelerations, *loads)
    part = linear_part(car, road, names, by_ports=by_ports)
    require_laws(dampers, part.matrices)
    laws = [_segments(damper.law) for damper in dampers]
    damping, _ = linearised_damping(part.twin, part.lines, laws)
    densities = density(part.twin.responses(damping))
    displacements = np.sqrt(densities[len(names) :] @ part.lines.width)
    locked = np.full(len(dampers), LOCKED)
    require_motion(dampers, locked * damper_speeds(part.twin, locked, part.lines), part.matrices.laws, displacements)
    estimate = RoadEstimate(
        car=vehicle.name,
        road=road.name,
        lines=part.lines,
        densities=dict(zip(names, densities, strict=False)),
        static_load={wheel: part.static.tyre_load[wheel] for wheel in vehicle.wheels},
        damping=dict(zip((damper.name for damper in dampers), damping.tolist(), strict=True)),
    )
    require_contact(estimate.static_load, estimate.tyre_load)
    return estimate


@lru_cache(maxsize=256)
def _segments(law: Damper) -> LineSegments:
    return line_segments(law)
