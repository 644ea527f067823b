"""`python -m vehicle show CAR`: masses, loads, stiffnesses, frequencies, geometry and parameters of a car."""

import argparse
import dataclasses
import sys
from typing import Any

from vehicle.commands.command_line import command, print_result
from vehicle.commands.destination import output_folder_of
from vehicle.commands.options import VEHICLE_HELP, command_parser, extra_output_options, message_options, set_option
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import vehicle_file


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("show", "Print masses, stiffnesses, frequencies, geometry and parameters of a car.")
    parser.add_argument("car", nargs="?", type=vehicle_file, metavar="CAR", help=VEHICLE_HELP)
    set_option(parser)
    parser.add_argument(
        "--search",
        nargs="?",
        const="",
        metavar="WORDS",
        help="list parameters whose path or meaning contains these words, with value, unit, range and source; "
        "without words all parameters",
    )
    extra_output_options(parser, "car.png (drawing with dimensions), car.json and parameters.csv")
    parser.former("--vehicle", "--vehicle is not an option here; name the car first, for example `show sedan`")
    parser.add_argument("--json", action="store_true", help="print JSON")
    message_options(parser)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.runs.car import Car

    if options.search is not None and options.output is not None:
        raise ConfigurationError(
            "--search and --output exclude each other: --search prints some parameters, --output writes all; "
            "leave one of them out"
        )
    car = Car.load(options.car, options.overrides)
    if options.search is not None:
        _print_parameters(car, options)
        _note_idle(car, options)
        return
    folder = None if options.output is None else output_folder_of(options, options.output)
    data = car.show()
    if folder is not None:
        from vehicle.runs.output.car_files import write_car

        write_car(folder, car, data, force=options.force)
    print_result(options, data.summary(), data)
    _note_idle(car, options)


def _note_idle(car: Any, options: argparse.Namespace) -> None:
    """Print a note for each changed parameter without effect."""
    from vehicle.model.parameters.idle import idle_parameters

    for notice in idle_parameters(car.vehicle, car.overrides):
        print(f"note: {notice}", file=sys.stderr if options.json else sys.stdout)


def _print_parameters(car: Any, options: argparse.Namespace) -> None:
    """Print the parameters that match the words of --search."""
    from vehicle.runs.car.car_text import parameter_table

    parameters = car.search(options.search)
    if not parameters:
        searched = options.search.split()
        unknown = [word for word in searched if not car.search(word)]
        shown = " or ".join(map(repr, unknown)) or f"all of {', '.join(map(repr, searched))}"
        raise ConfigurationError(
            f"--search {options.search!r}: no parameter of {car.vehicle.name} contains {shown} in its path or "
            "meaning; use other words, for example damper or mass, or --search without words to list all"
        )
    print_result(options, [dataclasses.asdict(parameter) for parameter in parameters], parameter_table(parameters))


main = command(parser, _job)
