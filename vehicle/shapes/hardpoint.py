"""The hardpoints and dimensions that the shapes are made from, checked on entry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.names import CENTER_POINTS, SIDE_POINTS, WHEELS
from vehicle.shapes.shape import Array

SIDES: Final = WHEELS
CENTRE_POINTS: Final = (*CENTER_POINTS, "rear_support_right", "rear_support_left")
DIMENSIONS: Final[dict[str, float]] = {
    "tyre_section_width": 0.195,  # 195/60 R15
    "tyre_deflection": 0.0125,  # free radius 0.3075 m of 195/60 R15 minus the loaded 0.295 m
    "rim_diameter": 0.381,  # 15 inch
    "brake_disc_radius": 0.129,  # assumed: 258 mm front disc
    "damper_tube_radius": 0.0255,  # assumed
    "spring_coil_radius": 0.070,  # assumed
    "spring_wire_radius": 0.006,  # assumed
    "spring_turns": 5.5,  # assumed
    "rear_overhang": 0.985,  # 4.45 m of the estate minus the rear axle at 3.465 m
}
"""drawn sizes [m] (turns: number) that hardpoints do not give; the pictures' own, no physics reads them"""

Points = Mapping[str, Array]


def checked_points(points: Mapping[str, np.ndarray]) -> dict[str, Array]:
    """All hardpoints as float arrays, or a ConfigurationError that names what is missing or not finite."""
    wanted = [f"{name}_{side}" for name in SIDE_POINTS for side in SIDES] + list(CENTRE_POINTS)
    missing = [name for name in wanted if name not in points]
    if missing:
        raise ConfigurationError(
            f"shapes: hardpoints missing: {', '.join(missing)}; side points end in _fr and _fl. "
            "Add them to the vehicle file."
        )
    checked = {}
    for name in wanted:
        point = np.asarray(points[name], dtype=float)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise ConfigurationError(
                f"shapes: hardpoint {name} is {np.asarray(points[name]).tolist()}; allowed are three finite numbers "
                "x, y, z [m]. Mend it in the vehicle file."
            )
        checked[name] = point
    return checked


def checked_dimensions(dimensions: Mapping[str, float] | None) -> dict[str, float]:
    """The drawn sizes with the given ones in place, or a ConfigurationError for an unknown name or a bad value."""
    sizes = dict(DIMENSIONS)
    for name, value in (dimensions or {}).items():
        if name not in sizes:
            raise ConfigurationError(f"shapes: unknown dimension {name!r}; the known ones are {', '.join(sizes)}.")
        if not (np.isfinite(value) and value > 0):
            raise ConfigurationError(f"shapes: dimension {name} is {value}; allowed is a finite number above 0.")
        sizes[name] = float(value)
    return sizes


def right_handed(points: Points, side: str) -> dict[str, Array]:
    """The points of one side without suffix, mirrored to y > 0 for the left one: shapes are drawn on the right."""
    turn = np.array([1.0, 1.0 if side == "fr" else -1.0, 1.0])
    return {name: points[f"{name}_{side}"] * turn for name in SIDE_POINTS}
