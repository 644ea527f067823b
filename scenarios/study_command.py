"""Command line shared by the studies that read one parameter file and write figures and results."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from vehicle.errors import VehicleError

INTERRUPTED = 130


def study_parser(name: str, description: str) -> argparse.ArgumentParser:
    """Parser with the options every study has.

    Args:
        name: module name; results go to runs/<name> without --output.
        description: one line.
    """
    parser = argparse.ArgumentParser(prog=f"python -m scenarios.{name}", description=description)
    parser.add_argument("--output", type=Path, default=Path("runs") / name, metavar="DIR", help="folder of the results")
    parser.add_argument(
        "--parameters", type=Path, metavar="FILE.toml", help="own parameters, named as the shipped ones"
    )
    parser.add_argument("--quick", action="store_true", help="fewer points on the curves")
    parser.add_argument("--force", action="store_true", help="overwrite an existing folder")
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    return parser


def run_study(parser: argparse.ArgumentParser, study: Callable[[argparse.Namespace], str], argv: list[str]) -> int:
    """Run a study and turn its errors into one message and an exit code.

    Args:
        parser: of `study_parser`.
        study: does the work and returns the line to print.
        argv: arguments without the program name.

    Returns:
        Exit code: 0, that of the `VehicleError`, or 130 when interrupted.
    """
    options = parser.parse_args(argv)
    try:
        print(study(options))
    except VehicleError as error:
        if options.debug:
            raise
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        print("interrupted; the results are incomplete", file=sys.stderr)
        return INTERRUPTED
    return 0
