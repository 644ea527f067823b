"""`python -m vehicle kinematics`: kinematics and compliance (K&C) of an axle."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import (
    command_parser,
    extra_output_options,
    message_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, finite_numbers, part, setting

if TYPE_CHECKING:
    from vehicle.engines.kinematics.axle_statics import WheelPose
    from vehicle.engines.kinematics.wheel_geometry import WheelGeometry

MOST_POSITIONS = 2001
"""Positions of one table: 0.1 mm over 200 mm."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "kinematics", "Compute camber, toe, loads, roll centre and steering axis of an axle over wheel travel and load."
    )
    vehicle_options(parser)
    setting_options(parser, KinematicsSettings, "axle", "travel", "opposite")
    loads = parser.scoped_group(
        "loads on the wheels",
        needs="elastic bushings, but --ideal makes them rigid joints; remove one of the two",
        active=lambda options: not options.ideal,
    )
    for name, quantity in (("contact-force", "force [N]"), ("moment", "moment [N m]")):
        loads.add_argument(
            f"--{name}",
            action="append",
            default=[],
            metavar="AXIS=VALUE",
            help=f"{quantity} on both wheels at their contact points (x to the rear, y to the right, z up), for "
            "example x=1000; with --opposite in opposite directions. May be repeated",
        )
    setting_options(parser, KinematicsSettings, "ideal", "tyre")
    extra_output_options(parser, "kinematics.csv and kinematics.png")
    parser.former("--replace", "--replace: no such option; use --force to replace files")
    parser.former(
        "--force(=| [^-])",
        "--force replaces files and takes no value; apply a force to the wheels with --contact-force AXIS=VALUE",
    )
    parser.add_argument("--json", action="store_true", help="print JSON")
    message_options(parser)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class KinematicsSettings(Settings):
    """Settings of kinematics and compliance of an axle.

    Attributes:
        contact_force, moment: components "AXIS=VALUE" on both wheels at their contact points [N, N m].
    """

    car: CarChoice = part(CarChoice)
    axle: str = setting("axle, a section of the vehicle file; default: %(default)s", "front", metavar="NAME")
    travel: str = setting(
        "travel of the wheel centres [mm], upwards positive; default: %(default)s", "-50:50:5", metavar="A:B[:STEP]"
    )
    opposite: bool = setting(
        "move the wheels in opposite directions, like roll: left wheel down, right wheel up", False, action="store_true"
    )
    contact_force: tuple[str, ...] = ()
    moment: tuple[str, ...] = ()
    ideal: bool = setting(
        "replace every bushing by an ideal joint: kinematics without elasticity", False, action="store_true"
    )
    tyre: str = setting(
        "rolling: the tyres roll freely, without horizontal force; standing: each tyre keeps the horizontal "
        "force and torque of the car at rest on plates; default: %(default)s",
        "rolling",
        choices=("rolling", "standing"),
    )
    destination: Destination = part(Destination)


def _job(settings: KinematicsSettings, console: Console) -> None:
    from vehicle.engines.kinematics.axle_curves import design_slopes, geometry_curve, travel_curve
    from vehicle.runs.car import Car
    from vehicle.runs.car.axle import axle_statics, car_at_rest, direction_to_middle

    travels = _travels(settings.travel)
    load = np.array([*_vector("--contact-force", settings.contact_force), *_vector("--moment", settings.moment)])
    output = settings.destination.output
    folder = None if output is None else settings.destination.folder(output)
    car = car_at_rest(Car.load(settings.car.vehicle, settings.car.overrides))
    statics = axle_statics(car, settings.axle, ideal=settings.ideal, standing=settings.tyre == "standing")
    rates = design_slopes(statics, opposite=settings.opposite, load=load)
    poses = travel_curve(statics, travels, opposite=settings.opposite, load=load)
    towards = direction_to_middle(car, settings.axle)
    geometry = geometry_curve(statics, travels, towards=towards, opposite=settings.opposite, load=load)
    if folder is not None:
        _write(settings, folder, car.vehicle.name, poses, geometry)
    rows = [
        {k: None if math.isnan(v) else v for entry in pair for k, v in dataclasses.asdict(entry).items()}
        for pair in zip(poses, geometry, strict=True)
    ]
    content = {"axle": settings.axle, "rates": rates, "rows": rows}
    console.result(content, _report(settings, poses, geometry, rates))


def _travels(text: str) -> list[float]:
    """Return the wheel travels [m] of the text A:B[:STEP] in mm."""
    numbers = finite_numbers(text, ":")
    first, last, step = (*numbers, 5.0)[:3] if len(numbers) in (2, 3) else (0.0, 0.0, 0.0)
    if not (first < last and step > 0.0):
        raise ConfigurationError(
            f"--travel {text!r}: must be A:B or A:B:STEP [mm] with A below B, for example -50:50:5"
        )
    count = math.floor((last - first) / step + 1e-9) + 1
    if count > MOST_POSITIONS:
        raise ConfigurationError(
            f"--travel {text!r}: gives {count} positions, but at most {MOST_POSITIONS} are allowed; use a larger step"
        )
    return [round(first + index * step, 9) * 1e-3 for index in range(count)]


def _vector(option: str, entries: Sequence[str]) -> list[float]:
    """Return the vector of repeated AXIS=VALUE options."""
    vector = dict.fromkeys("xyz", 0.0)
    for entry in entries:
        axis, _, text = entry.partition("=")
        value = finite_numbers(text, ",")
        if axis not in vector or len(value) != 1:
            raise ConfigurationError(
                f"{option} {entry!r}: must be AXIS=VALUE with x, y or z and a number, for example x=1000"
            )
        (vector[axis],) = value
    return list(vector.values())


