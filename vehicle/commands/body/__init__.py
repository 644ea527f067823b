"""`python -m vehicle body import | build | rigid | show | compare | participation`: body models, a file for each."""

import argparse
from typing import Any

from vehicle.commands.body import build_body, compare_bodies, import_body, participation, rigid_body, show_body
from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import EXIT_CODES, command_parser, read
from vehicle.commands.parser import Parser

TASKS = {
    "import": import_body,
    "build": build_body,
    "rigid": rigid_body,
    "show": show_body,
    "compare": compare_bodies,
    "participation": participation,
}


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "body",
        "Import a body model, build it, show it, compare two, rank its modes; fit mass and inertia to a hung test.",
    )
    tasks = parser.add_subparsers(dest="task", required=True, metavar="|".join(TASKS))
    for name, task in TASKS.items():
        task.add(tasks)
        tasks.choices[name].epilog = EXIT_CODES
        tasks.choices[name].add_version()
    return parser


def settings_of(options: argparse.Namespace) -> tuple[str, Any]:
    """Return the name of the task, and its settings of the parsed options."""
    return options.task, read(options, TASKS[options.task].SETTINGS)


def _job(task: tuple[str, Any], console: Console) -> None:
    name, settings = task
    TASKS[name].run(settings, console)


main = command(parser, settings_of, _job)
