"""`python -m vehicle new`: make a car from a template car and stated numbers."""

from __future__ import annotations

import argparse
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import FORCE_HELP, command_parser, message_options, read, setting_options
from vehicle.commands.parser import Parser
from vehicle.digits import number
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import field_quantity
from vehicle.model.parameters.shipped import CARS
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.runs.car.motion_figures import MotionFigure
    from vehicle.studies.design.new_car import NewCar

GROUPS = {
    "mass": ("kerb_mass", "front_axle_load", "rear_axle_load", "cog_x", "cog_height"),
    "lengths": ("wheelbase", "track_front", "track_rear", "tyre_radius", "tyre_free_radius"),
    "inertia": ("roll_inertia", "pitch_inertia", "yaw_inertia"),
    "ride": ("ride_frequency_front", "ride_frequency_rear", "pitch_frequency", "wheel_hop_front", "wheel_hop_rear"),
    "dampers": ("damping_ratio_front", "damping_ratio_rear", "damper_curve_front", "damper_curve_rear"),
    "roll": ("roll_stiffness_front", "roll_stiffness_rear"),
    "parts": tuple(
        f"{name}_{axle}"
        for name in (
            "unsprung_mass",
            "wheel_rate",
            "spring_stiffness",
            "tyre_stiffness",
            "wheel_damping",
            "damper_constant",
        )
        for axle in ("front", "rear")
    ),
}
"""Titles of the help, and the numbers of each."""


def parser() -> Parser:
    """Return the parser of the options."""
    from vehicle.studies.design.car_class import CLASSES
    from vehicle.studies.design.stated_numbers import AXLE_LOADS, StatedNumbers, option

    parser = command_parser("new", "Make a car from a template car and its masses, lengths and frequencies.")
    setting_options(parser, NewSettings, "folder", "source")
    parser.add_argument(
        "--car-class",
        dest="car_class",
        choices=CLASSES,
        help="class of the car, which sets default masses, lengths and ride frequencies; electric-suv has an "
        "electric drive, no engine",
    )
    setting_options(parser, NewSettings, "numbers", "table")
    for title, names in GROUPS.items():
        group = parser.add_argument_group(title)
        for name in names:
            declared = field_quantity(StatedNumbers, name)
            file = declared["is_file"]
            unit = f" [{declared['unit']}]" if declared["unit"] != "-" else ""
            unit += ", or its share of the kerb mass, for example 57%%" if name in AXLE_LOADS else ""
            group.add_argument(
                option(name), type=str if file else _kg_or_percent if name in AXLE_LOADS else float,
                metavar="FILE" if file else "X",
                help=f"{declared['meaning']}{unit}",
            )  # fmt: skip
        if "tyre_radius" in names:
            group.add_argument(
                "--tyre-size", metavar="SIZE", help="tyre size, for example 205/55R16, instead of --tyre-radius"
            )
    inertia = field_quantity(StatedNumbers, "inertia")
    parser.add_argument(
        "--inertia", choices=inertia["choices"], help=f"{inertia['meaning']}; default: {inertia['default']}"
    )
    parser.add_argument("--json", action="store_true", help="print the checks as JSON")
    parser.add_argument("--force", action="store_true", help=FORCE_HELP)
    message_options(parser)
    return parser


def _kg_or_percent(text: str) -> float | str:
    """Return a number, or the text: `stated_numbers` resolves "57%" and rejects others."""
    try:
        return float(text)
    except ValueError:
        return text


@dataclass(frozen=True, kw_only=True, slots=True)
class NewSettings(Settings):
    """Settings of a new car.

    Attributes:
        stated: name to stated number, which may be None.
    """

    folder: Path = setting(
        "folder of the new car; the last part of the path is the name of the car",
        flag="folder",
        type=Path,
        metavar="NAME",
    )
    source: str | None = setting(
        "car to start from: a shipped car with four wheels (sedan, focus_road) or the file of a car. Default "
        "with --car-class: sedan. Axles and powertrain are scaled with the mass",
        flag="--from",
        metavar="CAR",
    )
    numbers: Path | None = setting(
        "file with the values of these options ('_' for '-', for example kerb_mass = 1450) and loads as [load.driver]",
        type=Path,
        metavar="FILE.toml",
    )
    table: Sequence[Path] | None = setting(
        "tables of the car: hardpoints, masses, rates, tyres with names and units (CSV, XLSX, .adm, .cmd, .urdf, "
        ".tir); options and --numbers take precedence",
        type=Path,
        nargs="+",
        metavar="FILE",
    )
    stated: Mapping[str, Any] = field(default_factory=dict)
    destination: Destination = part(Destination)


def settings_of(options: argparse.Namespace) -> NewSettings:
    """Return the settings of the parsed options."""
    from vehicle.studies.design.stated_numbers import NAMES

    stated = {key: vars(options)[key] for key in (*NAMES, "tyre_size", "inertia", "car_class")}
    return read(options, NewSettings, stated=stated)


