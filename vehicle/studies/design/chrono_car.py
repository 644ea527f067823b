"""A car from the JSON files of Project Chrono: chassis, two axles with double wishbones or struts, wheels and tyres.

Its hardpoints are the static equilibrium, as of every vehicle file: the preloads of the springs follow from the loads,
and differ from those that the free lengths of Chrono give at the same points.
"""

import dataclasses
import re
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import rounded
from vehicle.engines.kinematics.axle_parts import axle_parts
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.template import read_template
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.studies.design.car_file import vehicle_text
from vehicle.studies.design.chrono_json import REFLECTION, ChronoFile, read_chrono_file, rotation, tensor
from vehicle.studies.design.chrono_suspension import ImportedAxle, imported_axle, turning
from vehicle.studies.design.chrono_tyre import ChronoTyre, chrono_tyre
from vehicle.studies.design.new_car import NewCar, checks_of, new_car
from vehicle.studies.design.stated_numbers import AXLES, StatedNumbers
from vehicle.studies.design.template_car import template_car
from vehicle.threads import one_blas_thread

GRAVITY = 9.81
"""Gravity [m/s2], as in Chrono's vehicle models."""
FRONT_AXLE = 0.9
"""Distance of the front axle from the origin of the vehicle frame [m]."""
DRIVER_TO_RAIL = 0.7
"""Height of the position of a driver of Chrono, which is that of a camera, above the seat rail [m]; assumed."""
LONGITUDINAL, LATERAL = 0.58, 0.52
"""Horizontal stiffnesses of a standing tyre over its vertical stiffness, those of the sedan [-]."""
CARCASS_LONGITUDINAL, CARCASS_LATERAL = 1.15, 0.33
"""Stiffnesses of the carcass over the vertical stiffness, those of the sedan [-]."""

HEIGHTS_AGREE = 1e-3
"""Difference of the ground under both axles that is not worth a note [m]."""

LEFT_OUT = {
    "Driveline": "driveline: the wheels roll freely",
    "Powertrain": "powertrain: its mass is in the chassis",
    "Steering Subsystems": "steering: the tie rods are attached to the body",
    "Rear Chassis": "rear chassis",
    "Subchassis": "subchassis",
}
LEFT_OUT_OF_AXLE = {
    "Left Brake Input File": "brakes",
    "Antirollbar Input File": "anti-roll bar: add the section stabilizer, with its points and parts",
}


PREFIX = "chrono:"
"""Prefix of a file of Chrono in the option for a car."""


@one_blas_thread()
def new_chrono_car(name: str, path: Path, tyre_file: Path | None, stated: StatedNumbers) -> NewCar:
    """Make a car from files of Chrono, see `chrono_car`, and change it by stated numbers.

    Raises:
        ConfigurationError, DataError: see `chrono_car`.
        SimulationError: a stated number is not met.
    """
    imported = chrono_car(re.sub(r"[^A-Za-z0-9_.-]", "_", path.stem), path, tyre_file)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "vehicle.toml"
        file.write_text(imported.text, encoding="utf-8")
        if stated != StatedNumbers():
            result = new_car(name, file, stated, scale=False)
            return dataclasses.replace(result, notes=imported.notes + result.notes)
        table = {**imported.car.vehicle.table, "name": name}
        car = Car(vehicle_of(table))
        text = imported.text.replace(f'name = "{imported.car.vehicle.name}"', f'name = "{name}"', 1)
        return NewCar(car=car, text=text, checks=checks_of(car, template_car(file), stated), notes=imported.notes)


