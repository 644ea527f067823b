"""Options of several commands, each defined once."""

from __future__ import annotations

import argparse
from pathlib import Path

from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.names import ENGINES

EXIT_CODES = (
    "Exit codes: 0 done, 2 usage, 3 bad data, 4 simulation failed, 5 library missing, 6 cannot write, 130 interrupted."
)

FORCE_HELP = "replace files of an earlier run; stop if the folder contains other or edited files"


def command_parser(name: str, description: str) -> Parser:
    """Return the parser of a command, with --help and --version.

    Args:
        name: name of the command.
        description: one line, also printed in the list of commands.
    """
    parser = Parser(prog=f"python -m vehicle {name}", description=description, epilog=EXIT_CODES, allow_abbrev=False)
    parser.add_version()
    return parser


CAR_HELP = f"folder or file of a car, or the name of a shipped car: {', '.join(CARS)}"
VEHICLE_HELP = f"{CAR_HELP}; the car of Bommer 2006 by default"


def vehicle_options(parser: argparse._ActionsContainer) -> argparse._ActionsContainer:
    """Add --vehicle and --set, which choose the car, as a group with the title "the car".

    Args:
        parser: parser of the command; or an existing group, which gets the options instead.

    Returns:
        The group.
    """
    group = parser.add_argument_group("the car") if isinstance(parser, argparse.ArgumentParser) else parser
    group.add_argument(
        "--vehicle",
        type=vehicle_file,
        metavar="FILE.toml",
        help=VEHICLE_HELP,
    )
    set_option(group)
    return group


def set_option(parser: argparse._ActionsContainer) -> None:
    """Add --set, which changes the car.

    Args:
        parser: parser of the command, or a group of it.
    """
    parser.add_argument(
        "--set",
        dest="overrides",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="override one parameter, as damper.coulomb_friction=93.75; a vector is [x, y, z], and the path "
        "of one component ends with its axis: bushings.tyre.stiffness.z=2e5; may be repeated",
    )


def output_options(parser: Parser, path: Path | None, *, default: str = "", metavar: str = "DIR") -> None:
    """Add --output and --force, see `vehicle.commands.destination`.

    Args:
        parser: parser of the command.
        path: folder or file without --output; None if the job chooses it.
        default: default path for the help, if `path` is None.
        metavar: DIR, or FILE with its ending.
    """
    destination = "folder" if metavar == "DIR" else "file"
    text = f"{destination} of the results; {default or path} by default, and the next free name where that exists"
    parser.add_argument("--output", type=Path, default=path, metavar=metavar, help=text)
    parser.add_argument("--force", action="store_true", help=FORCE_HELP)


def extra_output_options(parser: Parser, files: str) -> None:
    """Add --output and --force of a command that prints, and writes files only with --output.

    Args:
        parser: parser of the command.
        files: names of the files, for the help.
    """
    parser.add_argument("--output", type=Path, metavar="DIR", help=f"write {files} there")
    group = parser.scoped_group("files", needs="--output DIR", active=lambda options: options.output is not None)
    group.add_argument("--force", action="store_true", help=FORCE_HELP)


def figures_option(parser: argparse._ActionsContainer) -> None:
    """Add --no-figures, for a command that writes pictures beside its tables; the default of `figures` is True."""
    parser.add_argument(
        "--no-figures",
        dest="figures",
        action="store_false",
        help="write no pictures (PNG): the command is done sooner; tables, summary and report are unchanged",
    )


def head_options(parser: argparse._ActionsContainer) -> None:
    """Add --author and --project, the names in the head of a report."""
    parser.add_argument("--author", default="", metavar="NAME", help="author in the head of the report")
    parser.add_argument("--project", default="", metavar="NAME", help="project in the head of the report")


def report_option(parser: Parser, content: str, folder: str) -> None:
    """Add --report, a report beside the results, with --author and --project of its head.

    Args:
        parser: parser of the command.
        content: content of the report, for the help.
        folder: name of the folder of the results, for the help.
    """
    parser.add_argument(
        "--report",
        nargs="?",
        const="",
        metavar="FILE.html",
        help=f"write a report too: {content}; report.html in the folder of {folder} by default",
    )
    head_options(parser.scoped_group("a report", needs="--report", active=lambda options: options.report is not None))


def film_name(value: str, default: str) -> Path:
    """Return the path of a film.

    Args:
        value: value of --video; empty for the default.
        default: default path.

    Raises:
        ConfigurationError: it does not end in .mp4.
    """
    name = Path(value or default)
    if name.suffix != ".mp4":
        raise ConfigurationError(f"--video {name}: a film is written as .mp4; set FILE.mp4")
    return name


def engine_option(parser: argparse._ActionsContainer, default: str) -> None:
    """Add --engine, the solver of a run.

    Args:
        parser: parser of the command.
        default: mujoco for a single run, auto for many.
    """
    parser.add_argument(
        "--engine",
        choices=ENGINES,
        default=default,
        help="mujoco: complete nonlinear model; reduced: hundreds of times faster, all laws but linear geometry, no "
        "film; auto: reduced inside its valid range, otherwise mujoco; %(default)s by default",
    )


def skip_option(parser: argparse.ArgumentParser) -> None:
    """Add --skip, the start of the evaluation, see `vehicle.signals.excitation.evaluation_start`."""
    text = (
        "begin the evaluation (comfort, SEAT, slip shares, densities) S seconds after the start; on a road 2 by "
        "default, more below 19 km/h, since a road rises from rest during the first second; 0 with --input"
    )
    parser.add_argument("--skip", type=float, metavar="S", help=text)


def resume_options(parser: Parser) -> None:
    """Add --resume and --retry-failed, which continue a table of runs."""
    parser.add_argument("--resume", action="store_true", help="continue in that folder; finished rows are kept")
    group = parser.scoped_group("going on", needs="--resume", active=lambda options: options.resume)
    group.add_argument("--retry-failed", action="store_true", help="run failed rows again")


def jobs_option(parser: argparse.ArgumentParser, *, note: str = "") -> None:
    """Add --jobs, the number of processes; the results do not depend on it.

    Args:
        parser: parser of the command.
        note: addition to the help.
    """
    text = "processes for independent runs; %(default)s by default" + note
    parser.add_argument("--jobs", type=_jobs, default=1, metavar="N", help=text)


def executor_option(parser: argparse.ArgumentParser) -> None:
    """Add --executor, a cluster or a custom executor for independent runs."""
    text = "dask://host:port, or module:factory for an executor of your own"
    parser.add_argument("--executor", metavar="WHERE", help=text)


def time_limit_option(parser: argparse.ArgumentParser) -> None:
    """Add --time-limit, the maximum computing time of a run."""
    text = "maximum computing time of a run [s]; a run that takes longer is a failed row"
    parser.add_argument("--time-limit", type=float, metavar="S", help=text)


def _jobs(text: str) -> int:
    """Return the number of processes.

    Raises:
        ConfigurationError: no whole number of at least 1.
    """
    try:
        number = int(text)
    except ValueError:
        raise ConfigurationError(f"--jobs {text!r}: must be a whole number") from None
    if number < 1:
        raise ConfigurationError(f"--jobs {number}: must be at least 1")
    return number


def message_options(parser: argparse.ArgumentParser, *, quiet: bool = False) -> None:
    """Add --debug and, for a command whose results are files, --quiet."""
    if quiet:
        parser.add_argument("--quiet", action="store_true", help="print nothing but errors")
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
