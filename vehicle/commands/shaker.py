"""`python -m vehicle.shaker`: simulate the car on the shaker or a road, and write the results."""

from __future__ import annotations

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.film_options import film_options
from vehicle.commands.input_options import (
    RECORD_NEEDS,
    input_of,
    record_options,
    recorded_over_time,
    signal_options,
    unit_option,
)
from vehicle.commands.measured_options import measured_options
from vehicle.commands.options import (
    acceleration_options,
    command_parser,
    figures_option,
    message_options,
    output_options,
    read,
    report_option,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.commands.summary_text import summary_text
from vehicle.errors import ConfigurationError
from vehicle.handover.page.shaker_settings import ShakerSettings
from vehicle.runs.report.order_study import USUAL_ENGINE, USUAL_LENGTH, OrderSettings, order_study
from vehicle.signals.excitation.input_settings import PlateSettings

if TYPE_CHECKING:
    from vehicle.runs.car import Car
    from vehicle.signals.records.run_summary import RunSummary


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("shaker", "Put shaker signals or a road under the wheels of the complete car.")
    file = signal_options(parser)
    recorded = parser.scoped_group(
        "a file of signals or a recorded road",
        needs=RECORD_NEEDS,
        active=lambda options: bool(options.input) or recorded_over_time(options),
    )
    record_options(
        recorded, 'a plate, for example fr="Shaker FR", or the speed rpm of the crankshaft', rate=False, unit=False
    )
    setting_options(parser, ShakerSettings, "rpm", "no_forces")
    file.add_argument("--interpolate", action="store_true", help="fill gaps in the displacement by interpolation")
    file.add_argument("--remove-mean", action="store_true", help="subtract the mean of the displacement")
    read = parser.scoped_group(
        "a file of signals or of a measurement",
        needs="--input, --measured, or a road recorded over time; any other road has no file",
        active=lambda options: bool(options.input or options.measured) or recorded_over_time(options),
    )
    unit_option(read)
    output_options(parser, None, default="runs/<input stem> or runs/road_C_80")
    car = vehicle_options(parser)
    acceleration_options(car)
    setting_options(car, ShakerSettings, "law_band", "controller", "trust")
    setting_options(
        parser, ShakerSettings, "engine", "stated_errors", "skip", "timestep", "time_format", "channels", "formats"
    )
    figures_option(parser)
    film = film_options(parser, "render a video of the run")
    setting_options(film, ShakerSettings, "video_mode")
    measured_options(parser)
    report_option(parser, "an HTML file with findings, figures, moving modes and tables", "the run")
    message_options(parser, quiet=True)
    return parser


def settings_of(options: argparse.Namespace) -> ShakerSettings | OrderSettings:
    """Return the settings of the parsed options, or the settings of `orders` for steady speeds of the crankshaft."""
    settings = read(options, ShakerSettings, source=input_of(options))
    if settings.rpm is not None and settings.rpm.count(":") == 2:
        return _steady_points(settings, "engine" in options.given, options.speed)
    return settings


def _steady_points(settings: ShakerSettings, engine_given: bool, speed: float | str | None) -> OrderSettings:
    """Return the settings of `orders` with the same options.

    Args:
        engine_given: True if the command line has --engine.
        speed: value of --speed.
    """
    settings.require_forces()
    if isinstance(settings.source, PlateSettings):
        raise ConfigurationError("--rpm A:B:STEP: runs on a road at steady speeds; remove --input")
    settings.require_no_others("--rpm A:B:STEP runs many steady speeds", "rpm", "duration", "engine")
    car, destination = settings.car, settings.destination
    road, file = str(settings.source.road), destination.output
    arguments = ["--rpm", str(settings.rpm), "--road", road]
    for flag, value in (("--vehicle", car.vehicle), ("--speed", speed), ("--duration", settings.duration)):
        arguments += [] if value is None else [flag, str(value)]
    arguments += [word for text in car.overrides for word in ("--set", text)]
    arguments += ["--engine", settings.engine] if engine_given else []
    arguments += [] if file is None else ["--output", str(file), *(["--force"] if destination.force else [])]
    return OrderSettings(
        car=car,
        destination=destination,
        rpm=settings.rpm,
        speed=None if speed is None else str(speed),
        road=road,
        duration=settings.duration or USUAL_LENGTH,
        engine=settings.engine if engine_given else USUAL_ENGINE,
        words=tuple(arguments),
    )


def _job(settings: ShakerSettings | OrderSettings, console: Console) -> None:
    if isinstance(settings, OrderSettings):
        console.say(order_study(settings))
        return
    from vehicle.handover.page.profile_study import on_pieces, profile_study

    if on_pieces(settings):
        console.say(profile_study(settings, console, console.command("vehicle.shaker")))
        return
    from vehicle.handover.page.shaken_run import shake

    def print_numbers(summary: RunSummary, car: Car) -> None:
        from vehicle.runs.report.general_notices import without_general

        if not console.quiet:
            run_notices = without_general(summary.notices, car.vehicle)
            console.say(summary_text(replace(summary, notices=run_notices)))

    shaken = shake(settings, console, tell=print_numbers, command=console.command("vehicle.shaker"))
    console.say(f"files       {shaken.folder}: {', '.join(shaken.summary.files.values())}")


main = command(parser, settings_of, _job)
