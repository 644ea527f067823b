"""The car on its rig as parts with roles: wheels on plates, or the body on rubber blocks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from vehicle.model.shapes.roles import ROLES, Part, part_shapes
from vehicle.model.shapes.shape import Points, Shape

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
RIG: Final = {True: ("shaker_table", "shaker"), False: ("fixed_plate", "pedestal")}
"""roles of what moves and of what stands under a wheel on the right, and under any other"""


def car_shapes(
    points: Points, corners: Mapping[str, Points], supports: Points, composed: Iterable[Part], *, rig: bool = True
) -> dict[str, Shape]:
    """Every visible shape of car and rig at the design position; arguments as of `car_parts`.

    Returns:
        shapes by name, in a fixed order; the name is fit for a file
    """
    return part_shapes(car_parts(points, corners, supports, composed, rig=rig))


def car_parts(
    points: Points, corners: Mapping[str, Points], supports: Points, composed: Iterable[Part], *, rig: bool = True
) -> Iterator[Part]:
    """The body where the car has its points, its other parts, and the rig: a shaker under each wheel on the right.

    Args:
        points: of the car by name [m], in the vehicle frame
        corners: wheel to the points of its corner, "wheel_center" and "tyre_patch" among them
        supports: where the car stands on blocks, by side
        composed: parts of the car beside its body
        rig: draw shakers, pedestals and their bed plate
    """
    middle = {**points, **next(iter(corners.values()), {})}
    if "roof_left_rear" in points:
        behind = [*supports.values(), *(corner["wheel_center"] for corner in corners.values())]
        middle |= {"roof": points["roof_left_rear"], "rear_axle": max(behind, key=lambda place: place[0])}
    for role in BODY:
        own = supports if role == "support_shoes" else middle
        if set(ROLES[role][1]) <= set(own):
            yield Part(name="body", role=role, points=own)
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
