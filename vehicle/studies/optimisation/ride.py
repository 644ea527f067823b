"""Quantities of the ride for a search: comfort, tyre load, travel and slip of a run."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car import Run
from vehicle.signals.analysis.ride_comfort import (
    SEAT_PREFIX,
    SEAT_VALUE,
    UNWEIGHTED,
    WEIGHTED,
    comfort_columns,
    comfort_units,
)
from vehicle.signals.analysis.slip import slip_shares
from vehicle.studies.sweeps.measure import STEP, of_one
from vehicle.studies.sweeps.run_batch import Runs

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in AXES)
SEAT = tuple(f"seat_acc_{axis}" for axis in AXES)

QUANTITIES = {
    "unweighted": ("m/s2", "unweighted RMS of the seat rail, 2 to 50 Hz, all axes; unweighted_z for an axis"),
    "weighted": ("m/s2", "weighted RMS of the seat rail (ISO 2631-1), all axes; weighted_z for an axis"),
    "seat_unweighted": ("m/s2", "unweighted RMS of the cushion, of a car with an occupant; seat_unweighted_z"),
    "seat_weighted": ("m/s2", "weighted RMS of the cushion, of a car with an occupant; seat_weighted_z"),
    "seat_value": ("-", "SEAT value, of a car with an occupant"),
    "tyre_load": ("-", "RMS of dynamic over static tyre load, all tyres; tyre_load_fr for a wheel"),
    "lowest_load": ("-", "minimum tyre load over static load, all tyres; lowest_load_fr for a wheel"),
    "travel": ("m", "maximum travel of a damper from rest; travel_fr for a wheel"),
    "slip_share": ("-", "share of the time in which a damper slips, mean of all dampers; slip_share_fr for a wheel"),
}
"""Quantity to unit and definition; the first are those of `vehicle.signals.analysis.ride_comfort`."""

COMFORT = frozenset(comfort_units(seated=True)) & set(QUANTITIES)
"""Quantities that `comfort_columns` computes."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RideMeasure:
    """Measure of `QUANTITIES` of the ride; a suffix selects an axis or a wheel.

    The travel of a damper is the time integral of its velocity, from rest. The RMS over all tyres is the root of the
    mean of their mean squares; travel and lowest load are the worst of all wheels.

    Attributes:
        numbers: names of the quantities.
        wheels: wheels of the car.
        dampers: wheels with a damper.
        skip: excluded time at the beginning [s].
        timestep: maximum step of the reduced engine [s]; by default that of a single run.
    """

    numbers: tuple[str, ...]
    wheels: tuple[str, ...]
    dampers: tuple[str, ...]
    skip: float = 0.0
    timestep: float = STEP

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        channels: list[str] = []
        for number in self.numbers:
            quantity, suffix = split_name(number)
            if quantity in COMFORT:
                channels += (*RAIL, *SEAT) if quantity.startswith(SEAT_PREFIX) else RAIL
            elif quantity in ("tyre_load", "lowest_load"):
                channels += [f"tyre_{wheel}_force_z" for wheel in ([suffix] if suffix else self.wheels)]
            else:
                channels += [f"damper_{wheel}_velocity" for wheel in ([suffix] if suffix else self.dampers)]
        return tuple(dict.fromkeys(channels))

    @property
    def units(self) -> Mapping[str, str]:
        """Return name of each quantity to its unit."""
        return {number: QUANTITIES[split_name(number)[0]][0] for number in self.numbers}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the quantities of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the quantities of r runs; (r,) each."""
        quantities = {split_name(number)[0] for number in self.numbers}
        columns: Mapping[str, Vector] = {}
        if quantities & COMFORT:
            seated = any(quantity.startswith(SEAT_PREFIX) for quantity in quantities)
            cushion = runs.stacked(*SEAT) if seated else None
            names = {quantity.removeprefix(SEAT_PREFIX) for quantity in quantities}
            rail = runs.stacked(*RAIL)
            columns = comfort_columns(runs.timestep, rail, cushion, skip=self.skip, names=names, errors=False)
        return {
            number: columns[number] if number in columns else self._number(runs, *split_name(number))
            for number in self.numbers
        }

    def _number(self, runs: Runs, quantity: str, suffix: str) -> Vector:
        kept = slice(round(self.skip / runs.timestep), None)
        if quantity in ("tyre_load", "lowest_load"):
            wheels = [suffix] if suffix else self.wheels
            loads = [runs[f"tyre_{wheel}_force_z"][:, kept] / runs.tyre_load[wheel][:, None] for wheel in wheels]
            if quantity == "lowest_load":
                return np.asarray(np.min([np.min(load, axis=1) for load in loads], axis=0))
            return np.asarray(np.sqrt(np.mean([np.mean((load - 1.0) ** 2, axis=1) for load in loads], axis=0)))
        velocity = {wheel: runs[f"damper_{wheel}_velocity"] for wheel in ([suffix] if suffix else self.dampers)}
        if quantity == "slip_share":
            shares = [slip_shares(history[:, kept], runs.slip_velocity) for history in velocity.values()]
            return np.asarray(np.mean(shares, axis=0))
        travel = [
            scipy.integrate.cumulative_trapezoid(history, dx=runs.timestep, axis=1, initial=0.0)[:, kept]
            for history in velocity.values()
        ]
        return np.asarray(np.max([np.max(np.abs(history), axis=1) for history in travel], axis=0))


def split_name(number: str) -> tuple[str, str]:
    """Split the name of a ride value, as "tyre_load_fr", into quantity and suffix (axis or wheel; empty for all)."""
    quantity = max(
        (quantity for quantity in QUANTITIES if f"{number}_".startswith(f"{quantity}_")), key=len, default=""
    )
    return quantity, number[len(quantity) + 1 :]


def ride_measure(vehicle: Vehicle, numbers: tuple[str, ...], skip: float) -> RideMeasure:
    """Return the measure of given quantities of a car.

    Args:
        vehicle: the vehicle.
        numbers: names of the quantities.
        skip: excluded time at the beginning [s].

    Raises:
        ConfigurationError: the vehicle lacks a quantity.
    """
    dampers = vehicle.damped_wheels
    has: dict[str, tuple[str, ...]] = dict.fromkeys((UNWEIGHTED, WEIGHTED), ("", *AXES))
    has["tyre_load"] = ("", *vehicle.wheels)
    has |= {"lowest_load": ("", *vehicle.wheels)} | dict.fromkeys(("travel", "slip_share"), ("", *dampers))
    if vehicle.seated:
        has |= dict.fromkeys((f"{SEAT_PREFIX}{UNWEIGHTED}", f"{SEAT_PREFIX}{WEIGHTED}"), ("", *AXES))
        has[SEAT_VALUE] = ("",)
    if not dampers:
        del has["travel"], has["slip_share"]
    available = [f"{quantity}_{suffix}".rstrip("_") for quantity, suffixes in has.items() for suffix in suffixes]
    for number in numbers:
        if number not in available:
            raise ConfigurationError(f"{vehicle.name} has no quantity {number!r}; choose from {', '.join(available)}")
    return RideMeasure(numbers=tuple(dict.fromkeys(numbers)), wheels=vehicle.wheels, dampers=dampers, skip=skip)
