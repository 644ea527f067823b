"""Axles of a vehicle of Chrono as tables of the templates double_wishbone and macpherson.

Joints of Chrono between an arm and the chassis are revolute; here they are a ball joint and a bushing of `RIGID`. Parts
without mass in Chrono (dampers, tie rods without a body) have `SMALL` of the mass of the part that carries them.
Source: ChDoubleWishbone.cpp, ChMacPhersonStrut.cpp and ChUtilsJSON.cpp of Chrono.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.errors import DataError
from vehicle.studies.design.chrono_json import REFLECTION, ChronoFile, tensor

RIGID = 1e7
"""Stiffness in place of a joint without give [N/m]: 0.1 mm under 1 kN, and steps of half a millisecond."""
RIGID_DAMPING = 1e4
"""Its damping [N s/m]."""
SMALL = 0.02
"""Mass of a part that Chrono has without mass, as a share of the mass of the part that carries it."""
EQUAL = 1e-3
"""Distance below which two points are the same [m]."""

CURVE_SPEEDS = (0.015, 0.045, 0.1, 0.18, 0.3, 0.48, 0.75, 1.2, 2.0)
"""Speeds of the points of a degressive damper [m/s]: lines within 2 % of the law."""


@dataclass(kw_only=True, slots=True)
class ImportedAxle:
    """Axle of a car of Chrono in the vehicle frame.

    Attributes:
        template: name of the template.
        points: hardpoints of the right side by name [m].
        parts: mass, inertia, products and centre of gravity [m] of each part by name.
        tables: laws by the path of their table in the axle, as "main_spring".
        sources: source by path in the axle.
        left_out: what the template has no place for.
        changed: numbers that are changed.
        spring: extension [m] and force [N] of the main spring, both positive in extension, (n, 2).
        stretch: its extension at the hardpoints [m].
    """

    template: str
    points: dict[str, Vector]
    parts: dict[str, dict[str, Any]] = field(default_factory=dict)
    tables: dict[str, dict[str, Any]] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
    left_out: list[str] = field(default_factory=list)
    changed: list[str] = field(default_factory=list)
    spring: Vector = field(default_factory=lambda: np.zeros((0, 2)))
    stretch: float = 0.0

    def add_part(self, name: str, mass: float, cog: Vector, inertia: Vector | None, source: str) -> None:
        """Add a part with its tensor of inertia about its centre of gravity [kg m2]; None: as a rod."""
        part: dict[str, Any] = {"mass": mass}
        if inertia is not None:
            inertia, raised = _possible(inertia)
            if raised > 0.0:
                self.changed.append(f"{source.removeprefix('Chrono ')}: the largest moment of inertia exceeds "
                                    f"the sum of the two others; these are raised by {raised:.3g} kg m2")  # fmt: skip
            moments = np.diag(inertia)
            part["inertia"] = [rounded(value, 9) for value in moments]
            products = -np.array([inertia[0, 1], inertia[0, 2], inertia[1, 2]])
            if np.max(np.abs(products)) > 1e-9 * moments.sum():
                part["products"] = [rounded(value, 9) + 0.0 for value in products]
        self.parts[name] = {**part, "cog": cog}
        self.sources[f"parts.{name}"] = source

    def split_off(self, name: str, carrier: str, at: Vector, *, rod: bool = False) -> None:
        """Add a small part at a point, whose mass is taken from the part that carries it."""
        mass = SMALL * self.parts[carrier]["mass"]
        self.parts[carrier]["mass"] -= mass
        inertia = None if rod else np.eye(3) * mass * 0.05**2
        source = f"assumed: without mass in Chrono; {100 * SMALL:g} % of the mass of {carrier}, taken from it"
        self.add_part(name, mass, at, inertia, source)


def imported_axle(file: ChronoFile, to_vehicle: Callable[[Vector], Vector]) -> ImportedAxle:
    """Return the axle of a suspension file.

    Args:
        to_vehicle: function from a point of the left side in the frame of the suspension to the right side here.

    Raises:
        DataError: a suspension without a template here, or a wrong or missing value.
    """
    template = file.text("Template")
    if template == "DoubleWishbone":
        axle = _double_wishbone(file, to_vehicle)
    elif template == "MacPhersonStrut":
        axle = _strut(file, to_vehicle)
    else:
        raise DataError(f"{file.path}: found a suspension of type {template!r}, must be DoubleWishbone or "
            "MacPhersonStrut; for other axles write a template (docs: how to add an axle)")  # fmt: skip
    _add_spindle(axle, file, to_vehicle)
    for name in ("Camber Angle (deg)", "Toe Angle (deg)"):
        if name in file and (angle := file.number(name)) != 0.0:
            axle.left_out.append(f"{file.source(name)} = {angle:g}: the wheels stand upright and straight")
    if "Axle" in file:
        axle.left_out.append(f"{file.source('Axle')}: inertia of the drive shafts, which have no part here")
    return axle


def _double_wishbone(file: ChronoFile, to_vehicle: Callable[[Vector], Vector]) -> ImportedAxle:
    upper, lower = file.section("Upper Control Arm"), file.section("Lower Control Arm")
    tie, spring, shock = file.section("Tierod"), file.section("Spring"), file.section("Shock")
    sources_of_points = {
        "lower_ball": (lower, "Location Upright"),
        "lower_front": (lower, "Location Chassis Front"),
        "lower_rear": (lower, "Location Chassis Back"),
        "upper_ball": (upper, "Location Upright"),
        "upper_front": (upper, "Location Chassis Front"),
        "upper_rear": (upper, "Location Chassis Back"),
        "spring_lower": (spring, "Location Arm"),
        "spring_upper": (spring, "Location Chassis"),
        "damper_lower": (shock, "Location Arm"),
        "damper_upper": (shock, "Location Chassis"),
        "tie_outer": (tie, "Location Upright"),
        "tie_inner": (tie, "Location Chassis"),
    }
    axle = _axle_of_points("double_wishbone", sources_of_points, to_vehicle)
    vehicle_frame = file.table.get("Vehicle-Frame Inertia") is True
    for name, section in (("lower_arm", lower), ("upper_arm", upper)):
        frame = np.eye(3) if vehicle_frame else _plane_of(section)
        _add_body(axle, name, section, to_vehicle, frame)
        _leave_bushings(axle, section)
    upright = file.section("Upright")
    _add_body(axle, "knuckle", upright, to_vehicle, np.eye(3))
    for name in ("damper_bottom", "damper_top"):
        axle.split_off(name, "lower_arm", axle.points["damper_lower"], rod=True)
    _add_tie_rod(axle, tie, "tie_link", to_vehicle)
    axle.split_off("caliper", "knuckle", to_vehicle(file.section("Spindle").array("COM", 3)))
    for name in ("lower_rear", "upper_rear"):
        _make_rigid(axle, name)
    _add_spring(axle, spring, axle.points["spring_upper"] - axle.points["spring_lower"])
    _add_damper(axle, shock)
    return axle


def _strut(file: ChronoFile, to_vehicle: Callable[[Vector], Vector]) -> ImportedAxle:
    arm, tie = file.section("Control Arm"), file.section("Tierod")
    spring, shock = file.section("Spring"), file.section("Shock")
    sources_of_points = {
        "lower_ball": (arm, "Location Upright"),
        "arm_front": (arm, "Location Chassis Front"),
        "arm_rear": (arm, "Location Chassis Back"),
        "strut_top": (spring, "Location Chassis"),
        "damper_bottom": (spring, "Location Upright"),
        "tie_outer": (tie, "Location Upright"),
        "tie_inner": (tie, "Location Chassis"),
    }
    axle = _axle_of_points("macpherson", sources_of_points, to_vehicle)
    top, bottom = axle.points["strut_top"], axle.points["damper_bottom"]
    # Anywhere on the axis of the strut the spring has the same force.
    axle.points["spring_lower"] = bottom + 0.3 * (top - bottom)
    axle.sources["hardpoints.spring_lower"] = "assumed: on the axis of the strut, where its position changes no force"
    for name in ("Location Chassis", "Location Upright"):
        if np.linalg.norm(shock.array(name, 3) - spring.array(name, 3)) > EQUAL:
            axle.changed.append(f"{shock.source(name)}: the damper acts along the strut, on the line of the spring")
    _add_body(axle, "a_arm", arm, to_vehicle, _plane_of(arm))
    _leave_bushings(axle, arm)
    _add_body(axle, "knuckle", file.section("Upright"), to_vehicle, np.eye(3))
    strut = file.section("Strut")
    moments = tensor(strut.array("Inertia", 3), np.zeros(3))
    axle.add_part("damper_top", strut.number("Mass"), 0.5 * (top + bottom), moments, f"Chrono {strut.source()}")
    for name, carrier, at in (
        ("damper_bottom", "knuckle", bottom),
        ("main_spring_lower", "knuckle", axle.points["spring_lower"]),
        ("suspension_mount", "damper_top", top),
        ("main_spring_upper", "damper_top", top),
        ("caliper", "knuckle", to_vehicle(file.section("Spindle").array("COM", 3))),
    ):
        axle.split_off(name, carrier, at)
    _add_tie_rod(axle, tie, "steering_rod", to_vehicle)
    for name in ("arm_rear", "suspension_mount"):
        _make_rigid(axle, name)
    _add_spring(axle, spring, top - bottom)
    _add_damper(axle, shock)
    return axle


def _axle_of_points(
    template: str, sources_of_points: dict[str, tuple[ChronoFile, str]], to_vehicle: Callable[[Vector], Vector]
) -> ImportedAxle:
    """Return an axle with its hardpoints."""
    axle = ImportedAxle(
        template=template,
        points={name: to_vehicle(section.array(key, 3)) for name, (section, key) in sources_of_points.items()},
    )
    axle.sources |= {
        f"hardpoints.{name}": f"Chrono {part.source(key)}" for name, (part, key) in sources_of_points.items()
    }
    return axle


def _plane_of(arm: ChronoFile) -> Vector:
    """Return the axes of an arm as columns, (3, 3): x along its joints on the chassis, z across its plane."""
    front, back, ball = (
        arm.array(name, 3) for name in ("Location Chassis Front", "Location Chassis Back", "Location Upright")
    )
    across, along = np.cross(back - ball, front - ball), front - back
    if not np.linalg.norm(across) > 0.0:
        raise DataError(f"{arm.path}: the three points of {arm.inside[-1]} lie on a line; move one of them")
    across, along = across / np.linalg.norm(across), along / np.linalg.norm(along)
    return np.column_stack([along, np.cross(across, along), across])


def _add_body(
    axle: ImportedAxle, name: str, section: ChronoFile, to_vehicle: Callable[[Vector], Vector], frame: Vector
) -> None:
    """Add a part with its mass, centre of gravity and inertia, given in axes of the part."""
    key = "Moments of Inertia" if "Moments of Inertia" in section else "Inertia"
    products = section.array("Products of Inertia", 3) if "Products of Inertia" in section else np.zeros(3)
    inertia = frame @ tensor(section.array(key, 3), products) @ frame.T
    inertia = REFLECTION[:, None] * inertia * REFLECTION
    axle.add_part(
        name, section.number("Mass"), to_vehicle(section.array("COM", 3)), inertia, f"Chrono {section.source()}"
    )


def _add_tie_rod(axle: ImportedAxle, tie: ChronoFile, name: str, to_vehicle: Callable[[Vector], Vector]) -> None:
    """Add the tie rod: with the mass of its body, or small."""
    middle = to_vehicle(0.5 * (tie.array("Location Chassis", 3) + tie.array("Location Upright", 3)))
    if "Mass" in tie:
        axle.add_part(name, tie.number("Mass"), middle, None, f"Chrono {tie.source('Mass')}; inertia of a rod")
    else:
        axle.split_off(name, "knuckle", middle, rod=True)
    _leave_bushings(axle, tie)


def _leave_bushings(axle: ImportedAxle, section: ChronoFile) -> None:
    if "Bushing Data" in section:
        axle.left_out.append(
            f"{section.source('Bushing Data')}: joints are rigid here; to make them elastic, set bushings"
        )


def _make_rigid(axle: ImportedAxle, name: str) -> None:
    """Add a bushing in place of a joint without give."""
    axle.tables[f"bushings.{name}"] = {
        "stiffness": [RIGID] * 3,
        "damping": [RIGID_DAMPING] * 3,
        "rotational_stiffness": 0.0,
    }
    axle.sources[f"bushings.{name}"] = "assumed: rigid joint in Chrono; here 0.1 mm under 1 kN"


def _add_spring(axle: ImportedAxle, spring: ChronoFile, line: Vector) -> None:
    """Add the main spring; note its law and its extension at the hardpoints."""
    axle.stretch = float(np.linalg.norm(line)) - spring.number("Free Length")
    if "Spring Curve Data" in spring:
        points = spring.curve("Spring Curve Data")
        slope = float(
            np.interp(0.0, 0.5 * (points[1:, 0] + points[:-1, 0]), np.diff(points[:, 1]) / np.diff(points[:, 0]))
        )
        axle.tables["main_spring"] = {"stiffness": slope}
        axle.tables["main_spring.table"] = {"displacement": points[:, 0].tolist(), "force": points[:, 1].tolist()}
        axle.sources["main_spring"] = f"Chrono {spring.source('Spring Curve Data')}"
        axle.spring = points
    elif "Spring Coefficient" in spring:
        stiffness = spring.number("Spring Coefficient")
        axle.tables["main_spring"] = {"stiffness": stiffness}
        axle.sources["main_spring"] = f"Chrono {spring.source('Spring Coefficient')}"
        axle.spring = np.array([[-1.0, -stiffness], [1.0, stiffness]])
    else:
        raise DataError(f"{spring.path}: {' / '.join(spring.inside)} has neither Spring Coefficient nor Spring Curve "
            "Data; a map over deformation and velocity cannot be read; give a curve")  # fmt: skip
    if "Preload" in spring:
        axle.spring = axle.spring - [0.0, spring.number("Preload")]
    if "Minimum Length" in spring or "Maximum Length" in spring:
        axle.left_out.append(f"{spring.source()}: stops at Minimum Length and Maximum Length; set them at damper.stop")


def _add_damper(axle: ImportedAxle, shock: ChronoFile) -> None:
    """Add the damper."""
    if "Damping Curve Data" in shock:
        key, points = "Damping Curve Data", shock.curve("Damping Curve Data")
        law: dict[str, Any] = {
            "viscous_law": "table",
            "velocity": points[:, 0].tolist(),
            "force": points[:, 1].tolist(),
        }
    elif "Damping Coefficient" not in shock:
        raise DataError(f"{shock.path}: {' / '.join(shock.inside)} has neither Damping Coefficient nor Damping Curve "
            "Data; a map over deformation and velocity cannot be read; give a curve")  # fmt: skip
    elif "Degressivity Compression" in shock and "Degressivity Expansion" in shock:
        key, c = "Degressivity Compression, Degressivity Expansion", shock.number("Damping Coefficient")
        v = np.array([*(-speed for speed in reversed(CURVE_SPEEDS)), *CURVE_SPEEDS])
        down, up = (shock.number(f"Degressivity {way}") for way in ("Compression", "Expansion"))
        force = c * v / (1.0 + np.where(v < 0.0, down, up) * np.abs(v))
        law = {"viscous_law": "table", "velocity": v.tolist(), "force": [rounded(f, 9) for f in force]}
    else:
        key = "Damping Coefficient"
        law = {"viscous_law": "linear", "viscous": shock.number(key)}
    friction = {"friction_law": "coulomb", "coulomb_friction": 0.0, "smoothing": 1e5, "slip_velocity": 0.006}
    axle.tables["damper"] = law | friction
    axle.sources["damper"] = f"Chrono {shock.source(key)}"
    axle.sources |= {f"damper.{name}": "assumed: value of the shipped cars" for name in ("smoothing", "slip_velocity")}
    axle.sources |= {f"damper.{name}": "Chrono: no friction" for name in ("friction_law", "coulomb_friction")}
    if "Spring Coefficient" in shock or "Spring Curve Data" in shock:
        axle.left_out.append(f"{shock.source()}: a spring inside the damper")


def _add_spindle(axle: ImportedAxle, file: ChronoFile, to_vehicle: Callable[[Vector], Vector]) -> None:
    """Add the spindle as the part that turns with the wheel, and the wheel centre at its centre of gravity."""
    spindle = file.section("Spindle")
    axle.points["wheel_center"] = to_vehicle(spindle.array("COM", 3))
    axle.sources["hardpoints.wheel_center"] = f"Chrono {spindle.source('COM')}"
    axle.add_part(
        "brake_disc", spindle.number("Mass"), axle.points["wheel_center"], turning(spindle.array("Inertia", 3)),
        f"Chrono {spindle.source()}",
    )  # fmt: skip


def _possible(inertia: Vector) -> tuple[Vector, float]:
    """Return the nearest possible tensor of inertia, and the largest increase of a moment [kg m2].

    The integrals S = tr(I) / 2 - I of x x, x y, ... have no negative eigenvalue: negative values are set to zero.
    """
    values, axes = np.linalg.eigh(0.5 * np.trace(inertia) * np.eye(3) - inertia)
    if (smallest := float(values[0])) >= -1e-9 * np.trace(inertia):
        return inertia, 0.0
    # A little above zero, so that the digits of a file leave it there.
    second = (axes * np.maximum(values, 1e-6 * np.trace(inertia))) @ axes.T
    return np.trace(second) * np.eye(3) - second, -smallest


def turning(moments: Vector) -> Vector:
    """Return the tensor of a part that turns about y: equal moments about x and z, their mean [kg m2]."""
    x, y, z = moments
    return np.diag([0.5 * (x + z), y, 0.5 * (x + z)])
