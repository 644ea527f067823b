"""Convex blocks: bevelled boxes and hulls of points."""

from __future__ import annotations

from itertools import product

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes.placement import outward


def hull(points: ArrayLike) -> trimesh.Trimesh:
    """The convex hull of points [m], shape (n, 3)."""
    return outward(trimesh.convex.convex_hull(np.asarray(points, dtype=float)))


def box(low: ArrayLike, high: ArrayLike, bevel: float = 0.0) -> trimesh.Trimesh:
    """A box between two corners [m], all edges bevelled by `bevel` [m]."""
    a, b = (np.asarray(corner, dtype=float) for corner in (low, high))
    centre, half = (a + b) / 2, np.abs(b - a) / 2
    signs = np.array(list(product((-1.0, 1.0), repeat=3)))
    if bevel == 0.0:
        return hull(centre + signs * half)
    corners = [centre + signs * (half - bevel * (1 - np.eye(3)[axis])) for axis in range(3)]
    return hull(np.vstack(corners))
