"""Closed solids (hulls, boxes, bodies of revolution, tubes and bars swept along a path), placed and joined."""

import itertools
from collections.abc import Sequence

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from vehicle.arrays import Vector

ON_AXIS = 1e-9  # [m] minimum radius of a circle; smaller radii are points on the axis


def hull(points: ArrayLike) -> trimesh.Trimesh:
    """Build the convex hull of points [m], shape (n, 3)."""
    return outward(trimesh.convex.convex_hull(np.asarray(points, dtype=float)))


def box(low: ArrayLike, high: ArrayLike, bevel: float = 0.0) -> trimesh.Trimesh:
    """Build a box between two corners [m], all edges bevelled by `bevel` [m]."""
    a, b = (np.asarray(corner, dtype=float) for corner in (low, high))
    centre, half = (a + b) / 2, np.abs(b - a) / 2
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    if bevel == 0.0:
        return hull(centre + signs * half)
    return hull(np.vstack([centre + signs * (half - bevel * (1 - np.eye(3)[axis])) for axis in range(3)]))


def block(origin: ArrayLike, low: ArrayLike, high: ArrayLike, bevel: float = 0.0) -> trimesh.Trimesh:
    """Build a box between two corners relative to an origin [m]."""
    zero = np.asarray(origin, dtype=float)
    return box(zero + np.asarray(low), zero + np.asarray(high), bevel)


def plate(origin: ArrayLike, axis: int, span: Sequence[float], corners: Sequence[Sequence[float]]) -> trimesh.Trimesh:
    """Build a flat plate with parallel faces: the hull of a polygon at each end of a span.

    Args:
        origin: origin of all coordinates [m], shape (3,)
        axis: direction of the thickness, 0, 1 or 2
        span: positions of the faces along the axis [m]
        corners: corners of the polygon along the two other axes, in ascending order of the axes [m]
    """
    offsets = [np.insert(np.asarray(corner, dtype=float), axis, at) for at in span for corner in corners]
    return hull(np.asarray(origin, dtype=float) + np.array(offsets))


def lathe(profile: ArrayLike, *, sections: int = 24, closed: bool = False) -> trimesh.Trimesh:
    """Build the body of revolution of a profile about the z axis; outward normals if it is closed.

    x = r cos(phi), y = r sin(phi), phi = 2 pi k / sections

    The volume is that of the exact body times sin(a)/a with a = 2 pi / sections, the ratio of polygon to circle.

    Args:
        profile: points (r, z) [m], shape (n, 2); an open profile that begins and ends on the axis gives a closed body
        sections: number of divisions of the full turn
        closed: join the last point to the first (a ring that does not touch the axis)
    """
    phi = 2 * np.pi * np.arange(sections) / sections
    vertices: list[Vector] = []
    rings: list[np.ndarray] = []
    count = 0
    for r, z in np.asarray(profile, dtype=float):
        around = phi[: 1 if r < ON_AXIS else sections]
        vertices.append(np.column_stack([r * np.cos(around), r * np.sin(around), np.full(len(around), z)]))
        # A point on the axis counts as a ring of equal indices, so that all rings have equal length.
        rings.append(np.broadcast_to(count + np.arange(len(around)), sections))
        count += len(around)
    pairs = list(itertools.pairwise(rings)) + ([(rings[-1], rings[0])] if closed else [])
    faces = np.vstack([quads(low, np.roll(low, -1), np.roll(high, -1), high) for low, high in pairs])
    a, b, c = faces.T
    # Quadrangles at the axis have triangles with a corner twice.
    faces = faces[(a != b) & (b != c) & (c != a)]
    return outward(trimesh.Trimesh(np.vstack(vertices), faces, process=False))


def ring(inner: float, outer: float, low: float, high: float, *, sections: int = 20) -> trimesh.Trimesh:
    """Build a ring with rectangular section about z, between two radii [m] and two heights [m]."""
    return lathe([(inner, low), (outer, low), (outer, high), (inner, high)], sections=sections, closed=True)


