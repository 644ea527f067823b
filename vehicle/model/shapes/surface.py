"""Curves and open surfaces between curves: splines, rounded corners, helices, grids, Coons patches."""

from collections.abc import Callable

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.arrays import Vector
from vehicle.model.shapes.solids import quads


def spline(points: ArrayLike, count: int) -> Vector:
    """Interpolate points by a smooth curve (centripetal Catmull-Rom), even in its parameter; shape (count, d).

    Cubic Hermite segments; the tangent at a point is the slope of the parabola through the point and its neighbours.

    Args:
        points: points on the curve, shape (n, d), n >= 2
        count: number of points of the result
    """
    p = np.asarray(points, dtype=float)
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1) ** 0.5)])
    slopes = np.diff(p, axis=0) / np.diff(knots)[:, None]
    tangents = np.empty_like(p)
    tangents[0], tangents[-1] = slopes[0], slopes[-1]
    weight = (np.diff(knots)[:-1] / (knots[2:] - knots[:-2]))[:, None]
    tangents[1:-1] = (1 - weight) * slopes[:-1] + weight * slopes[1:]
    s = np.linspace(0, knots[-1], count)
    i = np.clip(np.searchsorted(knots, s, side="right") - 1, 0, len(p) - 2)
    # Hermite basis on the segment of each parameter: values and tangents at both ends.
    h = np.diff(knots)[i][:, None]
    u = (s[:, None] - knots[i][:, None]) / h
    curve: Vector = (
        (2 * u**3 - 3 * u**2 + 1) * p[i]
        + (u**3 - 2 * u**2 + u) * h * tangents[i]
        + (3 * u**2 - 2 * u**3) * p[i + 1]
        + (u**3 - u**2) * h * tangents[i + 1]
    )
    return curve


def bezier(start: ArrayLike, corner: ArrayLike, end: ArrayLike, count: int) -> Vector:
    """Return a quadratic Bezier curve: (1-u)^2 start + 2 u (1-u) corner + u^2 end, shape (count, d)."""
    u = np.linspace(0, 1, count)[:, None]
    a, b, c = (np.asarray(point, dtype=float) for point in (start, corner, end))
    curve: Vector = (1 - u) ** 2 * a + 2 * u * (1 - u) * b + u**2 * c
    return curve


def rounded(points: ArrayLike, radius: float, *, steps: int = 5) -> Vector:
    """Round each inner corner of a polyline by a curve that begins `radius` [m] before the corner."""
    p = np.asarray(points, dtype=float)
    pieces = [p[:1]]
    for before, corner, after in zip(p[:-2], p[1:-1], p[2:], strict=True):
        back, ahead = before - corner, after - corner
        cut = [corner + min(radius, 0.45 * np.linalg.norm(d)) * d / np.linalg.norm(d) for d in (back, ahead)]
        pieces.append(bezier(cut[0], corner, cut[1], steps))
    return np.vstack([*pieces, p[-1:]])


def helix(
    radius: float | Callable[[Vector], Vector], low: float, high: float, turns: float, *, steps: int = 20
) -> Vector:
    """Return a helix about z, (n, 3) [m]: (r cos(phi), r sin(phi), z), phi from 0 to 2 pi turns, z linear.

    With a constant radius the length is sqrt((2 pi r turns)^2 + (high - low)^2).

    Args:
        radius: radius [m], a number or a function of the share of the height, 0 to 1
        low: height of the beginning [m]
        high: height of the end [m]
        turns: number of turns
        steps: number of points per turn
    """
    share = np.linspace(0, 1, round(turns * steps) + 1)
    r = radius(share) if callable(radius) else np.full_like(share, radius)
    phi = 2 * np.pi * turns * share
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), low + (high - low) * share])


def grid(points: Vector, *, flip: bool = False) -> trimesh.Trimesh:
    """Triangulate a grid of points; the normal is (second index direction) x (first), reversed by `flip`.

    Args:
        points: grid of points [m], shape (m, n, 3); rows or columns may shrink to a point, empty triangles are omitted
        flip: reverse the normals

    Returns:
        open mesh, equal vertices merged
    """
    m, n = points.shape[:2]
    index = np.arange(m * n).reshape(m, n)
    faces = quads(index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    vertices = points.reshape(-1, 3)
    p, q, r = (vertices[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(q - p, r - p), axis=1)
    # A row that shrinks to a point has triangles without area.
    faces = faces[area > 1e-12]
    return trimesh.Trimesh(vertices, faces[:, ::-1] if flip else faces, process=True)


def coons(bottom: Vector, top: Vector, left: Vector, right: Vector) -> Vector:
    """Return the bilinearly blended surface between four boundary curves; (m, n, 3), v along the first index.

    S(u, v) = (1-v) bottom(u) + v top(u) + (1-u) left(v) + u right(v) - bilinear blend of the four corners

    Args:
        bottom: curve at v = 0, shape (n, 3), from the left to the right
        top: curve at v = 1, shape (n, 3)
        left: curve at u = 0, shape (m, 3), from the bottom to the top
        right: curve at u = 1, shape (m, 3)

    Source: S. A. Coons, Surfaces for computer-aided design of space forms, MIT MAC-TR-41, 1967.
    """
    u = np.linspace(0, 1, len(bottom))[None, :, None]
    v = np.linspace(0, 1, len(left))[:, None, None]
    corners = (1 - u) * (1 - v) * bottom[0] + u * (1 - v) * bottom[-1] + (1 - u) * v * top[0] + u * v * top[-1]
    surface: Vector = (1 - v) * bottom + v * top + (1 - u) * left[:, None] + u * right[:, None] - corners
    return surface
