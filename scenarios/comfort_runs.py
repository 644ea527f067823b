"""Comfort of the car on both roads under variations of its parameters, with statistical errors."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.car_runs import CarRuns
from scenarios.comfort_observation import Observation, Question, chosen_engine, observe
from vehicle.car import Run
from vehicle.errors import ConfigurationError
from vehicle.excitation.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS, velocity_density
from vehicle.excitation.slip_set import sets_text
from vehicle.parameters.paths import value_of
from vehicle.parameters.vehicle import Vehicle
from vehicle.sweeps.road import RoadInput

Changes = tuple[str, ...]
"""Overrides of one car, as "damper.coulomb_friction=62.5"."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Variation:
    """A parameter and the values it takes.

    Attributes:
        name: of its files.
        label: of its axis, with the unit.
        path: of the parameter; a component of a vector has its axis behind it.
        values: what it takes; in the unit of the parameter.
        figures: of source 1; empty beyond the source.
    """

    name: str
    label: str
    path: str
    values: tuple[float, ...]
    figures: str = ""

    def nominal(self, vehicle: Vehicle) -> float:
        """Value of the unchanged car."""
        return value_of(vehicle, self.path)

    def changes(self, vehicle: Vehicle, value: float) -> Changes:
        """Overrides that give the parameter a value; none for the value it has."""
        return () if value == self.nominal(vehicle) else (f"{self.path}={value!r}",)


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


def point(value: float, found: Sequence[Observation], reference: Sequence[Observation]) -> Point:
    """Means over records, and the ratio to the reference on the same records."""
    comfort, base = (np.array([one.comfort for one in many]) for many in (found, reference))
    slip = np.array([one.slip for one in found])
    gaussian = np.array([one.gaussian_error for one in found])
    return Point(
        value=value,
        relative=float(np.mean(comfort / base)),
        relative_error=standard_error(comfort / base),
        comfort=float(np.mean(comfort)),
        comfort_error=standard_error(comfort),
        gaussian_error=float(np.sqrt(np.sum(gaussian**2)) / len(found)),
        slip=float(np.mean(slip)),
        slip_error=standard_error(slip),
        saturated=float(np.mean([one.saturated for one in found])),
        slip_left=float(np.mean([one.slip_left for one in found])),
        lowest_load=float(min(one.lowest_load for one in found)),
        pulling=float(np.mean([one.pulling for one in found])),
    )


def standard_error(values: npt.ArrayLike) -> float:
    """Standard error of the mean of independent values, s / sqrt(n); NaN of a single one."""
    array = np.asarray(values, dtype=np.float64)
    return float(np.std(array, ddof=1) / np.sqrt(array.size)) if array.size > 1 else float("nan")


