"""Drawn pieces of a part, default drawn sizes, and visible shapes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import trimesh

from vehicle.arrays import Vector

Colour = tuple[float, float, float, float]
Points = Mapping[str, Vector]
Sizes = Mapping[str, float]

SIZES: Final[dict[str, float]] = {
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
"""Drawn sizes [m] (turns: number) that do not follow from points; used in pictures only, not in the simulation."""


class Piece(NamedTuple):
    """Mesh of a part."""

    name: str
    """empty or with a leading underscore: appended to the name of the part; else the complete name"""
    mesh: trimesh.Trimesh
    """triangles with outward normals, vertices [m]"""
    rgba: Colour
    """colour and opacity, each between 0 and 1"""
    held: bool = False
    """true: moves with the carrier of the part, not with the part"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Shape:
    """Visible mesh [m] in the vehicle frame (x rear, y driver's right, z up) at the design position."""

    mesh: trimesh.Trimesh
    """triangles with outward normals, vertices [m]"""
    rgba: Colour
    """colour and opacity, each between 0 and 1"""
    part: str
    """name of the rigid part with which the shape moves; `world` for a fixed shape"""
