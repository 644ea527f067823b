"""`python -m vehicle tune CAR`: fit parameters of a car to measured FRFs and time histories."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.clock_options import drift_option
from vehicle.commands.command_line import command
from vehicle.commands.console import Console, folded
from vehicle.commands.options import (
    CAR_HELP,
    command_parser,
    head_options,
    message_options,
    output_options,
    read,
    set_option,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.commands.tune_measurements import has_files, measurement_options
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.ranges import Range, parsed_variation
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.tuning.fit_settings import HistorySettings, PosteriorSettings, ResponseSettings

if TYPE_CHECKING:
    from vehicle.studies.tuning.tuning_study import TuningStudy


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("tune", "Fit parameters of a car to measured FRFs and time histories.")
    parser.add_argument("car", type=vehicle_file, metavar="CAR", help=CAR_HELP)
    set_option(parser)
    parser.add_argument(
        "--parameters",
        nargs="+",
        action="extend",
        type=_range,
        default=[],
        metavar="PATH=LOW:HIGH",
        help="parameter to fit and its bounds (in its unit, above 0 except for a coordinate), for example "
        "front.damper.viscous=800:4000. The fit starts at the value of the car, or of --set",
    )
    measurement_options(parser)
    responses = parser.scoped_group(
        "FRFs",
        needs="--frf or --levels",
        active=lambda options: has_files(options, "frf") or any(each.levels for each in options.measurements),
    )
    setting_options(responses, ResponseSettings, "band", "spacing", "window", "averages")
    records = parser.scoped_group(
        "time histories", needs="--record", active=lambda options: has_files(options, "record")
    )
    drift_option(records)
    setting_options(records, HistorySettings, "stretch", "lowpass")
    parser.add_argument(
        "--posterior",
        action="store_true",
        help="also compute the uncertainty of the parameters from the FRFs: their probability distribution "
        "(posterior) by random sampling with emcee",
    )
    posterior = parser.scoped_group("posterior", needs="--posterior", active=lambda options: options.posterior)
    setting_options(posterior, PosteriorSettings)
    setting_options(parser, SweepSettings, "engine", default="mujoco")
    output_options(parser, Path("runs/tune"))
    head_options(parser)
    parser.add_argument("--json", action="store_true", help="print tune.json instead of the text")
    parser.former("--measured", "--measured: use --frf FILE for FRFs, --record FILE for time histories")
    parser.former("--(vary|fit) ", "use --parameters PATH=LOW:HIGH for the parameters to fit")
    message_options(parser, quiet=True)
    return parser


def _range(text: str) -> Range:
    """Return the range of a text, for example "front.damper.viscous=800:4000"."""
    return parsed_variation("--parameters", text).range()


def settings_of(options: argparse.Namespace) -> TuningStudy:
    """Return the study of parsed options."""
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.studies.tuning.measurement_settings import MeasurementSettings
    from vehicle.studies.tuning.tuning_study import TuningStudy

    if not options.measurements:
        raise ConfigurationError("the measurement is missing; add --frf FILE or --record FILE")
    if not options.parameters:
        raise ConfigurationError(
            "the parameters to fit are missing; add --parameters PATH=LOW:HIGH, for example damper.viscous=800:4000"
        )
    channels = tuple(options.channels.split(",")) if options.channels else ()
    return read(
        options,
        TuningStudy,
        parameters={each.path: (each.low, each.high) for each in options.parameters},
        measurements=read(options, MeasurementSettings, files=tuple(options.measurements), channels=channels),
    )


def _job(study: TuningStudy, console: Console) -> None:
    from vehicle.studies.tuning.tuning_files import NUMBERS

    if len(study.measurements.files) > 1:
        console.require_one_file()

    def noticed(notices: list[str]) -> None:
        console.accept(notices)
        if not (console.quiet or console.json):
            for text in folded(notices):
                console.notice(text)

    fit = study.run(command=console.command("vehicle tune"), begin=console.progress, noticed=noticed)
    if console.json:
        print((fit.folder / NUMBERS).read_text(encoding="utf-8"), end="")
    else:
        console.say(fit)


main = command(parser, settings_of, _job)
