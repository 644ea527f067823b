"""`python -m vehicle sweep`: table of comfort and slip for variations of parameters and inputs."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import inputs_of, signal_options
from vehicle.commands.options import (
    car_of,
    command_parser,
    destination_of,
    message_options,
    output_options,
    read,
    report_option,
    resume_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.runs.output.destination import ReportChoice
from vehicle.studies.sweeps.sweep_settings import SHIFT, SweepSettings

if TYPE_CHECKING:
    from vehicle.studies.sweeps.case_file import CaseFile
    from vehicle.studies.sweeps.plan import Design
    from vehicle.studies.sweeps.sweep_study import SweepStudy


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("sweep", "Run the car with varied parameters on one or several inputs.")
    signal_options(parser, several=True)
    parser.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="PATH=VALUES",
        help="values of a parameter, as damper.coulomb_friction=62.5,125, or 62.5:125:6 for six equally spaced values; "
        "of a component of a vector, as bushings.tyre.stiffness.z=2e5,2.5e5; a whole vector is [x,y,z]; repeated: "
        "every combination",
    )
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE.csv",
        help="columns are parameter paths, rows are variations; or the table.csv of another sweep",
    )
    parser.add_argument(
        "--sobol",
        type=int,
        metavar="N",
        help="Sobol indices of comfort, or of --measure, with N base points, a power of two, at least 64; each "
        "parameter is uniform between the bounds of --vary PATH=LOW:HIGH; N times (parameters + 2) runs on each input",
    )
    parser.add_argument(
        "--cases",
        type=_cases,
        metavar="FILE.toml",
        help="roads, speeds, laden states and variants of a file, every car on every input, in one table",
    )
    parser.add_argument(
        "--each",
        type=steps_of,
        metavar="P%[,Dmm]",
        help="change each parameter alone by P percent, down and up, and rank them by their effect on comfort or "
        "--measure; --vary PATH, as front.damper or viscous, chooses them; by default all stiffnesses, dampings, "
        "friction forces, masses; a coordinate, which has no percentage, is moved by D mm, 10 by default: 20%%,5mm",
    )
    vehicle_options(parser)
    setting_options(parser, SweepSettings, "measure", "engine", "skip", "jobs", "executor", "time_limit")
    output_options(parser, Path("runs/sweep"))
    resume_options(parser)
    parser.add_argument("--allow-failed", action="store_true", help="exit with 0, not 4, although runs failed")
    report_option(parser, "best and base car, picture, tables, how to repeat the sweep", "the sweep")
    message_options(parser, quiet=True)
    return parser


def _cases(file: str) -> CaseFile:
    """Return the cases of a file."""
    from vehicle.studies.sweeps.case_file import read_cases

    return read_cases(Path(file))


def steps_of(text: str) -> tuple[float, float]:
    """Return the share [-] and the shift of coordinates [m] of a text as "20%", "20" or "20%,5mm".

    Raises:
        ConfigurationError: no number.
    """
    percent, comma, length = text.strip().removeprefix("+-").partition(",")
    try:
        share = 0.01 * float(percent.removesuffix("%"))
        return share, 1e-3 * float(length.removesuffix("mm")) if comma else SHIFT
    except ValueError:
        raise ConfigurationError(
            f"--each {text!r}: must be a percentage, as --each 20%, or that and the shift of coordinates in mm, as "
            "--each 20%,5mm"
        ) from None


def settings_of(options: argparse.Namespace) -> SweepStudy:
    """Return the study of parsed options.

    Raises:
        ConfigurationError: options that exclude each other.
    """
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.studies.sweeps.sweep_study import SweepStudy

    return read(
        options,
        SweepStudy,
        design=_design(options),
        car=car_of(options),
        inputs=inputs_of(options),
        destination=destination_of(options),
        report=read(options, ReportChoice),
    )


def _design(options: argparse.Namespace) -> Design:
    """Return what varies.

    Raises:
        ConfigurationError: options that exclude each other.
    """
    from vehicle.studies.sweeps.chosen_cars import EveryCombination, VariationTable
    from vehicle.studies.sweeps.parameter_effects import SingleChanges
    from vehicle.studies.sweeps.sobol_sweep import SobolSample

    if options.cases is not None and any(
        (options.vary, options.table, options.sobol, options.each, options.input, options.road)
    ):
        raise ConfigurationError(
            "--cases: its file has inputs and variants; leave out --vary, --input, --road and so on"
        )
    if options.each is not None and (options.table or options.sobol is not None):
        raise ConfigurationError("--each: takes --vary PATH, or no parameters; leave out --table and --sobol")
    if options.cases is None and options.each is None and bool(options.vary) == bool(options.table):
        raise ConfigurationError("give either --vary PATH=A,B,C (once or more) or --table FILE.csv")
    if options.sobol is not None and (options.table or options.report is not None):
        raise ConfigurationError(
            "--sobol: needs --vary PATH=LOW:HIGH, and has no report; leave out --table and --report"
        )
    vary = tuple(options.vary)
    if options.cases is not None:
        listed: CaseFile = options.cases
        return listed
    if options.each is not None:
        return SingleChanges(vary, *options.each)
    if options.sobol is not None:
        return SobolSample(vary, options.sobol)
    return VariationTable(options.table) if options.table else EveryCombination(vary)


def _job(study: SweepStudy, console: Console) -> None:
    result = study.run(
        command=console.command("vehicle sweep"),
        begin=console.progress,
        note=lambda text: console.say(f"note        {text}"),
        notice=lambda text: print(f"note: {text}", file=sys.stderr, flush=True),
    )
    console.say(result)
    if result.failed and not study.allow_failed:
        raise SimulationError(
            f"{result.failed} of {result.runs} runs failed; the table is written, with the reason in their rows; "
            "--allow-failed takes that as success"
        )


main = command(parser, settings_of, _job)
