"""A car on four wheels on roads of ISO 8608: class and speed, damper friction, with and without an occupant.

python -m scenarios.road [--output DIR] [--quick] [--jobs N] [--records N] [--engine auto|reduced|mujoco]
    [--vehicle FILE.toml] [--set PATH=VALUE]
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from scenarios.car_runs import CarRuns, swept
from scenarios.charts import figure_file
from scenarios.claims import COMPARED, OWN_CHECK, Claim, Findings, markdown
from scenarios.comfort_runs import chosen_engine, standard_error
from scenarios.comfort_sensitivity.figures import number
from scenarios.study import QUICK_NOTE, car_study
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.studies.sweeps.case import Case, all_tyre_words
from vehicle.studies.sweeps.case_table import Cases
from vehicle.studies.sweeps.measure import FigureMeasure, measure_of
from vehicle.studies.sweeps.sweep_inputs import file_of, inputs_of

CARS = {"without occupant": "focus_road", "with occupant": "focus_road_seated"}
"""Shipped cars of the study by their names in tables."""

ROADS, SPEEDS = ("A", "B", "C"), (50.0, 80.0, 120.0)
FRICTIONS = (0.0, 31.25, 62.5, 125.0, 250.0)
"""Coulomb friction of every damper [N]; Bommer 2006 has 125 N in front."""

SPEED = 80.0
"""Speed of the study of friction [km/h]."""

LEAD_S = 2.0
"""Seconds at the beginning that are left out: the road rises out of a plane in the first one."""

TIMESTEP = 5e-4
"""Largest step of the reduced engine [s]."""

RECORDS, DURATION_S = 3, 30.0
QUICK_DURATION_S = 4.0
QUICK_WHY = f"one record of {QUICK_DURATION_S:g} s tells it too coarsely"

SCALED = 5e-3
"""Difference of two relative comfort values that are one by the scaling [-]."""

LARGE = 1.10
"""Growth of a comfort value [-] that a passenger may notice: differences of about 10 % and more are felt (Mansfield and
Griffin, Journal of Sound and Vibration 236 (2000), just noticeable differences of vertical vibration in a car)."""

RAIL, RAIL_WEIGHTED, SEAT_WEIGHTED = "unweighted", "weighted", "seat_weighted"
"""Comfort values, see `vehicle.studies.optimisation.ride`."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Ride:
    """Ride of a car on a road."""

    car: str  # name of the car in tables, one of `Rides.cars`
    road: str  # class of ISO 8608
    speed: float = SPEED  # speed [km/h]
    friction: float | None = None  # friction limit of every damper [N]; None for the limits of the vehicle file


Numbers = Mapping[str, float]
"""Values of a record: those of the ride measure, and `load_front`, `load_rear`, the RMS of the dynamic over the static
tyre load, quadratic mean of the wheels of an axle [-]; no seat values of a car without seat."""


