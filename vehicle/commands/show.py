"""`python -m vehicle show CAR`: masses, loads, stiffnesses, frequencies, geometry and parameters of a car."""

import dataclasses
import sys
from dataclasses import dataclass
from typing import Any

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import (
    acceleration_options,
    car_argument,
    command_parser,
    extra_output_options,
    message_options,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("show", "Print masses, stiffnesses, frequencies, geometry and parameters of a car.")
    car_argument(parser, "show")
    acceleration_options(parser)
    setting_options(parser, ShowSettings, "search")
    extra_output_options(parser, "car.png (drawing with dimensions), car.json and parameters.csv")
    parser.add_argument("--json", action="store_true", help="print JSON")
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class ShowSettings(Settings):
    """Car to show; files are written only to an `output`."""

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    search: str | None = setting(
        "list parameters whose path or meaning contains these words, with value, unit, range and source; without "
        "words list all",
        nargs="?",
        const="",
        metavar="WORDS",
    )


def _job(settings: ShowSettings, console: Console) -> None:
    from vehicle.runs.car import Car

    output = settings.destination.output
    if settings.search is not None and output is not None:
        raise ConfigurationError(
            "--search and --output: --search prints some parameters, --output writes all; remove one of them"
        )
    car = Car.load(settings.car.vehicle, settings.car.overrides)
    if settings.search is not None:
        _print_parameters(car, settings.search, console)
        _note_idle(car, console)
        return
    folder = None if output is None else settings.destination.folder(output)
    data = car.show()
    if folder is not None:
        from vehicle.runs.output.car_files import write_car

        write_car(folder, car, data, force=settings.destination.force)
    console.result(data.summary(), data)
    _note_idle(car, console)


def _note_idle(car: Any, console: Console) -> None:
    """Print a note for each changed parameter without effect."""
    from vehicle.model.parameters.idle import idle_parameters

    for notice in idle_parameters(car.vehicle, car.overrides):
        print(f"note: {notice}", file=sys.stderr if console.json else sys.stdout)


def _print_parameters(car: Any, search: str, console: Console) -> None:
    """Print the parameters that match the words of --search."""
    from vehicle.runs.car.car_text import parameter_table

    parameters = car.search(search)
    if not parameters:
        searched = search.split()
        unknown = [word for word in searched if not car.search(word)]
        shown = " or ".join(map(repr, unknown)) or f"all of {', '.join(map(repr, searched))}"
        raise ConfigurationError(
            f"--search {search!r}: no parameter of {car.vehicle.name} contains {shown} in its path or "
            "meaning; use other words, for example damper or mass, or --search without words to list all"
        )
    console.result([dataclasses.asdict(parameter) for parameter in parameters], parameter_table(parameters))


main = command(parser, ShowSettings, _job)
