"""Records of road as inputs of a sweep, and what is read off a run on one."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import asdict, dataclass

import numpy as np

from vehicle.analysis.comfort import comfort_values
from vehicle.analysis.slip import slip_shares
from vehicle.car import SATURATED_VELOCITY, Run
from vehicle.excitation.exact_road import RATE_HZ, road
from vehicle.excitation.signal import Signal
from vehicle.sweeps.measure import of_one
from vehicle.sweeps.runs import Runs, Vector

SEAT_RAIL = ("seat_rail_acc_x", "seat_rail_acc_y", "seat_rail_acc_z")


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadInput:
    """A record of road as the input of a sweep; arguments as of `exact_road.road`."""

    name: str
    rms: float
    seed: int
    duration: float
    lead: float
    lower_band_edge: float

    def signal(self) -> Signal:
        """Generate the road."""
        return road(
            rms=self.rms, seed=self.seed, duration=self.duration, lead=self.lead, lower_band_edge=self.lower_band_edge
        )

    def identity(self) -> dict[str, object]:
        """What the runs depend on."""
        return {"sha256": hashlib.sha256(self.signal().displacement["fr"].tobytes()).hexdigest(), **asdict(self)}


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadMeasure:
    """Turns a run on a road into numbers.

    `comfort` is sqrt(RMSx^2 + RMSy^2 + RMSz^2) of the seat rail, unfiltered, 2 to 50 Hz; `gaussian_error` its standard
    error over Gaussian roads of this spectrum, see `vehicle.analysis.comfort_error`; `slip` and `slip_left` are shares
    of the time above the slip velocity, right and left damper; `saturated` is the share above 1 mm/s, right damper;
    `lowest_load` that of the tyre on the shaker; `pulling` the share of the time with a negative load there.

    Attributes:
        lead: seconds at the beginning that are left out.
        timestep: longest step of the reduced engine [s].
    """

    lead: float
    timestep: float = 5e-4

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that are needed."""
        return (*SEAT_RAIL, "damper_fr_velocity", "damper_fl_velocity", "tyre_fr_force_z")

    @property
    def units(self) -> Mapping[str, str]:
        """Name of each number to its unit."""
        return {
            "comfort": "m/s2",
            "gaussian_error": "m/s2",
            "slip": "-",
            "slip_left": "-",
            "saturated": "-",
            "lowest_load": "N",
            "pulling": "-",
        }

    def __call__(self, run: Run) -> dict[str, float]:
        """The numbers of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """The numbers of several runs."""
        # The record ends with the sample that begins its next period.
        record = slice(round(self.lead * RATE_HZ) + 1, None)
        found = comfort_values(runs.timestep, runs.stacked(*SEAT_RAIL)[:, :, record])
        right, left = (runs[f"damper_{wheel}_velocity"][:, record] for wheel in ("fr", "fl"))
        load = runs["tyre_fr_force_z"][:, record]
        limit = runs.slip_velocity
        return {
            "comfort": found.overall,
            "gaussian_error": found.error * found.overall,
            "slip": slip_shares(right, limit),
            "slip_left": slip_shares(left, limit),
            "saturated": slip_shares(right, np.full_like(limit, SATURATED_VELOCITY)),
            "lowest_load": np.min(load, axis=1),
            "pulling": np.mean(load < 0.0, axis=1),
        }
