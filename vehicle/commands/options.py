"""Options of several commands, each defined once, and the settings read from the parsed options."""

import argparse
import dataclasses
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any, TypeVar

from vehicle.commands.parser import Parser
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.driving import Driving
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings
from vehicle.studies.sweeps.sweep_settings import SweepSettings

S = TypeVar("S")

EXIT_CODES = (
    "Exit codes: 0 done, 2 usage, 3 bad data, 4 simulation failed, 5 library missing, 6 cannot write, 130 interrupted."
)

FORCE_HELP = "replace files of an earlier run, unless the folder contains other or edited files"


def command_parser(name: str, description: str) -> Parser:
    """Return the parser of a command, with --help and --version."""
    parser = Parser(prog=f"python -m vehicle {name}", description=description, epilog=EXIT_CODES, allow_abbrev=False)
    parser.add_version()
    return parser


CAR_HELP = f"folder or file of a car, or the name of a shipped car: {', '.join(CARS)}"
VEHICLE_HELP = f"{CAR_HELP}; default: focus"


def setting_options(
    parser: argparse._ActionsContainer, settings: type[Settings], *names: str, note: str = "", **more: Any
) -> None:
    """Add the options of declared settings.

    Args:
        names: settings; by default all that have an option.
    """
    all_declared = settings.declared()
    for name in names or [name for name, each in all_declared.items() if each["option"]]:
        declared = all_declared[name]
        default, factor = declared["default"], declared["factor"]
        if isinstance(default, tuple):  # numbers, or values to append to
            numbers = default and "type" in declared["option"]
            default = ":".join(f"{each:g}" for each in default) if numbers else list(default)
        arguments: dict[str, Any] = {
            "dest": name,
            "default": default / factor if isinstance(default, float) else default,
            "help": declared["meaning"],
            **declared["option"],
            **more,
        }
        arguments["help"] += note
        if not declared["flag"].startswith("-"):  # an argument without an option
            del arguments["dest"], arguments["default"]
        parser.add_argument(declared["flag"], **arguments)


def read(options: argparse.Namespace, settings: type[S], /, **more: Any) -> S:
    """Return the settings of parsed options, with their parts.

    A field takes the option of its name, or of the `dest` of its declaration; without one it has its default.

    Args:
        settings: dataclass; its class need not be one of `Settings`.
        more: values of further fields.
    """
    for each in dataclasses.fields(settings):  # type: ignore[arg-type]
        if each.name in more:
            continue
        declared = each.metadata
        if "part" in declared:
            of_part = PARTS.get(declared["part"])
            more[each.name] = of_part(options) if of_part else read(options, declared["part"])
            continue
        name, factor = declared.get("option", {}).get("dest", each.name), declared.get("factor", 1.0)
        value = vars(options).get(name)
        if value is not None and ("meaning" not in declared or declared["option"]):
            value = tuple(value) if isinstance(value, list) else value
            more[each.name] = value if factor == 1.0 else factor * value
    return settings(**more)


def car_of(options: argparse.Namespace) -> CarChoice:
    """Return the choice of the car of --vehicle, or of the argument CAR, and --set."""
    file = vars(options).get("car") or vars(options).get("vehicle")
    car = CarChoice(vehicle=file, overrides=tuple(options.overrides))
    for name in STEADY:
        if (value := vars(options).get(name)) is not None:
            car = car.with_(f"--{name}", f"driving.{name}={value!r}")
    return car


def destination_of(options: argparse.Namespace) -> Destination:
    """Return the destination of --output, --force and --resume; a notice is printed, except with --quiet."""
    given = vars(options)
    return Destination(
        output=options.output if "output" in options.given else None,
        force=given.get("force", False),
        resume=given.get("resume", False),
        tell=lambda text: None if given.get("quiet", False) else print(text, file=sys.stderr),
        held=given.get("held") or ExitStack(),
    )


PARTS: dict[Any, Callable[[argparse.Namespace], Any]] = {CarChoice: car_of, Destination: destination_of}
"""Reader of a part of settings whose options have other names than its fields."""


def vehicle_options(parser: argparse._ActionsContainer) -> argparse._ActionsContainer:
    """Add --vehicle and --set, which choose the car, to a group, or to a new one "the car"; return the group."""
    group = parser.add_argument_group("the car") if isinstance(parser, argparse.ArgumentParser) else parser
    group.add_argument("--vehicle", type=vehicle_file, metavar="FILE.toml", help=VEHICLE_HELP)
    set_option(group)
    return group


STEADY = ("acceleration", "lateral")
"""Parameters of a steady acceleration, with an option each."""