def drum(radius: float, low: float, high: float, *, bevel: float = 0.0, sections: int = 20) -> trimesh.Trimesh:
    """Build a solid cylinder about z between two heights [m], with bevelled edges [m]."""
    if bevel == 0.0:
        return lathe([(0, low), (radius, low), (radius, high), (0, high)], sections=sections)
    rim = [(radius - bevel, low), (radius, low + bevel), (radius, high - bevel), (radius - bevel, high)]
    return lathe([(0, low), *rim, (0, high)], sections=sections)


def ball(radius: float, *, sections: int = 14) -> trimesh.Trimesh:
    """Build a sphere [m] about the origin, with half as many divisions from pole to pole as sections."""
    theta = np.linspace(0, np.pi, sections // 2 + 1)
    profile = np.column_stack([radius * np.sin(theta), -radius * np.cos(theta)])
    profile[[0, -1], 0] = 0.0
    return lathe(profile, sections=sections)


def frames(path: Vector, up: ArrayLike | None, *, closed: bool) -> tuple[Vector, Vector]:
    """Return two unit normals at each point of a path, (n, 3) each, transported without twist by double reflection.

    The frame is mirrored at the middle plane of each chord, then at the plane that maps its tangent to the next.

    Args:
        path: points [m], shape (n, 3)
        up: preferred direction of the first normal; if set, EVERY first normal is the projection of this direction
        closed: the path returns to its first point (not repeated); it must be planar, or the end sections differ

    Source: W. Wang, B. Juettler, D. Zheng, Y. Liu, Computation of rotation minimizing frames, ACM TOG 27 (2008), 2.
    """
    tangents = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0) if closed else np.gradient(path, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    if up is not None:
        wish = np.asarray(up, dtype=float)
        # Projection of `up` onto the plane across the path.
        first = wish - (tangents @ wish)[:, None] * tangents
        first /= np.linalg.norm(first, axis=1)[:, None]
        return first, np.cross(tangents, first)
    first = np.empty_like(path)
    # Any normal at the first point: from the axis that is farthest from the tangent.
    start = np.eye(3)[np.argmin(np.abs(tangents[0]))]
    start = start - (start @ tangents[0]) * tangents[0]
    first[0] = start / np.linalg.norm(start)
    for i, chord in enumerate(np.diff(path, axis=0)):
        normal, tangent = _reflected(first[i], chord), _reflected(tangents[i], chord)
        first[i + 1] = _reflected(normal, tangents[i + 1] - tangent)
    return first, np.cross(tangents, first)


def _reflected(vector: Vector, normal: Vector) -> Vector:
    square = float(normal @ normal)
    if square < 1e-24:  # both tangents agree
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
    """Sweep a polygon along a path: a closed body with flat ends, or a ring, with outward normals.

    For a straight path the volume is that of the prism, sides/2 sin(2 pi / sides) radius^2 length; for a closed
    planar path it converges to the area of the polygon times the length of the path (Pappus).

    Args:
        path: points of the centre line [m], shape (n, 3), no two in a row equal
        radius: distance of the corners from the centre line along the first normal [m]; a number or shape (n,)
        sides: corners of the polygon; 4 makes a bar with flat faces
        closed: the path returns to its first point (which is not repeated)
        width: distance of the corners along the second normal [m]; `radius` by default
        up: direction of the first normal, for flat bars; by default without twist
    """
    centre = np.asarray(path, dtype=float)
    first, second = frames(centre, up, closed=closed)
    half_height, half_width = (
        np.broadcast_to(np.asarray(half, dtype=float), len(centre))[:, None, None]
        for half in (radius, radius if width is None else width)
    )
    # (path, corners, 3) by broadcasting.
    phi = (2 * np.pi * (np.arange(sides) + 0.5) / sides)[None, :, None]
    stretch = np.sqrt(2.0) if sides == 4 else 1.0  # half height and width of a bar refer to its flat faces
    return swept(
        centre[:, None, :]
        + stretch * half_height * np.cos(phi) * first[:, None, :]
        + stretch * half_width * np.sin(phi) * second[:, None, :],
        closed=closed,
    )


def swept(rings: Vector, *, closed: bool = False) -> trimesh.Trimesh:
    """Build a body from its sections: with flat ends, or closed to a ring, with outward normals.

    Args:
        rings: corners of each section [m], shape (n, sides, 3)
        closed: join the last section to the first
    """
    n, sides = rings.shape[:2]
    index = np.arange(n * sides).reshape(n, sides)
    low, high = (index, np.roll(index, -1, axis=0)) if closed else (index[:-1], index[1:])
    faces = [quads(low, np.roll(low, -1, axis=1), np.roll(high, -1, axis=1), high)]
    if not closed:
        # Flat ends as fans of triangles from corner 0.
        corner = np.arange(1, sides - 1)
        faces.append(np.column_stack([index[0, 0] + 0 * corner, index[0, corner + 1], index[0, corner]]))
        faces.append(np.column_stack([index[-1, 0] + 0 * corner, index[-1, corner], index[-1, corner + 1]]))
    return outward(trimesh.Trimesh(rings.reshape(-1, 3), np.vstack(faces), process=False))


def quads(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Return two triangles for each quadrangle a b c d, shape (2 n, 3), for vertex indices of a common shape."""
    return np.vstack([np.stack(corners, axis=-1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))])


def rod(start: ArrayLike, end: ArrayLike, radius: float, *, sides: int = 8) -> trimesh.Trimesh:
    """Build a straight round rod between two points [m]."""
    return tube(np.array([start, end], dtype=float), radius, sides=sides)


def axis_rotation(direction: ArrayLike) -> Vector:
    """Return the rotation by the smallest angle that maps z to a direction, shape (3, 3).

    R = 1 + [v] + [v]^2 / (1 + c), v = z x d, c = z . d (Rodrigues)

    Args:
        direction: direction of the new z axis, any length, shape (3,)
    """
    d = np.asarray(direction, dtype=float)
    d = d / np.linalg.norm(d)
    if d[2] < -1 + 1e-12:  # the smallest rotation is not unique: rotate about x
        return np.diag([1.0, -1.0, -1.0])
    v = np.array([-d[1], d[0], 0.0])
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    rotation: Vector = np.eye(3) + cross + cross @ cross / (1 + d[2])
    return rotation


def placed(mesh: trimesh.Trimesh, origin: ArrayLike, direction: ArrayLike = (0.0, 0.0, 1.0)) -> trimesh.Trimesh:
    """Copy a mesh with its z axis rotated to `direction` and its origin moved to `origin` [m]."""
    vertices = np.asarray(mesh.vertices) @ axis_rotation(direction).T + np.asarray(origin, dtype=float)
    return trimesh.Trimesh(vertices, mesh.faces, process=False)


def shifted(points: ArrayLike, dx: float, dy: float, dz: float) -> Vector:
    """Return points moved by (dx, dy, dz) [m], shape (..., 3)."""
    moved: Vector = np.asarray(points, dtype=float) + np.array([dx, dy, dz])
    return moved


def mirrored(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Mirror a mesh at the middle plane y = 0; faces are reversed so that normals stay outward."""
    vertices = np.asarray(mesh.vertices) * (1.0, -1.0, 1.0) + 0.0  # no -0.0: both halves share their middle vertices
    return trimesh.Trimesh(vertices, np.asarray(mesh.faces)[:, ::-1], process=False)


def inverted(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Return a mesh with reversed normals."""
    return trimesh.Trimesh(mesh.vertices, np.asarray(mesh.faces)[:, ::-1], process=False)


def outward(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Return a closed mesh with positive volume; reverse its faces if necessary."""
    return inverted(mesh) if mesh.volume < 0 else mesh


def joined(*meshes: trimesh.Trimesh | Sequence[trimesh.Trimesh]) -> trimesh.Trimesh:
    """Combine meshes to a single mesh without cutting overlapping surfaces."""
    flat: list[trimesh.Trimesh] = []
    for mesh in meshes:
        flat.extend([mesh] if isinstance(mesh, trimesh.Trimesh) else mesh)
    # Faces of each mesh count its vertices from 0: shift by the vertices before.
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in flat[:-1])])
    vertices = np.vstack([mesh.vertices for mesh in flat])
    faces = np.vstack([np.asarray(mesh.faces) + offset for mesh, offset in zip(flat, offsets, strict=True)])
    return trimesh.Trimesh(vertices, faces, process=False)


def both(*meshes: trimesh.Trimesh) -> trimesh.Trimesh:
    """Combine meshes of the right side with their mirror images."""
    return joined([*meshes, *(mirrored(mesh) for mesh in meshes)])
