"""What a search looks at: comfort, tyre load, travel and slip of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.analysis.seat_value import weighted_rms_of
from vehicle.signals.analysis.slip import slip_shares
from vehicle.studies.sweeps.measure import of_one
from vehicle.studies.sweeps.run_batch import Runs, Vector

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in AXES)
SEAT = tuple(f"seat_acc_{axis}" for axis in AXES)

KINDS = {
    "comfort": ("m/s2", "unweighted RMS of the seat rail, 2 to 50 Hz, all axes; comfort_x, _y, _z one of them"),
    "weighted": ("m/s2", "weighted RMS of the seat rail (ISO 2631-1), all axes"),
    "seat": ("m/s2", "weighted RMS of the seat (ISO 2631-1), all axes, of a car with an occupant"),
    "tyre_load": ("-", "RMS of dynamic over static tyre load, all tyres; tyre_load_fr that of one"),
    "lowest_load": ("-", "lowest tyre load over the static one, all tyres; lowest_load_fr that of one"),
    "travel": ("m", "largest travel of a damper from rest; travel_fr that of one"),
    "slip_share": ("-", "share of the time in which a damper slips, mean of all; slip_share_fr that of one"),
}
"""Number to its unit and what it is."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RideMeasure:
    """Numbers of a ride, of `KINDS`; tyre loads, travels and slips of one wheel have its name behind.

    The travel of a damper is the integral of its velocity from rest on. The RMS over all tyres is that of their loads
    taken together; the largest travel and the lowest load are the worst of all.

    Attributes:
        numbers: which.
        wheels: of the car.
        dampers: wheels that have a damper.
        skip: seconds at the beginning that are left out: the car starts at rest.
        timestep: longest step of the reduced engine [s].
    """

    numbers: tuple[str, ...]
    wheels: tuple[str, ...]
    dampers: tuple[str, ...]
    skip: float = 2.0
    timestep: float = 5e-4

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that are needed."""
        found: list[str] = []
        for number in self.numbers:
            kind, one = split(number)
            if kind in ("comfort", "weighted"):
                found += RAIL
            elif kind == "seat":
                found += SEAT
            elif kind in ("tyre_load", "lowest_load"):
                found += [f"tyre_{wheel}_force_z" for wheel in ([one] if one else self.wheels)]
            else:
                found += [f"damper_{wheel}_velocity" for wheel in ([one] if one else self.dampers)]
        return tuple(dict.fromkeys(found))

    @property
    def units(self) -> Mapping[str, str]:
        """Name of each number to its unit."""
        return {number: KINDS[split(number)[0]][0] for number in self.numbers}

    def __call__(self, run: Run) -> dict[str, float]:
        """The numbers of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """The numbers of several runs."""
        return {number: self._number(runs, *split(number)) for number in self.numbers}

    def _number(self, runs: Runs, kind: str, one: str) -> Vector:
        # Without the first sample: a round number of them has a spectrum ten times as quick as a prime one.
        kept = slice(round(self.skip / runs.timestep) + 1, None)
        if kind == "comfort":
            value = comfort_values(runs.timestep, runs.stacked(*RAIL)[:, :, kept])
            return value.axes[:, AXES.index(one)] if one else value.overall
        if kind in ("weighted", "seat"):
            each = runs.stacked(*(RAIL if kind == "weighted" else SEAT))
            return np.array([weighted_rms_of(runs.timestep, xyz, skip=self.skip)[3] for xyz in each])
        if kind in ("tyre_load", "lowest_load"):
            wheels = [one] if one else self.wheels
            loads = [runs[f"tyre_{wheel}_force_z"][:, kept] / runs.tyre_load[wheel][:, None] for wheel in wheels]
            if kind == "lowest_load":
                return np.asarray(np.min([np.min(load, axis=1) for load in loads], axis=0))
            return np.asarray(np.sqrt(np.mean([np.mean((load - 1.0) ** 2, axis=1) for load in loads], axis=0)))
        velocity = {wheel: runs[f"damper_{wheel}_velocity"] for wheel in ([one] if one else self.dampers)}
        if kind == "slip_share":
            shares = [slip_shares(one[:, kept], runs.slip_velocity) for one in velocity.values()]
            return np.asarray(np.mean(shares, axis=0))
        travel = [
            scipy.integrate.cumulative_trapezoid(one, dx=runs.timestep, axis=1, initial=0.0)[:, kept]
            for one in velocity.values()
        ]
        return np.asarray(np.max([np.max(np.abs(one), axis=1) for one in travel], axis=0))


def split(number: str) -> tuple[str, str]:
    """Kind of a number, and the axis or wheel behind it; empty for all."""
    kind = max((kind for kind in KINDS if f"{number}_".startswith(f"{kind}_")), key=len, default="")
    return kind, number[len(kind) + 1 :]


def ride_measure(vehicle: Vehicle, numbers: tuple[str, ...], skip: float) -> RideMeasure:
    """The measure of numbers of a car.

    Args:
        vehicle: the car.
        numbers: their names.
        skip: seconds left out at the beginning.

    Raises:
        ConfigurationError: a number that the car does not have.
    """
    names = {damper.name for damper in vehicle.composition.dampers}
    dampers = tuple(wheel for wheel in vehicle.wheels if f"damper_{wheel}" in names)
    has = {"comfort": ("", *AXES), "weighted": ("",), "tyre_load": ("", *vehicle.wheels)}
    has |= {"lowest_load": ("", *vehicle.wheels)} | dict.fromkeys(("travel", "slip_share"), ("", *dampers))
    if vehicle.seated:
        has["seat"] = ("",)
    if not dampers:
        del has["travel"], has["slip_share"]
    known = [f"{kind}_{one}".rstrip("_") for kind, ones in has.items() for one in ones]
    for number in numbers:
        if number not in known:
            raise ConfigurationError(f"no number {number!r} of {vehicle.name}; there are {', '.join(known)}")
    return RideMeasure(numbers=tuple(dict.fromkeys(numbers)), wheels=vehicle.wheels, dampers=dampers, skip=skip)
