"""All visible shapes of the complete car on its rig."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import trimesh

from vehicle.shapes import (
    body_shell,
    body_trim,
    cabin,
    engine,
    palette,
    rig,
    strut,
    suspension,
    underbody,
    wheel,
)
from vehicle.shapes.body_outline import outline
from vehicle.shapes.hardpoint import Points, checked_dimensions, checked_points, right_handed
from vehicle.shapes.placement import joined, mirrored
from vehicle.shapes.shape import Colour, Shape

SHELL: Final = (
    "body_shell",
    "body_painted",
    "body_trim",
    "body_rails",
    "body_lamps_front",
    "body_lamps_rear",
    "body_plates",
    "body_glass",
)
"""shapes that hide the chassis: make them translucent together, and leave `body_lining` out then"""


def car_shapes(points: Mapping[str, np.ndarray], dimensions: Mapping[str, float] | None = None) -> dict[str, Shape]:
    """Every visible shape of car and rig at the design position.

    Args:
        points: hardpoints [m] in the vehicle frame, side points with suffix `_fr` or `_fl`
        dimensions: drawn sizes [m] that replace those of `hardpoint.DIMENSIONS`

    Returns:
        shapes by name, in a fixed order; the name is fit for a file

    Raises:
        ConfigurationError: a hardpoint is missing or not finite, or a dimension unknown or not positive
    """
    hardpoints, size = checked_points(points), checked_dimensions(dimensions)
    shapes = body_shapes(hardpoints, size) | engine_shapes(hardpoints)
    for side in ("fr", "fl"):
        shapes |= corner_shapes(hardpoints, size, side)
    return shapes | rig_shapes(hardpoints)


def body_shapes(points: Points, size: Mapping[str, float]) -> dict[str, Shape]:
    """Shell, glass, trim, cabin and the structure underneath: all on the part `body`."""
    body = outline(points, size)
    house = [
        underbody.wheel_house(body, axle, depth)
        for axle, depth in ((0, underbody.FRONT_HOUSE_DEPTH), (1, underbody.REAR_HOUSE_DEPTH))
    ]
    meshes: dict[str, tuple[trimesh.Trimesh, Colour]] = {
        "body_floor": (underbody.floor(body, points), palette.FLOOR),
        "body_front_structure": (underbody.front_structure(body, points, size), palette.STAND),
        "body_subframe": (underbody.subframe(points), palette.DARK_STEEL),
        "body_rack_bellows": (underbody.rack_bellows(points), palette.RUBBER),
        "body_exhaust": (underbody.exhaust(points), palette.CAST),
        "body_engine_mounts": (engine.side_mounts(points), palette.DARK_STEEL),
        "body_support_shoes": (
            joined([rig.support_shoe(points[f"rear_support_{side}"]) for side in ("right", "left")]),
            palette.STAND,
        ),
        "body_seats": (cabin.seats(points), palette.SEAT),
        "body_seat_rails": (cabin.seat_rails(points), palette.STEEL),
        "body_dashboard": (cabin.dashboard(points), palette.TRIM),
        "body_lining": (joined(body_shell.lining(body), house), palette.LINING),
        "body_shell": (body_shell.sheet_metal(body), palette.BODY),
        "body_painted": (body_trim.painted_parts(body), palette.BODY),
        "body_trim": (body_trim.dark_trim(body), palette.TRIM),
        "body_rails": (body_trim.roof_rails(body), palette.CHROME),
        "body_lamps_front": (body_trim.headlamps(body), palette.HEADLAMP),
        "body_lamps_rear": (body_trim.tail_lamps(body), palette.TAIL_LAMP),
        "body_plates": (body_trim.plates(body), palette.CHROME),
        "body_glass": (body_shell.glass(body), palette.GLASS),
    }
    return {name: Shape(mesh=mesh, rgba=rgba, part="body") for name, (mesh, rgba) in meshes.items()}


def engine_shapes(points: Points) -> dict[str, Shape]:
    """Engine with gearbox, and the torque arm."""
    meshes: dict[str, tuple[trimesh.Trimesh, Colour, str]] = {
        "engine_castings": (engine.castings(points), palette.ALUMINIUM, "engine"),
        "engine_block": (engine.cylinder_block(points), palette.CAST, "engine"),
        "engine_covers": (engine.covers(points), palette.ENGINE_DARK, "engine"),
        "engine_pulleys": (engine.pulleys(points), palette.STEEL, "engine"),
        "engine_belt": (engine.belt(points), palette.RUBBER, "engine"),
        "engine_mount_rubber": (engine.mount_rubber(points), palette.RUBBER, "engine"),
        "engine_bolt": (engine.torque_arm_bolt(points), palette.STEEL, "engine"),
        "torque_arm": (engine.torque_arm(points), palette.LINK, "torque_arm"),
        "torque_arm_rubber": (engine.torque_arm_rubber(points), palette.RUBBER, "torque_arm"),
    }
    return {name: Shape(mesh=mesh, rgba=rgba, part=part) for name, (mesh, rgba, part) in meshes.items()}


def corner_shapes(points: Points, size: Mapping[str, float], side: str) -> dict[str, Shape]:
    """Suspension and wheel of one side, drawn on the right and mirrored for the left."""
    p = right_handed(points, side)
    meshes: dict[str, tuple[trimesh.Trimesh, Colour, str]] = {
        "a_arm": (suspension.a_arm(p), palette.CAST, "a_arm"),
        "a_arm_rubber": (suspension.a_arm_rubber(p), palette.RUBBER, "a_arm"),
        "a_arm_bolts": (suspension.a_arm_bolts(p), palette.STEEL, "body"),
        "knuckle": (suspension.knuckle(p, size), palette.STEEL, "knuckle"),
        "brake_disc": (wheel.brake_disc(p, size), palette.DISC, "brake_disc"),
        "caliper": (wheel.caliper(p, size), palette.CALIPER, "caliper"),
        "tyre": (wheel.tyre(p, size), palette.RUBBER, "tyre"),
        "rim": (wheel.rim(p, size), palette.RIM, "tyre"),
        "wheel_bolts": (wheel.wheel_bolts(p, size), palette.DARK_STEEL, "tyre"),
        "damper_bottom": (strut.damper_housing(p, size), palette.DAMPER, "damper_bottom"),
        "spring_seat_lower": (strut.lower_seat(p, size), palette.DARK_STEEL, "damper_bottom"),
        "damper_top": (strut.piston_rod(p), palette.ROD, "damper_top"),
        "spring_seat_upper": (strut.upper_seat(p, size), palette.DARK_STEEL, "damper_top"),
        "bump_stop": (strut.bump_stop(p), palette.RUBBER, "damper_top"),
        "suspension_mount": (strut.top_mount_rubber(p), palette.RUBBER, "suspension_mount"),
        "suspension_mount_steel": (strut.top_mount_steel(p), palette.STEEL, "suspension_mount"),
        "main_spring": (strut.coil_spring(p, size), palette.SPRING, "main_spring"),
        "steering_rod": (suspension.steering_rod(p), palette.LINK, "steering_rod"),
        "stabilizer_half": (suspension.stabilizer_half(p), palette.LINK, "stabilizer_half"),
        "stabilizer_bushing": (suspension.stabilizer_bushing(p), palette.RUBBER, "body"),
        "stabilizer_rod": (suspension.stabilizer_rod(p), palette.LINK, "stabilizer_rod"),
    }
    return {
        f"{name}_{side}": Shape(
            mesh=mesh if side == "fr" else mirrored(mesh), rgba=rgba, part=part if part == "body" else f"{part}_{side}"
        )
        for name, (mesh, rgba, part) in meshes.items()
    }


def rig_shapes(points: Points) -> dict[str, Shape]:
    """Shaker, pedestal, stands and bed plate; only both plates may move."""
    right, left = points["tyre_patch_fr"], points["tyre_patch_fl"]
    supports = {side: points[f"rear_support_{side}"] for side in ("right", "left")}
    meshes: dict[str, tuple[trimesh.Trimesh, Colour, str]] = {
        "plate_fr": (rig.shaker_table(right), palette.PLATE, "plate_fr"),
        "plate_inserts_fr": (rig.table_inserts(right), palette.DARK_STEEL, "plate_fr"),
        "plate_fl": (rig.fixed_plate(left), palette.PLATE, "plate_fl"),
        "shaker_fr": (rig.shaker_body(right), palette.SHAKER, "world"),
        "shaker_frame_fr": (rig.shaker_frame(right), palette.STAND, "world"),
        "pedestal_fl": (rig.pedestal(left), palette.STAND, "world"),
        "bed_plate": (rig.bed_plate(points), palette.BED, "world"),
    }
    for side, support in supports.items():
        meshes[f"rubber_block_{side}"] = (rig.rubber_block(support), palette.RUBBER, "world")
        meshes[f"stand_{side}"] = (rig.stand(support), palette.STAND, "world")
    return {name: Shape(mesh=mesh, rgba=rgba, part=part) for name, (mesh, rgba, part) in meshes.items()}