HEADS = {
    "wheel_travel_m": "travel [mm]",
    "camber_deg": "camber [deg]",
    "toe_deg": "toe-in [deg]",
    "lateral_m": "lateral [mm]",
    "longitudinal_m": "longitudinal [mm]",
    "patch_lateral_m": "patch lateral [mm]",
    "patch_longitudinal_m": "patch long. [mm]",
    "load_n": "load [N]",
    "strut_length_m": "spring [mm]",
}
"""Columns of the first printed table: lengths in mm."""

GEOMETRY_HEADS = {
    "roll_centre_height_m": "roll centre [mm]",
    "front_swing_arm_m": "front arm [m]",
    "side_swing_arm_m": "side arm [m]",
    "brake_support_deg": "brake [deg]",
    "drive_support_deg": "drive [deg]",
    "caster_deg": "caster [deg]",
    "kingpin_inclination_deg": "kingpin [deg]",
    "caster_trail_m": "trail [mm]",
    "scrub_radius_m": "scrub [mm]",
}
"""Columns of the second printed table: swing arms in m, other lengths in mm."""

COLUMNS = (*HEADS, *GEOMETRY_HEADS, "roll_centre_lateral_m", "side_swing_height_m")
"""Columns of kinematics.csv."""


def _report(
    settings: KinematicsSettings, poses: list[WheelPose], geometry: list[WheelGeometry], rates: dict[str, float | None]
) -> str:
    """Return the two tables as text."""
    joints = "ideal joints" if settings.ideal else "compliant bushings"
    lines = [
        f"{settings.axle} axle, right wheel: changes from the design position; {joints}"
        + ("; left wheel opposite" if settings.opposite else ""),
        "camber: top outwards +, toe: front inwards +, lateral: outwards +, longitudinal: to the rear +",
        *_rows(HEADS, [dataclasses.asdict(pose) for pose in poses]),
        "roll centre: height above the ground; swing arms: inwards and towards the middle of the car +; "
        "anti-dive, anti-lift and anti-squat angles: + if they reduce dive, lift and squat",
        *_rows(
            {"wheel_travel_m": HEADS["wheel_travel_m"], **GEOMETRY_HEADS},
            [
                {**dataclasses.asdict(entry), "wheel_travel_m": pose.wheel_travel_m}
                for pose, entry in zip(poses, geometry, strict=True)
            ],
        ),
    ]
    if rates["wheel_rate_n_per_m"] is not None:
        travel = ", opposite travel: anti-roll bar or beam included" if settings.opposite else ""
        lines.append(f"wheel rate {1e-3 * rates['wheel_rate_n_per_m']:.2f} N/mm{travel}")
    camber, toe = (0.1 * (rates[f"{name}_deg_per_m"] or 0.0) for name in ("camber", "toe"))
    lines.append(f"in the design position: camber {camber:z.3f} and toe-in {toe:z.3f} deg per 100 mm")
    return "\n".join(lines)


def _rows(heads: dict[str, str], values: list[dict[str, float]]) -> list[str]:
    """Return the lines of a table: its heads, then a line for each position."""
    widths = [max(len(head), 8) for head in heads.values()]
    lines = ["  ".join(f"{head:>{width}}" for head, width in zip(heads.values(), widths, strict=True))]
    for row in values:
        cells = []
        for (name, head), width in zip(heads.items(), widths, strict=True):
            value = row[name] * (1e3 if head.endswith("[mm]") else 1.0)
            text = "-" if math.isnan(value) else f"{value:z.{0 if name == 'wheel_travel_m' else 3}f}"
            cells.append(f"{text:>{width}}")
        lines.append("  ".join(cells))
    return lines


def _write(
    settings: KinematicsSettings, output: Path, name: str, poses: list[WheelPose], geometry: list[WheelGeometry]
) -> None:
    from vehicle.drawing.rendering.kinematics_plot import plot_kinematics
    from vehicle.runs.output.folder import output_folder, write_files
    from vehicle.signals.formats.csv_table import write_table

    units = {"m": "m", "deg": "deg", "n": "N"}
    heads = [f"{name.rpartition('_')[0]} [{units[name.rpartition('_')[2]]}]" for name in COLUMNS]
    values = [
        {**dataclasses.asdict(pose), **dataclasses.asdict(entry)} for pose, entry in zip(poses, geometry, strict=True)
    ]
    columns = [np.array([row[name] for row in values]) for name in COLUMNS]
    comments = [
        f"{name}, {settings.axle} axle, right wheel: changes from the design position",
        "camber: top outwards +, toe: front inwards +, lateral: outwards +, longitudinal: to the rear +",
    ]
    parts = ["opposite travel" if settings.opposite else "equal travel"]
    parts.append("ideal joints" if settings.ideal else "compliant bushings")
    parts += [f"force {entry} N" for entry in settings.contact_force]
    parts += [f"moment {entry} N m" for entry in settings.moment]
    title = f"{name}: {settings.axle} axle, wheel on the right"
    picture = partial(plot_kinematics, poses=poses, geometry=geometry, title=title, caption="; ".join(parts))
    table = partial(write_table, cells=heads, columns=columns, comments=comments)
    with output_folder(output, force=settings.destination.force) as folder:
        write_files(folder, {"kinematics.csv": table, "kinematics.png": picture})


main = command(parser, KinematicsSettings, _job)
