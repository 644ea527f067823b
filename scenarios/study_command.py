"""Command lines of the scenarios: options that all have, and those of studies with one parameter file of their own."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from vehicle.command_line import Parser, parse_and_run


def scenario_parser(name: str, description: str, *, quick: str, jobs: str) -> argparse.ArgumentParser:
    """Parser with the options every scenario has.

    Args:
        name: module name; results go to runs/<name> without --output.
        description: one line.
        quick, jobs: what --quick and --jobs mean here.
    """
    parser = Parser(prog=f"python -m scenarios.{name}", description=description)
    parser.add_argument("--output", type=Path, default=Path("runs") / name, metavar="DIR", help="folder of the results")
    parser.add_argument("--quick", action="store_true", help=quick)
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help=jobs)
    parser.add_argument("--force", action="store_true", help="overwrite an existing folder")
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    return parser


def study_parser(name: str, description: str) -> argparse.ArgumentParser:
    """Parser of a study with one parameter file; arguments as of `scenario_parser`."""
    parser = scenario_parser(
        name,
        description,
        quick="fewer points on the curves",
        jobs="worker processes; these studies batch their runs in one process, so it changes nothing",
    )
    parser.add_argument(
        "--parameters", type=Path, metavar="FILE.toml", help="own parameters, named as the shipped ones"
    )
    return parser


def run_study(parser: argparse.ArgumentParser, study: Callable[[argparse.Namespace], str], argv: list[str]) -> int:
    """Run a study and turn its errors into one message and an exit code.

    Args:
        parser: of `study_parser`.
        study: does the work and returns the line to print.
        argv: arguments without the program name.

    Returns:
        Exit code, as of `run_command`.
    """
    return parse_and_run(parser, lambda options: print(study(options)), argv)
