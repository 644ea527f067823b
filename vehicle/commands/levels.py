"""`python -m vehicle levels CAR`: FRFs of a car at every level, and the level at which each damper begins to slip."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console, ProgressLine
from vehicle.commands.options import (
    car_argument,
    command_parser,
    figures_option,
    message_options,
    output_options,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, finite_numbers, pair, part, setting

if TYPE_CHECKING:
    from vehicle.arrays import Vector
    from vehicle.runs.car import Car

FREQUENCY, LEVEL, FORCE_LEVEL, RANDOM_LEVEL = "1:30:100", "0.01:10:24", "1:1000:24", "0.1:10:7"
"""Default frequencies [Hz], levels of plates [mm], of forces [N or N m] and of random plates [mm RMS]."""

FACTORS = {"mm": (1e-3, "m"), "m/s2": (1.0, "m/s2"), "N": (1.0, "N"), "N m": (1.0, "N m")}
"""Unit of a level to its factor and its SI unit."""

OF_SINES = ("applied_force", "frequency", "at", "band", "samples")
"""Settings of sinusoidal inputs alone."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "levels", "Compute FRFs over frequency and level, and where the dampers slip: periodic states of the car."
    )
    car_argument(parser, "levels")
    setting_options(parser, LevelSettings)
    parser.add_argument("--json", action="store_true", help="print JSON")
    output_options(parser, None, default="runs/levels_<name of the car>")
    figures_option(parser)
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class LevelSettings(Settings):
    """Settings of the command.

    Attributes:
        figures: write pictures (PNG).
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
    applied_force: str | None = setting(
        "a force of the car in place of the plates: its name, for example crank_torque of [force.crank_torque], "
        "imbalance_fr for both parts of an imbalance, or shares as fl_x=1,fl_z=1@90",
        metavar="NAME",
    )
    axle_delay: float | None = setting(
        "speed of the car over the plates [km/h]: rear axles move later; default: no delay",
        type=float,
        metavar="KM/H",
        within="(0, inf)",
    )
    frequency: str = setting(
        "frequencies [Hz]: LOW:HIGH:N, at equal ratios, or N,...; default: %(default)s", FREQUENCY, metavar="HZ"
    )
    level: str | None = setting(
        "amplitudes of the plates [mm], or with the unit as '0.1:10:24 m/s2'; of a force [N or N m]: LOW:HIGH:N, at "
        f"equal ratios, or N,...; default: {LEVEL}, of a force {FORCE_LEVEL}",
        metavar="MM",
    )
    channels: str = setting(
        "channels by name or words, the first for peak and damping; default: %(default)s",
        "seat rail z",
        metavar="NAME,...",
    )
    random: str | None = setting(
        "take a random input in place of sines; flat: flat velocity spectrum, 0.5 to 40 Hz, as of a road after ISO "
        "8608. --level is the RMS [mm] then",
        choices=("flat",),
    )
    realisations: int | None = setting(
        "random signals at each level; default: 40", type=int, metavar="N", within="[4, 1000]"
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


def levels_of(text: str, force: bool) -> tuple[Vector, str | None]:
    """Return levels and their SI unit; no unit for levels of a force in text without a unit.

    Raises:
        ConfigurationError: another form or unit.
    """
    values, _, unit = text.strip().partition(" ")
    unit = " ".join(unit.split())
    if not unit and force:
        return numbers("--level", values, "N"), None
    if unit not in ("", *FACTORS):
        raise ConfigurationError(f"--level {text}: unit {unit!r}, must be {', '.join(FACTORS)}")
    factor, si = FACTORS[unit or "mm"]
    return factor * numbers("--level", values, unit or "mm"), si


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

    lines = numbers("--frequency", settings.frequency, "Hz")
    force = settings.applied_force is not None
    default = RANDOM_LEVEL if settings.random else FORCE_LEVEL if force else LEVEL
    levels, unit = levels_of(settings.level or default, force)
    of_sines = [f"--{name.replace('_', '-')}" for name in settings.given() if name in OF_SINES]
    if settings.random and (of_sines or unit != "m"):
        wrong = ", ".join(of_sines) or f"--level in {unit}"
        raise ConfigurationError(f"--random: {wrong} belongs to sinusoidal inputs; leave it out, with levels in mm")
    if settings.realisations and not settings.random:
        raise ConfigurationError("--realisations: belongs to a random input; add --random flat")
    cuts = list(dict.fromkeys(cut_frequency(text) for text in settings.at or ()))
    car = Car.load(settings.car.vehicle, settings.car.overrides)
    inputs = () if settings.car.vehicle is None else (settings.car.vehicle,)
    folder = settings.destination.folder(Path("runs") / f"levels_{car.vehicle.name}", protect=inputs)
    progress = console.progress("periodic states")
    if settings.random:
        return _random(settings, console, car, levels, folder, inputs, progress)

    def states(frequency: Vector | list[float], progress: Callable[[float], None] | None = None):  # type: ignore[no-untyped-def]
        return car.levels(
            plates=settings.plates,
            force=settings.applied_force,
            axle_delay=settings.axle_delay,
            frequency=frequency,
            level=levels,
            level_unit=unit,
            channels=settings.channels.split(","),
            samples=settings.samples,
            progress=progress,
        )

    try:
        report = LevelReport(states(lines, progress), settings.band)
        at = {frequency: states([frequency]) for frequency in cuts}
    finally:
        progress.stop()
    files = write_levels(folder, report, at, force=settings.destination.force, figures=settings.figures, protect=inputs)
    text = "\n".join([printed(report, folder, files), *(printed_cut(report, cut) for cut in at.values())])
    console.result(summary_of(report, files), text)
    for notice in report.states.notices:
        console.notice(notice)


def _random(
    settings: LevelSettings,
    console: Console,
    car: Car,
    levels: Vector,
    folder: Path,
    inputs: tuple[Path, ...],
    progress: ProgressLine,
) -> None:
    from vehicle.runs.output.random_level_files import printed_random, random_summary, write_random_levels

    try:
        states = car.random_levels(
            level=levels,
            plates=settings.plates,
            axle_delay=settings.axle_delay,
            channels=settings.channels.split(","),
            realisations=settings.realisations or 40,
            progress=progress,
        )
    finally:
        progress.stop()
    files = write_random_levels(
        folder, states, force=settings.destination.force, figures=settings.figures, protect=inputs
    )
    console.result(random_summary(states, files), printed_random(states, folder, files))
    for notice in states.notices:
        console.notice(notice)


main = command(parser, LevelSettings, _job)
