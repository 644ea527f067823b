"""Passive against semi-active dampers of the complete car over speeds and road classes: comfort against tyre load.

python -m scenarios.semi_active [--output DIR] [--quick] [--jobs N] [--engine mujoco|reduced|auto] [--vehicle FILE.toml]
    [--set PATH=VALUE]...
"""

import argparse
import sys
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.car_runs import CarRuns, swept
from scenarios.charts import chart
from scenarios.claims import OWN_CHECK, Claim, Findings, markdown
from scenarios.comfort_runs import chosen_engine
from scenarios.study import QUICK_NOTE, car_study
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.semi_active_damper import LAWS, PASSIVE
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Run
from vehicle.runs.car.road import Road
from vehicle.runs.figures.chosen_figure import chosen_figure
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.spectra import band_rms
from vehicle.studies.sweeps.case import Case, all_tyre_words
from vehicle.studies.sweeps.case_table import Cases
from vehicle.studies.sweeps.measure import FigureMeasure, of_one
from vehicle.studies.sweeps.measure import measure_of as figures_of
from vehicle.studies.sweeps.sweep_inputs import inputs_of

CAR = "focus_road"
LEAD_S = 3.0
"""Left out at the beginning [s]: the road rises for 1 s, and the body's heave at 1.3 Hz dies out."""

SHOWN = ("B", 80.0)
"""Road class and speed [km/h] of the passive settings and of the delays."""

WHEEL_BAND = (7.0, 30.0)
"""Hop of the wheels [Hz]: about 11 Hz where the dampers slide, up to 28 Hz where they stick."""

