"""Measures: a few values of each run of a sweep."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.reduced_run import LONGEST_STEP
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES, CORNERS
from vehicle.runs.car import SATURATED_VELOCITY, Run
from vehicle.signals.analysis.ride_comfort import comfort_columns, comfort_units
from vehicle.signals.analysis.slip import first_slips, slip_shares
from vehicle.studies.sweeps.run_batch import Runs, single


class Measure(Protocol):
    """Function that returns the values of a run; picklable, with a `repr` that identifies the measure."""

    @property
    def channels(self) -> tuple[str, ...] | None:
        """Return the required channels; None for all channels."""

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run, NaN for undefined values."""


@runtime_checkable
class BatchMeasure(Measure, Protocol):
    """Measure of a batch of runs: the reduced engine then simulates the cars as a batch, several times as fast."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""

    @property
    def timestep(self) -> float:
        """Return the maximum step of the reduced engine [s]."""

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the values of r runs, (r,) each; values of a run must be bitwise independent of the other runs."""


def of_one(measure: BatchMeasure, run: Run) -> dict[str, float]:
    """Return the values of a single run."""
    return {name: float(values[0]) for name, values in measure.of(single(run)).items()}


STEP = LONGEST_STEP
"""Default of the maximum step of a measure [s]: that of a single run, so that both have the same comfort."""

FRONT = tuple(CORNERS.values())[:2]
"""Front wheels."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortMeasure:
    """Measure of comfort and slip: the values of `vehicle.signals.analysis.ride_comfort`, slip shares, first slip.

    Attributes:
        skip: excluded time at the beginning for all values except the first slip [s].
        wheels: wheels of the evaluated dampers.
        seat: add the values on the cushion and the SEAT value, for a car with a seat.
        timestep: maximum step of the reduced engine [s]; by default that of a single run.
    """

    skip: float = 0.0
    wheels: tuple[str, ...] = FRONT
    seat: bool = False
    timestep: float = STEP

    def __post_init__(self) -> None:
        if not 0.0 <= self.skip < math.inf:
            raise ConfigurationError(f"measure: skip {self.skip:g} s, must be a finite number of seconds, at least 0")

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        points = ("seat_rail", "seat") if self.seat else ("seat_rail",)
        dampers = (f"damper_{wheel}_velocity" for wheel in self.wheels)
        return (*(f"{point}_acc_{axis}" for point in points for axis in AXES), *dampers)

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        slip = {f"{share}_{wheel}": "-" for share in ("slip_share", "saturated_share") for wheel in self.wheels}
        return comfort_units(seated=self.seat) | slip | {f"first_slip_{wheel}": "s" for wheel in self.wheels}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return both comfort values and slip.

        `unweighted_error` and `weighted_error` are the relative standard errors for Gaussian roads of this class and
        length, NaN for one event; SEAT value and slip have no standard error. Slip is motion above
        `damper.slip_velocity`, the saturated share is above 1 mm/s. The first slip refers to the whole run, as in
        `summary.json`; NaN without slip.
        """
        kept = slice(round(self.skip / runs.timestep), None)
        rail = runs.stacked(*(f"seat_rail_acc_{axis}" for axis in AXES))
        cushion = runs.stacked(*(f"seat_acc_{axis}" for axis in AXES)) if self.seat else None
        # The waves are not in `units`, so in no table: they are for the error of the difference of two cars.
        numbers = comfort_columns(runs.timestep, rail, cushion, skip=self.skip)
        if not runs.random:
            numbers |= {name: np.full(len(rail), np.nan) for name in numbers if "_error" in name or "_wave_" in name}
        velocity = {wheel: runs[f"damper_{wheel}_velocity"] for wheel in self.wheels}
        limit = runs.slip_velocity if self.wheels else np.zeros(len(runs.vehicles))
        for share, above in (("slip_share", limit), ("saturated_share", np.full_like(limit, SATURATED_VELOCITY))):
            for wheel in self.wheels:
                numbers[f"{share}_{wheel}"] = slip_shares(velocity[wheel][:, kept], above)
        for wheel in self.wheels:
            numbers[f"first_slip_{wheel}"] = first_slips(runs.time, velocity[wheel], limit)
        return numbers


def comfort_measure(vehicle: Vehicle, skip: float) -> ComfortMeasure:
    """Return the measure of a vehicle: its front dampers, those behind if it has none in front.

    Args:
        vehicle: the vehicle.
        skip: excluded time at the beginning [s].
    """
    damped = vehicle.damped_wheels
    wheels = tuple(wheel for wheel in FRONT if wheel in damped) or damped
    return ComfortMeasure(skip=skip, wheels=wheels, seat=vehicle.seated)
