"""`python -m vehicle mjcf`: write the generated MJCF files of a vehicle."""

import argparse
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.destination import output_folder_of
from vehicle.commands.options import command_parser, message_options, output_options, vehicle_options
from vehicle.commands.parser import Parser


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("mjcf", "Write a car as a MuJoCo model: car.xml, scene.xml and meshes.")
    vehicle_options(parser)
    output_options(parser, Path("mjcf"))
    message_options(parser)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.model.assembly.mjcf_files import mjcf_files
    from vehicle.runs.car import Car
    from vehicle.runs.output.model_files import write_mjcf

    car = Car.load(options.vehicle, options.overrides)
    files = mjcf_files(car.vehicle, car.trimmed_body)
    # With --force the files of others in the folder stay, so that it is not replaced as a whole.
    folder = options.output
    if not (options.force and folder.is_dir()):
        folder = output_folder_of(options, options.output)
    write_mjcf(folder, files)
    print(f"{folder}: car.xml, scene.xml, {len(files) - 2} meshes")


main = command(parser, _job)
