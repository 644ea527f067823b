"""Axles of another type than the template's, which a table of points needs; data in `axles.toml`."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from vehicle.model.parameters.toml_file import copy_table, read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.studies.design.template_car import TemplateCar

AXLE_TYPES = read_table(Path(__file__).parent / "axles.toml")
"""Axles by the names of their templates: points relative to the wheel centre, parts and bushings."""

OF_WHEEL = ("tyre", "brake_disc", "caliper")
"""Parts that stay as they are."""

BAR = 700.0
"""Torsional stiffness of the stabilizer where the axle before has none [N m/rad]; assumed, from the sedan."""


def axle_type_names(name: str) -> tuple[str, ...]:
    """Return the names of the hardpoints and parts of a type, see `TemplateCar.point_names`."""
    axle = AXLE_TYPES[name]
    others = [f"{section}.{part}" for section in ("parts", "bushings") for part in axle[section]]
    return ("wheel_center", "tyre_patch", *axle["hardpoints"], *others, *(f"parts.{part}" for part in OF_WHEEL))


def with_axles(template: TemplateCar, types: Mapping[str, str]) -> TemplateCar:
    """Return a template with axles of other types.

    Args:
        template: template car.
        types: name of the new type by axle, "front" or "rear".
    """
    for word, name in types.items():
        axle, table = template.axle(word), copy_table(template.table)
        table[axle] = _axle(table[axle], name)
        vehicle = vehicle_of(table, template.file.parent)
        placed = {wheel.name: wheel for wheel in vehicle.composition.wheels}
        wheels = {key: (placed[right.name], placed[left.name]) for key, (right, left) in template.wheels.items()}
        template = dataclasses.replace(template, table=vehicle.table, vehicle=vehicle, wheels=wheels)
    return template


def _axle(before: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Return the table of an axle of a type at the wheel centre of the axle before, with its wheel and damper."""
    new = copy_table(AXLE_TYPES[name])
    center = before["hardpoints"]["wheel_center"]
    moved = {
        point: [round(a + b, 6) for a, b in zip(center, at, strict=True)] for point, at in new["hardpoints"].items()
    }
    new["hardpoints"] = {key: before["hardpoints"][key] for key in ("wheel_center", "tyre_patch")} | moved
    new["parts"] |= {part: before["parts"][part] for part in OF_WHEEL}
    new["bushings"]["tyre"] = before["bushings"]["tyre"]
    new |= {key: before[key] for key in ("main_spring", "damper")}
    new["stabilizer"] = before.get("stabilizer", {"torsional_stiffness": BAR})
    return {"template": name, **new}