def chrono_car(name: str, path: Path, tyre_file: Path | None = None) -> NewCar:
    """Read a car of Chrono.

    Args:
        path: JSON file of a wheeled vehicle, or the file of a whole model that names it and its tyre.
        tyre_file: JSON file of the tyre of all wheels; by default that of the model.

    Returns:
        The car without checks; its notes list values that are left out, and assumed values.

    Raises:
        ConfigurationError: a file is missing, the car has not two axles, no tyre is known, or the car cannot be.
        DataError: a suspension or a tyre of another type, or a wrong or missing value.
    """
    model = read_chrono_file(path)
    vehicle = model.section("Vehicle").named_file("Input File") if "Vehicle" in model else model
    tyre = _tyre(model, tyre_file)
    positions = vehicle.sections("Axles")
    if len(positions) != 2:
        raise ConfigurationError(
            f"{vehicle.path}: has {len(positions)} axles, must be 2; name the file of another vehicle"
        )
    positions.sort(key=lambda position: -position.array("Suspension Location", 3)[0])
    suspensions = [position.named_file("Suspension Input File") for position in positions]
    spindles = [
        position.array("Suspension Location", 3) + suspension.section("Spindle").array("COM", 3)
        for position, suspension in zip(positions, suspensions, strict=True)
    ]
    # The front tyres without load touch z = 0.
    origin = np.array([spindles[0][0] + FRONT_AXLE, 0.0, spindles[0][2] - tyre.radius])
    axles = []
    for position, suspension in zip(positions, suspensions, strict=True):
        axles.append(imported_axle(suspension, _placing(position.array("Suspension Location", 3) - origin)))
        _add_wheel(axles[-1], position, tyre)
    body, sources, points = _body(vehicle.section("Chassis").named_file("Input File"), origin)
    loads = _wheel_loads(body, axles)
    _set_ground(axles, tyre, loads)
    table: dict[str, Any] = {
        "name": name,
        "gravity": GRAVITY,
        "hardpoints": points,
        "body": body,
        **{word: _axle_table(axle) for word, axle in zip(AXLES, axles, strict=True)},
        "outputs": {point: {"on": "body", "at": point} for point in points},
        "solver": {"record_rate": 1000.0},
    }
    sources |= {
        f"{word}.{key}": text for word, axle in zip(AXLES, axles, strict=True) for key, text in axle.sources.items()
    }
    sources |= {
        "name": "given",
        "gravity": "Chrono",
        "outputs": "assumed: at the hardpoint of this name",
        "solver": "assumed: the rate of the shipped inputs",
        **{
            f"{word}.template": f"Chrono {file.source('Template')}"
            for word, file in zip(AXLES, suspensions, strict=True)
        },
    }
    car = Car(vehicle_of(table))
    header = (
        f"{name}: made by `python -m vehicle new` from {path.name} of Project Chrono.\n"
        "Behind each value stand its unit and its origin: file and name in Chrono, or assumed and why.\n"
        "Frame: x to the rear, y to the driver's right, z up, z = 0 where unloaded front tyres stand. SI units."
    )
    left_out = [f"left out: {text}" for key, text in LEFT_OUT.items() if key in vehicle or key in model]
    for word, position, axle in zip(AXLES, positions, axles, strict=True):
        left_out += [f"left out, {word}: {text}" for key, text in LEFT_OUT_OF_AXLE.items() if key in position]
        left_out += [f"left out, {word}: {text}" for text in axle.left_out]
        left_out += [f"changed, {word}: {text}" for text in axle.changed]
    left_out += _assumptions(car, axles)
    text = vehicle_text(car.vehicle, header, sources, path.name, {})
    return NewCar(car=car, text=text, checks=(), notes=tuple(dict.fromkeys(left_out)))


def _tyre(model: ChronoFile, file: Path | None) -> ChronoTyre:
    """Return the tyre: of the file of the option, or of that of the whole model."""
    if file is not None:
        return chrono_tyre(read_chrono_file(file))
    if "Tire" not in model:
        raise ConfigurationError(f"{model.path}: states no tyre; add the file of a Chrono tyre with "
            "--chrono-tyre FILE.json, or name the file of the whole model (with Vehicle and Tire)")  # fmt: skip
    return chrono_tyre(model.section("Tire").named_file("Input File"))


def _placing(shift: Vector) -> Callable[[Vector], Vector]:
    """Return the function from the left side of a suspension to the right side of the vehicle frame."""
    return lambda point: REFLECTION * (shift + point)


def _add_wheel(axle: ImportedAxle, position: ChronoFile, tyre: ChronoTyre) -> None:
    """Add rim and tyre as a single part, `tyre`."""
    wheel = position.named_file("Left Wheel Input File")
    axle.add_part(
        "tyre",
        wheel.number("Mass") + tyre.mass,
        axle.points["wheel_center"],
        turning(wheel.array("Inertia", 3) + tyre.inertia),
        f"Chrono {wheel.source()} and {tyre.file.source()}",
    )


