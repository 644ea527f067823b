"""Moving, mirroring and joining meshes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.shapes.shape import Array


def axis_rotation(direction: ArrayLike) -> Array:
    """Rotation that takes z to a direction by the shortest turn.

    R = 1 + [v] + [v]^2 / (1 + c), v = z x d, c = z . d (Rodrigues)

    Args:
        direction: direction of the new z axis, any length, shape (3,)

    Returns:
        rotation matrix, shape (3, 3)
    """
    d = np.asarray(direction, dtype=float)
    d = d / np.linalg.norm(d)
    if d[2] < -1 + 1e-12:  # the shortest turn is not unique: turn about x
        return np.diag([1.0, -1.0, -1.0])
    v = np.array([-d[1], d[0], 0.0])
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    rotation: Array = np.eye(3) + cross + cross @ cross / (1 + d[2])
    return rotation


def placed(mesh: trimesh.Trimesh, origin: ArrayLike, direction: ArrayLike = (0.0, 0.0, 1.0)) -> trimesh.Trimesh:
    """A copy of a mesh made about z, its z axis turned to `direction`, its origin moved to `origin` [m]."""
    vertices = np.asarray(mesh.vertices) @ axis_rotation(direction).T + np.asarray(origin, dtype=float)
    return trimesh.Trimesh(vertices, mesh.faces, process=False)


def shifted(points: ArrayLike, dx: float, dy: float, dz: float) -> Array:
    """Points moved by (dx, dy, dz) [m], shape (..., 3)."""
    moved: Array = np.asarray(points, dtype=float) + np.array([dx, dy, dz])
    return moved


def mirrored(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh mirrored at the middle plane y = 0; the faces are turned so that normals stay outward."""
    vertices = np.asarray(mesh.vertices) * (1.0, -1.0, 1.0) + 0.0  # no -0.0: both halves share their middle vertices
    return trimesh.Trimesh(vertices, np.asarray(mesh.faces)[:, ::-1], process=False)


def inverted(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """The mesh with its normals turned round."""
    return trimesh.Trimesh(mesh.vertices, np.asarray(mesh.faces)[:, ::-1], process=False)


def outward(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """A closed mesh with its faces turned, where needed, so that its volume is positive."""
    return inverted(mesh) if mesh.volume < 0 else mesh


def joined(*meshes: trimesh.Trimesh | Sequence[trimesh.Trimesh]) -> trimesh.Trimesh:
    """Several meshes as one; they may overlap, their surfaces are not cut."""
    flat: list[trimesh.Trimesh] = []
    for mesh in meshes:
        flat.extend([mesh] if isinstance(mesh, trimesh.Trimesh) else mesh)
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in flat[:-1])])
    vertices = np.vstack([mesh.vertices for mesh in flat])
    faces = np.vstack([np.asarray(mesh.faces) + offset for mesh, offset in zip(flat, offsets, strict=True)])
    return trimesh.Trimesh(vertices, faces, process=False)


def both(*meshes: trimesh.Trimesh) -> trimesh.Trimesh:
    """Right-hand meshes with their mirror images."""
    return joined([*meshes, *(mirrored(mesh) for mesh in meshes)])
