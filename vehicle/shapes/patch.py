"""Open surface patches: grids of points and Coons patches."""

from __future__ import annotations

import numpy as np
import trimesh

from vehicle.shapes.shape import Array


def grid(points: Array, *, flip: bool = False) -> trimesh.Trimesh:
    """Triangles through a grid of points; the normal is (second index direction) x (first), turned by `flip`.

    Args:
        points: shape (m, n, 3) [m]; rows or columns may shrink to a point, the empty triangles are left out
        flip: turn the normals

    Returns:
        open mesh, equal vertices merged
    """
    m, n = points.shape[:2]
    index = np.arange(m * n).reshape(m, n)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = np.vstack([np.stack([a, b, c], axis=-1).reshape(-1, 3), np.stack([a, c, d], axis=-1).reshape(-1, 3)])
    vertices = points.reshape(-1, 3)
    p, q, r = (vertices[faces[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(q - p, r - p), axis=1)
    faces = faces[area > 1e-12]
    return trimesh.Trimesh(vertices, faces[:, ::-1] if flip else faces, process=True)


def coons(bottom: Array, top: Array, left: Array, right: Array) -> Array:
    """The bilinearly blended surface between four boundary curves.

    S(u, v) = (1-v) bottom(u) + v top(u) + (1-u) left(v) + u right(v) - bilinear blend of the four corners

    Args:
        bottom: curve at v = 0, shape (n, 3), from the left to the right
        top: curve at v = 1, shape (n, 3)
        left: curve at u = 0, shape (m, 3), from the bottom to the top
        right: curve at u = 1, shape (m, 3)

    Returns:
        points, shape (m, n, 3), v along the first index

    Source: S. A. Coons, Surfaces for computer-aided design of space forms, MIT MAC-TR-41, 1967.
    """
    u = np.linspace(0, 1, len(bottom))[None, :, None]
    v = np.linspace(0, 1, len(left))[:, None, None]
    corners = (1 - u) * (1 - v) * bottom[0] + u * (1 - v) * bottom[-1] + (1 - u) * v * top[0] + u * v * top[-1]
    surface: Array = (1 - v) * bottom + v * top + (1 - u) * left[:, None] + u * right[:, None] - corners
    return surface


def ruled_slab(edge_a: Array, edge_b: Array, offset: Array) -> trimesh.Trimesh:
    """A closed slab between two edge curves, thickened to both sides.

    Args:
        edge_a: shape (n, 3) [m]
        edge_b: shape (n, 3) [m]
        offset: half thickness with its direction, shape (3,) [m]

    Returns:
        closed mesh
    """
    rings = np.stack([edge_a + offset, edge_b + offset, edge_b - offset, edge_a - offset], axis=1)
    n = len(rings)
    index = np.arange(4 * n).reshape(n, 4)
    low, high = index[:-1], index[1:]
    low_next, high_next = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
    faces = [
        np.stack([low, low_next, high_next], axis=-1).reshape(-1, 3),
        np.stack([low, high_next, high], axis=-1).reshape(-1, 3),
        np.array([[0, 2, 1], [0, 3, 2]]),
        np.array([[0, 1, 2], [0, 2, 3]]) + 4 * (n - 1),
    ]
    mesh = trimesh.Trimesh(rings.reshape(-1, 3), np.vstack(faces), process=False)
    return trimesh.Trimesh(mesh.vertices, np.asarray(mesh.faces)[:, ::-1], process=False) if mesh.volume < 0 else mesh
