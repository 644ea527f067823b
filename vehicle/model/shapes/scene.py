"""Car on its rig as parts with roles: wheels on plates, or the body on rubber blocks."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from vehicle.model.shapes.roles import ROLES, Part, part_shapes
from vehicle.model.shapes.shape import Points, Shape

SHELL: Final = tuple(
    f"body_{name}" for name in ("shell", "painted", "trim", "rails", "lamps_front", "lamps_rear", "plates", "glass")
)
"""Names of the shapes that hide the chassis: make all of them translucent, and omit `body_lining`."""

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
RIG: Final = {True: ("shaker_table", "shaker"), False: ("fixed_plate", "pedestal")}
"""Roles of the plate and of the stand under a wheel: True on the right side (shaker), False elsewhere (pedestal)."""


def car_shapes(
    points: Points, corners: Mapping[str, Points], supports: Points, composed: Iterable[Part], *, rig: bool = True
) -> dict[str, Shape]:
    """Return all visible shapes of car and rig at the design position, by name; see `car_parts` for the arguments."""
    return part_shapes(car_parts(points, corners, supports, composed, rig=rig))


def car_parts(
    points: Points, corners: Mapping[str, Points], supports: Points, composed: Iterable[Part], *, rig: bool = True
) -> Iterator[Part]:
    """Yield the parts of the body for which the car has points, its other parts, and the rig.

    The rig has a shaker under each wheel on the right, a pedestal under each other wheel, a stand at each support.

    Args:
        points: points of the car by name [m], in the vehicle frame
        corners: wheel name -> points of its corner, including "wheel_center" and "tyre_patch"
        supports: support points of the car on rubber blocks, by side
        composed: parts of the car other than its body
        rig: draw shakers, pedestals and their bed plate
    """
    middle = {**points, **next(iter(corners.values()), {})}
    if "roof_left_rear" in points:
        behind = [*supports.values(), *(corner["wheel_center"] for corner in corners.values())]
        middle |= {"roof": points["roof_left_rear"], "rear_axle": max(behind, key=lambda point: point[0])}
    for role in BODY:
        role_points = supports if role == "support_shoes" else middle
        if set(ROLES[role][1]) <= set(role_points):
            yield Part(name="body", role=role, points=role_points)
    yield from composed
    stands = {wheel: RIG[bool(corner["wheel_center"][1] > 0.0)] for wheel, corner in corners.items() if rig}
    for wheel, (plate, _) in stands.items():
        yield Part(name="plate", role=plate, points=corners[wheel], suffix=f"_{wheel}")
    for wheel, (_, under) in stands.items():
        yield Part(name=under, role=under, points=corners[wheel], suffix=f"_{wheel}", carrier="world")
    standing = {wheel: corner["tyre_patch"] for wheel, corner in corners.items()} | dict(supports)
    yield Part(name="bed_plate", role="bed_plate" if rig else "none", points=standing, carrier="world")
    for side, support in supports.items():
        block = {"support": support}
        yield Part(name="rubber_block", role="rear_block", points=block, suffix=f"_{side}", carrier="world")
