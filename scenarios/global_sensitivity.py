"""Global sensitivity of comfort to ten parameters: Sobol indices.

python -m scenarios.global_sensitivity [--runs N] [--road smooth|rough] [--jobs N] [--quick]
"""

from __future__ import annotations

import argparse
import sys
import time as clock
from dataclasses import asdict
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.charts import figure_file
from scenarios.claims import markdown
from scenarios.comfort_runs import chosen_engine
from scenarios.road_measure import RoadInput, RoadMeasure
from scenarios.signals.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from scenarios.study import study_parser
from vehicle.commands.command_line import ProgressLine, parse_and_run
from vehicle.commands.destination import study_folder_of
from vehicle.commands.options import VEHICLE_HELP, resume_options, setting_options
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.paths import unit_of
from vehicle.model.parameters.ranges import Range
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.output.folder import study_folder, write_json, write_text
from vehicle.signals.analysis.ride_comfort import MEANING, UNWEIGHTED, WEIGHTED
from vehicle.studies.sweeps.case import all_tyre_words
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.executors import executor_factory
from vehicle.studies.sweeps.indices import sobol_indices, sobol_sample
from vehicle.studies.sweeps.store import ROWS
from vehicle.studies.sweeps.sweep import sweep
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.sweeps.sweep_table import SweepTable

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

SOBOL_RUNS = 12288
"""1024 base points, times ten parameters and two."""


def parser() -> Parser:
    """Return the parser of the command."""
    study_options = study_parser("global_sensitivity", quick="a few short runs, to see that everything works")
    study_options.add_argument(
        "--runs", type=int, default=SOBOL_RUNS, metavar="N", help=f"at most this many runs; {SOBOL_RUNS} by default"
    )
    study_options.add_argument("--road", choices=sorted(ROAD_RMS), default="smooth", help="smooth by default")
    study_options.add_argument("--vehicle", type=vehicle_file, metavar="FILE.toml", help=VEHICLE_HELP)
    study_options.add_argument("--seed", type=int, default=2006, help="seed of the sample; 2006 by default")
    setting_options(study_options, SweepSettings, "engine")
    study_options.add_argument("--executor", metavar="WHERE", help="dask://host:port, or module:factory")
    resume_options(study_options)
    return study_options


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


