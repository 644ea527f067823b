"""Names that more than one room uses, each written once: wheels, hardpoints, body nodes, channels with their units."""

from __future__ import annotations

WHEELS = ("fr", "fl")
"""Front right (y > 0, on the shaker) and front left."""

WHEEL_SIGN = {"fr": 1.0, "fl": -1.0}
"""Sign of y of each wheel: +y points to the driver's right side."""

SIDE_SIGN = {"right": 1.0, "left": -1.0}
"""Sign of y of each side: +y points to the driver's right."""

SIDE_OF_WHEEL = {"fr": "right", "fl": "left"}
WHEEL_OF_OPTION = {"front_right": "fr", "front_left": "fl"}

ENGINES = ("mujoco", "reduced", "auto")
"""What computes a run: the complete car, its poles, or the poles where they are valid."""

SIDE_POINTS = (
    "wheel_center",
    "tyre_patch",
    "lower_ball",
    "arm_front",
    "arm_rear",
    "strut_top",
    "damper_bottom",
    "spring_lower",
    "tie_outer",
    "tie_inner",
    "stab_body",
    "stab_end",
    "stab_rod_top",
)
"""Hardpoints given for the right side and mirrored to the left."""

CENTER_POINTS = (
    "engine_cog",
    "hydromount",
    "linear_mount",
    "bottom_engine",
    "bottom_body",
    "seat_rail",
    "seat",
    "roof_left_rear",
    "body_front",
)
"""Hardpoints that exist once."""

BODY_OUTPUTS = ("seat_rail", "seat", "roof_left_rear", "body_front")
"""Output points on the flexible body."""

AXES = ("x", "y", "z")

SIDE_ATTACHMENTS = ("strut_top", "arm_front", "arm_rear", "tie_inner", "stab_body")
"""Side hardpoints that must be nodes of the flexible body."""


def body_nodes() -> tuple[str, ...]:
    """Names of the nodes that the flexible body must have for the car to be attached and measured."""
    sides = [f"{point}_{wheel}" for point in SIDE_ATTACHMENTS for wheel in WHEELS]
    rear = [f"rear_support_{side}" for side in ("right", "left")]
    return (*sides, *rear, "hydromount", "linear_mount", "bottom_body", *BODY_OUTPUTS)


def acceleration_places() -> tuple[str, ...]:
    """Places whose acceleration is recorded, in the order of the files."""
    sides = [f"{place}_{wheel}" for wheel in WHEELS for place in ("knuckle", "damper_top", "suspension_mount")]
    return (*sides, "seat_rail", "seat", "engine", "roof_left_rear", "body_front")


def acceleration_channels() -> tuple[str, ...]:
    """Channels `<place>_acc_<axis>` of all acceleration places."""
    return tuple(f"{place}_acc_{axis}" for place in acceleration_places() for axis in AXES)


def wheel_channels() -> dict[str, str]:
    """Channels of the wheels and their units."""
    units = {"damper_{}_velocity": "m/s", "damper_{}_force": "N", "tyre_{}_force_z": "N", "plate_{}_displacement": "m"}
    return {name.format(wheel): unit for wheel in WHEELS for name, unit in units.items()}


def channel_units() -> dict[str, str]:
    """Every channel of a recording and its unit."""
    return {**dict.fromkeys(acceleration_channels(), "m/s2"), **wheel_channels()}
