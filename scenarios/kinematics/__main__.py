"""Kinematics and compliance of the axles of all cars, and of axles with a moved hardpoint.

python -m scenarios.kinematics [--output DIR] [--quick] [--vehicle FILE]... [--point PATH] [--shift MM]
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from scenarios.claims import Findings
from scenarios.kinematics.axles import POINT, Axle, Moved, axles_of, moved_axles
from scenarios.kinematics.claims import axle_table, claims
from scenarios.kinematics.figures import compliance_figure, moved_figure, travel_figure
from scenarios.study import Study, study_parser
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.runs.car import Car

REACH = 60
"""Wheel travel to both sides [mm]."""


def study(files: Sequence[Path], folder: Path, options: argparse.Namespace) -> Findings:
    """Measure all axles, write their figures into the folder, and return the findings."""
    step = 20 if options.quick else 4
    travels = [1e-3 * z for z in range(-REACH, REACH + 1, step)]
    shift = 1e-3 * options.shift
    moved = moved_axles(files, options.point, shift, travels)
    axles = axles_of([Car.load(file) for file in files], travels)
    travel_figure(folder / "travel.png", axles)
    compliance_figure(folder / "compliance.png", axles)
    moved_figure(folder / "point_moved.png", moved, options.point)
    return Findings(
        title="Kinematics and compliance of axles",
        claims=claims(axles, moved),
        notes=[axle_table(axles), *findings(axles), *(sentence(moved_point, options.point) for moved_point in moved)],
        data={
            "axles": {axle.label: {"equal": axle.slopes, "opposite": axle.rolling} for axle in axles},
            "moved": {
                moved_point.label: {"gain_deg_per_m2": moved_point.gain, "neutral_m": moved_point.neutral}
                for moved_point in moved
            },
        },
    )


def findings(axles: Sequence[Axle]) -> list[str]:
    """Return sentences on the table of the axles."""

    def each(say: str, value: Callable[[Axle], float]) -> str:
        ranked = sorted((axle for axle in axles if math.isfinite(value(axle))), key=lambda axle: -abs(value(axle)))
        return ", ".join(f"{axle.label} {value(axle):{say}}" for axle in ranked)

    def slope(name: str) -> Callable[[Axle], float]:
        # Rounded, so that what is nothing has no sign.
        return lambda axle: round(0.1 * float(axle.slopes[name] or 0.0), 3) + 0.0

    def rate(axle: Axle) -> float:
        return float(axle.slopes["wheel_rate_n_per_m"] or math.nan)

    return [
        f"Camber over equal travel [deg per 100 mm]: {each('+.2f', slope('camber_deg_per_m'))}.",
        f"Toe-in over equal travel [deg per 100 mm]: {each('+.2f', slope('toe_deg_per_m'))}.",
        "What bushings add by their twist to the wheel rate that the spring alone makes with ideal joints, or take "
        f"from it by yielding: {each('+.0%', lambda axle: rate(axle) / axle.from_spring - 1.0)}.",
        "Wheel rate over opposite travel, times that over equal travel: "
        f"{each('.2f', lambda axle: float(axle.rolling['wheel_rate_n_per_m'] or math.nan) / rate(axle))}.",
        "Toe-in of the outer wheel in a bend, under 1 kN towards the middle of the bend [deg]: "
        f"{each('+.3f', lambda axle: -axle.across.toe_deg)}; negative understeers in front and oversteers behind.",
    ]


def sentence(moved_point: Moved, point: str) -> str:
    """Return a sentence on the effect of moving the point."""
    if not math.isfinite(moved_point.neutral):
        return f"{moved_point.label}: {point} does not change toe."
    middle = moved_point.toe_slopes[len(moved_point.shifts) // 2]
    return (
        f"{moved_point.label}: {point} higher by 10 mm changes the slope of toe-in by "
        f"{1e-3 * moved_point.gain:+.2f} deg per 100 mm, "
        f"from {0.1 * middle:+.2f}; by this slope toe would not change over small travel with it moved by "
        f"{1e3 * moved_point.neutral:+.0f} mm."
    )


def load(options: argparse.Namespace) -> list[Path]:
    """Return the vehicle files; check the options before the folder is created."""
    if not 0.1 <= options.shift <= 100.0:
        raise ConfigurationError(f"--shift {options.shift:g}: allowed are 0.1 to 100 mm")
    return options.vehicle or [vehicle_file(name) for name in CARS]


def parser() -> Parser:
    """Return the parser of the study."""
    study_options = study_parser("kinematics", quick="few points on the curves", jobs="; this study is one process")
    study_options.add_argument(
        "--vehicle",
        type=vehicle_file,
        action="append",
        metavar="FILE.toml",
        help=f"vehicle file, or the name of a shipped car: {', '.join(CARS)}; all of these by default; may be repeated",
    )
    study_options.add_argument(
        "--point", default=POINT, metavar="PATH", help="coordinate that is moved; %(default)s by default"
    )
    study_options.add_argument(
        "--shift", type=float, default=10.0, metavar="MM", help="by how much [mm]; %(default)s by default"
    )
    return study_options


main = Study(parser=parser(), load=load, study=study)


if __name__ == "__main__":
    sys.exit(main())
