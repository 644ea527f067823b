"""Which parameters decide comfort when all of them vary at once: Sobol indices or Morris effects on the smooth road.

python -m scenarios.global_sensitivity [--method sobol|morris|lhs] [--runs N] [--road smooth|rough] [--jobs N] [--quick]
"""

from __future__ import annotations

import argparse
import sys
import textwrap
import time as clock
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from scenarios.comfort_observation import chosen_engine
from scenarios.output_folder import write_text
from vehicle.commands.command_line import Parser, ProgressLine, parse_and_run
from vehicle.commands.options import engine_option, jobs_option, message_options, output_options
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.excitation.exact_road import LEAD_S, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.output.folder import write_json, write_whole
from vehicle.parameters.paths import unit_of
from vehicle.parameters.ranges import Range
from vehicle.parameters.vehicle import Vehicle
from vehicle.rendering.figure import COLOURS, saved_figure
from vehicle.sweeps.case import Case, table_cases
from vehicle.sweeps.executors import executor_factory
from vehicle.sweeps.indices import (
    MorrisEffects,
    SobolIndices,
    morris_effects,
    morris_sample,
    sobol_indices,
    sobol_sample,
)
from vehicle.sweeps.road import RoadInput, RoadMeasure
from vehicle.sweeps.sample import sample
from vehicle.sweeps.store import sweep_folder
from vehicle.sweeps.sweep import sweep
from vehicle.sweeps.table import SweepTable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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

MORRIS_RUNS = 440
"""40 trajectories of ten steps."""

METHODS = ("sobol", "morris", "lhs")


def parser() -> Parser:
    """The options of the command."""
    found = Parser(
        prog="python -m scenarios.global_sensitivity",
        description="Sobol indices, Morris effects or a Latin hypercube of the comfort value over ten parameters.",
    )
    found.add_argument("--method", choices=METHODS, default="sobol", help="sobol by default")
    found.add_argument(
        "--runs", type=int, metavar="N", help=f"about this many runs; {SOBOL_RUNS} (sobol), {MORRIS_RUNS} (others)"
    )
    found.add_argument("--road", choices=sorted(ROAD_RMS), default="smooth", help="smooth by default")
    found.add_argument("--vehicle", type=Path, metavar="FILE.toml", help="vehicle file; the car of source 1 by default")
    found.add_argument("--seed", type=int, default=2006, help="seed of the sample; 2006 by default")
    engine_option(found, "auto")
    jobs_option(found)
    found.add_argument("--executor", metavar="WHERE", help="dask://host:port, or module:factory")
    output_options(found, Path("runs/global_sensitivity"))
    found.add_argument("--quick", action="store_true", help="a few short runs, to see that everything works")
    found.add_argument("--resume", action="store_true", help="go on in that folder; finished runs are kept")
    found.add_argument("--retry-failed", action="store_true", help="with --resume: run failed rows again")
    message_options(found)
    return found


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


