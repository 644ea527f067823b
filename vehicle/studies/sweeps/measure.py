"""What is kept of a run: a few numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.names import AXES, CORNERS
from vehicle.runs.car import SATURATED_VELOCITY, Run
from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.analysis.comfort_error import WAVES
from vehicle.signals.analysis.seat_value import seat_value, weighted_rms_of
from vehicle.signals.analysis.slip import first_slips, slip_shares
from vehicle.studies.sweeps.run_batch import Runs, Vector, single


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


@runtime_checkable
class BatchMeasure(Measure, Protocol):
    """One that takes many runs at once: those of the reduced engine are then marched together, a multiple as fast."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that are needed."""

    @property
    def timestep(self) -> float:
        """Longest step of the reduced engine that its numbers allow [s]."""

    def of(self, runs: Runs) -> dict[str, Vector]:
        """The numbers of r runs, (r,) each; those of one must not depend on the others, to the last digit."""


def of_one(measure: BatchMeasure, run: Run) -> dict[str, float]:
    """The numbers of a run alone."""
    return {name: float(values[0]) for name, values in measure.of(single(run)).items()}


WAVE_NAMES = tuple(f"comfort_wave_{number}_{part}" for number in range(1, WAVES + 1) for part in ("re", "im"))
"""Stored numbers C_m of `vehicle.signals.analysis.comfort_error`, which have no column in the table."""

FRONT = tuple(CORNERS.values())[:2]
"""Wheels that every car has."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortMeasure:
    """Values of a run in a sweep: unweighted and weighted RMS of the seat rail, slip shares, first slip.

    Attributes:
        skip: seconds at the beginning that all but the first slip leave out: the car starts at rest.
        wheels: whose dampers are looked at.
        seat: also what ISO 2631-1 says of the seat, and its SEAT value; of a car with a seat.
        timestep: longest step of the reduced engine [s].
    """

    skip: float = 2.0
    wheels: tuple[str, ...] = FRONT
    seat: bool = False
    timestep: float = 5e-4

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
        weighted = {f"seat_rail_weighted_{axis}": "m/s2" for axis in (*AXES, "overall")}
        return comfort | slip | {f"first_slip_{wheel}": "s" for wheel in self.wheels} | weighted

    def __call__(self, run: Run) -> dict[str, float]:
        """The numbers of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Unweighted RMS [m/s2] in 2 to 50 Hz (comfort) with its standard error as a share, weighted RMS, slip.

        The standard error is that over Gaussian roads of this class and length, see
        `vehicle.signals.analysis.comfort_error`; weighted values, SEAT value and slip have none. Slip is above
        `damper.slip_velocity`, the saturated share above 1 mm/s. The first slip is that of the whole run, as in
        `summary.json`; NaN where there is none.
        """
        interval = runs.timestep
        kept = slice(round(self.skip / interval), None)
        rail = runs.stacked(*(f"seat_rail_acc_{axis}" for axis in AXES))
        value = comfort_values(interval, rail[:, :, kept])
        numbers = {f"comfort_{axis}": value.axes[:, number] for number, axis in enumerate(AXES)}
        numbers |= {"comfort_overall": value.overall, "comfort_error": value.error}
        # Not in `units`, so in no table: for the error of the difference of two cars.
        numbers |= dict(zip(WAVE_NAMES, value.waves.view(np.float64).T, strict=True))
        weighted = np.array([weighted_rms_of(interval, one, skip=self.skip) for one in rail])
        numbers |= {f"seat_rail_weighted_{axis}": weighted[:, i] for i, axis in enumerate((*AXES, "overall"))}
        if self.seat:
            seat = runs.stacked(*(f"seat_acc_{axis}" for axis in AXES))
            weighted = np.array([weighted_rms_of(interval, one, skip=self.skip) for one in seat])
            numbers |= {f"seat_weighted_{axis}": weighted[:, i] for i, axis in enumerate((*AXES, "overall"))}
            below = zip(seat[:, 2], runs["seat_rail_acc_z"], strict=True)
            values = [seat_value(interval, one, rail, skip=self.skip).rms for one, rail in below]
            numbers["seat_value"] = np.array(values)
        velocity = {wheel: runs[f"damper_{wheel}_velocity"] for wheel in self.wheels}
        limit = runs.slip_velocity
        for kind, above in (("slip_share", limit), ("saturated_share", np.full_like(limit, SATURATED_VELOCITY))):
            for wheel in self.wheels:
                numbers[f"{kind}_{wheel}"] = slip_shares(velocity[wheel][:, kept], above)
        for wheel in self.wheels:
            numbers[f"first_slip_{wheel}"] = first_slips(runs.time, velocity[wheel], limit)
        return numbers
