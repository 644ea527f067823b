"""What is kept of a run: a few numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vehicle.analysis.comfort import comfort_value, rms_standard_error
from vehicle.analysis.seat_value import seat_value, weighted_rms_of
from vehicle.analysis.slip import slip_share
from vehicle.car import SATURATED_VELOCITY, Run
from vehicle.errors import ConfigurationError
from vehicle.names import AXES, CORNERS


class Measure(Protocol):
    """Turns a run into numbers; must be picklable, and its `repr` must tell it from others."""

    @property
    def channels(self) -> tuple[str, ...] | None:
        """Channels that are needed; None for all."""

    @property
    def units(self) -> Mapping[str, str]:
        """Name of each number to its unit."""

    def __call__(self, run: Run) -> dict[str, float]:
        """The numbers of a run, NaN where one does not exist."""


FRONT = tuple(CORNERS.values())[:2]
"""Wheels that every car has."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortMeasure:
    """Comfort values of the seat rail, slip shares, the first slip.

    Attributes:
        skip: seconds at the beginning that all but the first slip leave out: the car starts at rest.
        wheels: whose dampers are looked at.
        seat: also what ISO 2631-1 says of the seat, and its SEAT value; of a car with a seat.
    """

    skip: float = 2.0
    wheels: tuple[str, ...] = FRONT
    seat: bool = False

    def __post_init__(self) -> None:
        if not 0.0 <= self.skip < math.inf:
            raise ConfigurationError(f"measure: skip {self.skip:g} s, must be a finite number of seconds, at least 0")

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that are needed."""
        places = ("seat_rail", "seat") if self.seat else ("seat_rail",)
        dampers = (f"damper_{wheel}_velocity" for wheel in self.wheels)
        return (*(f"{place}_acc_{axis}" for place in places for axis in AXES), *dampers)

    @property
    def units(self) -> Mapping[str, str]:
        """Name of each number to its unit."""
        comfort = {f"comfort_{axis}": "m/s2" for axis in (*AXES, "overall")} | {"comfort_error": "-"}
        slip = {f"{kind}_{wheel}": "-" for kind in ("slip_share", "saturated_share") for wheel in self.wheels}
        if self.seat:
            comfort |= {f"seat_weighted_{axis}": "m/s2" for axis in (*AXES, "overall")} | {"seat_value": "-"}
        return comfort | slip | {f"first_slip_{wheel}": "s" for wheel in self.wheels}

    def __call__(self, run: Run) -> dict[str, float]:
        """Comfort [m/s2] in 2 to 50 Hz, its standard error as a share of it, the seat where it is asked for, slip.

        Slip is above `damper.slip_velocity`, the saturated share above 1 mm/s. The first slip is that of the whole run,
        as in `summary.json`; NaN where there is none.
        """
        interval = run.recording.timestep
        kept = slice(round(self.skip / interval), None)
        xyz = np.array([run[f"seat_rail_acc_{axis}"][kept] for axis in AXES])
        value = comfort_value(interval, xyz)
        squares = np.array([value.x, value.y, value.z]) ** 2
        # Errors of the axes as if they were independent: d(overall)/overall = sum(rms_i^2 error_i) / overall^2 at most.
        error = float(
            np.sqrt(np.sum((squares * rms_standard_error(interval, xyz)) ** 2)) / max(np.sum(squares), 1e-300)
        )
        numbers = {"comfort_x": value.x, "comfort_y": value.y, "comfort_z": value.z, "comfort_overall": value.overall}
        numbers["comfort_error"] = error
        if self.seat:
            seat = np.array([run[f"seat_acc_{axis}"] for axis in AXES])
            weighted = weighted_rms_of(interval, seat, skip=self.skip)
            numbers |= {f"seat_weighted_{axis}": one for axis, one in zip((*AXES, "overall"), weighted, strict=True)}
            numbers["seat_value"] = seat_value(interval, seat[2], run["seat_rail_acc_z"], skip=self.skip).rms
        for kind, velocity in (
            ("slip_share", run.car.vehicle.damper.slip_velocity),
            ("saturated_share", SATURATED_VELOCITY),
        ):
            for wheel in self.wheels:
                numbers[f"{kind}_{wheel}"] = slip_share(run[f"damper_{wheel}_velocity"][kept], velocity)
        for wheel in self.wheels:
            first = run.first_slip(wheel)
            numbers[f"first_slip_{wheel}"] = math.nan if first is None else first
        return numbers