class ComfortRuns:
    """Observations on the roads, each made once.

    Args:
        runs: the car and how it is run.
        records: of road.
        folder: for the rows of an unfinished study and the table of a finished one; made if missing.
    """

    def __init__(self, runs: CarRuns, records: Records, folder: Path) -> None:
        self.runs, self.records, self.folder = runs, records, folder
        self.engine = chosen_engine(runs.engine)
        self._done: dict[Question, Observation] = {}
        self._histories: dict[Question, Run] = {}

    @property
    def computed(self) -> int:
        """Number of runs so far."""
        return len(self._done)

    def cars(self, variation: Variation, base: Changes = ()) -> dict[float, Changes]:
        """Cars of a variation by its values; `base` are changes that all have."""
        vehicle = self.runs.car().vehicle
        return {value: (*base, *variation.changes(vehicle, value)) for value in variation.values}

    def questions(
        self,
        car: Changes,
        road: str,
        *,
        edge: float = ROAD_EDGE_HZ,
        engine: str | None = None,
        count: int | None = None,
    ) -> list[Question]:
        """The runs of a car on a road, one for each record.

        Args:
            car: its changes.
            road: "smooth" or "rough".
            edge: lower band edge of the road [Hz].
            engine: another one than that of the study.
            count: fewer records.
        """
        return [
            Question(
                car=car,
                source=RoadInput(
                    name=f"{road} road, seed {seed}",
                    rms=ROAD_RMS[road],
                    seed=seed,
                    duration=self.records.duration,
                    lead=self.records.lead,
                    lower_band_edge=edge,
                ),
                engine=engine or self.engine,
            )
            for seed in range(count or self.records.count)
        ]

    def __call__(self, questions: Sequence[Question]) -> list[Observation]:
        """The answers, computed together where they are missing."""
        missing = [question for question in dict.fromkeys(questions) if question not in self._done]
        if missing:
            self.folder.mkdir(exist_ok=True)
            self._done.update(zip(missing, observe(missing, self.runs, self.folder), strict=True))
            # They served an interrupted study; a finished one must not read them when the program has changed.
            (self.folder / "rows.jsonl").unlink()
        return [self._done[question] for question in questions]

    def history(self, car: Changes, road: str, engine: str) -> Run:
        """Seat rail in z over the first record of a road; kept, since the nominal car is in many figures."""
        question = self.questions(car, road, engine=engine, count=1)[0]
        if question not in self._histories:
            self._histories[question] = self.run_of(question)
        return self._histories[question]

    def run_of(self, question: Question) -> Run:
        """Seat rail in z of a question, run here and not kept."""
        car = self.runs.car(question.car)
        return car.run(question.source.signal(), engine=question.engine, channels=["seat_rail_acc_z"])

    def all_questions(self, variation: Variation, base: Changes = ()) -> list[Question]:
        """All runs that the curves of a variation need, those about one car side by side."""
        cars = dict.fromkeys([base, *self.cars(variation, base).values()])
        return [question for car in cars for road in ROAD_RMS for question in self.questions(car, road)]

    def point(self, value: float, car: Changes, road: str, reference: Changes, edge: float = ROAD_EDGE_HZ) -> Point:
        """A car on a road, relative to another one."""
        found, base = (self(self.questions(one, road, edge=edge)) for one in (car, reference))
        return point(value, found, base)

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


def setting(comfort: ComfortRuns) -> list[str]:
    """Paragraphs for `results.md`."""
    runs, found = comfort.runs, {road: comfort.point(0.0, (), road, ()) for road in ROAD_RMS}
    car = "the car of source 1" if runs.vehicle is None else runs.vehicle.name
    changes = f", changed: {', '.join(runs.overrides)}" if runs.overrides else ""
    levels = ", ".join(
        f"{road} {1e3 * rms:g} mm RMS (velocity PSD {velocity_density(rms):.3g} (m/s)²/Hz)"
        for road, rms in ROAD_RMS.items()
    )
    errors = ", ".join(
        f"{road} {100.0 * one.comfort_error / one.comfort:.2f} % over the records, "
        f"{100.0 * one.gaussian_error / one.comfort:.2f} % as a Gaussian road"
        for road, one in found.items()
    )
    return [
        f"Made with {car}{changes}; engine {comfort.engine}. Roads: {levels}, {ROAD_EDGE_HZ:g} to 50 Hz, lines of "
        f"exact level and random phase, {comfort.records.text()}; every car runs on the same records.",
        f"Standard error of the comfort value of the nominal car: {errors} (1/2 sqrt(int S² df / T) / int S df, which "
        "would hold if the amplitudes of the lines were random too). ± behind a number is one standard error over the "
        "records; that of a ratio is over the ratios of the single records.",
        f"Slip shares: time with the right damper above {1e3 * runs.car().vehicle.damper.slip_velocity:g} mm/s, above "
        "1 mm/s, and the left one. Lowest load: of the tyre on the shaker.",
        sets_text(),
        "The tyre is a linear spring, as in the source: where its load is negative it pulls.",
    ]
