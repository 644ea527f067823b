"""Bodies of revolution."""

from __future__ import annotations

import itertools

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes.placement import outward

ON_AXIS = 1e-9  # [m] a smaller radius is a point on the axis


def lathe(profile: ArrayLike, *, sections: int = 24, closed: bool = False) -> trimesh.Trimesh:
    """Turn a profile about the z axis.

    x = r cos(phi), y = r sin(phi), phi = 2 pi k / sections

    Its volume is that of the turned body times sin(a)/a with a = 2 pi / sections, the ratio of polygon to circle.

    Args:
        profile: points (r, z) [m], shape (n, 2); an open profile that begins and ends on the axis makes a closed body
        sections: number of divisions of the full turn
        closed: join the last point to the first (a ring that does not touch the axis)

    Returns:
        mesh with outward normals if it is closed
    """
    points = np.asarray(profile, dtype=float)
    phi = 2 * np.pi * np.arange(sections) / sections
    vertices: list[tuple[float, float, float]] = []
    rings: list[np.ndarray] = []
    for r, z in points:
        first = len(vertices)
        if r < ON_AXIS:
            vertices.append((0.0, 0.0, float(z)))
            rings.append(np.full(sections, first))
        else:
            vertices.extend((float(r * np.cos(p)), float(r * np.sin(p)), float(z)) for p in phi)
            rings.append(first + np.arange(sections))
    pairs = list(itertools.pairwise(rings)) + ([(rings[-1], rings[0])] if closed else [])
    faces: list[np.ndarray] = []
    for low, high in pairs:
        low_next, high_next = np.roll(low, -1), np.roll(high, -1)
        faces.append(np.column_stack([low, low_next, high_next]))
        faces.append(np.column_stack([low, high_next, high]))
    stacked = np.vstack(faces)
    a, b, c = stacked.T
    stacked = stacked[(a != b) & (b != c) & (c != a)]
    return outward(trimesh.Trimesh(np.array(vertices), stacked, process=False))


def ring(inner: float, outer: float, low: float, high: float, *, sections: int = 20) -> trimesh.Trimesh:
    """A plain ring about z between two radii [m] and two heights [m]."""
    return lathe([(inner, low), (outer, low), (outer, high), (inner, high)], sections=sections, closed=True)


def drum(radius: float, low: float, high: float, *, bevel: float = 0.0, sections: int = 20) -> trimesh.Trimesh:
    """A solid cylinder about z between two heights [m], its edges bevelled [m]."""
    if bevel == 0.0:
        return lathe([(0, low), (radius, low), (radius, high), (0, high)], sections=sections)
    rim = [(radius - bevel, low), (radius, low + bevel), (radius, high - bevel), (radius - bevel, high)]
    return lathe([(0, low), *rim, (0, high)], sections=sections)


def ball(radius: float, *, sections: int = 14) -> trimesh.Trimesh:
    """A sphere [m] about the origin, as many divisions from pole to pole as half its sections."""
    theta = np.linspace(0, np.pi, sections // 2 + 1)
    profile = np.column_stack([radius * np.sin(theta), -radius * np.cos(theta)])
    profile[[0, -1], 0] = 0.0
    return lathe(profile, sections=sections)
