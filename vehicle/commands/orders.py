"""`python -m vehicle orders`: orders of crankshaft or wheels at steady speeds, with their limits and modes."""

from __future__ import annotations

import argparse
import json
import math
import shlex
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import parse_and_run
from vehicle.commands.destination import output_folder_of
from vehicle.commands.options import (
    command_parser,
    extra_output_options,
    message_options,
    set_once,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.digits import aligned
from vehicle.errors import ConfigurationError
from vehicle.studies.sweeps.sweep_settings import SweepSettings

if TYPE_CHECKING:
    from vehicle.runs.car.order_points import OrderPoints

MOST_ORDERS = 12
"""Maximum number of orders."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "orders", "Compute amplitudes at orders of crankshaft or wheels at steady speeds, with limits and Campbell map."
    )
    vehicle_options(parser)
    parser.add_argument(
        "--rpm",
        metavar="A:B:STEP",
        help="speeds of the crankshaft [1/min], for example 700:3000:50; a run at each speed",
    )
    parser.add_argument(
        "--speed",
        metavar="A:B:STEP",
        help="speeds of the car [km/h], for example 60:160:5; with --rpm a single speed of the car",
    )
    parser.add_argument(
        "--orders",
        default="1,2",
        metavar="N,...",
        help="orders (multiples of the rotation frequency), for example 2,4; default: %(default)s",
    )
    parser.add_argument(
        "--channel",
        action="append",
        metavar="WORDS",
        help="acceleration channels, as seat rail z,roof left rear x; may be repeated. By default seat rail z",
    )
    parser.add_argument(
        "--angle",
        metavar="NAME",
        help="rotation that the orders refer to: crank, or a wheel, for example wheel_fr; default: that of the "
        "first force",
    )
    parser.add_argument("--road", default="level", metavar="C", help="road class of ISO 8608; default: %(default)s")
    parser.add_argument(
        "--duration", type=float, default=10.0, metavar="S", help="length of each run [s]; default: %(default)s"
    )
    setting_options(parser, SweepSettings, "engine", default="reduced")
    parser.add_argument("--json", action="store_true", help="print JSON")
    extra_output_options(parser, "orders.csv, orders.png, campbell.png and report.html")
    message_options(parser)
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit code."""
    return parse_and_run(parser(), job, arguments)


def job(options: argparse.Namespace) -> None:
    """Run the car at each speed, and write and print its orders."""
    rpm = points_of("--rpm", options.rpm)
    speeds = points_of("--speed", options.speed)
    if not rpm and not speeds:
        raise ConfigurationError(
            "orders: the speeds are missing; set --rpm A:B:STEP, for example 700:3000:50, or --speed A:B:STEP, "
            "for example 60:160:5"
        )
    if rpm and len(speeds) > 1:
        raise ConfigurationError(
            "--rpm and --speed: only one of them can be a range; with --rpm A:B:STEP give a single speed, for "
            "example --speed 80"
        )
    orders = _orders(options.orders)
    from vehicle.runs.car import Car
    from vehicle.runs.car.order_points import order_points_at
    from vehicle.runs.output.run_size import batch_memory, say_size
    from vehicle.runs.report.order_page import HEADS, order_points_sentences, order_rows

    folder = None if options.output is None else output_folder_of(options, options.output)
    driving = [f"driving.speed={speeds[0] / 3.6!r}"] if rpm and speeds else []
    set_once(options.overrides, "--speed", driving or (["driving.speed="] if speeds else []))
    set_once(options.overrides, "--rpm", ["crank.rpm="] if rpm else [])
    car = Car.load(options.vehicle, [*options.overrides, *driving])
    asked_channels = ",".join(options.channel or ["seat rail z"]).split(",")
    count = len(asked_channels) + len(car.vehicle.damped_wheels)
    samples = options.duration * car.vehicle.solver.record_rate
    memory = batch_memory(samples, count, reduced=options.engine == "reduced")
    say_size(folder or Path(), f"runs of {options.duration:g} s", memory, 0.0, "for less, set a shorter --duration")
    channels = order_points_at(
        car,
        asked_channels,
        rpm=rpm,
        speed=() if rpm else speeds,
        orders=orders,
        angle=options.angle,
        surface=options.road,
        duration=options.duration,
        engine=options.engine,
    )
    caption = f"{len(channels[0].points)} runs of {options.duration:g} s, road {options.road}, engine {options.engine}"
    if folder is not None:
        _write(options, channels, car.vehicle.name, caption)
    if options.json:
        data = [_data(results) for results in channels]
        # Keys of the first channel as without the others.
        print(json.dumps(data[0] | ({"channels": data} if len(data) > 1 else {}), indent=2, allow_nan=False))
        return
    for results in channels:
        print(f"{car.vehicle.name}, {results.channel}, {caption}; amplitudes")
        print("\n".join([*aligned([HEADS, *order_rows(results)], left=0), *order_points_sentences(results)]))


def _data(results: OrderPoints) -> dict[str, Any]:
    """Return the results of a channel for JSON."""
    parts = [
        [{"frequency_hz": part.frequency, "name": part.name, "share": part.share} for part in each]
        for each in results.parts
    ]
    modes = dict(zip(map("{:g}".format, results.orders.tolist()), parts, strict=True))
    return {"channel": results.channel, "angle": results.angle, "unit": results.unit, "rows": results.rows(),
            "parts": modes}  # fmt: skip


def points_of(option: str, text: str | None) -> list[float]:
    """Return the speeds of a text A:B:STEP, or of a single number; none without a text.

    Args:
        option: name of the option, for messages.
        text: its value.

    Raises:
        ConfigurationError: another form, a value that is not positive, or more points than a study runs.
    """
    if text is None:
        return []
    from vehicle.runs.car.order_points import MOST

    try:
        values = [float(part) for part in text.split(":")]
    except ValueError:
        values = []
    if len(values) == 1 and math.isfinite(values[0]) and values[0] > 0.0:
        return values
    if len(values) == 2:
        raise ConfigurationError(
            f"{option} {text}: the step between the speeds is missing, for example "
            f"{text}:{max((values[1] - values[0]) / 20, 1):.0f}; for a run-up type python -m vehicle shaker "
            "--rpm A:B --duration S"
        )
    if len(values) != 3 or not all(map(math.isfinite, values)) or not 0.0 < values[0] < values[1] or values[2] <= 0.0:
        raise ConfigurationError(f"{option} {text!r}: must be A:B:STEP with 0 < A < B, for example 700:3000:50")
    first, last, step = values
    count = math.floor((last - first) / step + 1e-9) + 1
    if count > MOST:
        raise ConfigurationError(f"{option} {text}: gives {count} points, must be at most {MOST}; use a larger step")
    return [round(first + index * step, 9) for index in range(count)]


def _orders(text: str) -> list[float]:
    """Return the orders of the text N,...; half orders too."""
    try:
        orders = [float(part) for part in text.split(",")]
    except ValueError:
        orders = []
    wrong = not orders or any(not 0.0 < order <= 100.0 or (2.0 * order) % 1.0 for order in orders)
    if wrong or len(set(orders)) < len(orders) or len(orders) > MOST_ORDERS:
        raise ConfigurationError(
            f"--orders {text!r}: must be up to {MOST_ORDERS} whole or half orders, each once, for example 2,4"
        )
    return orders


def _write(options: argparse.Namespace, channels: Sequence[OrderPoints], name: str, caption: str) -> None:
    from vehicle.runs.output.folder import output_folder, write_text, write_whole
    from vehicle.runs.report.order_page import draw_cuts, draw_map, order_page
    from vehicle.signals.formats.csv_table import write_table

    command = shlex.join(["python", "-m", "vehicle", "orders", *options.words])
    with output_folder(options.output, force=options.force) as folder:
        for results in channels:
            # The files of the first channel have their names with and without others.
            end = "" if results is channels[0] else f"_{results.channel}"
            heads, columns = results.columns()
            comments = [f"{name}: {results.channel} at orders of {results.angle}; {caption}"]
            table = partial(write_table, cells=heads, columns=columns, comments=comments)
            write_whole(folder / f"orders{end}.csv", table)
            if len(results.points) > 1:
                for stem, draw in (("orders", draw_cuts), ("campbell", draw_map)):
                    picture = partial(draw, orders=results, name=name, caption=caption)
                    write_whole(folder / f"{stem}{end}.png", picture)
        if len(channels[0].points) > 1:
            write_text(folder / "report.html", order_page(channels, name, caption, command=command))
