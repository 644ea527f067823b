"""Kinematics and compliance of the axles of all cars beside each other, and bump steer with the tie rod moved.

python -m scenarios.kinematics [--output DIR] [--quick] [--vehicle FILE]...

`python -m vehicle kinematics` measures one axle, also with any point moved by `--set`.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scenarios.charts import figure_file
from scenarios.claims import OWN_CHECK, Claim, Findings, markdown
from scenarios.study import Study, study_parser
from vehicle.commands.parser import Parser
from vehicle.drawing.rendering.figure import COLOURS
from vehicle.engines.kinematics.axle_curves import SMALL, design_slopes, travel_curve
from vehicle.engines.kinematics.axle_statics import WheelPose
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.shipped import CARS, vehicle_file
from vehicle.runs.car import Car
from vehicle.runs.car.axle import axle_statics

REACH = 60
"""Wheel travel to both sides [mm]."""

FORCE = 1000.0
"""Force at each contact point for compliance [N]."""

SHIFT = 0.01
"""By how much the inner end of the tie rod is moved up and down [m]."""

TWISTED = 5e-3
"""Toe and camber [deg] of an axle that swings about its pivots: bushings of both sides yield alike."""

LEVER_ERROR = 0.1
"""Relative error of the closed form of bump steer: the steering axis tilts and the outer end rises less."""

PANELS = {
    "camber [deg], top outwards +": "camber_deg",
    "toe [deg], front inwards +": "toe_deg",
    "contact point, lateral [mm], outwards +": "patch_lateral_m",
    "wheel centre, longitudinal [mm], to the rear +": "longitudinal_m",
    "vertical load [kN]": "load_n",
    "spring length [mm]": "strut_length_m",
}
"""Label of a panel to its quantity."""

COMPLIANCES = {
    "lateral [mm/kN], lateral force": ("across", "patch_lateral_m", 1e3),
    "toe-in [deg/kN], lateral force": ("across", "toe_deg", 1.0),
    "longitudinal [mm/kN], braking force": ("along", "patch_longitudinal_m", 1e3),
    "toe-in [deg/kN], braking force": ("along", "toe_deg", 1.0),
}
"""Label of a compliance of the right wheel to the direction of the force, the quantity and its scale."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Axle:
    """Kinematics and compliance of an axle of a car, as measured on the rig."""

    label: str  # name of the car and of the axle
    template: str  # template of the axle
    equal: list[WheelPose]  # equal, opposite: poses of the right wheel over equal and opposite travel of both wheels
    opposite: list[WheelPose]
    slopes: dict[str, float | None]  # slopes, rolling: slopes in the design position over equal and opposite travel
    rolling: dict[str, float | None]
    from_spring: float  # wheel rate of the spring with ideal joints, k i^2 + F di/dz [N/m]; nan for a spring on a slide
    across: WheelPose  # across, along: pose under a force to the right and to the rear on both wheels
    along: WheelPose


def measured(car: Car, name: str, travels: Sequence[float]) -> Axle:
    """Measure all curves of an axle of a car, given by name, over travels of the right wheel [m]."""
    statics = axle_statics(car, name, ideal=False)
    pushed = [statics.solve([0.0, 0.0], np.array([force] * 2))[0] for force in FORCE * np.eye(6)[[1, 0]]]
    ideal, from_spring = axle_statics(car, name, ideal=True), math.nan
    if spring := next(iter(statics.parts.springs), None):
        low, design, high = (ideal.solve([z, z])[0].strut_length_m for z in (-SMALL, 0.0, SMALL))
        ratio, bend = (high - low) / (2.0 * SMALL), (high - 2.0 * design + low) / SMALL**2
        # Virtual work: the load of the wheel is the pull of the spring times dL/dz.
        force, rate = spring.pull(0.0)
        from_spring = rate * ratio**2 - force * bend
    return Axle(
        label=f"{car.vehicle.name}, {name}",
        template=str(car.vehicle.table[name]["template"]),
        equal=travel_curve(statics, travels),
        opposite=travel_curve(statics, travels, opposite=True),
        slopes=design_slopes(statics),
        rolling=design_slopes(statics, opposite=True),
        from_spring=from_spring,
        across=pushed[0],
        along=pushed[1],
    )


