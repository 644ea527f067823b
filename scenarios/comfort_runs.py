"""Comfort of the car on both roads under variations of its parameters, with statistical errors."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.car_runs import CarRuns
from vehicle.engines.reduced.pole_stepping import has_compiler
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.excitation.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.evaluation import recordings_of, run_of
from vehicle.studies.sweeps.road import RoadInput, RoadMeasure
from vehicle.studies.sweeps.sweep import sweep

Vector = npt.NDArray[np.float64]

SEAT_RAIL_Z = ("seat_rail_acc_z",)

Changes = tuple[str, ...]
"""Overrides of one car, as "damper.coulomb_friction=62.5"."""

Numbers = Mapping[str, float]
"""What `RoadMeasure` reads off one run."""


def chosen_engine(asked: str) -> str:
    """Engine of the studies: "auto" is the reduced one, on the rough road too, where `Car.run` would take MuJoCo.

    There parts turn by 0.13 rad, beyond what the reduced engine vouches for; its comfort value is still the same within
    a few tenths of a percent, which the full study checks on its corner points.
    """
    reduced = "reduced" if has_compiler() else "mujoco"
    return reduced if asked == "auto" else asked


@dataclass(frozen=True, kw_only=True, slots=True)
class Variation:
    """A parameter and the values it takes.

    Attributes:
        name: of its files.
        label: of its axis, with the unit.
        path: of the parameter; a component of a vector has its axis behind it.
        values: what it takes; in the unit of the parameter.
        figures: of Bommer 2006; empty beyond the source.
    """

    name: str
    label: str
    path: str
    values: tuple[float, ...]
    figures: str = ""


def changes(vehicle: Vehicle, path: str, value: float) -> Changes:
    """Overrides that give a parameter a value; none for the value it has."""
    return () if value == value_of(vehicle, path) else (f"{path}={value!r}",)


@dataclass(frozen=True, kw_only=True, slots=True)
class Records:
    """Records of road that every point of a study runs on: common random numbers.

    Attributes:
        count: of records; record i has the seed i on both roads.
        duration: evaluated length of each [s].
        lead: left out before it [s].
    """

    count: int
    duration: float = 60.0
    lead: float = LEAD_S

    def text(self) -> str:
        """For captions."""
        many = f"{self.count} records" if self.count > 1 else "1 record"
        return f"{many} of {self.duration:g} s (seeds 0 to {self.count - 1}) after {self.lead:g} s left out"


@dataclass(frozen=True, kw_only=True, slots=True)
class Point:
    """One car on one road: means over the records and their standard errors.

    Attributes:
        value: of the parameter.
        relative: comfort value over that of the reference [-].
        relative_error: standard error of that ratio, from the ratios of the single records [-].
        comfort: comfort value [m/s2].
        comfort_error: standard error, from the single records [m/s2].
        gaussian_error: what a Gaussian road of this length would give, from the spectrum [m/s2].
        slip, slip_error: share of the time above the slip velocity, right damper [-].
        saturated, slip_left: share above 1 mm/s; share above the slip velocity, left damper [-].
        lowest_load: of the tyre on the shaker [N].
        pulling: share of the time with a negative load [-].
    """

    value: float
    relative: float
    relative_error: float
    comfort: float
    comfort_error: float
    gaussian_error: float
    slip: float
    slip_error: float
    saturated: float
    slip_left: float
    lowest_load: float
    pulling: float


Curves = Mapping[str, Sequence[Point]]
"""Points of one variation by road."""


def point(value: float, found: Sequence[Numbers], reference: Sequence[Numbers]) -> Point:
    """Means over records, and the ratio to the reference on the same records."""
    rows = {name: np.array([one[name] for one in found]) for name in found[0]}
    comfort, mean = rows["comfort"], {name: float(np.mean(row)) for name, row in rows.items()}
    ratio = comfort / np.array([one["comfort"] for one in reference])
    return Point(
        value=value,
        relative=float(np.mean(ratio)),
        relative_error=standard_error(ratio),
        comfort_error=standard_error(comfort),
        gaussian_error=float(np.sqrt(np.sum(rows["gaussian_error"] ** 2)) / len(found)),
        slip_error=standard_error(rows["slip"]),
        lowest_load=float(np.min(rows["lowest_load"])),
        **{name: mean[name] for name in ("comfort", "slip", "saturated", "slip_left", "pulling")},
    )


def standard_error(values: npt.ArrayLike) -> float:
    """Standard error of the mean of independent values, s / sqrt(n); NaN of a single one."""
    array = np.asarray(values, dtype=np.float64)
    return float(np.std(array, ddof=1) / np.sqrt(array.size)) if array.size > 1 else float("nan")


class ComfortRuns:
    """Runs on the roads, each made once.

    Args:
        runs: the car and how it is run.
        records: of road.
        folder: for the rows of an unfinished study and the table of a finished one; made if missing.
    """

    def __init__(self, runs: CarRuns, records: Records, folder: Path) -> None:
        self.runs, self.records, self.folder = runs, records, folder
        self.engine = chosen_engine(runs.engine)
        self._done: dict[Case, Numbers] = {}
        self._histories: dict[Case, Vector] = {}

    @property
    def computed(self) -> int:
        """Number of runs so far."""
        return len(self._done)

    @property
    def tyres(self) -> str:
        """What the tyres of the car do."""
        return self.runs.car().vehicle.driving.words

    def text(self) -> str:
        """Records, tyres and engine, for captions."""
        return f"{self.records.text()}, tyres {self.tyres}, engine {self.engine}"

    def cars(self, variation: Variation, base: Changes = ()) -> dict[float, Changes]:
        """Cars of a variation by its values; `base` are changes that all have."""
        vehicle = self.runs.car().vehicle
        return {value: (*base, *changes(vehicle, variation.path, value)) for value in variation.values}

    def cases(
        self,
        car: Changes,
        road: str,
        *,
        edge: float = ROAD_EDGE_HZ,
        engine: str | None = None,
        count: int | None = None,
    ) -> list[Case]:
        """The runs of a car on a road, one for each record.

        Args:
            car: its changes.
            road: "smooth" or "rough".
            edge: lower band edge of the road [Hz].
            engine: another one than that of the study.
            count: fewer records.
        """
        return [
            self.runs.case(
                RoadInput(
                    name=f"{road} road, seed {seed}",
                    rms=ROAD_RMS[road],
                    seed=seed,
                    duration=self.records.duration,
                    lead=self.records.lead,
                    lower_band_edge=edge,
                    wheel=self.runs.wheel,
                ),
                car,
                engine=engine or self.engine,
            )
            for seed in range(count or self.records.count)
        ]

    def __call__(self, cases: Sequence[Case]) -> list[Numbers]:
        """Numbers of the cases, in their order; what is missing is computed together, one car after the other.

        Raises:
            SimulationError: a run failed.
        """
        missing = [case for case in dict.fromkeys(cases) if case not in self._done]
        if missing:
            self.folder.mkdir(exist_ok=True)
            # One job needs no process of its own, which takes seconds to start.
            inside = partial(ThreadPoolExecutor, 1) if self.runs.jobs == 1 else None
            measure = RoadMeasure(lead=self.records.lead, wheel=self.runs.wheel)
            table = sweep(missing, measure, executor=inside, jobs=self.runs.jobs, folder=self.folder)
            for case, reason in table.failed[:1]:
                raise SimulationError(f"{case.label}: {reason}; {len(table.failed)} of {len(missing)} runs failed")
            self._done.update(zip(missing, (result.values for result in table.results), strict=True))
            # They served an interrupted study; a finished one must not read them when the program has changed.
            (self.folder / "rows.jsonl").unlink()
        return [self._done[case] for case in cases]

    def histories(
        self, cars: Sequence[Changes], road: str, *, record: int = 0, engine: str | None = None
    ) -> list[Vector]:
        """Seat rail in z of cars over one record of a road [m/s2], (n,) each.

        The reduced engine takes them side by side, as in the sweep; kept, since the nominal car is in many figures.
        """
        cases = [self.cases(car, road, engine=engine)[record] for car in cars]
        missing = [case for case in dict.fromkeys(cases) if case not in self._histories]
        if missing and missing[0].engine == "mujoco":
            recordings = [run_of(case, SEAT_RAIL_Z).recording for case in missing]
        else:
            recordings = recordings_of(missing, SEAT_RAIL_Z) if missing else []
        self._histories |= {case: one[SEAT_RAIL_Z[0]] for case, one in zip(missing, recordings, strict=True)}
        return [self._histories[case] for case in cases]

    def all_cases(self, variation: Variation, base: Changes = ()) -> list[Case]:
        """All runs that the curves of a variation need, those about one car side by side."""
        cars = dict.fromkeys([base, *self.cars(variation, base).values()])
        return [case for car in cars for road in ROAD_RMS for case in self.cases(car, road)]

    def point(self, value: float, car: Changes, road: str, reference: Changes, edge: float = ROAD_EDGE_HZ) -> Point:
        """A car on a road, relative to another one."""
        found, base = (self(self.cases(one, road, edge=edge)) for one in (car, reference))
        return point(value, found, base)

    def nominal(self) -> dict[str, Point]:
        """The unchanged car on both roads."""
        return {road: self.point(0.0, (), road, ()) for road in ROAD_RMS}

    def curves(self, variation: Variation, base: Changes = ()) -> Curves:
        """Points of a variation on both roads, relative to the car with `base` alone."""
        cars = self.cars(variation, base)
        return {road: [self.point(value, car, road, base) for value, car in cars.items()] for road in ROAD_RMS}


RECORDS = 4
"""Records of 60 s: with them the comfort value is known within 1 % even as that of a road with Gaussian amplitudes."""

QUICK = Records(count=2, duration=8.0, lead=3.0)
"""Records with --quick."""


def comfort_options(parser: argparse.ArgumentParser) -> None:
    """Add --records to the options of a study; the reduced engine by default."""
    parser.set_defaults(engine="auto")
    parser.add_argument(
        "--records", type=int, metavar="N", help=f"records of road for every point, 60 s each; {RECORDS} by default"
    )


def records_of(options: argparse.Namespace) -> Records:
    """The records that the options ask for.

    Raises:
        ConfigurationError: fewer than one.
    """
    if options.records is not None and options.records < 1:
        raise ConfigurationError(f"--records {options.records}: must be at least 1; a single one tells no error")
    base = QUICK if options.quick else Records(count=RECORDS)
    return base if options.records is None else Records(count=options.records, duration=base.duration, lead=base.lead)
