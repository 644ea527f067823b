"""`python -m vehicle.mjcf`: write the generated MJCF files of a vehicle."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle.commands.command_line import Parser, command
from vehicle.commands.options import command_parser, message_options, vehicle_options


def parser() -> Parser:
    """The options of the command."""
    found = command_parser("mjcf", "Write car.xml, scene.xml and meshes of a vehicle.")
    vehicle_options(found)
    found.add_argument(
        "--output",
        type=Path,
        default=Path("mjcf"),
        metavar="DIR",
        help="folder of the model, where an older one is replaced; mjcf/ by default",
    )
    message_options(found)
    return found


def _job(options: argparse.Namespace) -> None:
    from vehicle.assembly.mjcf_files import mjcf_files, write_mjcf
    from vehicle.car import Car

    car = Car.load(options.vehicle, options.overrides)
    files = mjcf_files(car.vehicle, car.trimmed_body)
    write_mjcf(options.output, files)
    print(f"{options.output}: car.xml, scene.xml, {len(files) - 2} meshes")


main = command(parser, _job)