def _body(chassis: ChronoFile, origin: Vector) -> tuple[dict[str, Any], dict[str, str], dict[str, list[float]]]:
    """Return the table [body] of a chassis, its sources, and its points."""
    mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for part in chassis.sections("Components"):
        frame = part.section("Centroidal Frame")
        at, turn = frame.array("Location", 3), rotation(frame.array("Orientation", 4))
        sign = -1.0 if part.table.get("Void") is True else 1.0
        m = sign * part.number("Mass")
        inertia = turn @ tensor(part.array("Moments of Inertia", 3), part.array("Products of Inertia", 3)) @ turn.T
        mass, first = mass + m, first + m * at
        second = second + sign * inertia + m * (at @ at * np.eye(3) - np.outer(at, at))
    if not mass > 0.0:
        raise ConfigurationError(f"{chassis.path}: the masses of Components add up to {mass:g} kg, must be above 0")
    cog = first / mass
    inertia = second - mass * (cog @ cog * np.eye(3) - np.outer(cog, cog))
    # A turn by 180 degrees about z.
    turn = np.array([-1.0, -1.0, 1.0])
    inertia = turn[:, None] * inertia * turn
    numbers = [inertia[0, 0], inertia[1, 1], inertia[2, 2], -inertia[0, 1], -inertia[0, 2], -inertia[1, 2]]
    names = ("ixx", "iyy", "izz", "ixy", "izx", "iyz")
    values = {key: rounded(value, 9) for key, value in zip(names, numbers, strict=True)}
    body = {
        "mass": mass,
        "cog": coordinates(turn * (cog - origin)),
        "flexible": False,
        "attachment_flexibility": False,
        "inertia": {
            key: value for key, value in values.items() if key in names[:3] or abs(value) > 1e-9 * values["izz"]
        },
    }
    sources = {
        "body": f"Chrono {chassis.source('Components')}",
        "body.flexible": "Chrono: rigid",
        "body.attachment_flexibility": "Chrono: rigid",
        "hardpoints.seat_rail": "assumed: at the centre of gravity, Chrono has no driver",
    }
    points = {"seat_rail": cog}
    if "Driver Position" in chassis:
        driver = chassis.section("Driver Position")
        points = {"driver": (at := driver.array("Location", 3)), "seat_rail": at - [0.0, 0.0, DRIVER_TO_RAIL]}
        sources["hardpoints.driver"] = f"Chrono {driver.source('Location')}"
        sources["hardpoints.seat_rail"] = f"assumed: {DRIVER_TO_RAIL:g} m under the point `driver`, that of a camera"
    return body, sources, {name: coordinates(turn * (point - origin)) for name, point in points.items()}


def _wheel_loads(body: Mapping[str, Any], axles: list[ImportedAxle]) -> list[float]:
    """Return the static load of a wheel of each axle [N], by the levers of all masses."""
    parts = [part for axle in axles for part in axle.parts.values()]
    mass = body["mass"] + sum(2.0 * part["mass"] for part in parts)
    x = (body["mass"] * body["cog"][0] + sum(2.0 * part["mass"] * part["cog"][0] for part in parts)) / mass
    front, rear = (axle.points["wheel_center"][0] for axle in axles)
    share = (x - front) / (rear - front)
    if not 0.0 < share < 1.0:
        raise ConfigurationError(
            f"the centre of gravity of the car is {x - front:.3f} m behind its front axle, must be within the "
            f"wheelbase of {rear - front:.3f} m; check Components and Axles"
        )
    return [0.5 * GRAVITY * mass * (1.0 - share), 0.5 * GRAVITY * mass * share]


