"""`python -m vehicle bench CAR`: a local web page on which the numbers of a car follow its sliders."""

from __future__ import annotations

import argparse
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import input_of, signal_options
from vehicle.commands.options import (
    car_argument,
    command_parser,
    measure_option,
    message_options,
    read,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.settings import Settings, part, setting
from vehicle.signals.excitation.input_settings import DriveInput, PlateSettings

if TYPE_CHECKING:
    from vehicle.runs.car import Car
    from vehicle.runs.car.road import Road
    from vehicle.signals.excitation.signal import Signal

PORT = 8630
"""Default port."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BenchSettings(Settings):
    """Settings of the bench.

    Attributes:
        source: signals of the plates, or a drive on a road.
        measure: further figures of the table of the page.
        output: folder for the files that the page saves.
    """

    source: PlateSettings | DriveInput
    car: CarChoice = part(CarChoice)
    measure: tuple[str, ...] = ()
    output: Path = Path("runs/bench")
    first: float = setting("use the file from this time on [s]", 0.0, flag="--from", type=float, metavar="S")
    seconds: float | None = setting(
        "length of the evaluation [s], 5 to 60; default: 10, on an obstacle until 3 s after it",
        within="[5, 60]",
        type=float,
        metavar="S",
    )
    port: int = setting(
        "port of the page, or the next free port above it; default: %(default)s",
        PORT,
        within="[1, 65535]",
        type=int,
        metavar="N",
    )


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "bench", "Open a local web page whose sliders change a car, and whose curves show comfort, FRFs and slip."
    )
    car_argument(parser)
    file = signal_options(parser, precision=False)
    setting_options(file, BenchSettings, "first")
    setting_options(parser, BenchSettings, "seconds")
    measure_option(parser, "table of the page")
    setting_options(parser, BenchSettings, "port")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("runs/bench"),
        metavar="DIR",
        help="folder for the files that the page saves; default: %(default)s",
    )
    message_options(parser)
    return parser


def settings_of(options: argparse.Namespace) -> BenchSettings:
    """Return the settings of the parsed options."""
    return read(options, BenchSettings, source=input_of(options))


def _job(settings: BenchSettings, console: Console) -> None:
    from vehicle.handover.bench.drive import bench_drive
    from vehicle.handover.bench.guard import Guard
    from vehicle.handover.bench.numbers import require_figures
    from vehicle.handover.bench.page import Page
    from vehicle.handover.bench.server import close_server, open_server
    from vehicle.handover.bench.state import BenchState
    from vehicle.runs.car import Car

    car = Car.load(settings.car.vehicle, settings.car.overrides)
    require_figures(car, settings.measure)
    source = _source(settings.source, car)
    guard = Guard()
    server = open_server(guard, settings.port)
    try:
        print("compiling ...", flush=True)
        drive = bench_drive(car, source, begin=settings.first, seconds=settings.seconds)
        state = BenchState(car, drive, settings.measure)
        page = Page(server, state, settings.output)
        print(f"ready: {guard.address(server.get_port())} (Ctrl-C ends the bench)", flush=True)
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            print("bench closed")
        finally:
            page.close()
    finally:
        close_server(server)


def _source(source: PlateSettings | DriveInput, car: Car) -> Signal | Road:
    """Return the signals of the plates, or the road."""
    if isinstance(source, PlateSettings):
        return source.signal(source.corner(car.vehicle.shaker_wheel))
    from vehicle.runs.car.road import road_of

    return road_of(source)


main = command(parser, settings_of, _job)