def axles_of(cars: Sequence[Car], travels: Sequence[float]) -> list[Axle]:
    """Measure every axle with wheels; an axle with the same table in several cars is measured once."""
    axles, seen = [], []
    for car in cars:
        for name in dict.fromkeys(wheel.axle for wheel in car.vehicle.composition.wheels):
            if car.vehicle.table[name] not in seen:
                seen.append(car.vehicle.table[name])
                axles.append(measured(car, name, travels))
    return axles


@dataclass(frozen=True, kw_only=True, slots=True)
class Moved:
    """Bump steer of a front axle with the inner end of the tie rod higher and lower."""

    label: str  # car
    slope: float  # dtoe/dz in the design position [deg/m]
    gain: float  # change of the slope with the height of the point [deg/m2]
    closed_form: float  # the same by `bump_steer_gain`

    @property
    def neutral(self) -> float:
        """Return the shift for constant toe over small travel [m]."""
        return -self.slope / self.gain


def bump_steer_gain(car: Car) -> float:
    """Return the change of the slope of toe per height of the inner end of the front tie rod [deg/m2].

    The rod keeps its length: with the inner end higher by d, its outer end, which rises by dz, must give way by
    d dz / s, s = (O - I) . (k x (O - A)): the knuckle turns about its steering axis k through the lower ball A.
    """
    names = ("tie_outer", "tie_inner", "lower_ball", "strut_top")
    outer, inner, ball, top = (np.array(car.vehicle.points[f"{name}_fr"]) for name in names)
    axis = (top - ball) / np.linalg.norm(top - ball)
    return float(np.degrees(axis[2] / ((outer - inner) @ np.cross(axis, outer - ball))))


def moved_axles(files: Sequence[Path]) -> list[Moved]:
    """Measure the front struts of all cars with the inner end of the tie rod lower, unchanged and higher."""
    moved, seen, path = [], [], "front.hardpoints.tie_inner.z"
    for file in files:
        car = Car.load(file)
        front = car.vehicle.table.get("front")
        if front in seen or not {"tie_inner_fr", "strut_top_fr", "lower_ball_fr"} <= set(car.vehicle.points):
            continue
        seen.append(front)
        heights = (value_of(car.vehicle, path) + shift for shift in (-SHIFT, 0.0, SHIFT))
        cars = [Car.load(file, [f"{path}={height!r}"]) for height in heights]
        low, middle, high = (
            float(design_slopes(axle_statics(each, "front", ideal=False))["toe_deg_per_m"] or 0.0) for each in cars
        )
        gain, closed_form = (high - low) / (2.0 * SHIFT), bump_steer_gain(car)
        moved.append(Moved(label=car.vehicle.name, slope=middle, gain=gain, closed_form=closed_form))
    return moved


def study(files: Sequence[Path], folder: Path, options: argparse.Namespace) -> Findings:
    """Measure all axles, write their figure into the folder, and return the findings."""
    travels = [1e-3 * z for z in range(-REACH, REACH + 1, 20 if options.quick else 4)]
    axles, moved = axles_of([Car.load(file) for file in files], travels), moved_axles(files)
    travel_figure(folder / "travel.png", axles)
    heads = ("car", "toe-in [deg/100 mm]", "tie rod 10 mm higher inside", "none if moved by [mm]")
    steering = []
    for each in moved:
        slopes = (f"{0.1 * slope:+.2f}" for slope in (each.slope, each.slope + SHIFT * each.gain))
        steering.append((each.label, *slopes, f"{1e3 * each.neutral:+.0f}"))
    return Findings(
        title="Kinematics and compliance of axles",
        claims=claims(axles, moved),
        notes=[axle_table(axles), f"Bump steer of the front axles:\n\n{markdown(heads, steering)}"],
        data={
            "axles": {axle.label: {"equal": axle.slopes, "opposite": axle.rolling} for axle in axles},
            "moved": {each.label: {"gain_deg_per_m2": each.gain, "neutral_m": each.neutral} for each in moved},
        },
    )