FACTORS = (0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
"""Passive settings, as shares of the passive damper: the range of the semi-active one."""

DELAYS_MS = (0.0, 5.0, 10.0, 20.0, 40.0)

COMFORT, TYRE = "weighted_z", "tyre_load"
HEADS = {
    COMFORT: "weighted rail z [m/s2]",
    "unweighted": "unfiltered rail [m/s2]",
    TYRE: "dynamic / static tyre load [-]",
    "lowest_load": "lowest tyre load [-]",
    "hop": "that of the wheel hop [-]",
}
"""Values of `HopMeasure` and their heads in the table."""

CONTINUOUS = tuple(law for law in LAWS if not law.endswith("_on_off"))
MARKS = dict(zip(CONTINUOUS, zip(COLOURS[1:], "os^", strict=False), strict=False))


@dataclass(frozen=True, kw_only=True, slots=True)
class Setting:
    """A damper on a road: law, class, speed [km/h], delay [ms], share of the passive damper."""

    law: str = PASSIVE
    road: str = SHOWN[0]
    speed: float = SHOWN[1]
    delay: float = 0.0
    factor: float = 1.0

    def changes(self, vehicle: Vehicle) -> list[str]:
        """Return the overrides that set all dampers of a vehicle to this setting."""
        overrides = []
        for path in dict.fromkeys(damper.path for damper in vehicle.composition.dampers):
            law = next(damper.law for damper in vehicle.composition.dampers if damper.path == path)
            if law.control is None or law.viscous is None:
                raise ConfigurationError(f"{path}.control: missing; the study needs it and {path}.viscous")
            overrides += [f"{path}.control.law={self.law}", f"{path}.control.delay={1e-3 * self.delay!r}"]
            overrides += [f"{path}.viscous={self.factor * law.viscous!r}"] if self.factor != 1.0 else []
        return overrides


@dataclass(frozen=True, kw_only=True, slots=True)
class HopMeasure:
    """Comfort at the seat rail and dynamic tyre load of a run; `hop` is the load within `WHEEL_BAND`, RMS of all tyres.

    Attributes:
        ride: measure of the other values, see `vehicle.studies.optimisation.ride`.
    """

    ride: FigureMeasure

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        return self.ride.channels

    @property
    def timestep(self) -> float:
        """Return the maximum step of the reduced engine [s]."""
        return self.ride.timestep

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value."""
        return {**self.ride.units, "hop": "-"}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the values of r runs; (r,) each."""
        kept = slice(round(LEAD_S / runs.timestep), None)
        bands = [
            band_rms(runs.timestep, runs[f"tyre_{wheel}_force_z"][:, kept] / runs.tyre_load[wheel][:, None], WHEEL_BAND)
            for wheel in runs.tyre_load
        ]
        return {**self.ride.of(runs), "hop": np.sqrt(np.mean(np.square(bands), axis=0))}


def measure_of(vehicle: Vehicle) -> HopMeasure:
    """Return the measure of a vehicle."""
    figures = {name: chosen_figure(name, vehicle) for name in tuple(HEADS)[:-1]}
    ride = figures_of(vehicle, figures, LEAD_S, errors=False)
    assert isinstance(ride, FigureMeasure)
    return HopMeasure(ride=replace(ride, timestep=5e-4))


Numbers = Mapping[str, float]
Points = Mapping[Setting, Numbers]


def settings(quick: bool) -> list[Setting]:
    """Return all settings of the study: laws over speeds and roads, passive settings, delays."""
    roads, speeds = ((SHOWN[0],), (SHOWN[1],)) if quick else (("A", "B", "C"), (50.0, 80.0, 120.0))
    laws = (PASSIVE, *LAWS)
    points = [Setting(law=law, road=road, speed=speed) for road in roads for speed in speeds for law in laws]
    points += [Setting(factor=factor) for factor in FACTORS[:: 2 if quick else 1]]
    points += [Setting(law=law, delay=delay) for law in CONTINUOUS for delay in DELAYS_MS[:: 2 if quick else 1]]
    return list(dict.fromkeys(points))


def computed(runs: CarRuns, chosen: Iterable[Setting], duration: float, engine: str) -> dict[Setting, Numbers]:
    """Run all settings and return setting to values."""
    listed = list(chosen)
    cases = cases_of(runs, listed, duration, engine)
    return dict(zip(listed, swept(cases, measure_of(runs.car().vehicle), jobs=runs.jobs), strict=True))


def cases_of(runs: CarRuns, chosen: Iterable[Setting], duration: float, engine: str) -> list[Case]:
    """Return the case of each setting."""
    car = runs.car()
    cases: list[Case] = []
    for setting in chosen:
        inputs = inputs_of(car, Road(setting.road, setting.speed, duration=duration))
        changes = tuple(setting.changes(car.vehicle))
        cases += Cases([changes], inputs, engine=engine, vehicle=runs.vehicle, fixed=runs.overrides)
    return cases


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run all settings, write the figures into the folder, and return the findings."""
    engine, duration = chosen_engine(options.engine), 20.0 if options.quick else 60.0
    points = computed(runs, settings(options.quick), duration, engine)
    name, tyres = runs.car().vehicle.name, all_tyre_words(cases_of(runs, points, duration, engine))
    trade_off(folder / "trade_off.png", points, f"{name}, {duration:g} s of road, tyres {tyres}, engine {engine}")
    checks = [] if options.quick or engine == "mujoco" else [engines(runs, points, duration)]
    changed = f", changed: {', '.join(runs.overrides)}" if runs.overrides else ""
    conditions = f"Made with {name}{changed}; engine {engine}, {duration:g} s of each road, {LEAD_S:g} s left out."
    return Findings(
        title="Semi-active dampers on the complete car: comfort against dynamic tyre load",
        claims=[*claims(points), *checks],
        tyres=tyres,
        notes=[table_of(points), words(points), conditions, *([QUICK_NOTE] if options.quick else [])],
        data={"points": [asdict(setting) | dict(numbers) for setting, numbers in points.items()]},
    )


def engines(runs: CarRuns, points: Points, duration: float) -> Claim:
    """Return the row that compares the reduced engine with MuJoCo on one road."""
    both = [Setting(), Setting(law="skyhook")]
    stepped = computed(runs, both, duration, "mujoco")
    gaps = {f"{setting.law}, {name}": points[setting][name] / stepped[setting][name] - 1.0 for setting in both
            for name in (COMFORT, TYRE)}  # fmt: skip
    text = ", ".join(f"{name} {100.0 * gap:+.2f} %" for name, gap in gaps.items())
    why = "1.5 %: tyre forces of MuJoCo are 0.8 % off at its step of 1 ms, and vanish with it"
    holds = max(map(abs, gaps.values())) < 0.015
    return OWN_CHECK.statement("reduced engine against MuJoCo", "same car", text, holds, why)


def claims(points: Points) -> list[Claim]:
    """Return the rows on the purposes of the control laws, and on the effect of a delay.

    Groundhook is designed against wheel hop (Ahmadian 1997). It reduces the damping of the body, so the
    total load may still rise: `words` reports both.
    """
    passive, rows = points[Setting()], []
    for law, name, quantity in (
        ("skyhook", COMFORT, "weighted acceleration of the rail"),
        ("groundhook", "hop", f"dynamic tyre load of the wheel hop, {WHEEL_BAND[0]:g} to {WHEEL_BAND[1]:g} Hz"),
    ):
        ratio = points[Setting(law=law)][name] / passive[name]
        best = min(points[setting][name] for setting in points if setting == Setting(factor=setting.factor))
        gain = 100.0 * (best / passive[name] - 1.0)
        late = points[Setting(law=law, delay=DELAYS_MS[-1])][name] / passive[name]
        rows.append(
            OWN_CHECK.statement(
                f"{law} against the passive damper: {quantity}, road B at 80 km/h",
                "less",
                f"{100.0 * (ratio - 1.0):+.1f} %, with a delay of {DELAYS_MS[-1]:g} ms {100.0 * (late - 1.0):+.1f} %",
                ratio < 1.0,
                f"what the law is made for, without delay; best passive setting {gain:+.1f} %",
            )
        )
    return rows


def words(points: Points) -> str:
    """Return a text on the part of the tyre load that groundhook reduces."""
    hooked, passive = (points[Setting(law=law)] for law in ("groundhook", PASSIVE))
    hop = 100.0 * (hooked["hop"] / passive["hop"] - 1.0)
    remainder = 100.0 * (
        np.sqrt((hooked[TYRE] ** 2 - hooked["hop"] ** 2) / (passive[TYRE] ** 2 - passive["hop"] ** 2)) - 1.0
    )
    whole = 100.0 * (hooked[TYRE] / passive[TYRE] - 1.0)
    return (
        f"Groundhook changes the tyre load of the wheel hop ({WHEEL_BAND[0]:g} to {WHEEL_BAND[1]:g} Hz) by {hop:+.1f} "
        f"%, the rest by {remainder:+.1f} %, the whole by {whole:+.1f} %. It damps the wheel against ground at rest "
        "and leaves the body to swing: a quarter car with an ideal groundhook does the same (docs/theory/elements.md, "
        "semi-active dampers)."
    )


def table_of(points: Points) -> str:
    """Return a table of all runs."""
    rows = [
        (
            setting.road,
            f"{setting.speed:g}",
            setting.law,
            f"{setting.factor:g}",
            f"{setting.delay:g}",
            *(f"{n[name]:.4g}" for name in HEADS),
        )
        for setting, n in points.items()
    ]
    heads = ("road", "speed [km/h]", "law", "passive factor [-]", "delay [ms]", *HEADS.values())
    return markdown(heads, rows)


def trade_off(path: Path, points: Points, description: str) -> None:
    """Write comfort against tyre load: a mark for each law, on the shown road the line of passive settings."""
    roads = list(dict.fromkeys((setting.road, setting.speed) for setting in points))
    columns = min(len(roads), 3)
    caption = (
        "Lower left is better. Circle: skyhook, square: groundhook, triangle: hybrid, open where on-off; black: "
        f"passive, on road {SHOWN[0]} at {SHOWN[1]:g} km/h also with its constant times the number beside it. "
        f"{description}."
    )
    size = (4.6 * max(columns, 2), 4.0 * -(-len(roads) // columns) + 1.2)
    with chart(path, caption, rows=-(-len(roads) // columns), columns=columns, size=size) as axes:
        for axis, (road, speed) in zip(axes, roads, strict=False):
            road_points = {
                setting: n
                for setting, n in points.items()
                if (setting.road, setting.speed, setting.delay) == (road, speed, 0.0)
            }
            passive = sorted(
                (setting.factor, n[COMFORT], n[TYRE]) for setting, n in road_points.items() if setting.law == PASSIVE
            )
            axis.plot([n[1] for n in passive], [n[2] for n in passive], "k.-", linewidth=1.0, label=PASSIVE)
            for factor, x, y in passive:
                axis.annotate(f"{factor:g}", (x, y), xytext=(3, 3), textcoords="offset points", fontsize=7)
            for setting, n in road_points.items():
                if setting.law != PASSIVE:
                    _mark(axis, setting.law, n[COMFORT], n[TYRE])
            axis.set(xlabel="weighted rail acceleration z [m/s²]", ylabel="dynamic / static tyre load, RMS [-]")
            axis.set_title(f"road {road}, {speed:g} km/h")
        axes[0].legend(fontsize=7)


def _mark(axis: Any, law: str, x: float, y: float) -> None:
    colour, mark = MARKS[law.removesuffix("_on_off")]
    face, label = ("none" if law.endswith("_on_off") else colour), law.replace("_on_off", ", on-off")
    axis.plot([x], [y], mark, color=colour, markerfacecolor=face, label=label)


main = car_study("semi_active", study)
main.parser.set_defaults(vehicle=vehicle_file(Path(CAR)), engine="auto")


if __name__ == "__main__":
    sys.exit(main())
