"""`python -m vehicle.mjcf`: write the generated MJCF files of a vehicle."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from vehicle.command_line import SET_HELP, Parser, parse_and_run

FOLDER = Path(__file__).resolve().parents[1] / "mjcf"
"""Folder of the files in the repository."""


def parser() -> Parser:
    """The options of the command."""
    found = Parser(prog="python -m vehicle.mjcf", description="Write car.xml, scene.xml and meshes of a vehicle.")
    found.add_argument("--vehicle", type=Path, metavar="FILE.toml", help="vehicle file; the car of source 1 by default")
    found.add_argument("--set", dest="overrides", action="append", default=[], metavar="PATH=VALUE", help=SET_HELP)
    found.add_argument("--output", type=Path, default=FOLDER, metavar="DIR", help="folder; mjcf/ by default")
    found.add_argument("--debug", action="store_true", help="show the traceback of an error")
    return found


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


def _job(options: argparse.Namespace) -> None:
    from vehicle.assembly.mjcf_files import mjcf_files, write_mjcf
    from vehicle.car import Car

    car = Car.load(options.vehicle, options.overrides)
    files = mjcf_files(car.vehicle, car.trimmed_body)
    write_mjcf(options.output, files)
    print(f"{options.output}: car.xml, scene.xml, {len(files) - 2} meshes")


if __name__ == "__main__":
    sys.exit(main())
