"""Measures: a few values of each run of a sweep."""

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


WAVE_NAMES = tuple(f"comfort_wave_{number}_{part}" for number in range(1, WAVES + 1) for part in ("re", "im"))
"""Names of the stored values C_m of `vehicle.signals.analysis.comfort_error`, which have no column in the table."""

FRONT = tuple(CORNERS.values())[:2]
"""Front wheels, which every car has."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ComfortMeasure:
    """Measure of comfort and slip: unweighted and weighted RMS of the seat rail, slip shares, first slip.

    Attributes:
        skip: excluded time at the beginning for all values except the first slip [s]: the car starts at rest.
        wheels: wheels of the evaluated dampers.
        seat: add weighted RMS of the seat (ISO 2631-1) and SEAT value, for a car with a seat.
        timestep: maximum step of the reduced engine [s].
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
        """Return the required channels."""
        points = ("seat_rail", "seat") if self.seat else ("seat_rail",)
        dampers = (f"damper_{wheel}_velocity" for wheel in self.wheels)
        return (*(f"{point}_acc_{axis}" for point in points for axis in AXES), *dampers)

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        comfort = {f"comfort_{axis}": "m/s2" for axis in (*AXES, "overall")} | {"comfort_error": "-"}
        slip = {f"{share}_{wheel}": "-" for share in ("slip_share", "saturated_share") for wheel in self.wheels}
        if self.seat:
            comfort |= {f"seat_weighted_{axis}": "m/s2" for axis in (*AXES, "overall")} | {"seat_value": "-"}
        weighted = {f"seat_rail_weighted_{axis}": "m/s2" for axis in (*AXES, "overall")}
        return comfort | slip | {f"first_slip_{wheel}": "s" for wheel in self.wheels} | weighted

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return comfort (unweighted RMS, 2 to 50 Hz [m/s2]) with relative standard error, weighted RMS, and slip.

        The standard error applies to Gaussian roads of this class and length, see
        `vehicle.signals.analysis.comfort_error`; weighted values, SEAT value and slip have no standard error. Slip is
        motion above `damper.slip_velocity`, the saturated share is above 1 mm/s. The first slip refers to the whole
        run, as in `summary.json`; NaN without slip.
        """
        interval = runs.timestep
        kept = slice(round(self.skip / interval), None)
        rail = runs.stacked(*(f"seat_rail_acc_{axis}" for axis in AXES))
        value = comfort_values(interval, rail[:, :, kept])
        numbers = {f"comfort_{axis}": value.axes[:, number] for number, axis in enumerate(AXES)}
        numbers |= {"comfort_overall": value.overall, "comfort_error": value.error}
        # Not in `units`, so in no table: for the error of the difference of two cars.
        numbers |= dict(zip(WAVE_NAMES, value.waves.view(np.float64).T, strict=True))
        weighted = np.array([weighted_rms_of(interval, xyz, skip=self.skip) for xyz in rail])
        numbers |= {f"seat_rail_weighted_{axis}": weighted[:, i] for i, axis in enumerate((*AXES, "overall"))}
        if self.seat:
            seat = runs.stacked(*(f"seat_acc_{axis}" for axis in AXES))
            weighted = np.array([weighted_rms_of(interval, xyz, skip=self.skip) for xyz in seat])
            numbers |= {f"seat_weighted_{axis}": weighted[:, i] for i, axis in enumerate((*AXES, "overall"))}
            vertical = zip(seat[:, 2], runs["seat_rail_acc_z"], strict=True)
            values = [seat_value(interval, cushion, rail, skip=self.skip).rms for cushion, rail in vertical]
            numbers["seat_value"] = np.array(values)
        velocity = {wheel: runs[f"damper_{wheel}_velocity"] for wheel in self.wheels}
        limit = runs.slip_velocity
        for share, above in (("slip_share", limit), ("saturated_share", np.full_like(limit, SATURATED_VELOCITY))):
            for wheel in self.wheels:
                numbers[f"{share}_{wheel}"] = slip_shares(velocity[wheel][:, kept], above)
        for wheel in self.wheels:
            numbers[f"first_slip_{wheel}"] = first_slips(runs.time, velocity[wheel], limit)
        return numbers
