"""`python -m vehicle body import | build | show | compare | participation`: body models for a car, a file for each."""

import argparse

from vehicle.commands.body import build_body, compare_bodies, import_body, participation, show_body
from vehicle.commands.command_line import command
from vehicle.commands.options import EXIT_CODES, command_parser
from vehicle.commands.parser import Parser

TASKS = {
    "import": import_body,
    "build": build_body,
    "show": show_body,
    "compare": compare_bodies,
    "participation": participation,
}


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "body",
        "Import a body model from finite elements or a modal test, build it, show it, compare two, rank its modes.",
    )
    tasks = parser.add_subparsers(dest="task", required=True, metavar="|".join(TASKS))
    for name, task in TASKS.items():
        task.add(tasks)
        tasks.choices[name].epilog = EXIT_CODES
        tasks.choices[name].add_version()
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.model.parameters.vehicle import load_vehicle

    TASKS[options.task].run(options, load_vehicle(options.vehicle, options.overrides))


main = command(parser, _job)
