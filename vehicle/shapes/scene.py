"""The car on its rig as parts with roles: two wheels on plates, the rear of the body on rubber blocks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from vehicle.shapes.roles import Part, part_shapes
from vehicle.shapes.shape import Shape

SHELL: Final = tuple(
    f"body_{name}" for name in ("shell", "painted", "trim", "rails", "lamps_front", "lamps_rear", "plates", "glass")
)
"""shapes that hide the chassis: make them translucent together, and leave `body_lining` out then"""

BODY: Final = (
    "floor",
    "front_structure",
    "subframe",
    "exhaust",
    "engine_mounts",
    "support_shoes",
    "cabin",
    "estate_body",
)
CORNER: Final = {
    "a_arm": "lower_arm",
    "knuckle": "knuckle",
    "brake_disc": "brake_disc",
    "caliper": "caliper",
    "tyre": "wheel",
    "damper_bottom": "damper_tube",
    "damper_top": "damper_rod",
    "suspension_mount": "top_mount",
    "main_spring": "coil_spring",
    "steering_rod": "steering_rod",
    "stabilizer_half": "stabilizer_half",
    "stabilizer_rod": "stabilizer_rod",
}
"""part of a corner to its role"""

RIG: Final = {True: ("shaker_table", "shaker"), False: ("fixed_plate", "pedestal")}
"""roles of what moves and of what stands under a wheel on the right, and under any other"""

WHEEL: Final = "wheel_center_"
SUPPORT: Final = "rear_support_"


def car_shapes(points: Mapping[str, np.ndarray]) -> dict[str, Shape]:
    """Every visible shape of car and rig at the design position.

    Args:
        points: hardpoints [m] in the vehicle frame; those of a corner end in the name of its wheel

    Returns:
        shapes by name, in a fixed order; the name is fit for a file
    """
    return part_shapes(car_parts(points))


def car_parts(points: Mapping[str, np.ndarray]) -> Iterator[Part]:
    """The parts of the car and of its rig: a shaker under each wheel on the right, a pedestal under the others.

    Args:
        points: hardpoints as for `car_shapes`
    """
    wheels = [name.removeprefix(WHEEL) for name in points if name.startswith(WHEEL)]
    wheels.sort(key=lambda wheel: -points[WHEEL + wheel][1])
    corners = {
        wheel: {name.removesuffix(f"_{wheel}"): points[name] for name in points if name.endswith(f"_{wheel}")}
        for wheel in wheels
    }
    supports = {name.removeprefix(SUPPORT): points[name] for name in sorted(points)[::-1] if name.startswith(SUPPORT)}
    middle = {**points, **corners[wheels[0]]}
    middle |= {"roof": points["roof_left_rear"], "rear_axle": next(iter(supports.values()))}
    for role in BODY:
        yield Part(name="body", role=role, points=supports if role == "support_shoes" else middle)
    yield Part(name="engine", role="engine", points=middle)
    yield Part(name="torque_arm", role="torque_arm", points=middle)
    for wheel, corner in corners.items():
        left = bool(corner["wheel_center"][1] < 0.0)
        for part, role in CORNER.items():
            yield Part(name=part, role=role, points=corner, suffix=f"_{wheel}", left=left)
    stands = {wheel: RIG[bool(corner["wheel_center"][1] > 0.0)] for wheel, corner in corners.items()}
    for wheel, (plate, _) in stands.items():
        yield Part(name="plate", role=plate, points=corners[wheel], suffix=f"_{wheel}")
    for wheel, (_, under) in stands.items():
        yield Part(name=under, role=under, points=corners[wheel], suffix=f"_{wheel}", carrier="world")
    standing = {wheel: corner["tyre_patch"] for wheel, corner in corners.items()} | supports
    yield Part(name="bed_plate", role="bed_plate", points=standing, carrier="world")
    for side, support in supports.items():
        points = {"support": support}
        yield Part(name="rubber_block", role="rear_block", points=points, suffix=f"_{side}", carrier="world")
