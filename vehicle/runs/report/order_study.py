"""Orders at steady speeds as a study: settings, files and printed tables, for the commands `orders` and `shaker`."""

from __future__ import annotations

import math
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.digits import aligned
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, engine_setting, part, setting

if TYPE_CHECKING:
    from vehicle.runs.car.order_points import OrderPoints

MOST_ORDERS = 12
"""Maximum number of orders."""

USUAL_LENGTH, USUAL_ENGINE = 10.0, "reduced"
"""Default length of a run [s], and engine."""


@dataclass(frozen=True, kw_only=True, slots=True)
class OrderSettings(Settings):
    """Settings of orders at steady speeds.

    Attributes:
        words: arguments of the command, for the report.
    """

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    words: tuple[str, ...] = ()
    rpm: str | None = setting(
        "speeds of the crankshaft [1/min], for example 700:3000:50; a run at each speed", metavar="A:B:STEP"
    )
    speed: str | None = setting(
        "speeds of the car [km/h], for example 60:160:5; with --rpm a single speed of the car", metavar="A:B:STEP"
    )
    orders: str = setting(
        "orders (multiples of the rotation frequency), for example 2,4; default: %(default)s", "1,2", metavar="N,..."
    )
    channel: tuple[str, ...] | None = setting(
        "acceleration channels, for example seat rail z,roof left rear x; default: seat rail z. May be repeated",
        action="append",
        metavar="WORDS",
    )
    angle: str | None = setting(
        "rotation that the orders refer to: crank, or a wheel, for example wheel_fr; default: that of the first force",
        metavar="NAME",
    )
    road: str = setting("road class of ISO 8608; default: %(default)s", "level", metavar="C")
    duration: float = setting(
        "length of each run [s]; default: %(default)s", USUAL_LENGTH, within="(0, inf)", type=float, metavar="S"
    )
    engine: str = engine_setting(USUAL_ENGINE)


@dataclass(frozen=True, kw_only=True, slots=True)
class OrderStudy:
    """Orders of a car at steady speeds; as text the printed tables.

    Attributes:
        car: name of the car.
        caption: number and length of the runs, road and engine.
        channels: results of each channel.
    """

    car: str
    caption: str
    channels: Sequence[OrderPoints]

    def summary(self) -> dict[str, Any]:
        """Return the results for JSON: those of the first channel, and of all if there are several."""
        data = [_data(results) for results in self.channels]
        return data[0] | ({"channels": data} if len(data) > 1 else {})

    def __str__(self) -> str:
        """Return a table and its findings for each channel."""
        from vehicle.runs.report.order_page import HEADS, order_points_sentences, order_rows

        lines = []
        for results in self.channels:
            lines += [f"{self.car}, {results.channel}, {self.caption}; amplitudes"]
            lines += [*aligned([HEADS, *order_rows(results)], left=0), *order_points_sentences(results)]
        return "\n".join(lines)


def order_study(settings: OrderSettings) -> OrderStudy:
    """Run the car at each speed, and write its orders if there is an output.

    Raises:
        ConfigurationError: no speeds, two ranges of speeds, or orders that cannot be computed.
    """
    rpm = points_of("--rpm", settings.rpm)
    speeds = points_of("--speed", settings.speed)
    if not rpm and not speeds:
        raise ConfigurationError(
            "orders: the speeds are missing; set --rpm A:B:STEP, for example 700:3000:50, or --speed A:B:STEP, "
            "for example 60:160:5"
        )
    if rpm and len(speeds) > 1:
        raise ConfigurationError(
            "--rpm and --speed: only one can be a range; with --rpm A:B:STEP give one speed, for example --speed 80"
        )
    orders = _orders(settings.orders)
    from vehicle.runs.car import Car
    from vehicle.runs.car.order_points import order_points_at
    from vehicle.runs.output.run_size import batch_memory, say_size

    output = settings.destination.output
    folder = None if output is None else settings.destination.folder(output)
    choice = settings.car
    choice.require_once("--speed", ["driving.speed="] if speeds and not rpm else [])
    choice.require_once("--rpm", ["crank.rpm="] if rpm else [])
    choice = choice.rolling(speeds[0]) if rpm and speeds else choice
    car = Car.load(choice.vehicle, choice.overrides)
    asked_channels = ",".join(settings.channel or ["seat rail z"]).split(",")
    memory = batch_memory(
        settings.duration * car.vehicle.solver.record_rate,
        len(asked_channels) + len(car.vehicle.damped_wheels),
        reduced=settings.engine == "reduced",
    )
    say_size(folder or Path(), f"runs of {settings.duration:g} s", memory, 0.0, "for less, choose a shorter --duration")
    channels = order_points_at(
        car,
        asked_channels,
        rpm=rpm,
        speed=() if rpm else speeds,
        orders=orders,
        angle=settings.angle,
        surface=settings.road,
        duration=settings.duration,
        engine=settings.engine,
    )
    caption = (
        f"{len(channels[0].points)} runs of {settings.duration:g} s, road {settings.road}, engine {settings.engine}"
    )
    study = OrderStudy(car=car.vehicle.name, caption=caption, channels=channels)
    if folder is not None:
        _write(study, settings, folder)
    return study


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
        raise ConfigurationError(
            f"{option} {text}: gives {count} points, but at most {MOST} are allowed; use a larger step"
        )
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


def _write(study: OrderStudy, settings: OrderSettings, path: Path) -> None:
    from vehicle.runs.output.folder import output_folder, write_text, write_whole
    from vehicle.runs.report.order_page import draw_cuts, draw_map, order_page
    from vehicle.signals.formats.csv_table import write_table

    name, channels, caption = study.car, study.channels, study.caption
    command = shlex.join(["python", "-m", "vehicle", "orders", *settings.words])
    with output_folder(path, force=settings.destination.force) as folder:
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
