"""Runs of cars on roads of ISO 8608: cases, measure, and means over the records."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from scenarios.comfort_runs import chosen_engine, standard_error
from vehicle.errors import SimulationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road, lifting_tyres
from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.analysis.seat_value import seat_value, weighted_rms_of
from vehicle.signals.analysis.slip import slip_shares
from vehicle.studies.sweeps.case import Case, all_tyre_words, overrides_of
from vehicle.studies.sweeps.measure import of_one
from vehicle.studies.sweeps.run_batch import Runs, Vector
from vehicle.studies.sweeps.sweep import sweep

LEAD_S = 2.0
"""Seconds at the beginning that are left out: the road rises out of a plane in the first one."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RideMeasure:
    """Turns a run on a road into numbers, all without the lead.

    `rail` is the comfort value of Bommer 2006, sqrt(RMSx^2 + RMSy^2 + RMSz^2) unfiltered in 2 to 50 Hz; `rail_weighted`
    and `seat_weighted` are vector sums after ISO 2631-1 (x and y by Wd, z by Wk), `seat_value` the SEAT value along z;
    the last two are NaN of a car without seat. `load_front` and `load_rear` are RMS of the dynamic tyre load over the
    static one, quadratic mean of the wheels of an axle; `lowest_load` that of any tyre over its static one; `pulling`
    the largest share of the time in which a tyre would pull; `slip` the mean share of slip of all dampers.
    """

    wheels: tuple[tuple[str, str], ...]  # names of wheel and axle of each
    dampers: tuple[str, ...]  # names
    seat: bool  # whether the car has the place `seat` at all
    timestep: float = 5e-4  # longest step of the reduced engine [s]

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        points = ("seat_rail", "seat") if self.seat else ("seat_rail",)
        motion = (f"{point}_acc_{axis}" for point in points for axis in AXES)
        return (
            *motion,
            *(f"tyre_{wheel}_force_z" for wheel, _ in self.wheels),
            *(f"{name}_velocity" for name in self.dampers),
        )

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        loads = [f"load_{axle}" for axle in dict(self.by_axle)]
        return dict.fromkeys(("rail", "rail_weighted", "seat_weighted"), "m/s2") | dict.fromkeys(
            ("seat_value", *loads, "lowest_load", "pulling", "slip"), "-"
        )

    @property
    def by_axle(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Return the wheels of each axle."""
        axles = dict.fromkeys(axle for _, axle in self.wheels)
        return tuple((axle, tuple(wheel for wheel, its in self.wheels if its == axle)) for axle in axles)

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the values of r runs; (r,) each."""
        step = runs.timestep
        kept = slice(round(LEAD_S / step), None)
        rail = runs.stacked(*(f"seat_rail_acc_{axis}" for axis in AXES))
        values = {
            "rail": comfort_values(step, rail[:, :, kept]).overall,
            "rail_weighted": np.array([weighted_rms_of(step, xyz, skip=LEAD_S)[3] for xyz in rail]),
            "seat_weighted": np.full(len(rail), np.nan),
            "seat_value": np.full(len(rail), np.nan),
        }
        for row, vehicle in enumerate(runs.vehicles):
            if vehicle.seated:
                seat = np.array([runs[f"seat_acc_{axis}"][row] for axis in AXES])
                values["seat_weighted"][row] = weighted_rms_of(step, seat, skip=LEAD_S)[3]
                values["seat_value"][row] = seat_value(step, seat[2], rail[row, 2], skip=LEAD_S).rms
        loads = {
            wheel: runs[f"tyre_{wheel}_force_z"][:, kept] / runs.tyre_load[wheel][:, None] for wheel, _ in self.wheels
        }
        for axle, wheels in self.by_axle:
            values[f"load_{axle}"] = np.sqrt(
                np.mean([np.mean((loads[wheel] - 1.0) ** 2, axis=1) for wheel in wheels], axis=0)
            )
        values["lowest_load"] = np.min([np.min(load, axis=1) for load in loads.values()], axis=0)
        values["pulling"] = np.max([np.mean(load < 0.0, axis=1) for load in loads.values()], axis=0)
        shares = [slip_shares(runs[f"{damper}_velocity"][:, kept], runs.slip_velocity) for damper in self.dampers]
        values["slip"] = np.mean(shares, axis=0)
        return values


@dataclass(frozen=True, kw_only=True, slots=True)
class Ride:
    """Ride of a car on a road."""

    car: str  # name of the car in tables, one of `RideRuns.cars`
    road: str  # class of ISO 8608
    speed: float  # speed [km/h]
    friction: float | None = None  # friction limit of every damper [N]; None for the limits of the vehicle file
    engine: str | None = None  # engine, by default that of the study
    one_sided: bool = False  # True for tyres that lift off and never pull


@dataclass(frozen=True, kw_only=True, slots=True)
class Found:
    """Means over the records of a ride, and their standard errors (NaN of one record)."""

    mean: Mapping[str, float]
    error: Mapping[str, float]
    each: Sequence[Mapping[str, float]]


class RideRuns:
    """Cache of rides; missing rides run as a batch.

    Args:
        cars: name in tables to vehicle file; all cars have the same wheels.
        overrides: overrides of every car.
        engine: "mujoco", "reduced" or "auto".
        jobs: worker processes.
        records: number of roads with the seeds 1, 2, ...
        duration: duration of each road, without the lead [s].
        folder: folder for the rows of an unfinished study.
    """

    def __init__(
        self,
        cars: Mapping[str, Path],
        *,
        overrides: Sequence[str] = (),
        engine: str = "auto",
        jobs: int = 1,
        records: int,
        duration: float,
        folder: Path,
    ) -> None:
        self.cars, self.overrides, self.engine, self.jobs = dict(cars), tuple(overrides), chosen_engine(engine), jobs
        self.records, self.duration, self.folder = records, duration, folder
        self.vehicles = {name: Car.load(path, self.overrides).vehicle for name, path in self.cars.items()}
        first = next(iter(self.vehicles.values()))
        self.measure = RideMeasure(
            wheels=tuple((wheel.name, wheel.axle) for wheel in first.composition.wheels),
            dampers=tuple(damper.name for damper in first.composition.dampers),
            seat="seat_acc_z" in first.channels,
        )
        self._done: dict[Ride, Found] = {}

    @property
    def computed(self) -> int:
        """Return the number of finished runs."""
        return self.records * len(self._done)

    def tyres(self, speed: float | None = None) -> str:
        """Return the state of the tyres of the finished rides, at one speed [km/h] or at all speeds."""
        rides = [ride for ride in self._done if speed in (None, ride.speed)]
        return all_tyre_words([case for ride in rides for case in self.cases(ride)[:1]])

    def text(self, speed: float | None = None) -> str:
        """Return a text on records, tyres and engine of the finished rides for captions; speed [km/h], None for all."""
        records = f"{self.records} records" if self.records > 1 else "1 record"
        seeds = f"seeds 1 to {self.records}" if self.records > 1 else "seed 1"
        return (
            f"{records} of {self.duration:g} s ({seeds}) after {LEAD_S:g} s left out, tyres {self.tyres(speed)}, "
            f"engine {self.engine}"
        )

    def compute(self, rides: Sequence[Ride]) -> None:
        """Compute what is missing.

        Raises:
            SimulationError: a run failed.
        """
        missing = [ride for ride in dict.fromkeys(rides) if ride not in self._done]
        if not missing:
            return
        # One car after the other: building one costs more than a record.
        missing.sort(
            key=lambda ride: (list(self.cars).index(ride.car), -1.0 if ride.friction is None else ride.friction)
        )
        self.folder.mkdir(exist_ok=True)
        cases = [case for ride in missing for case in self.cases(ride)]
        inside = partial(ThreadPoolExecutor, 1) if self.jobs == 1 else None
        table = sweep(cases, self.measure, executor=inside, jobs=self.jobs, folder=self.folder)
        for case, reason in table.failed[:1]:
            raise SimulationError(f"{case.label}: {reason}; {len(table.failed)} of {len(cases)} runs failed")
        for number, ride in enumerate(missing):
            each = [record.values for record in table.results[number * self.records : (number + 1) * self.records]]
            columns = {name: np.array([record[name] for record in each]) for name in each[0]}
            self._done[ride] = Found(
                mean={name: float(np.mean(values)) for name, values in columns.items()},
                error={name: standard_error(values) for name, values in columns.items()},
                each=each,
            )
        # They served an interrupted study; a finished one must not read them when the program has changed.
        (self.folder / "rows.jsonl").unlink()

    def __call__(self, ride: Ride) -> Found:
        """Return the result of a finished ride."""
        self.compute([ride])
        return self._done[ride]

    def cases(self, ride: Ride) -> list[Case]:
        """Return the cases of a ride, a case for each record."""
        vehicle = self.vehicles[ride.car]
        changes = () if ride.friction is None else all_friction(vehicle, ride.friction)
        changes = (*changes, *one_sided_tyres(vehicle)) if ride.one_sided else changes
        roads = [
            Road(ride.road, ride.speed, duration=self.duration + LEAD_S, seed=seed).under(vehicle, self.overrides)
            for seed in range(1, self.records + 1)
        ]
        engine, file = ride.engine or self.engine, self.cars[ride.car]
        cases_of_rides = []
        for drive in roads:
            shared = (*self.overrides, *overrides_of(drive))
            cases_of_rides.append(
                Case(source=drive, overrides=(*shared, *changes), engine=engine, vehicle=file, shared=len(shared))
            )
        return cases_of_rides


def all_friction(vehicle: Vehicle, friction: float) -> tuple[str, ...]:
    """Return the overrides that set the Coulomb friction [N] of every damper of a car."""
    paths = dict.fromkeys(damper.path for damper in vehicle.composition.dampers)
    return tuple(f"{path}.coulomb_friction={friction!r}" for path in paths)


def one_sided_tyres(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the overrides that let all tyres of a car lift off."""
    return tuple(f"{path}.one_sided=true" for path in lifting_tyres(vehicle))