def points_of(method: str, runs: int, seed: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Points of a method with at most about `runs` runs; (points, parameters)."""
    size = len(RANGES)
    if method == "sobol":
        base = 2 ** int(np.log2(max(runs // (size + 2), 2)))
        return sobol_sample(RANGES, base, seed=seed)
    if method == "morris":
        return morris_sample(RANGES, max(runs // (size + 1), 2), seed=seed)
    return sample(RANGES, runs, method="lhs", seed=seed)


def _job(options: argparse.Namespace) -> None:
    runs = options.runs or (SOBOL_RUNS if options.method == "sobol" else MORRIS_RUNS)
    duration, lead = DURATION_S, LEAD_S
    if options.quick:
        runs, duration, lead = 24 if options.method == "sobol" else 22, 2.0, 1.0
    if runs < len(RANGES) + 2:
        raise ConfigurationError(f"--runs {runs}: needed are at least {len(RANGES) + 2} for {len(RANGES)} parameters")
    make = executor_factory(options.executor, options.jobs)
    points = points_of(options.method, runs, options.seed)
    road = RoadInput(
        name=f"{options.road} road",
        rms=ROAD_RMS[options.road],
        seed=0,
        duration=duration,
        lead=lead,
        lower_band_edge=ROAD_EDGE_HZ,
    )
    engine = chosen_engine(options.engine)
    cases: list[Case] = table_cases(
        [one.path for one in RANGES], points.tolist(), [road], engine=engine, vehicle=options.vehicle
    )
    folder = sweep_folder(options.output, resume=options.resume, force=options.force)
    started = clock.perf_counter()
    table = sweep(
        cases,
        RoadMeasure(lead=lead),
        executor=make,
        folder=folder,
        retry_failed=options.retry_failed,
        progress=ProgressLine("sensitivity"),
    )
    seconds = clock.perf_counter() - started
    caption = (
        f"comfort value (unfiltered RMS of the seat rail, 2 to 50 Hz) on the {options.road} road, RMS "
        f"{1e3 * road.rms:g} mm, {duration:g} s after {lead:g} s left out; {len(cases)} runs, engine {engine}, "
        f"seed {options.seed}"
    )
    text = _evaluate(options.method, folder, table, points, caption, options.seed)
    write_text(folder / "results.md", f"# Global sensitivity of comfort\n\n{caption}\n\n{text}\n\n{_ranges_text()}\n")
    print(
        f"{folder}: {len(cases)} runs, {len(table.failed)} failed, {seconds:.0f} s; results.md, results.json, figures"
    )


def _evaluate(
    method: str,
    folder: Path,
    table: SweepTable,
    points: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    caption: str,
    seed: int,
) -> str:
    """Draw and write the result of a method; returns the text of its table."""
    comfort = table.column("comfort")
    if np.all(np.isnan(comfort)):
        raise SimulationError(f"every run failed; the first: {table.failed[0][1]}")
    spread = f"Comfort value {np.nanmean(comfort):.3f} +- {np.nanstd(comfort):.3f} m/s2 (mean and scatter)."
    if method == "sobol":
        found = sobol_indices(RANGES, comfort, seed=seed)
        draw_sobol(folder / "indices.png", found, caption)
        write_json(folder / "results.json", {"caption": caption, **_plain(asdict(found))})
        order = np.argsort(-found.total)
        lines = ["| parameter | S1 | +- | ST | +- |", "|---|---|---|---|---|"]
        lines += [
            f"| {found.paths[i]} | {found.first[i]:.3f} | {found.first_error[i]:.3f} | {found.total[i]:.3f} "
            f"| {found.total_error[i]:.3f} |"
            for i in order
        ]
        lines += [
            "",
            "S1: share of the variance that the parameter explains alone; ST: with all its interactions; +-: half "
            f"width of the 95 % interval (bootstrap). From half the sample to the whole, no ST moved by more than "
            f"{found.drift:.3f}. Sum of S1 {np.sum(found.first):.2f}.",
        ]
    elif method == "morris":
        effects = morris_effects(RANGES, points, comfort, seed=seed)
        draw_morris(folder / "effects.png", effects, caption)
        write_json(folder / "results.json", {"caption": caption, **_plain(asdict(effects))})
        lines = ["| parameter | mu* [m/s2] | +- | mu [m/s2] | sigma [m/s2] |", "|---|---|---|---|---|"]
        lines += [
            f"| {effects.paths[i]} | {effects.mean_size[i]:.4f} | {effects.mean_size_error[i]:.4f} "
            f"| {effects.mean[i]:+.4f} | {effects.scatter[i]:.4f} |"
            for i in np.argsort(-effects.mean_size)
        ]
        lines += ["", "Change of the comfort value over the whole range of a parameter: mean size, mean, scatter."]
    else:
        draw_scatter(folder / "scatter.png", RANGES, points, comfort, caption)
        write_json(
            folder / "results.json",
            {
                "caption": caption,
                "points": points.tolist(),
                "comfort": [None if np.isnan(value) else value for value in comfort.tolist()],
            },
        )
        lines = ["Every run is a row of `table.csv`."]
    return "\n".join([*lines, "", spread])


def _plain(content: dict[str, object]) -> dict[str, object]:
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in content.items()}


def _ranges_text() -> str:
    lines = ["| parameter | from | to | unit | why |", "|---|---|---|---|---|"]
    lines += [
        f"| {one.path} | {one.low:g} | {one.high:g} | {unit_of(Vehicle, one.path)} | {one.reason} |" for one in RANGES
    ]
    return "\n".join(lines)


def draw_sobol(path: Path, found: SobolIndices, caption: str) -> None:
    """Bars of first-order and total indices with their 95 % intervals, the largest on top."""
    order = np.argsort(found.total)
    place = np.arange(len(order))

    def draw(temporary: Path) -> None:
        with saved_figure(temporary, (9.0, 5.6)) as figure:
            axes = figure.add_subplot()
            for values, errors, shift, label, colour in (
                (found.first, found.first_error, -0.2, "S1, alone", COLOURS[0]),
                (found.total, found.total_error, 0.2, "ST, with all interactions", COLOURS[3]),
            ):
                axes.barh(place - shift, values[order], 0.38, xerr=errors[order], label=label, color=colour, capsize=2)
            axes.set_yticks(place, [_short(found.paths[i]) for i in order])
            axes.set_xlabel("share of the variance of the comfort value [-]")
            axes.axvline(0.0, color="#444444", linewidth=0.8)
            axes.grid(axis="x", alpha=0.3)
            axes.legend(loc="lower right")
            _caption(figure, caption + "; whiskers: 95 % intervals (bootstrap)")

    write_whole(path, draw)


def draw_morris(path: Path, found: MorrisEffects, caption: str) -> None:
    """Scatter of the elementary effects over their mean size."""

    def draw(temporary: Path) -> None:
        with saved_figure(temporary, (9.0, 5.6)) as figure:
            axes = figure.add_subplot()
            axes.errorbar(
                found.mean_size, found.scatter, xerr=found.mean_size_error, fmt="o", color=COLOURS[0], capsize=2
            )
            for name, x, y in zip(found.paths, found.mean_size, found.scatter, strict=True):
                axes.annotate(_short(name), (x, y), xytext=(6, 4), textcoords="offset points", fontsize=8)
            axes.set_xlabel("mu*, mean size of the effect over the whole range [m/s2]")
            axes.set_ylabel("sigma, scatter of the effect: interaction and curvature [m/s2]")
            axes.margins(0.15)
            axes.grid(alpha=0.3)
            _caption(figure, caption + "; whiskers: 95 % intervals (bootstrap)")

    write_whole(path, draw)


def draw_scatter(
    path: Path, ranges: Sequence[Range], points: npt.NDArray[np.float64], comfort: npt.NDArray[np.float64], caption: str
) -> None:
    """Comfort value of every run over each parameter."""

    def draw(temporary: Path) -> None:
        columns = 5
        rows = -(-len(ranges) // columns)
        with saved_figure(temporary, (13.0, 2.8 * rows + 0.6)) as figure:
            panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
            for index, one in enumerate(ranges):
                axes = panels[index // columns][index % columns]
                axes.plot(points[:, index], comfort, ".", markersize=3, color=COLOURS[0])
                axes.set_xlabel(f"{_short(one.path)} [{unit_of(Vehicle, one.path)}]", fontsize=7)
                axes.tick_params(labelsize=7)
                axes.grid(alpha=0.3)
            for row in panels:
                row[0].set_ylabel("comfort value [m/s2]", fontsize=8)
            _caption(figure, caption)

    write_whole(path, draw)


def _short(path: str) -> str:
    return path.removeprefix("bushings.")


def _caption(figure: Figure, text: str) -> None:
    """Caption below everything, as the layout's own label."""
    figure.supxlabel(textwrap.fill(text, 120), fontsize=7, color="#444444", x=0.01, ha="left")


if __name__ == "__main__":
    sys.exit(main())
