"""The quarter-car family of source 1: every figure of chapter 2 and the appendices, and its table of results."""

from __future__ import annotations

import argparse
import sys

from scenarios.output_folder import prepare_folder
from scenarios.quarter_car_claims import write_results
from scenarios.quarter_car_figures import FIGURES
from scenarios.quarter_car_runs import Runs
from scenarios.study_command import run_study, study_parser
from vehicle.parameters.quarter_car import PUBLISHED, load_quarter_car


def main(argv: list[str]) -> int:
    """Run the study with command-line arguments and return the exit code."""
    parser = study_parser(
        "quarter_car", "Quarter-car models with friction, engine, degressive damper and inclined strut"
    )
    parser.add_argument(
        "--figure", choices=list(FIGURES), metavar="NAME", help=f"one of {', '.join(FIGURES)}; no table"
    )
    return run_study(parser, _study, argv)


def _study(options: argparse.Namespace) -> str:
    runs = Runs(car=load_quarter_car(options.parameters or PUBLISHED), quick=options.quick)
    folder = prepare_folder(options.output, force=options.force)
    names = [options.figure] if options.figure else list(FIGURES)
    for name in names:
        FIGURES[name](runs, folder / f"figure_{name.replace('.', '_').lower()}.png")
    written = f"{len(names)} figure{'s' if len(names) > 1 else ''}"
    if not options.figure:
        write_results(runs, folder)
        written += ", results.md and results.json"
    return f"{folder}: {written}; {runs.seconds:.0f} s of solving"


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
