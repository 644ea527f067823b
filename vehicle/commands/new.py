"""`python -m vehicle new`: make a car from a template car and stated numbers."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import command, print_result
from vehicle.commands.options import FORCE_HELP, command_parser, message_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import field_quantity
from vehicle.model.parameters.shipped import CARS

if TYPE_CHECKING:
    from vehicle.runs.car.motion_figures import MotionFigure
    from vehicle.studies.design.new_car import NewCar

GROUPS = {
    "mass": ("kerb_mass", "front_axle_load", "rear_axle_load", "cog_x", "cog_height"),
    "lengths": ("wheelbase", "track_front", "track_rear", "tyre_radius"),
    "inertia": ("roll_inertia", "pitch_inertia", "yaw_inertia"),
    "ride": ("ride_frequency_front", "ride_frequency_rear", "pitch_frequency", "wheel_hop_front", "wheel_hop_rear"),
    "dampers": ("damping_ratio_front", "damping_ratio_rear", "damper_curve_front", "damper_curve_rear"),
    "roll": ("roll_stiffness_front", "roll_stiffness_rear"),
}
"""Titles of the help, and the numbers of each."""


def parser() -> Parser:
    """Return the parser of the options."""
    from vehicle.studies.design.car_class import CLASSES
    from vehicle.studies.design.stated_numbers import AXLE_LOADS, StatedNumbers, option

    parser = command_parser("new", "Make a car from a template car and its masses, lengths and frequencies.")
    parser.add_argument(
        "folder",
        type=Path,
        metavar="NAME",
        help="folder of the new car; the last part of the path is the name of the car",
    )
    parser.add_argument(
        "--from",
        dest="source",
        metavar="CAR",
        help="car to start from: a shipped car with four wheels (sedan, focus_road) or the file of a car. Default "
        "with --car-class: sedan. Axles and powertrain are scaled with the mass",
    )
    parser.add_argument(
        "--car-class",
        dest="car_class",
        choices=CLASSES,
        help="class of the car, which sets default masses, lengths and ride frequencies; electric-suv has an "
        "electric drive, no engine",
    )
    parser.add_argument(
        "--numbers",
        type=Path,
        metavar="FILE.toml",
        help="file with the values of these options ('_' for '-', for example kerb_mass = 1450) and loads as "
        "[load.driver]",
    )
    for title, names in GROUPS.items():
        group = parser.add_argument_group(title)
        for name in names:
            declared = field_quantity(StatedNumbers, name)
            file = declared["is_file"]
            unit = f" [{declared['unit']}]" if declared["unit"] != "-" else ""
            unit += ", or as 57%% of the kerb mass" if name in AXLE_LOADS else ""
            group.add_argument(
                option(name), type=str if file else _kg_or_percent if name in AXLE_LOADS else float,
                metavar="FILE" if file else "X",
                help=f"{declared['meaning']}{unit}",
            )  # fmt: skip
        if "tyre_radius" in names:
            group.add_argument(
                "--tyre-size", metavar="SIZE", help="size of the tyres, as 205/55R16, instead of --tyre-radius"
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
    """Return a number, or a text that is none, as "57%", which `stated_numbers` resolves or rejects."""
    try:
        return float(text)
    except ValueError:
        return text


def _job(options: argparse.Namespace) -> None:
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.model.parameters.quantity import NAME_PATTERN
    from vehicle.model.parameters.shipped import vehicle_file
    from vehicle.runs.car.motion_figures import motion_figures
    from vehicle.runs.output.folder import output_folder, write_files, write_text
    from vehicle.runs.output.free_names import named
    from vehicle.studies.design.new_car import new_car, template_files
    from vehicle.studies.design.stated_numbers import NAMES, stated_numbers

    name = options.folder.name
    if not NAME_PATTERN.fullmatch(name):
        raise ConfigurationError(f"NAME {str(options.folder)!r}: its last part must be letters, digits, '_', '.', '-'")
    if name in CARS and options.folder == Path(name):
        raise ConfigurationError(
            f"NAME {name}: is the name of a shipped car, which --vehicle would find first; choose another name"
        )
    stated = stated_numbers(
        options.numbers, {key: getattr(options, key) for key in (*NAMES, "tyre_size", "inertia", "car_class")}
    )
    if options.source is None:
        if stated.car_class is None:
            raise ConfigurationError(
                "--from is missing; give the car to start from, for example --from sedan, or a --car-class"
            )
        options.source = "sedan"
    source = vehicle_file(options.source)
    try:
        folder = named(options.held, options.folder, force=options.force, protect=(source,))
    except ConfigurationError as error:
        raise ConfigurationError(str(error).replace("--output", "NAME", 1)) from None
    result = new_car(name, options.source, stated)
    with output_folder(folder, force=options.force) as temporary:
        write_text(temporary / "vehicle.toml", result.text)
        write_files(temporary, {file.name: file.read_bytes() for file in template_files(source, result.car)})
    file = folder / "vehicle.toml"
    figures = motion_figures(result.car)
    print_result(options, _checks(result, file, figures), _report(result, file, figures))


def _report(result: NewCar, file: Path, figures: Sequence[MotionFigure]) -> str:
    """Return the checks as text: each number, its stated value and the value of the car; then its headline figures."""
    from vehicle.runs.car.car_text import figures_table

    lines = [f"{file}: {result.car.vehicle.name}", f"{'':<34}{'stated':>10}{'car':>12}{'deviation':>12}"]
    for check in result.checks:
        unit = f" [{check.unit}]" if check.unit != "-" else ""
        stated = "-" if check.stated is None else f"{check.stated:.6g}"
        deviation = "" if check.stated is None else f"{100.0 * check.deviation:z.3f} %"
        lines.append(f"{check.name.replace('_', ' ') + unit:<34}{stated:>10}{check.value:>12.6g}{deviation:>12}")
    lines += ["", str(figures_table(figures)), "", *(f"note: {text}" for text in _notes(result))]
    lines.append(f"run it: python -m vehicle shaker --vehicle {file} --road B --speed 80")
    return "\n".join(lines)


def _checks(result: NewCar, file: Path, figures: Sequence[MotionFigure]) -> dict[str, Any]:
    """Return checks and headline figures for JSON."""
    rows = {}
    for check in result.checks:
        numbers = {"stated": check.stated, "value": check.value, "deviation": check.deviation}
        finite = {name: None if value is None or math.isnan(value) else value for name, value in numbers.items()}
        rows[check.name] = {"unit": check.unit, **finite}
    return {
        "file": str(file),
        "checks": rows,
        "figures": [asdict(figure) for figure in figures],
        "notes": _notes(result),
    }


def _notes(result: NewCar) -> list[str]:
    """Return the notes of a new car and those on the damping of its figures."""
    from vehicle.runs.car.motion_figures import damper_notes

    return [*result.notes, *damper_notes(result.car)]


main = command(parser, _job)