def acceleration_options(group: argparse._ActionsContainer) -> None:
    """Add --acceleration and --lateral, the steady acceleration in which the car rides; see `Driving`."""
    meanings = {entry.name: entry.metadata["meaning"] for entry in dataclasses.fields(Driving) if entry.name in STEADY}
    for name in STEADY:
        group.add_argument(f"--{name}", type=float, metavar="M/S2", help=f"{meanings[name]} [m/s2]; default: 0")


def car_argument(parser: Parser, command: str = "") -> None:
    """Add the car by its place, and --set.

    Args:
        command: name of a command without --vehicle, whose message then names the place; empty for others.
    """
    parser.add_argument("car", nargs="?", type=vehicle_file, metavar="CAR", help=VEHICLE_HELP)
    set_option(parser)
    if command:
        parser.former("--vehicle", f"--vehicle: no such option; name the car first, for example `{command} sedan`")


def set_option(parser: argparse._ActionsContainer) -> None:
    """Add --set, which changes the car."""
    parser.add_argument(
        "--set",
        dest="overrides",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="change one parameter, for example damper.coulomb_friction=93.75; a vector is [x, y, z], and .z selects "
        "its third component: bushings.tyre.stiffness.z=2e5. May be repeated",
    )


def output_options(parser: Parser, path: Path | None, *, default: str = "", metavar: str = "DIR") -> None:
    """Add --output and --force, see `destination_of`.

    Args:
        path: folder or file without --output; None if the job chooses it.
        default: default path for the help, if `path` is None.
        metavar: DIR, or FILE with its ending.
    """
    destination = "folder" if metavar == "DIR" else "file"
    text = f"{destination} of the results; default: {default or path}, or the next free name if it exists"
    parser.add_argument("--output", type=Path, default=path, metavar=metavar, help=text)
    parser.add_argument("--force", action="store_true", help=FORCE_HELP)


def extra_output_options(parser: Parser, files: str) -> None:
    """Add --output and --force of a command that prints, and writes files only with --output."""
    parser.add_argument("--output", type=Path, metavar="DIR", help=f"write {files} there")
    group = parser.scoped_group("files", needs="--output DIR", active=lambda options: options.output is not None)
    group.add_argument("--force", action="store_true", help=FORCE_HELP)


def figures_option(parser: argparse._ActionsContainer) -> None:
    """Add --no-figures, for a command that writes pictures and tables; the default of `figures` is True."""
    parser.add_argument(
        "--no-figures",
        dest="figures",
        action="store_false",
        help="write no pictures (PNG), to save time; tables, summary and report are unchanged",
    )


def head_options(parser: argparse._ActionsContainer) -> None:
    """Add --author and --project, the names in the head of a report."""
    parser.add_argument("--author", default="", metavar="NAME", help="author, shown at the top of the report")
    parser.add_argument("--project", default="", metavar="NAME", help="project, shown at the top of the report")


def report_option(parser: Parser, content: str, folder: str) -> None:
    """Add --report, a report in addition to the results, with --author and --project of its head."""
    parser.add_argument(
        "--report",
        nargs="?",
        const="",
        metavar="FILE.html",
        help=f"also write a report: {content}; default: report.html in the same folder as {folder}",
    )
    head_options(parser.scoped_group("a report", needs="--report", active=lambda options: options.report is not None))


def damper_option(parser: argparse._ActionsContainer) -> None:
    """Add --damper, the state of the dampers for modes and FRFs of the linear car."""
    states = ("stuck", "sliding")
    help_text = "dampers stuck by friction, or sliding; default: stuck"
    parser.add_argument("--damper", choices=states, default="stuck", help=help_text)


def measure_option(parser: argparse._ActionsContainer, where: str) -> None:
    """Add --measure, further figures of a table or page."""
    parser.add_argument(
        "--measure",
        action="append",
        default=[],
        metavar="NAME",
        help=f"add a figure to the {where}, for example tyre_load_crest, travel_fr or peak:seat_rail_acc_z. May be "
        "repeated",
    )


def resume_options(parser: Parser) -> None:
    """Add --resume and --retry-failed, which continue a table of runs."""
    parser.add_argument(
        "--resume", action="store_true", help="continue the unfinished study in this folder; finished rows are kept"
    )
    group = parser.scoped_group("going on", needs="--resume", active=lambda options: options.resume)
    setting_options(group, SweepSettings, "retry_failed")


def message_options(parser: argparse.ArgumentParser, *, quiet: bool = False) -> None:
    """Add --debug and, for a command whose results are files, --quiet."""
    if quiet:
        parser.add_argument("--quiet", action="store_true", help="print errors only")
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