class Rides:
    """Rides of cars over the same records of road, each run once.

    Args:
        cars: name in tables to the car.
        engine: "mujoco", "reduced" or "auto".
        jobs: worker processes.
        records: number of roads with the seeds 1, 2, ...
        duration: duration of each road, without the lead [s].
        folder: folder for the rows of an unfinished study.
    """

    def __init__(
        self,
        cars: Mapping[str, Car],
        *,
        engine: str = "auto",
        jobs: int = 1,
        records: int,
        duration: float,
        folder: Path,
    ) -> None:
        self.cars, self.engine, self.jobs = dict(cars), chosen_engine(engine), jobs
        self.records, self.duration, self.folder = records, duration, folder
        self._done: dict[Ride, list[Numbers]] = {}

    def cases(self, ride: Ride) -> Sequence[Case]:
        """Return the cases of a ride, a case for each record."""
        car, roads = self.cars[ride.car], range(1, self.records + 1)
        inputs = [Road(ride.road, ride.speed, duration=self.duration + LEAD_S, seed=seed) for seed in roads]
        paths = dict.fromkeys(damper.path for damper in car.vehicle.composition.dampers)
        changes = () if ride.friction is None else tuple(f"{path}.coulomb_friction={ride.friction!r}" for path in paths)
        return Cases([changes], inputs_of(car, inputs), engine=self.engine, vehicle=file_of(car), fixed=car.overrides)

    def compute(self, rides: Sequence[Ride]) -> None:
        """Run what is missing, one car after the other: building one costs more than a record.

        Raises:
            SimulationError: a run failed.
        """
        for name, car in self.cars.items():
            missing = [ride for ride in dict.fromkeys(rides) if ride.car == name and ride not in self._done]
            missing.sort(key=lambda ride: -1.0 if ride.friction is None else ride.friction)
            wheels, seated = car.vehicle.wheels, car.vehicle.seated
            names = (RAIL, RAIL_WEIGHTED, *((SEAT_WEIGHTED, "seat_value") if seated else ()))
            names += ("lowest_load", "slip_share", *(f"tyre_load_{wheel}" for wheel in wheels))
            figures = {name: chosen_figure(name, car.vehicle) for name in names}
            of_ride = measure_of(car.vehicle, figures, LEAD_S, errors=False)
            assert isinstance(of_ride, FigureMeasure)
            measure = replace(of_ride, timestep=TIMESTEP)
            cases = [case for ride in missing for case in self.cases(ride)]
            rows = iter(swept(cases, measure, jobs=self.jobs, folder=self.folder))
            for ride in missing:
                records = itertools.islice(rows, self.records)
                self._done[ride] = [{**row, **axle_loads(car, row)} for row in records]

    def each(self, ride: Ride, name: str) -> list[float]:
        """Return a value of a ride in every record; NaN where the car has none."""
        self.compute([ride])
        return [row.get(name, float("nan")) for row in self._done[ride]]

    def mean(self, ride: Ride, name: str) -> float:
        """Return the mean of a value of a ride over the records."""
        return float(np.mean(self.each(ride, name)))

    def ratio(self, ride: Ride, name: str) -> tuple[float, float]:
        """Return the ratio of a value to that of the car without friction: mean and standard error over the records."""
        values = np.array(self.each(ride, name)) / self.each(replace(ride, friction=0.0), name)
        return float(np.mean(values)), standard_error(values)

    def axles(self) -> list[str]:
        """Return the names of the loads of the axles, "load_front" first."""
        wheels = next(iter(self.cars.values())).vehicle.composition.wheels
        return list(dict.fromkeys(f"load_{wheel.axle}" for wheel in wheels))

    def text(self, rides: Sequence[Ride]) -> str:
        """Return a text on records, tyres and engine of rides for captions."""
        records = f"{self.records} records" if self.records > 1 else "1 record"
        seeds = f"seeds 1 to {self.records}" if self.records > 1 else "seed 1"
        return (
            f"{records} of {self.duration:g} s ({seeds}) after {LEAD_S:g} s left out, tyres {self.tyres(rides)}, "
            f"engine {self.engine}"
        )

    def tyres(self, rides: Sequence[Ride]) -> str:
        """Return the state of the tyres in rides."""
        return all_tyre_words([self.cases(ride)[0] for ride in rides])


