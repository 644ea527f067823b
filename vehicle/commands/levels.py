"""`python -m vehicle levels CAR`: FRFs of a car at every level, and the level at which each damper begins to slip."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import (
    VEHICLE_HELP,
    car_of,
    command_parser,
    destination_of,
    message_options,
    output_options,
    read,
    set_option,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, finite_numbers, pair, part, setting

if TYPE_CHECKING:
    from vehicle.arrays import Vector

FREQUENCY, LEVEL = "1:30:100", "0.01:10:24"
"""Default frequencies [Hz] and levels [mm]."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "levels", "Compute FRFs over frequency and level, and where the dampers slip: periodic states of the car."
    )
    parser.add_argument("car", nargs="?", type=vehicle_file, metavar="CAR", help=VEHICLE_HELP)
    set_option(parser)
    setting_options(parser, LevelSettings)
    parser.former("--vehicle", "--vehicle: no such option; name the car first, for example `levels sedan`")
    parser.add_argument("--json", action="store_true", help="print JSON")
    output_options(parser, None, default="runs/levels_<name of the car>")
    parser.add_argument("--no-figures", dest="figures", action="store_false", help="write no pictures (SVG)")
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class LevelSettings(Settings):
    """Settings of the command.

    Attributes:
        figures: write pictures (SVG).
    """

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    figures: bool = True
    plates: str = setting(
        "motion of the plates: heave, pitch, roll, warp, a wheel, or shares with phases in degrees as fl=1,fr=1@90; "
        "default: %(default)s",
        "heave",
        metavar="NAME",
    )
    frequency: str = setting(
        "frequencies [Hz]: LOW:HIGH:N, at equal ratios, or N,...; default: %(default)s", FREQUENCY, metavar="HZ"
    )
    level: str = setting(
        "amplitudes of the plates [mm]: LOW:HIGH:N, at equal ratios, or N,...; default: %(default)s",
        LEVEL,
        metavar="MM",
    )
    channels: str = setting(
        "channels by name or words, the first for peak and damping; default: %(default)s",
        "seat rail z",
        metavar="NAME,...",
    )
    at: tuple[str, ...] | None = setting(
        'also compute all levels at this frequency, for example "3.7 Hz". May be repeated',
        action="append",
        metavar="HZ",
    )
    band: tuple[float, float] | None = setting(
        "band of the peak [Hz]; default: around the peak that falls most from the lowest to the highest level",
        type=pair("--band", "LOW:HIGH in Hz, for example 2:5"),
        metavar="A:B",
    )
    samples: int = setting(
        "samples of a period; notices name channels that need more; default: %(default)s",
        128,
        type=int,
        metavar="K",
        within="[32, 8192]",
    )


def settings_of(options: argparse.Namespace) -> LevelSettings:
    """Return the settings of the parsed options."""
    return read(options, LevelSettings, car=car_of(options), destination=destination_of(options))


def numbers(option: str, text: str, unit: str) -> Vector:
    """Return the numbers of LOW:HIGH:N at equal ratios, or of a list; (n,).

    Raises:
        ConfigurationError: another form.
    """
    import numpy as np

    if ":" in text:
        low, high, count = (finite_numbers(text, ":") + 3 * [0.0])[:3]
        if text.count(":") == 2 and 0.0 < low < high and count >= 2.0 and count == int(count):
            return np.geomspace(low, high, int(count))
    elif values := finite_numbers(text, ","):
        return np.array(values)
    raise ConfigurationError(
        f"{option} {text}: must be LOW:HIGH:N with 0 < LOW < HIGH in {unit} and at least 2 numbers, for example "
        f"{FREQUENCY if unit == 'Hz' else LEVEL}, or a list of numbers"
    )


def cut_frequency(text: str) -> float:
    """Return the frequency of --at [Hz]."""
    matched = re.fullmatch(r"\s*([\d.eE+-]+)\s*(?:Hz)?\s*", text)
    values = finite_numbers(matched[1], ",") if matched else []
    if not values or values[0] <= 0.0:
        raise ConfigurationError(f'--at {text}: must be a frequency above 0, for example --at "3.7 Hz"')
    return values[0]


def _job(settings: LevelSettings, console: Console) -> None:
    from vehicle.runs.car import Car
    from vehicle.runs.output.level_files import LevelReport, printed, printed_cut, summary_of, write_levels

    lines, levels = numbers("--frequency", settings.frequency, "Hz"), numbers("--level", settings.level, "mm")
    cuts = list(dict.fromkeys(cut_frequency(text) for text in settings.at or ()))
    car = Car.load(settings.car.vehicle, settings.car.overrides)
    inputs = () if settings.car.vehicle is None else (settings.car.vehicle,)
    folder = settings.destination.folder(Path("runs") / f"levels_{car.vehicle.name}", protect=inputs)
    progress = console.progress("periodic states")

    def states(frequency: Vector | list[float], progress: Callable[[float], None] | None = None):  # type: ignore[no-untyped-def]
        return car.levels(
            plates=settings.plates,
            frequency=frequency,
            level=1e-3 * levels,
            channels=settings.channels.split(","),
            samples=settings.samples,
            progress=progress,
        )

    try:
        report = LevelReport(states(lines, progress), settings.plates, settings.band)
        at = {frequency: states([frequency]) for frequency in cuts}
    finally:
        progress.stop()
    files = write_levels(folder, report, at, force=settings.destination.force, figures=settings.figures, protect=inputs)
    text = "\n".join([printed(report, folder, files), *(printed_cut(report, cut) for cut in at.values())])
    console.result(summary_of(report, files), text)
    for notice in report.states.notices:
        console.notice(notice)


main = command(parser, settings_of, _job)