def _job(settings: NewSettings, console: Console) -> None:
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.commands.new_table import plot_table, table_json, table_report
    from vehicle.model.parameters.quantity import NAME_PATTERN
    from vehicle.model.parameters.shipped import vehicle_file
    from vehicle.runs.car.motion_figures import motion_figures
    from vehicle.runs.output.folder import output_folder, write_files, write_text
    from vehicle.runs.output.free_names import named
    from vehicle.studies.design.axle_types import AXLE_TYPES, axle_type_names, with_axles
    from vehicle.studies.design.new_car import new_car, template_files
    from vehicle.studies.design.stated_numbers import stated_numbers
    from vehicle.studies.design.template_car import template_car
    from vehicle.studies.design.written_table import table_lines
    from vehicle.studies.tables.car_table import car_table

    name, from_car, force = settings.folder.name, settings.source, settings.destination.force
    if not NAME_PATTERN.fullmatch(name):
        raise ConfigurationError(f"NAME {str(settings.folder)!r}: its last part must be letters, digits, '_', '.', '-'")
    if name in CARS and settings.folder == Path(name):
        raise ConfigurationError(
            f"NAME {name}: is the name of a shipped car, which --vehicle finds first; choose another name"
        )
    stated = stated_numbers(settings.numbers, settings.stated)
    if from_car is None and settings.table:
        from_car = "sedan"
    if from_car is None:
        if stated.car_class is None:
            raise ConfigurationError(
                "--from is missing; give the car to start from, for example --from sedan, or a class with --car-class"
            )
        from_car = "sedan"
    source = vehicle_file(from_car)
    try:
        folder = named(settings.destination.held, settings.folder, force=force, protect=(source,))
    except ConfigurationError as error:
        raise ConfigurationError(str(error).replace("--output", "NAME", 1)) from None
    of_file, template = None, template_car(source)
    if settings.table:
        of_file = car_table(settings.table, template.point_names, {name: axle_type_names(name) for name in AXLE_TYPES})
        template = with_axles(template, of_file.axles)
        stated = stated_numbers(settings.numbers, settings.stated, of_file.numbers)
    result = new_car(name, from_car, stated, of_file)
    with output_folder(folder, force=force) as temporary:
        write_text(temporary / "vehicle.toml", result.text)
        write_files(temporary, {file.name: file.read_bytes() for file in template_files(source, result.car)})
        if of_file is not None:
            write_text(temporary / "table.csv", "\n".join(table_lines(result, template, of_file)) + "\n")
            if of_file.points:
                plot_table(temporary / "points.svg", result, template, of_file)
    file = folder / "vehicle.toml"
    figures = motion_figures(result.car)
    read = {} if of_file is None else {"table": table_json(of_file)}
    lines = [] if of_file is None else table_report(result, template, of_file)
    console.result({**_checks(result, file, figures), **read}, "\n".join([*lines, _report(result, file, figures)]))


def _report(result: NewCar, file: Path, figures: Sequence[MotionFigure]) -> str:
    """Return the stated numbers with the values of the car, the others with their origin, and its headline figures."""
    from vehicle.runs.car.axle import mass_and_cog
    from vehicle.runs.car.car_text import figures_table
    from vehicle.studies.design.new_car import RIDE_ORDER

    lines = [f"{file}: {result.car.vehicle.name}", f"{'stated':<34}{'value':>10}{'car':>12}{'deviation':>12}"]
    others = [f"{'not stated, largest influence on ride first':<44}{'car':>12}  from"]
    ranks = {name: rank for rank, name in enumerate(RIDE_ORDER)}
    for check in sorted(result.checks, key=lambda check: ranks.get(check.name, len(ranks)) if check.origin else -1):
        name = check.name.replace("_", " ") + (f" [{check.unit}]" if check.unit != "-" else "")
        if check.origin:
            others.append(f"{name:<44}{number(check.value, 4):>12}  {check.origin}")
        else:
            lines.append(f"{name:<34}{check.stated:>10.6g}{check.value:>12.6g}{100.0 * check.deviation:z10.3f} %")
    others += [f"{name:<56}  {origin}" for name, origin in result.parts]
    table = figures_table(figures, mass_and_cog(result.car)[0])
    lines += ["", *others, "", str(table), "", *(f"note: {text}" for text in _notes(result))]
    lines.append(f"run it: python -m vehicle shaker --vehicle {file} --road B --speed 80")
    return "\n".join(lines)


def _checks(result: NewCar, file: Path, figures: Sequence[MotionFigure]) -> dict[str, Any]:
    """Return checks and headline figures for JSON."""
    rows = {}
    for check in result.checks:
        numbers = {"stated": check.stated, "value": check.value, "deviation": check.deviation}
        finite = {name: None if value is None or math.isnan(value) else value for name, value in numbers.items()}
        rows[check.name] = {"unit": check.unit, **finite, "origin": check.origin}
    return {
        "file": str(file),
        "checks": rows,
        "parts": dict(result.parts),
        "figures": [asdict(figure) for figure in figures],
        "notes": _notes(result),
    }


def _notes(result: NewCar) -> list[str]:
    """Return the notes of a new car and those on the damping of its figures."""
    from vehicle.runs.car.motion_figures import damper_notes

    return [*result.notes, *damper_notes(result.car)]


main = command(parser, settings_of, _job)
