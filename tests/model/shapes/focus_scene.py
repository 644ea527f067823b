"""Scene of a MacPherson car on plates and blocks, built from its points like that of a composed car."""

from collections.abc import Mapping

import numpy as np

from vehicle.model.shapes import Part, Shape
from vehicle.model.shapes.scene import car_shapes as scene

CORNER = {
    "a_arm": "lower_arm", "knuckle": "knuckle", "tyre": "wheel", "brake_disc": "brake_disc", "caliper": "caliper",
    "damper_bottom": "damper_tube", "damper_top": "damper_rod", "suspension_mount": "top_mount",
    "main_spring": "coil_spring", "steering_rod": "steering_rod", "stabilizer_half": "stabilizer_half",
    "stabilizer_rod": "stabilizer_rod",
}  # fmt: skip


def car_shapes(points: Mapping[str, np.ndarray]) -> dict[str, Shape]:
    """Return all visible shapes; the names of corner points end with the wheel name."""
    corners = {w: {n[:-3]: points[n] for n in points if n.endswith(f"_{w}")} for w in ("fr", "fl")}
    parts = [Part(name=name, role=name, points=points) for name in ("engine", "torque_arm")]
    parts += [
        Part(name=name, role=role, points=corner, suffix=f"_{wheel}", left=wheel == "fl")
        for wheel, corner in corners.items()
        for name, role in CORNER.items()
    ]
    supports = {side: points[f"rear_support_{side}"] for side in ("right", "left")}
    return scene(points, corners, supports, parts)