def points_of(runs: int, seed: int) -> Matrix:
    """Return the points of at most `runs` runs; (points, parameters)."""
    base = 2 ** int(np.log2(max(runs // (len(RANGES) + 2), 2)))
    return sobol_sample(RANGES, base, seed=seed)


def _job(options: argparse.Namespace) -> None:
    runs, duration, lead = options.runs, DURATION_S, LEAD_S
    if options.quick:
        runs, duration, lead = 24, 2.0, 1.0
    if runs < len(RANGES) + 2:
        raise ConfigurationError(f"--runs {runs}: needed are at least {len(RANGES) + 2} for {len(RANGES)} parameters")
    make = None if options.executor is None else executor_factory(options.executor)
    points = points_of(runs, options.seed)
    wheel = load_vehicle(options.vehicle).shaker_wheel
    road = RoadInput(
        name=f"{options.road} road",
        rms=ROAD_RMS[options.road],
        seed=0,
        duration=duration,
        lead=lead,
        lower_band_edge=ROAD_EDGE_HZ,
        wheel=wheel,
    )
    engine = chosen_engine(options.engine)
    cases = table_cases(
        [parameter.path for parameter in RANGES], points.tolist(), [road], engine=engine, vehicle=options.vehicle
    )
    ranges = markdown(
        ("parameter", "from", "to", "unit", "why"),
        [
            (
                parameter.path,
                f"{parameter.low:g}",
                f"{parameter.high:g}",
                unit_of(load_vehicle(), parameter.path),
                parameter.reason,
            )
            for parameter in RANGES
        ],
    )
    output = study_folder_of(options, options.output, rows=(ROWS,))
    with study_folder(output, force=options.force, resume=options.resume, rows=(ROWS,)) as folder:
        started = clock.perf_counter()
        table = sweep(
            cases,
            RoadMeasure(lead=lead, wheel=wheel),
            executor=make,
            jobs=options.jobs,
            folder=folder,
            retry_failed=options.retry_failed,
            progress=ProgressLine("sensitivity", runs=len(cases)),
        )
        seconds = clock.perf_counter() - started
        caption = (
            f"comfort of the seat rail on the {options.road} road, RMS "
            f"{1e3 * road.rms:g} mm, {duration:g} s after {lead:g} s left out; {len(cases)} runs, tyres "
            f"{all_tyre_words(cases)}, engine {engine}, seed {options.seed}"
        )
        text = _evaluate(folder, table, caption)
        write_text(folder / "results.md", f"# Global sensitivity of comfort\n\n{caption}\n\n{text}\n\n{ranges}\n")
    print(
        f"{output}: {len(cases)} runs, {len(table.failed)} failed, tyres {all_tyre_words(cases)}, {seconds:.0f} s; "
        "results.md, results.json, figures"
    )


def _evaluate(folder: Path, table: SweepTable, caption: str) -> str:
    """Draw and write the result; returns its text."""
    content: dict[str, object] = {"caption": caption}
    texts = []
    for name in (UNWEIGHTED, WEIGHTED):
        comfort = table.column(name)
        if np.all(np.isnan(comfort)):
            raise SimulationError(f"every run failed; the first: {table.failed[0][1]}")
        figure = folder / ("indices.png" if name == UNWEIGHTED else f"{name}_indices.png")
        data, text = _sobol(figure, comfort, f"{name} {caption}")
        plain = {key: value.tolist() if isinstance(value, np.ndarray) else value for key, value in data.items()}
        content |= plain if name == UNWEIGHTED else {name: plain}
        spread = f"{name}: {np.nanmean(comfort):.3f} +- {np.nanstd(comfort):.3f} m/s2 (mean and scatter)."
        texts.append(f"## {name}: {MEANING[name]}\n\n{text}\n\n{spread}")
    write_json(folder / "results.json", content)
    return "\n\n".join(texts)


def _sobol(path: Path, comfort: Matrix, caption: str) -> tuple[dict[str, object], str]:
    """Draw first-order and total indices as bars with 95 % intervals, the largest on top.

    Returns:
        Entries of `results.json`, and the text of the table.
    """
    sobol = sobol_indices(RANGES, comfort)
    order = np.argsort(sobol.total)
    position = np.arange(len(order))
    with figure_file(
        path, (9.0, 5.6), "", f"{caption}; whiskers: 95 % intervals ({sobol.scramblings} scramblings)"
    ) as figure:
        axes = figure.add_subplot()
        for values, errors, shift, label, colour in (
            (sobol.first, sobol.first_error, -0.2, "S1, alone", COLOURS[0]),
            (sobol.total, sobol.total_error, 0.2, "ST, with all interactions", COLOURS[3]),
        ):
            axes.barh(position - shift, values[order], 0.38, xerr=errors[order], label=label, color=colour, capsize=2)
        axes.set_yticks(position, [_short(sobol.paths[i]) for i in order])
        axes.set_xlabel("share of the variance of the comfort value [-]")
        axes.axvline(0.0, color="#444444", linewidth=0.8)
        axes.legend(loc="lower right")
    left = (
        f" {sobol.left_out} of {sobol.base} base points have a failed run and do not count: the indices are those of "
        "the cars that could be run."
        if sobol.left_out
        else ""
    )
    columns = (sobol.first, sobol.first_error, sobol.total, sobol.total_error)
    rows = [[sobol.paths[i], *(f"{column[i]:.3f}" for column in columns)] for i in np.argsort(-sobol.total)]
    return asdict(sobol), (
        f"{markdown(('parameter', 'S1', '+-', 'ST', '+-'), rows)}\n\n"
        "S1: share of the variance that the parameter explains alone; ST: with all its interactions; +-: half "
        f"width of the 95 % interval, from {sobol.scramblings} independent scramblings of the Sobol sequence "
        "(jackknife, Student's t). From half the sample to the whole, no ST moved by more than "
        f"{sobol.drift:.3f}. Sum of S1 {np.sum(sobol.first):.2f}." + left
    )


def _short(path: str) -> str:
    return path.removeprefix("bushings.")


if __name__ == "__main__":
    sys.exit(main())