def axle_loads(car: Car, row: Numbers) -> dict[str, float]:
    """Return `load_front` and `load_rear` of a record from the loads of the wheels."""
    by_axle: dict[str, list[float]] = {}
    for wheel in car.vehicle.composition.wheels:
        by_axle.setdefault(f"load_{wheel.axle}", []).append(row[f"tyre_load_{wheel.name}"])
    return {axle: float(np.sqrt(np.mean(np.square(loads)))) for axle, loads in by_axle.items()}


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run the cars on all roads, write the figure into the folder, and return the findings."""
    quick = options.quick
    if options.records is not None and options.records < 1:
        raise ConfigurationError(f"--records {options.records}: must be at least 1; an error needs at least 2")
    files: Mapping[str, str | Path] = CARS if runs.vehicle is None else {runs.car().vehicle.name: runs.vehicle}
    rides = Rides(
        {name: Car.load(vehicle_file(file), runs.overrides) for name, file in files.items()},
        engine=runs.engine,
        jobs=runs.jobs,
        records=options.records or (1 if quick else RECORDS),
        duration=QUICK_DURATION_S if quick else DURATION_S,
        folder=folder / "sweep",
    )
    roads, speeds = (ROADS[::2], SPEEDS[1:2]) if quick else (ROADS, SPEEDS)
    frictions = FRICTIONS[::4] if quick else FRICTIONS
    grid = [Ride(car=car, road=road, speed=speed) for car in rides.cars for road in roads for speed in speeds]
    varied = [Ride(car=car, road=road, friction=force) for car in rides.cars for road in roads for force in frictions]
    rides.compute([*grid, *varied])
    values = (RAIL, RAIL_WEIGHTED, SEAT_WEIGHTED, "seat_value", *rides.axles(), "slip_share")
    draw_friction(folder / "friction.png", rides, varied)
    claims = [
        claim
        for car in rides.cars
        for claim in (*friction_claims(rides, car, roads, frictions), *scaling_claim(rides, car, roads, frictions))
    ]
    return Findings(
        title="A car on four wheels on the road: class, speed, friction, occupant (beyond Bommer 2006)",
        claims=claims,
        tyres=rides.tyres([*grid, *varied]),
        unjudged={claim.name: QUICK_WHY for claim in claims} if quick else {},
        notes=[
            f"{rides.text([*grid, *varied])}; the same roads under every car. Isotropic tracks, wheelbase delay, "
            "contact patch of 0.1 m. ± is one standard error over the records; that of a ratio is over the ratios of "
            "the single records. A tyre whose lowest load is below 0 pulls.",
            "Class and speed, friction of the vehicle file:",
            class_table(rides, grid),
            f"Friction of every damper at {SPEED:g} km/h; % of the same car without friction on the same records:",
            friction_table(rides, varied),
            *([QUICK_NOTE] if quick else []),
        ],
        data={
            "rides": [asdict(ride) | {name: rides.mean(ride, name) for name in values} for ride in (*grid, *varied)],
            "engine": rides.engine,
            "records": rides.records,
            "duration_s": rides.duration,
        },
    )


def class_table(rides: Rides, shown: Sequence[Ride]) -> str:
    """Return every ride of the grid of classes and speeds as a Markdown table."""
    comfort = {
        RAIL: "rail, 2 to 50 Hz [m/s²]",
        RAIL_WEIGHTED: "rail, ISO 2631-1 [m/s²]",
        SEAT_WEIGHTED: "seat, ISO 2631-1 [m/s²]",
        "seat_value": "SEAT value [-]",
    }
    loads = {axle: f"dynamic over static load, {axle.removeprefix('load_')} [%]" for axle in rides.axles()}
    heads = ("car", "class", "speed [km/h]", *comfort.values(), *loads.values())
    rows = [
        (
            *(ride.car, ride.road, f"{ride.speed:g}", *(pair(rides, ride, name) for name in comfort)),
            *(f"{100.0 * rides.mean(ride, name):.1f}" for name in loads),
            *(f"{100.0 * rides.mean(ride, name):.0f}" for name in ("lowest_load", "slip_share")),
        )
        for ride in shown
    ]
    return markdown((*heads, "lowest load over static [%]", "slip of the dampers [%]"), rows)


def friction_table(rides: Rides, shown: Sequence[Ride]) -> str:
    """Return a table of every friction limit, relative to the car without friction on the same records."""
    names = (RAIL, RAIL_WEIGHTED, SEAT_WEIGHTED, *rides.axles())
    rows = []
    for ride in shown:
        ratios = [rides.ratio(ride, name) for name in names]
        cells = [f"{100.0 * mean:.1f} ± {number(100.0 * error, 1)}" if mean == mean else "" for mean, error in ratios]
        slip = f"{100.0 * rides.mean(ride, 'slip_share'):.0f}"
        rows.append((ride.car, ride.road, f"{ride.friction:g}", pair(rides, ride, RAIL), *cells, slip))
    heads = ("car", "class", "friction of every damper [N]", "rail, 2 to 50 Hz [m/s²]")
    return markdown((*heads, *(f"{name} [%]" for name in names), "slip of the dampers [%]"), rows)


def pair(rides: Rides, ride: Ride, name: str) -> str:
    """Return mean and standard error of a value as a text; empty where the car has none."""
    mean = rides.mean(ride, name)
    return "" if np.isnan(mean) else f"{mean:.3f} ± {number(standard_error(rides.each(ride, name)), 3)}"


def friction_claims(rides: Rides, car: str, roads: Sequence[str], frictions: Sequence[float]) -> list[Claim]:
    """Return the rows on friction: less comfort on a smooth road, less effect on a rough road, on four wheels.

    Roads from smooth to rough, frictions from 0 up [N].
    """

    def grown(road: str, name: str) -> list[float]:
        return [rides.ratio(Ride(car=car, road=road, friction=friction), name)[0] for friction in frictions]

    def percents(values: Sequence[float]) -> str:
        return ", ".join(f"{100.0 * value:.0f} %" for value in values)

    smooth, rough = grown(roads[0], RAIL), grown(roads[-1], RAIL)
    forces = ", ".join(f"{friction:g}" for friction in frictions)
    rows = [
        COMPARED.statement(
            f"{car}: comfort of the rail on the smoothest road (class {roads[0]}) against friction",
            "friction makes a smooth road uncomfortable (chapter 4, one corner on the shaker)",
            f"{percents(smooth)} of the value without friction at {forces} N",
            smooth[-1] > LARGE and all(b > a for a, b in itertools.pairwise(smooth[1:])),
            f"it must rise from step to step beyond the first, and by more than {100.0 * (LARGE - 1.0):.0f} % in all",
        ),
        COMPARED.statement(
            f"{car}: the same on the roughest road (class {roads[-1]})",
            "on a rough road friction matters less",
            f"{percents(rough)} at {forces} N",
            rough[-1] - 1.0 < 0.5 * (smooth[-1] - 1.0),
            "its growth must be less than half of that on the smoothest road",
        ),
    ]
    if rides.cars[car].vehicle.seated:
        seat = grown(roads[0], SEAT_WEIGHTED)
        rows.append(
            OWN_CHECK.statement(
                f"{car}: weighted vibration of the seat on class {roads[0]} against friction",
                "what the rail shows reaches the person",
                f"{percents(seat)} at {forces} N",
                seat[-1] > LARGE,
                f"it must rise by more than {100.0 * (LARGE - 1.0):.0f} % in all",
            )
        )
    return rows


def scaling_claim(rides: Rides, car: str, roads: Sequence[str], frictions: Sequence[float]) -> list[Claim]:
    """Return the row on equal relative comfort for twice the road amplitude and twice the friction.

    A car that is linear but for Coulomb friction has u = a U(F / a) on a road of the amplitude a; each class has twice
    the amplitude of the one before.
    """
    rough, smooth, factor = roads[-1], roads[0], CLASSES[roads[-1]] / CLASSES[roads[0]]
    pairs = [
        (Ride(car=car, road=smooth, friction=limit), Ride(car=car, road=rough, friction=other))
        for limit in frictions
        for other in frictions
        if limit > 0.0 and np.isclose(other, limit * factor**0.5)
    ]
    if not pairs:
        return []
    ratios = [[rides.ratio(ride, RAIL)[0] for ride in both] for both in pairs]
    texts = [
        ", ".join(
            f"{100.0 * value:.2f} % (class {ride.road}, {ride.friction:g} N)"
            for value, ride in zip(values, both, strict=True)
        )
        for values, both in zip(ratios, pairs, strict=True)
    ]
    return [
        OWN_CHECK.statement(
            f"{car}: what counts is friction over the amplitude of the road",
            "a car that is linear but for Coulomb friction has the same relative comfort at twice both",
            "; ".join(texts),
            all(abs(a / b - 1.0) < SCALED for a, b in ratios),
            f"within {100.0 * SCALED:g} %: exact in the reduced engine, in MuJoCo parts turn by finite angles",
        )
    ]


def draw_friction(path: Path, rides: Rides, shown: Sequence[Ride]) -> None:
    """Draw comfort at rail and seat and tyre load over the friction of all dampers, relative to no friction."""
    load, styles = rides.axles()[0], dict(zip(rides.cars, ("-", "--", ":"), strict=False))
    panels = {
        RAIL: "seat rail, unweighted, 2 to 50 Hz [%]",
        RAIL_WEIGHTED: "seat rail, ISO 2631-1 [%]",
        SEAT_WEIGHTED: "seat, ISO 2631-1 [%]",
        load: f"dynamic tyre load, {load.removeprefix('load_')} [%]",
    }
    named = ", ".join(f"{car} ({word})" for car, word in zip(styles, ("full", "dashed", "dotted"), strict=False))
    caption = (
        f"Over the Coulomb friction of every damper, relative to the same car without friction on the same records, at "
        f"{SPEED:g} km/h on roads of ISO 8608; {named}; {rides.text(shown)}; bars: two standard errors of the ratio "
        "over the records."
    )
    curves: dict[tuple[str, str], list[Ride]] = {}
    for ride in shown:
        curves.setdefault((ride.road, ride.car), []).append(ride)
    colours = dict(zip(dict.fromkeys(road for road, _ in curves), COLOURS, strict=False))
    with figure_file(path, (10.5, 7.0), "Friction of the dampers", caption) as figure:
        axes = figure.subplots(2, 2, sharex=True).ravel()
        for axis, (name, label) in zip(axes, panels.items(), strict=True):
            for (road, car), along in curves.items():
                values, errors = np.transpose([rides.ratio(ride, name) for ride in along])
                if np.isfinite(values).all():
                    look = {"color": colours[road], "linestyle": styles[car], "label": f"class {road}, {car}"}
                    bars, forces = 200.0 * np.nan_to_num(errors), [ride.friction for ride in along]
                    axis.errorbar(forces, 100.0 * values, yerr=bars, marker="o", markersize=3.5, capsize=2.5, **look)
            axis.axhline(100.0, color="#777777", linewidth=0.8)
            axis.set(ylabel=label, xlabel="Coulomb friction of every damper [N]")
        axes[0].legend(loc="upper left", fontsize=7)
        figure.align_ylabels(axes)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this study: the reduced engine by default, the number of records."""
    parser.set_defaults(engine="auto")
    records_help = f"roads for every point, {DURATION_S:g} s each; {RECORDS} by default"
    parser.add_argument("--records", type=int, metavar="N", help=records_help)


main = car_study("road", study, add_options)

if __name__ == "__main__":
    sys.exit(main())
