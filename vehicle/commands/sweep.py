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
    acceleration_options,
    command_parser,
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
        help="values of a parameter, for example damper.coulomb_friction=62.5,125; 62.5:125:6 are six equally spaced "
        "values; a vector is [x,y,z], one component bushings.tyre.stiffness.z=2e5,2.5e5. Repeated: every combination",
    )
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE.csv",
        help="table with a column for each parameter path and a row for each variation, or table.csv of another sweep",
    )
    parser.add_argument(
        "--sobol",
        type=int,
        metavar="N",
        help="compute Sobol indices of comfort or of --measure from N base points (a power of two, at least 64); each "
        "parameter is uniform between the bounds of --vary PATH=LOW:HIGH; takes N (parameters + 2) runs on each input",
    )
    parser.add_argument(
        "--cases",
        type=_cases,
        metavar="FILE.toml",
        help="run every car on every input of this file of roads, speeds, laden states and variants; one table",
    )
    parser.add_argument(
        "--each",
        type=steps_of,
        metavar="P%[,Dmm]",
        help="vary one parameter at a time by ±P %% and rank the effects on comfort or --measure, for example 20%%; "
        "default: all stiffnesses, dampings, friction forces and masses; restrict with --vary, for example --vary "
        "front.damper; coordinates are shifted by ±D mm (default 10), for example 20%%,5mm",
    )
    acceleration_options(vehicle_options(parser))
    setting_options(parser, SweepSettings, "estimate", "measure", "engine", "skip")
    setting_options(
        parser,
        SweepSettings,
        "jobs",
        default=None,
        help="processes for independent runs; default: chosen by the estimated work (a process takes 2.4 s to start)",
    )
    setting_options(parser, SweepSettings, "executor", "time_limit")
    output_options(parser, Path("runs/sweep"))
    resume_options(parser)
    parser.add_argument("--allow-failed", action="store_true", help="exit with 0 instead of 4 if runs failed")
    report_option(parser, "best and base car, picture, tables, the command to repeat the sweep", "the sweep")
    message_options(parser, quiet=True)
    return parser


def _cases(file: str) -> CaseFile:
    """Return the cases of a file."""
    from vehicle.studies.sweeps.case_file import read_cases

    return read_cases(Path(file))


def steps_of(text: str) -> tuple[float, float]:
    """Return the share [-] and the shift of coordinates [m] of "20%", "20" or "20%,5mm"."""
    percent, comma, length = text.strip().removeprefix("+-").partition(",")
    try:
        share = 0.01 * float(percent.removesuffix("%"))
        return share, 1e-3 * float(length.removesuffix("mm")) if comma else SHIFT
    except ValueError:
        raise ConfigurationError(
            f"--each {text!r}: must be a percentage, for example 20%, or with the shift of coordinates in mm 20%,5mm"
        ) from None


def settings_of(options: argparse.Namespace) -> SweepStudy:
    """Return the study of parsed options."""
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.studies.sweeps.sweep_study import SweepStudy

    return read(
        options,
        SweepStudy,
        design=_design(options),
        inputs=inputs_of(options),
        runs=read(options, SweepSettings, jobs=options.jobs),
    )


def _design(options: argparse.Namespace) -> Design:
    """Return what varies."""
    from vehicle.studies.sweeps.chosen_cars import EveryCombination, VariationTable
    from vehicle.studies.sweeps.parameter_effects import SingleChanges
    from vehicle.studies.sweeps.sobol_sweep import SobolSample

    if options.cases is not None and any(
        (options.vary, options.table, options.sobol, options.each, options.input, options.road)
    ):
        raise ConfigurationError(
            "--cases already sets inputs and variants: remove --vary, --input, --road and the like"
        )
    if options.each is not None and (options.table or options.sobol is not None):
        raise ConfigurationError("--each takes its parameters from --vary PATH: remove --table and --sobol")
    if options.cases is None and options.each is None and bool(options.vary) == bool(options.table):
        raise ConfigurationError("give either --vary PATH=A,B,C (may be repeated) or --table FILE.csv")
    if options.sobol is not None and (options.table or options.report is not None):
        raise ConfigurationError("--sobol needs --vary PATH=LOW:HIGH and writes no report: remove --table and --report")
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
            f"{result.failed} of {result.runs} runs failed; their rows of the table state the reason; to accept them, "
            "add --allow-failed"
        )


main = command(parser, settings_of, _job)
