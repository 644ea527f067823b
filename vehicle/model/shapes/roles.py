"""What a part is drawn as: each role with the points that it needs; a rod between its points for any other part."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Final

from vehicle.model.shapes import body_structure, engine, rig, suspension, wheel
from vehicle.model.shapes.body_outline import OUTLINE
from vehicle.model.shapes.body_trim import estate_body
from vehicle.model.shapes.shape import SIZES, Piece, Points, Shape, Sizes
from vehicle.model.shapes.solids import mirrored
from vehicle.model.shapes.suspension import STRUT

ENGINE: Final = ("engine_cog", "hydromount", "linear_mount", "bottom_engine")
RAILS: Final = (*OUTLINE, *STRUT, "body_front", "arm_front")
CRADLE: Final = ("arm_front", "arm_rear", "stab_body", "tie_inner", "bottom_body", "seat")

ROLES: Final[dict[str, tuple[Callable[[Points, Sizes], list[Piece]], tuple[str, ...]]]] = {
    "floor": (body_structure.floor, (*OUTLINE, "seat_rail")),
    "front_structure": (body_structure.front_structure, RAILS),
    "subframe": (body_structure.subframe, CRADLE),
    "exhaust": (body_structure.exhaust, ("bottom_body", "rear_axle")),
    "engine_mounts": (engine.side_mounts, ("hydromount", "linear_mount")),
    "support_shoes": (body_structure.support_shoes, ()),
    "cabin": (body_structure.cabin, ("seat", "seat_rail")),
    "estate_body": (estate_body, OUTLINE),
    "engine": (engine.engine, ENGINE),
    "torque_arm": (engine.torque_arm, ("bottom_engine", "bottom_body")),
    "lower_arm": (suspension.lower_arm, ("lower_ball", "arm_front", "arm_rear")),
    "knuckle": (suspension.knuckle, ("wheel_center", "lower_ball", "tie_outer", *STRUT)),
    "brake_disc": (wheel.brake_disc, ("wheel_center",)),
    "caliper": (wheel.caliper, ("wheel_center",)),
    "wheel": (wheel.wheel, ("wheel_center", "tyre_patch")),
    "damper_tube": (suspension.damper_tube, STRUT),
    "damper_rod": (suspension.damper_rod, STRUT),
    "top_mount": (suspension.top_mount, STRUT),
    "coil_spring": (suspension.coil_spring, STRUT),
    "coil": (suspension.coil, suspension.SEATS),
    "tube": (suspension.plain_tube, suspension.EYES),
    "piston": (suspension.piston, suspension.EYES),
    "steering_rod": (suspension.steering_rod, ("tie_inner", "tie_outer")),
    "stabilizer_half": (suspension.stabilizer_half, ("stab_end", "stab_body", "stab_rod_top")),
    "stabilizer_rod": (suspension.stabilizer_rod, ("stab_end", "stab_rod_top")),
    "shaker_table": (rig.shaker_table, ("tyre_patch",)),
    "fixed_plate": (rig.fixed_plate, ("tyre_patch",)),
    "shaker": (rig.shaker, ("tyre_patch",)),
    "pedestal": (rig.pedestal, ("tyre_patch",)),
    "rear_block": (rig.rear_block, ("support",)),
    "bed_plate": (rig.bed_plate, ()),
}
"""role to what draws it on the right side of the car, and the names of the points that it must be given"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """A part of a car or a rig that can be looked at.

    Attributes:
        name: of the part without its suffix; shapes are called after it.
        role: what it is drawn as: a name of `ROLES`, `none` for nothing, any other for rods between its points.
        points: points that it hangs on, at the design position [m] in the vehicle frame, by their names.
        around: further points that its role may ask for, by the names that the role gives them.
        suffix: `_fr` and the like, behind the names of part and shapes; empty for what exists once.
        carrier: the part that holds it: its bolts move with that.
        left: drawn mirrored, as the roles draw the right side.
        sizes: drawn sizes that replace those of `SIZES`.
    """

    name: str
    role: str
    points: Points
    around: Points = field(default_factory=dict)
    suffix: str = ""
    carrier: str = "body"
    left: bool = False
    sizes: Sizes = field(default_factory=dict)


def pieces(part: Part) -> list[Piece]:
    """Draw a part on the right side by its role; rods between its points where its role is unknown or lacks a point."""
    turn = (1.0, -1.0 if part.left else 1.0, 1.0)
    own, known = ({name: point * turn for name, point in given.items()} for given in (part.points, part.around))
    draw, needed = ROLES.get(part.role, (None, ()))
    if part.role == "none" or not own:
        return []
    if draw is None or not set(needed) <= {*own, *known}:
        return suspension.rods(list(own.values()))
    return draw(known | own, {**SIZES, **part.sizes})


def part_shapes(parts: Iterable[Part]) -> dict[str, Shape]:
    """Visible shapes of parts, by name, in the order of the parts; the name is fit for a file."""
    shapes: dict[str, Shape] = {}
    for part in parts:
        for piece in pieces(part):
            name = part.name + piece.name if piece.name[:1] in ("", "_") else piece.name
            if name + part.suffix in shapes:  # a second part of the role on this corner
                name = f"{part.name}_{piece.name}"
            shapes[name + part.suffix] = Shape(
                mesh=mirrored(piece.mesh) if part.left else piece.mesh,
                rgba=piece.rgba,
                part=part.carrier if piece.held else part.name + part.suffix,
            )
    return shapes