def _set_ground(axles: list[ImportedAxle], tyre: ChronoTyre, loads: list[float]) -> None:
    """Put the ground under the tyres at their static load; add the laws of the tyres."""
    for axle, load in zip(axles, loads, strict=True):
        deflection, stiffness = tyre.deflection(load), tyre.stiffness(load)
        patch = axle.points["wheel_center"] - [0.0, 0.0, tyre.radius - deflection]
        axle.points["tyre_patch"] = patch
        where = f"Chrono {tyre.file.source()}" + (f", {tyre.estimated}" if tyre.estimated else "")
        axle.sources["hardpoints.tyre_patch"] = (
            f"{where}: unloaded radius {tyre.radius:g} m less {1e3 * deflection:.1f} mm under {load:.0f} N"
        )
        axle.tables["bushings.tyre"] = {
            "stiffness": [rounded(share * stiffness, 9) for share in (LONGITUDINAL, LATERAL, 1.0)],
            "damping": [0.0, 0.0, rounded(tyre.damping, 9)],
            "rotational_stiffness": 0.0,
            **{name: rounded(tyre.slip_stiffness(name, load), 9) for name in tyre.slip},
            "carcass_longitudinal": rounded(CARCASS_LONGITUDINAL * stiffness, 9),
            "carcass_lateral": rounded(CARCASS_LATERAL * stiffness, 9),
        }
        axle.sources["bushings.tyre"] = f"{where}, at {load:.0f} N"
        axle.sources["bushings.tyre.stiffness"] = (
            f"{where}, dF/dz at {load:.0f} N; assumed: ratio of the stiffnesses along and across as in the sedan"
        )
        axle.sources["bushings.tyre.rotational_stiffness"] = "assumed: none"
        for name in ("carcass_longitudinal", "carcass_lateral"):
            axle.sources[f"bushings.tyre.{name}"] = "assumed: same ratio to the vertical stiffness as in the sedan"


def coordinates(point: Vector) -> list[float]:
    """Return coordinates in nanometres, without -0."""
    return [round(float(value), 9) + 0.0 for value in point]


def _axle_table(axle: ImportedAxle) -> dict[str, Any]:
    """Return the table of an axle: centres of gravity as offsets from the points of the template."""
    template = read_template(axle.template, (), ())
    parts: dict[str, Any] = {}
    for name, part in axle.parts.items():
        numbers = {key: value for key, value in part.items() if key != "cog"}
        numbers["mass"] = rounded(numbers["mass"], 9)
        middle = np.mean([axle.points[point] for point in template.parts[name].points], axis=0)
        if np.max(np.abs(offset := part["cog"] - middle)) > 1e-9 and "inertia" in numbers:
            numbers["offset"] = coordinates(offset)
        parts[name] = numbers
    table: dict[str, Any] = {
        "template": axle.template,
        "hardpoints": {name: coordinates(point) for name, point in axle.points.items()},
        "parts": parts,
    }
    for path, law in axle.tables.items():
        inner = table
        for key in path.split("."):
            inner = inner.setdefault(key, {})
        inner |= law
    return table


def _assumptions(car: Car, axles: list[ImportedAxle]) -> list[str]:
    """Return notes on the equilibrium and on assumed numbers."""
    model = car.model.model
    parts = axle_parts(model, car.model.static.preload, [wheel.part for wheel in car.vehicle.composition.wheels])
    carried = {model.site(spring.lower).name.partition("/")[0]: spring.preload for spring in parts.springs}
    notes = []
    for word, axle in zip(AXLES, axles, strict=True):
        name = next(wheel.name for wheel in car.vehicle.composition.wheels if wheel.axle == word)
        force = carried[f"main_spring_{name}"]
        longer = float(np.interp(-force, axle.spring[:, 1], axle.spring[:, 0])) - axle.stretch
        there = -float(np.interp(axle.stretch, axle.spring[:, 0], axle.spring[:, 1]))
        notes.append(
            f"{word}: a main spring carries {force:.0f} N here; in Chrono it has {there:.0f} N at these points, "
            f"so the Chrono car settles until it is {1e3 * abs(longer):.0f} mm "
            f"{'longer' if longer > 0.0 else 'shorter'}"
        )
    front, rear = (axle.points["tyre_patch"][2] for axle in axles)
    if abs(rear - front) > HEIGHTS_AGREE:
        notes.append(
            f"the ground is {1e3 * abs(rear - front):.0f} mm {'higher' if rear > front else 'lower'} under the rear "
            "wheels, as they stand at these points"
        )
    notes.append("assumed, as the file says behind each number: small masses of massless parts, horizontal stiffness "
                 "and carcass of the tyres, no pneumatic trail, seat rail")  # fmt: skip
    return notes
