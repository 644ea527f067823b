"""Comfort of the car on both roads under variations of its parameters, with statistical errors."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.car_runs import CarRuns, swept
from scenarios.road_measure import RoadInput, RoadMeasure
from scenarios.signals.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.arrays import Vector
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import recordings_of, run_of

SEAT_RAIL_Z = ("seat_rail_acc_z",)

Changes = tuple[str, ...]
"""Overrides of one car, for example "damper.coulomb_friction=62.5"."""

Numbers = Mapping[str, float]
"""Values of `RoadMeasure` for one run."""


def chosen_engine(asked: str) -> str:
    """Return the engine of the studies: "auto" is the reduced engine, also on the rough road.

    `Car.run` would use MuJoCo on the rough road: parts rotate by 0.13 rad, outside the valid range of the reduced
    engine. The comfort value of the reduced engine still agrees within
    a few tenths of a percent, which the full study checks on its corner points.
    """
    return "reduced" if asked == "auto" else asked


@dataclass(frozen=True, kw_only=True, slots=True)
class Variation:
    """Parameter with the values of its variation."""

    name: str  # name of the files
    label: str  # label of the axis, with the unit
    path: str  # path of the parameter; a component of a vector has the axis as suffix
    values: tuple[float, ...]  # values in the unit of the parameter
    figures: str = ""  # figures of Bommer 2006; empty for variations that are not in the thesis


def changes(vehicle: Vehicle, path: str, value: float) -> Changes:
    """Return the overrides that set the parameter to a value; empty for the present value."""
    return () if value == value_of(vehicle, path) else (f"{path}={value!r}",)


@dataclass(frozen=True, kw_only=True, slots=True)
class Records:
    """Records of road that every point of a study runs on: common random numbers."""

    count: int  # of records; record i has the seed i on both roads
    duration: float = 60.0  # evaluated length of each [s]
    lead: float = LEAD_S  # left out before it [s]

    def text(self) -> str:
        """Return a text on the records for captions."""
        records = f"{self.count} records" if self.count > 1 else "1 record"
        return f"{records} of {self.duration:g} s (seeds 0 to {self.count - 1}) after {self.lead:g} s left out"


@dataclass(frozen=True, kw_only=True, slots=True)
class Point:
    """Means over the records of a car on a road, with standard errors."""

    value: float  # value of the parameter
    relative: float  # comfort value over the comfort value of the reference [-]
    relative_error: float  # standard error of the ratio, from the ratios of the single records [-]
    comfort: float  # comfort value, `unweighted` [m/s2]
    weighted: float  # weighted RMS of the seat rail (ISO 2631-1) [m/s2]
    relative_weighted: float  # `weighted` over its value at the reference [-]
    comfort_error: float  # standard error, from the single records [m/s2]
    gaussian_error: float  # standard error for a Gaussian road of this length, from the spectrum [m/s2]
    slip: float  # slip, slip_error: share of the time above the slip velocity, right damper [-]
    slip_error: float
    saturated: float  # saturated, slip_left: share above 1 mm/s; share above the slip velocity, left damper [-]
    slip_left: float
    lowest_load: float  # minimum load of the tyre on the shaker [N]
    pulling: float  # share of the time with a negative load [-]


Curves = Mapping[str, Sequence[Point]]
"""Points of one variation by road."""


def point(value: float, numbers: Sequence[Numbers], reference: Sequence[Numbers]) -> Point:
    """Return means over records, and the ratio to the reference on the same records."""
    rows = {name: np.array([record[name] for record in numbers]) for name in numbers[0]}
    comfort, mean = rows[UNWEIGHTED], {name: float(np.mean(row)) for name, row in rows.items()}
    ratio, ratio_weighted = (
        rows[name] / np.array([record[name] for record in reference]) for name in (UNWEIGHTED, WEIGHTED)
    )
    return Point(
        value=value,
        relative=float(np.mean(ratio)),
        relative_error=standard_error(ratio),
        comfort_error=standard_error(comfort),
        gaussian_error=float(np.sqrt(np.sum(rows["gaussian_error"] ** 2)) / len(numbers)),
        slip_error=standard_error(rows["slip"]),
        lowest_load=float(np.min(rows["lowest_load"])),
        comfort=mean[UNWEIGHTED],
        weighted=mean[WEIGHTED],
        relative_weighted=float(np.mean(ratio_weighted)),
        **{name: mean[name] for name in ("slip", "saturated", "slip_left", "pulling")},
    )


def standard_error(values: npt.ArrayLike) -> float:
    """Return the standard error of the mean of independent values, s / sqrt(n); NaN for a single value."""
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
        """Return the number of finished runs."""
        return len(self._done)

    @property
    def tyres(self) -> str:
        """Return a description of the state of the tyres."""
        return self.runs.car().vehicle.driving.words

    def text(self) -> str:
        """Return a text on records, tyres and engine for captions."""
        return f"{self.records.text()}, tyres {self.tyres}, engine {self.engine}"

    def cars(self, variation: Variation, base: Changes = ()) -> dict[float, Changes]:
        """Return value to overrides of the cars of a variation; `base` are overrides of all cars."""
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
        """Return the cases of a car on a road, a case for each record.

        Args:
            car: overrides of the car.
            road: "smooth" or "rough".
            edge: lower band edge of the road [Hz].
            engine: engine, by default the engine of the study.
            count: number of records, by default all.
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
        """Return the values of cases in their order; run missing cases in a batch, sorted by car.

        Raises:
            SimulationError: a run failed.
        """
        missing = [case for case in dict.fromkeys(cases) if case not in self._done]
        if missing:
            measure = RoadMeasure(lead=self.records.lead, wheel=self.runs.wheel)
            values = swept(missing, measure, jobs=self.runs.jobs, folder=self.folder)
            self._done.update(zip(missing, values, strict=True))
        return [self._done[case] for case in cases]

    def histories(
        self, cars: Sequence[Changes], road: str, *, record: int = 0, engine: str | None = None
    ) -> list[Vector]:
        """Return the vertical acceleration of the seat rail of cars over one record of a road [m/s2], (n,) each.

        The reduced engine runs the cars in a batch, as in a sweep; histories are cached for use in several figures.
        """
        cases = [self.cases(car, road, engine=engine)[record] for car in cars]
        missing = [case for case in dict.fromkeys(cases) if case not in self._histories]
        if missing and missing[0].engine == "mujoco":
            recordings = [run_of(case, SEAT_RAIL_Z).recording for case in missing]
        else:
            recordings = recordings_of(missing, SEAT_RAIL_Z) if missing else []
        self._histories |= {
            case: recording[SEAT_RAIL_Z[0]] for case, recording in zip(missing, recordings, strict=True)
        }
        return [self._histories[case] for case in cases]

    def all_cases(self, variation: Variation, base: Changes = ()) -> list[Case]:
        """Return all cases of the curves of a variation, sorted by car."""
        cars = dict.fromkeys([base, *self.cars(variation, base).values()])
        return [case for car in cars for road in ROAD_RMS for case in self.cases(car, road)]

    def point(self, value: float, car: Changes, road: str, reference: Changes) -> Point:
        """Return the point of a car on a road, relative to a reference car."""
        numbers, base = (self(self.cases(record, road)) for record in (car, reference))
        return point(value, numbers, base)

    def nominal(self) -> dict[str, Point]:
        """Return the point of the unmodified car on both roads."""
        return {road: self.point(0.0, (), road, ()) for road in ROAD_RMS}

    def curves(self, variation: Variation, base: Changes = ()) -> Curves:
        """Return the points of a variation on both roads, relative to the car with only the overrides `base`."""
        cars = self.cars(variation, base)
        return {road: [self.point(value, car, road, base) for value, car in cars.items()] for road in ROAD_RMS}


RECORDS = 4
"""Records of 60 s: they give the comfort value within 1 %, also for a road with Gaussian amplitudes."""

QUICK = Records(count=2, duration=8.0, lead=3.0)
"""Records with --quick."""