def claims(axles: Sequence[Axle], moved: Sequence[Moved]) -> list[Claim]:
    """Return the rows that compare axle theory with the rig."""
    rows = []
    for axle in axles:
        if axle.template == "twist_beam":
            largest_angle = max(max(abs(pose.camber_deg), abs(pose.toe_deg)) for pose in axle.equal)
            why = f"it swings about the line through its pivots; {TWISTED:g} deg for the bushings"
            name = f"{axle.label}: camber and toe over equal travel"
            rows.append(
                OWN_CHECK.statement(name, "none", f"at most {largest_angle:.1e} deg", largest_angle <= TWISTED, why)
            )
        equal, rolling = (1e-3 * float(entry["wheel_rate_n_per_m"] or 0.0) for entry in (axle.slopes, axle.rolling))
        rows.append(
            OWN_CHECK.statement(
                f"{axle.label}: wheel rate over opposite travel",
                "not below that over equal travel",
                f"{rolling:.1f} against {equal:.1f} N/mm",
                rolling > 0.999 * equal,
                "an anti-roll bar or a beam twists over opposite travel alone; 0.1 % for axles that have neither",
            )
        )
    for each in moved:
        why = f"a rod of fixed length about the steering axis; {100 * LEVER_ERROR:g} % for what it leaves out"
        name = f"{each.label}: toe slope for a higher inner end of the tie rod [deg/m2]"
        rows.append(OWN_CHECK.number(name, each.closed_form, each.gain, LEVER_ERROR * abs(each.closed_form), why))
    return rows


def axle_table(axles: Sequence[Axle]) -> str:
    """Return the table of slopes and compliances of all axles."""
    heads = ("camber", "toe-in", "patch, lateral", "spring ratio", "wheel rate", "of it the spring", "opposite travel")
    units = ("[deg/100 mm]", "[deg/100 mm]", "[mm/100 mm]", "[-]", "[N/mm]", "[N/mm]", "[N/mm]")
    columns = ["axle", "template", *(f"{head} {unit}" for head, unit in zip(heads, units, strict=True))]
    rows = []
    for axle in axles:
        slope = {name: math.nan if value is None else value for name, value in axle.slopes.items()}
        cells = [0.1 * slope["camber_deg_per_m"], 0.1 * slope["toe_deg_per_m"], 100.0 * slope["patch_lateral_per_m"]]
        cells += [slope["spring_ratio"], 1e-3 * slope["wheel_rate_n_per_m"], 1e-3 * axle.from_spring]
        cells += [1e-3 * float(axle.rolling["wheel_rate_n_per_m"] or 0.0)]
        pushed = [scale * getattr(getattr(axle, way), name) for way, name, scale in COMPLIANCES.values()]
        rows.append([axle.label, axle.template, *map(_cell, (*cells, *pushed))])
    return (
        "Slopes in the design position, equal travel, wheel on the right; compliance under 1 kN to the right or to "
        + (f"the rear on both wheels at the ground:\n\n{markdown([*columns, *COMPLIANCES], rows)}")
    )


def _cell(value: float) -> str:
    """Return a number with three digits; a dash for NaN, no sign for zero."""
    return "-" if math.isnan(value) else f"{round(value, 6) + 0.0:.3g}"


def travel_figure(path: Path, axles: Sequence[Axle]) -> None:
    """Write the curves of all axles over equal and over opposite travel."""
    note = (
        "Right wheel, changes from its design position, body held, bushings as they are; solid: both wheels lifted "
        "alike, dashed: the left wheel goes down where the right one goes up"
    )

    def values(poses: Sequence[WheelPose], name: str) -> list[float]:
        scale = {"m": 1e3, "n": 1e-3}.get(name.rpartition("_")[2], 1.0)
        return [scale * getattr(pose, name) for pose in poses]

    with figure_file(path, (13.0, 8.6), "Axles over wheel travel", note) as figure:
        grid = figure.subplots(2, 3, sharey=True)
        for panel, (label, name) in zip(grid.ravel(), PANELS.items(), strict=True):
            for number, axle in enumerate(axles):
                colour = COLOURS[number % len(COLOURS)]
                for poses, style, text in ((axle.equal, "-", axle.label), (axle.opposite, "--", None)):
                    height = values(poses, "wheel_travel_m")
                    panel.plot(values(poses, name), height, style, color=colour, label=text)
            panel.axhline(0.0, color="#888888", linewidth=0.6)
            panel.set(xlabel=label)
        grid[0, 0].legend(loc="best")
        for panel in grid[:, 0]:
            panel.set(ylabel="wheel travel [mm], upwards +")


def load(options: argparse.Namespace) -> list[Path]:
    """Return the vehicle files."""
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
    return study_options


main = Study(parser=parser(), load=load, study=study)


if __name__ == "__main__":
    sys.exit(main())
