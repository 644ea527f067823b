"""Tubes and bars swept along a path."""

from __future__ import annotations

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes.placement import outward
from vehicle.shapes.shape import Array


def frames(path: Array, up: ArrayLike | None, *, closed: bool) -> tuple[Array, Array]:
    """Two normals at each point of a path, carried along it without twist by double reflection.

    The frame is mirrored at the middle plane of each chord, then at the plane that brings its tangent to the next one.

    Args:
        path: points [m], shape (n, 3)
        up: wished direction of the first normal; with it, EVERY normal is the projection of this direction
        closed: the path returns to its first point (not repeated); it must lie in a plane, or the section will not meet

    Returns:
        first and second normal, unit length, each shape (n, 3)

    Source: W. Wang, B. Juettler, D. Zheng, Y. Liu, Computation of rotation minimizing frames, ACM TOG 27 (2008), 2.
    """
    if closed:
        tangents = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    else:
        tangents = np.gradient(path, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    if up is not None:
        wish = np.asarray(up, dtype=float)
        first = wish - (tangents @ wish)[:, None] * tangents
        first /= np.linalg.norm(first, axis=1)[:, None]
        return first, np.cross(tangents, first)
    first = np.empty_like(path)
    start = np.eye(3)[np.argmin(np.abs(tangents[0]))]
    start = start - (start @ tangents[0]) * tangents[0]
    first[0] = start / np.linalg.norm(start)
    for i, chord in enumerate(np.diff(path, axis=0)):
        normal, tangent = _reflected(first[i], chord), _reflected(tangents[i], chord)
        first[i + 1] = _reflected(normal, tangents[i + 1] - tangent)
    return first, np.cross(tangents, first)


def _reflected(vector: Array, normal: Array) -> Array:
    square = float(normal @ normal)
    if square < 1e-24:  # nothing to turn
        return vector
    return vector - (2 * float(normal @ vector) / square) * normal


def tube(
    path: ArrayLike,
    radius: ArrayLike,
    *,
    sides: int = 8,
    closed: bool = False,
    width: ArrayLike | None = None,
    up: ArrayLike | None = None,
) -> trimesh.Trimesh:
    """Sweep a polygon along a path: a closed body with flat ends, or a ring.

    For a straight path the volume is that of the prism, sides/2 sin(2 pi / sides) radius^2 length; for a closed
    planar path it is the polygon's area times the length of the path (Pappus) as the steps get finer.

    Args:
        path: points of the centre line [m], shape (n, 3), no two in a row equal
        radius: half height of the section, along the first normal [m]; a number or shape (n,)
        sides: corners of the polygon; 4 makes a bar with flat faces
        closed: the path returns to its first point (which is not repeated)
        width: half width, along the second normal [m]; `radius` if not given
        up: direction that the first normal follows, for flat bars; free of twist if not given

    Returns:
        mesh with outward normals
    """
    centre = np.asarray(path, dtype=float)
    first, second = frames(centre, up, closed=closed)
    n = len(centre)
    half_height = np.broadcast_to(np.asarray(radius, dtype=float), (n,))
    half_width = half_height if width is None else np.broadcast_to(np.asarray(width, dtype=float), (n,))
    phi = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    stretch = np.sqrt(2.0) if sides == 4 else 1.0  # for a bar, half height and width are those of its flat faces
    rings = (
        centre[:, None, :]
        + stretch * half_height[:, None, None] * np.cos(phi)[None, :, None] * first[:, None, :]
        + stretch * half_width[:, None, None] * np.sin(phi)[None, :, None] * second[:, None, :]
    )
    index = np.arange(n * sides).reshape(n, sides)
    low, high = (index, np.roll(index, -1, axis=0)) if closed else (index[:-1], index[1:])
    low_next, high_next = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
    quads = [np.stack([low, low_next, high_next], axis=-1), np.stack([low, high_next, high], axis=-1)]
    faces = [quad.reshape(-1, 3) for quad in quads]
    if not closed:
        corner = np.arange(1, sides - 1)
        faces.append(np.column_stack([index[0, 0] + 0 * corner, index[0, corner + 1], index[0, corner]]))
        faces.append(np.column_stack([index[-1, 0] + 0 * corner, index[-1, corner], index[-1, corner + 1]]))
    return outward(trimesh.Trimesh(rings.reshape(-1, 3), np.vstack(faces), process=False))


def rod(start: ArrayLike, end: ArrayLike, radius: float, *, sides: int = 8) -> trimesh.Trimesh:
    """A straight round rod between two points [m]."""
    return tube(np.array([start, end], dtype=float), radius, sides=sides)
