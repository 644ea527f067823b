"""Roles of parts: drawing function and required points of each role; other parts are drawn as rods between points."""

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
"""Role -> function that draws the part on the right side of the car, and the names of its required points."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    """Visible part of a car or a rig.

    Attributes:
        name: name of the part without suffix; its shapes have this name.
        role: key of `ROLES`; `none` for an invisible part; any other name for rods between the points.
        points: attachment points of the part by name, at the design position [m] in the vehicle frame.
        around: further points required by the role, by the names used in the role.
        suffix: suffix of the names of part and shapes, for example `_fr`; empty for a single part.
        carrier: part to which this part is attached; the bolts move with the carrier.
        left: true: drawn as the mirror image of the right side.
        sizes: drawn sizes that replace entries of `SIZES`.
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
    """Draw a part on the right side by its role; as rods between its points if the role is unknown or lacks a point."""
    turn = (1.0, -1.0 if part.left else 1.0, 1.0)
    points, around = ({name: point * turn for name, point in group.items()} for group in (part.points, part.around))
    draw, needed = ROLES.get(part.role, (None, ()))
    if part.role == "none" or not points:
        return []
    if draw is None or not set(needed) <= {*points, *around}:
        return suspension.rods(list(points.values()))
    return draw(around | points, {**SIZES, **part.sizes})


def part_shapes(parts: Iterable[Part]) -> dict[str, Shape]:
    """Return the visible shapes of parts by name, in the order of the parts; names are valid as file names."""
    shapes: dict[str, Shape] = {}
    for part in parts:
        for piece in pieces(part):
            name = part.name + piece.name if piece.name[:1] in ("", "_") else piece.name
            if name + part.suffix in shapes:  # another part of the same role on this corner
                name = f"{part.name}_{piece.name}"
            shapes[name + part.suffix] = Shape(
                mesh=mirrored(piece.mesh) if part.left else piece.mesh,
                rgba=piece.rgba,
                part=part.carrier if piece.held else part.name + part.suffix,
            )
    return shapes
