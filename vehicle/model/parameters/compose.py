"""Composition of a car from a vehicle file and its templates. Handles types of joints; part names are data."""

import itertools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.additions import further_connection, further_output, law_kind, placed_load, point_of
from vehicle.model.parameters.applied_force import AppliedForce
from vehicle.model.parameters.composition import Composition
from vehicle.model.parameters.driving import Crank, crank_of
from vehicle.model.parameters.further_forces import engine_forces, force_targets, further_force
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import Instance, instances
from vehicle.model.parameters.placed_elements import (
    element_kinds,
    placed_connections,
    placed_dampers,
    placed_outputs,
    placed_springs,
    placed_wheels,
)
from vehicle.model.parameters.placed_parts import placed_parts
from vehicle.model.parameters.placed_wheel_forces import wheel_forces
from vehicle.model.parameters.references import (
    require_aliases,
    require_geometry,
    require_points,
    require_ports,
    require_sound,
    require_taken,
)
from vehicle.model.parameters.rigid_part import Load
from vehicle.model.parameters.toml_file import convert

NAMED_TABLES = ("hardpoints", "connection", "outputs", "alias", "load", "force")
"""Tables of a vehicle file that are not instances and contain tables or points by name."""

APPLY_FORCES = "apply_forces"
"""Key of a vehicle file; false leaves out all applied forces."""


def compose(table: Mapping[str, Any], folders: tuple[Path, ...]) -> Composition:
    """Compose a car: read the instances of its file, place their elements, add those of the file, check the whole.

    Args:
        table: vehicle file, see `read_table`.
        folders: folders of user templates, searched before the package.

    Returns:
        All elements, placed and named; parents before their children.

    Raises:
        ConfigurationError: a name that does not exist, a value that is missing or wrong, a part without a joint, a
            loop of joints; the message names table and template.
    """
    tables = {key: convert(dict, table.get(key, {}), key) for key in NAMED_TABLES}
    file_points = {name: point_of(f"hardpoints.{name}", value) for name, value in tables["hardpoints"].items()}
    car = instances(table, folders, file_points)
    points = {
        i.label(name, side): i.point(name, side)
        for i in car.values()
        for name, side in itertools.product(i.template.hardpoints, i.sides())
        if side is not None or not i.template.mirrored
    }
    if twice := sorted(set(file_points) & set(points)):
        raise ConfigurationError(
            f"hardpoints.{twice[0]}: a template already has a point of this name; rename one of them"
        )
    points = {**file_points, **points}
    require_geometry(car)
    wheels = list(placed_wheels(car))
    names = {"body", "world", *(wheel.plate for wheel in wheels)}
    names |= {i.label(name, side) for i in car.values() for name in i.template.parts for side in i.sides()}
    require_ports(car, names)
    parts = placed_parts(car)
    connections = placed_connections(car)
    connections += [further_connection(name, entry, names, points) for name, entry in tables["connection"].items()]
    springs, joint_springs = placed_springs(car)
    dampers = placed_dampers(car)
    further = [further_output(name, entry, names, points) for name, entry in tables["outputs"].items()]
    carriers = {"body", *(part.name for part in parts if part.seat is None)}
    loads = [placed_load(name, entry, carriers, points) for name, entry in tables["load"].items()]
    body_cog: Point = convert(Point, table["body"]["cog"], "body.cog")
    targets = force_targets(parts, points, wheels, connections, crank_of(table), body_cog)
    forces = [*wheel_forces(car, wheels, parts, connections, targets), *engine_forces(car, targets)]
    forces += [further_force(name, entry, targets) for name, entry in tables["force"].items()]
    composition = Composition(
        parts=(*parts, *loads),
        connections=tuple(connections),
        springs=tuple(springs),
        joint_springs=tuple(joint_springs),
        dampers=tuple(dampers),
        outputs=tuple(placed_outputs(car, further)),
        wheels=tuple(wheels),
        # Those of tyres act on no part of the model: they come last.
        forces=tuple(sorted(forces if table.get(APPLY_FORCES, True) else (), key=lambda force: bool(force.tyre))),
        speeds=targets.speeds,
        crank_run_up=targets.run_up,
        points=points,
        kinds=parameter_kinds(car, table),
        meanings={f"{i.name}.hardpoints.{n}": text for i in car.values() for n, text in i.template.hardpoints.items()},
    )
    require_sound(composition)
    require_taken(car)
    require_points(table, car)
    require_aliases(table)
    return composition


def parameter_kinds(car: Mapping[str, Instance], table: Mapping[str, Any]) -> dict[str, type]:
    """Return the parameter class of each table of numbers, by its path in the vehicle file."""
    kinds: dict[str, type] = {
        f"connection.{name}": law_kind(entry) for name, entry in table.get("connection", {}).items()
    }
    kinds |= {f"load.{name}": Load for name in table.get("load", {})}
    kinds |= {f"force.{name}": AppliedForce for name in table.get("force", {})}
    kinds |= {"crank": Crank} if "crank" in table else {}
    return kinds | element_kinds(car)
