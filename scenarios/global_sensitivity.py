"""Global sensitivity of comfort to ten parameters: Sobol indices.

python -m scenarios.global_sensitivity [--road smooth|rough] [--jobs N] [--quick] [--engine auto|reduced|mujoco]

`python -m vehicle sweep --sobol N` gives the indices of any car and parameters.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.car_runs import CarRuns
from scenarios.charts import figure_file
from scenarios.claims import Findings, markdown
from scenarios.comfort_runs import chosen_engine
from scenarios.road_measure import RoadInput, RoadMeasure
from scenarios.signals.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from scenarios.study import QUICK_NOTE, car_study
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.model.parameters.paths import unit_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.analysis.ride_comfort import MEANING, UNWEIGHTED, WEIGHTED
from vehicle.studies.sweeps.case import all_tyre_words
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.indices import LEAST_BASE, SobolIndices, sobol_indices, sobol_sample
from vehicle.studies.sweeps.sobol_sweep import index_lines
from vehicle.studies.sweeps.sweep import sweep

Matrix = npt.NDArray[np.float64]

HALF = "half to one and a half times the final set of the source"
TENTH = "+-20 %: another spring is a development decision of that size"

RANGES = (
    Range(path="damper.coulomb_friction", low=62.5, high=250.0, reason="what the source varied (figure 4.4)"),
    Range(path="damper.viscous", low=1125.0, high=3375.0, reason=HALF),
    Range(
        path="bushings.suspension_mount.stiffness.z",
        low=3.5e5,
        high=14e5,
        reason="what the source varied (figure 4.12)",
    ),
    Range(
        path="bushings.suspension_mount.damping.z", low=0.0, high=2000.0, reason="what the source varied (figure 4.8)"
    ),
    Range(path="main_spring.stiffness", low=2.0e4, high=3.0e4, reason=TENTH),
    Range(path="stabilizer.torsional_stiffness", low=2.5e3, high=7.5e3, reason=HALF),
    Range(path="bushings.tyre.stiffness.z", low=2.0e5, high=3.0e5, reason="+-20 %: pressure and carcass"),
    Range(path="bushings.tyre.damping.z", low=0.0, high=800.0, reason="none to twice the final set"),
    Range(path="bushings.hydromount.stiffness.z", low=2.0e5, high=6.0e5, reason=HALF),
    Range(
        path="body.frequency_scale",
        low=0.8,
        high=1.25,
        reason="body modes 20 % lower to 25 % higher: 0.64 to 1.56 times as stiff",
    ),
)
"""Ten parameters; each varies evenly between its limits, independent of the others."""

DURATION_S = 20.0
"""Evaluated part of each run [s]; with the lead every run is 30 s."""

BASE, QUICK_PARAMETERS = 1024, 2
"""Base points, each of which takes as many runs as there are parameters, and two; and the parameters of a quick study,
which takes the fewest base points that have indices."""

SEED = 2006
"""Seed of the sample."""


def points_of(base: int, ranges: Sequence[Range] = RANGES) -> Matrix:
    """Return the points of the runs of some base points; (base (parameters + 2), parameters)."""
    return sobol_sample(ranges, base, seed=SEED)


def study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Run the sample, draw the indices of both comfort values into the folder, and return the findings."""
    duration, lead = (2.0, 1.0) if options.quick else (DURATION_S, LEAD_S)
    ranges, base = (RANGES[:QUICK_PARAMETERS], LEAST_BASE) if options.quick else (RANGES, BASE)
    points = points_of(base, ranges)
    road = RoadInput(
        name=f"{options.road} road",
        rms=ROAD_RMS[options.road],
        seed=0,
        duration=duration,
        lead=lead,
        lower_band_edge=ROAD_EDGE_HZ,
        wheel=runs.wheel,
    )
    engine, paths = chosen_engine(options.engine), [parameter.path for parameter in ranges]
    cases = table_cases(paths, points.tolist(), [road], engine=engine, vehicle=runs.vehicle, fixed=runs.overrides)
    (folder / "sweep").mkdir(exist_ok=True)
    table = sweep(cases, RoadMeasure(lead=lead, wheel=runs.wheel), jobs=runs.jobs, folder=folder / "sweep")
    caption = (
        f"comfort of the seat rail on the {options.road} road, RMS {1e3 * road.rms:g} mm, {duration:g} s after "
        f"{lead:g} s left out; {len(cases)} runs, tyres {all_tyre_words(cases)}, engine {engine}, seed {SEED}"
    )
    notes, indices = [f"{caption[0].upper()}{caption[1:]}; {len(table.failed)} failed."], {}
    for name, file in ((UNWEIGHTED, "indices.png"), (WEIGHTED, "weighted_indices.png")):
        comfort = table.column(name)
        indices[name] = sobol_indices(ranges, comfort)
        draw_indices(folder / file, indices[name], f"{name} {caption}")
        notes.append(
            f"{name}, {MEANING[name]}: {np.nanmean(comfort):.3f} +- {np.nanstd(comfort):.3f} m/s2 (mean and scatter). "
            f"Sum of S1 {np.sum(indices[name].first):.2f}; from half the sample to the whole, no ST moved by more than "
            f"{indices[name].drift:.3f}."
        )
        notes.append("\n".join(["```text", *index_lines({name: indices[name]}), "```"]))
    return Findings(
        title="Global sensitivity of comfort",
        claims=[],
        tyres=all_tyre_words(cases),
        notes=[*notes, range_table(runs.car().vehicle, ranges), *([QUICK_NOTE] if options.quick else [])],
        data={"caption": caption, **{name: plain(each) for name, each in indices.items()}},
    )


def range_table(vehicle: Vehicle, ranges: Sequence[Range]) -> str:
    """Return the limits of the parameters as a Markdown table."""
    rows = [(each.path, f"{each.low:g}", f"{each.high:g}", unit_of(vehicle, each.path), each.reason) for each in ranges]
    return markdown(("parameter", "from", "to", "unit", "why"), rows)


def plain(indices: SobolIndices) -> dict[str, object]:
    """Return the indices as plain data."""
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in asdict(indices).items()}


def draw_indices(path: Path, indices: SobolIndices, caption: str) -> None:
    """Draw first-order and total indices as bars with 95 % intervals, the largest on top."""
    order = np.argsort(indices.total)
    position = np.arange(len(order))
    whiskers = f"whiskers: 95 % intervals ({indices.scramblings} scramblings)"
    with figure_file(path, (9.0, 5.6), "", f"{caption}; {whiskers}") as figure:
        axes = figure.add_subplot()
        for values, errors, shift, label, colour in (
            (indices.first, indices.first_error, -0.2, "S1, alone", COLOURS[0]),
            (indices.total, indices.total_error, 0.2, "ST, with all interactions", COLOURS[3]),
        ):
            axes.barh(position - shift, values[order], 0.38, xerr=errors[order], label=label, color=colour, capsize=2)
        axes.set_yticks(position, [indices.paths[i].removeprefix("bushings.") for i in order])
        axes.set_xlabel("share of the variance of the comfort value [-]")
        axes.axvline(0.0, color="#444444", linewidth=0.8)
        axes.legend(loc="lower right")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of this study: the reduced engine by default, the road."""
    parser.set_defaults(engine="auto")
    parser.add_argument("--road", choices=sorted(ROAD_RMS), default="smooth", help="smooth by default")


main = car_study("global_sensitivity", study, add_options)


if __name__ == "__main__":
    sys.exit(main())
