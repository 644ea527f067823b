"""One visible shape: a mesh in vehicle coordinates, its colour and the rigid part that carries it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray

Array = NDArray[np.float64]
Colour = tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Shape:
    """A mesh [m] in the vehicle frame (x rear, y driver's right, z up) at the design position."""

    mesh: trimesh.Trimesh
    """triangles with outward normals, vertices [m]"""
    rgba: Colour
    """colour and opacity, each between 0 and 1"""
    part: str
    """name of the rigid part that carries the shape; `world` for what stands still"""
