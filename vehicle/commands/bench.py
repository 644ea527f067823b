"""`python -m vehicle bench CAR`: a local web page on which the numbers of a car follow its sliders."""

from __future__ import annotations

import argparse
import threading
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.input_options import drives_on_road, signal_options
from vehicle.commands.options import VEHICLE_HELP, command_parser, measure_option, message_options, set_option
from vehicle.commands.parser import Parser
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.names import CORNERS

if TYPE_CHECKING:
    from vehicle.runs.car import Car
    from vehicle.runs.car.road import Road
    from vehicle.signals.excitation.signal import Signal

PORT = 8630
"""Default port."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "bench", "Open a local web page whose sliders change a car, and whose curves show comfort, FRFs and slip."
    )
    parser.add_argument("car", nargs="?", type=vehicle_file, metavar="CAR", help=VEHICLE_HELP)
    set_option(parser)
    file = signal_options(parser)
    file.add_argument(
        "--from", dest="first", type=float, default=0.0, metavar="S", help="use the file from this time on [s]"
    )
    parser.add_argument(
        "--seconds",
        type=float,
        metavar="S",
        help="length of the evaluation [s], 5 to 60; default: 10, with an obstacle until 3 s after it",
    )
    measure_option(parser, "table of the page")
    parser.add_argument(
        "--port",
        type=int,
        default=PORT,
        metavar="N",
        help="port of the page, or the next free port above it; default: %(default)s",
    )
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("runs/bench"),
        metavar="DIR",
        help="folder for the files that the page saves; default: %(default)s",
    )
    message_options(parser)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.handover.bench.drive import bench_drive
    from vehicle.handover.bench.guard import Guard
    from vehicle.handover.bench.page import Page
    from vehicle.handover.bench.server import close_server, open_server
    from vehicle.handover.bench.state import BenchState
    from vehicle.runs.car import Car

    car = Car.load(options.car, options.overrides)
    source = _source(options, car)
    guard = Guard()
    server = open_server(guard, options.port)
    try:
        print("compiling ...", flush=True)
        drive = bench_drive(car, source, begin=options.first, seconds=options.seconds)
        state = BenchState(car, drive, options.measure)
        page = Page(server, state, options.output)
        print(f"ready: {guard.address(server.get_port())} (Ctrl-C ends the bench)", flush=True)
        try:
            threading.Event().wait()
        except KeyboardInterrupt:
            print("bench closed")
        finally:
            page.close()
    finally:
        close_server(server)


def _source(options: argparse.Namespace, car: Car) -> Signal | Road:
    """Return the signal of --input, or the road."""
    if drives_on_road(options):
        from vehicle.commands.road import class_or_profile, road_of

        return road_of(class_or_profile(options.road), options)
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.signals.excitation.signal_file import read_signal

    wheel = CORNERS[options.wheel] if options.wheel else car.vehicle.shaker_wheel
    return read_signal(find_input(options.input), wheel=wheel, accept_implausible=options.any_level)


main = command(parser, _job)
