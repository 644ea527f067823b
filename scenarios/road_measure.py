"""Periodic road records as inputs of a sweep, and the measure of runs on them."""

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass

import numpy as np

from scenarios.evidence import SLIP_STEP
from scenarios.signals.exact_road import road
from vehicle.arrays import Vector
from vehicle.names import across
from vehicle.runs.car import SATURATED_VELOCITY, Run
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED
from vehicle.signals.analysis.seat_value import weighted_rms_of
from vehicle.signals.analysis.slip import slip_shares
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.measure import of_one

SEAT_RAIL = ("seat_rail_acc_x", "seat_rail_acc_y", "seat_rail_acc_z")


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadInput:
    """Road record as input of a sweep under one wheel; the other attributes are the arguments of `road`."""

    name: str
    rms: float
    seed: int
    duration: float
    lead: float
    lower_band_edge: float
    wheel: str

    def signal(self) -> Signal:
        """Generate the road."""
        return road(
            rms=self.rms,
            seed=self.seed,
            wheel=self.wheel,
            duration=self.duration,
            lead=self.lead,
            lower_band_edge=self.lower_band_edge,
        )

    def identity(self) -> dict[str, object]:
        """Return digest of the samples and all attributes: the data that the runs depend on."""
        return {"sha256": hashlib.sha256(self.signal().displacement[self.wheel].tobytes()).hexdigest(), **asdict(self)}


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadMeasure:
    """Measure of runs on a road.

    `unweighted` and `weighted` are the comfort of the seat rail, see `vehicle.signals.analysis.ride_comfort`; the
    unweighted value is that of whole periods of the record. `gaussian_error` is its standard error over Gaussian roads
    of this spectrum, see `vehicle.signals.analysis.comfort_error`; `slip` and `slip_left` are shares of the time above
    the slip velocity, for the damper of `wheel` and the damper of the opposite wheel; `slip_less` and `slip_more` are
    those of the damper of `wheel` above a slip velocity 10 % lower and higher; `saturated` is the share above
    1 mm/s for the damper of `wheel`; `lowest_load` is the minimum load of its tyre; `pulling` is the share of the time
    with a negative load.
    """

    lead: float  # excluded time at the beginning [s]
    wheel: str  # wheel on the road
    timestep: float = 5e-4  # maximum step of the reduced engine [s]

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the names of the channels of a run that the measure evaluates."""
        return (*SEAT_RAIL, *self._dampers, f"tyre_{self.wheel}_force_z")

    @property
    def _dampers(self) -> tuple[str, str]:
        return f"damper_{self.wheel}_velocity", f"damper_{across(self.wheel)}_velocity"

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        return {
            UNWEIGHTED: "m/s2",
            WEIGHTED: "m/s2",
            "gaussian_error": "m/s2",
            "slip": "-",
            "slip_left": "-",
            "slip_less": "-",
            "slip_more": "-",
            "saturated": "-",
            "lowest_load": "N",
            "pulling": "-",
        }

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the values of r runs; (r,) each."""
        # The last sample of the record is the first sample of the next period.
        record = evaluated_span(runs.time.size, runs.timestep, self.lead)
        rail = runs.stacked(*SEAT_RAIL)
        comfort = comfort_values(runs.timestep, rail[:, :, record])
        weighted = [weighted_rms_of(runs.timestep, xyz[:, : record.stop], skip=self.lead)[3] for xyz in rail]
        right, left = (runs[name][:, record] for name in self._dampers)
        load = runs[f"tyre_{self.wheel}_force_z"][:, record]
        limit, limit_left = runs.slip_velocities((self.wheel, across(self.wheel))).T
        return {
            UNWEIGHTED: comfort.overall,
            WEIGHTED: np.array(weighted),
            "gaussian_error": comfort.error * comfort.overall,
            "slip": slip_shares(right, limit),
            "slip_left": slip_shares(left, limit_left),
            "slip_less": slip_shares(right, (1.0 - SLIP_STEP) * limit),
            "slip_more": slip_shares(right, (1.0 + SLIP_STEP) * limit),
            "saturated": slip_shares(right, np.full_like(limit, SATURATED_VELOCITY)),
            "lowest_load": np.min(load, axis=1),
            "pulling": np.mean(load < 0.0, axis=1),
        }
