"""`python -m vehicle mjcf`: write the generated MJCF files of a vehicle."""

from dataclasses import dataclass
from pathlib import Path

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import command_parser, message_options, output_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part

FOLDER = Path("mjcf")


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("mjcf", "Write a car as a MuJoCo model: car.xml, scene.xml and meshes.")
    vehicle_options(parser)
    output_options(parser, FOLDER)
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class MjcfSettings(Settings):
    """Car, and the folder of its files."""

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)


def _job(settings: MjcfSettings, console: Console) -> None:
    from vehicle.model.assembly.mjcf_files import mjcf_files
    from vehicle.runs.car import Car
    from vehicle.runs.output.model_files import write_mjcf

    car = Car.load(settings.car.vehicle, settings.car.overrides)
    if car.vehicle.driving.accelerates:
        raise ConfigurationError(
            "mjcf: writes the car at rest, and the vehicle sets a steady acceleration; set driving.acceleration and "
            "driving.lateral to 0"
        )
    files = mjcf_files(car.vehicle, car.trimmed_body)
    # With --force the files of others in the folder stay, so that it is not replaced as a whole.
    folder = settings.destination.output or FOLDER
    if not (settings.destination.force and folder.is_dir()):
        folder = settings.destination.folder(FOLDER)
    write_mjcf(folder, files)
    console.say(f"{folder}: car.xml, scene.xml, {len(files) - 2} meshes")


main = command(parser, MjcfSettings, _job)
