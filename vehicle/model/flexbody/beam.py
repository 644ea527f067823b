"""Stiffness of straight three-dimensional Euler-Bernoulli beams and of a space frame assembled from them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError

_PARALLEL = 1e-6  # sine of the angle below which a reference direction counts as parallel to the beam


@dataclass(frozen=True, kw_only=True, slots=True)
class BeamSection:
    """Stiffness of a beam cross-section; `local_axes` defines the local y and z axes."""

    axial: float
    """E A, axial stiffness [N]"""
    torsion: float
    """G J, torsional stiffness [N m2]"""
    bending_y: float
    """E Iy, bending about the local y axis, so deflection along local z [N m2]"""
    bending_z: float
    """E Iz, bending about the local z axis, so deflection along local y [N m2]"""

    def __post_init__(self) -> None:
        for name in ("axial", "torsion", "bending_y", "bending_z"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0.0):
                raise ConfigurationError(
                    f"beam section: {name} is {value} but must be finite and at least 0. Correct the section."
                )


def local_stiffness(length: float, section: BeamSection) -> Vector:
    """Return the stiffness of a beam in its local axes [N/m, N, N m], (12, 12): (ux, uy, uz, rx, ry, rz) of both nodes.

    Axial E A / L, torsion G J / L, and in each bending plane the cubic-interpolation terms 12, 6 L, 4 L^2, 2 L^2
    times E I / L^3.

    Args:
        length: distance between the end nodes [m].
        section: cross-section stiffnesses.

    Source: J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, eq. (5.116) without shear deformation.
    """
    k = np.zeros((12, 12))
    for start, stiffness in ((0, section.axial), (3, section.torsion)):
        k[start, start] = k[start + 6, start + 6] = stiffness / length
        k[start, start + 6] = k[start + 6, start] = -stiffness / length
    planes = (  # deflection, rotation of both nodes; the sign couples the rotation to the slope of the deflection
        ([1, 5, 7, 11], section.bending_z, 1.0),  # rz = +d uy / dx
        ([2, 4, 8, 10], section.bending_y, -1.0),  # ry = -d uz / dx
    )
    for dofs, stiffness, sign in planes:
        s, q = sign * 6.0 * length, length**2
        bending = [[12.0, s, -12.0, s], [s, 4.0 * q, -s, 2.0 * q], [-12.0, -s, 12.0, -s], [s, 2.0 * q, -s, 4.0 * q]]
        # An index of (4, 1) and (4,) addresses the 4 x 4 block of these degrees of freedom.
        k[np.array(dofs)[:, None], dofs] = stiffness / length**3 * np.array(bending)
    return k


def local_axes(start: ArrayLike, end: ArrayLike) -> Vector:
    """Return the local axes of a beam: x along it, z the global z, or x for a vertical beam, made perpendicular to x.

    Args:
        start: position of the first node [m], shape (3,).
        end: position of the second node [m], shape (3,).

    Returns:
        Rotation with the local axes as rows, shape (3, 3): local = rotation @ global.

    Raises:
        ConfigurationError: both ends are at the same position.
    """
    along = np.asarray(end, dtype=float) - np.asarray(start, dtype=float)
    length = float(np.linalg.norm(along))
    if not length > 0.0:
        raise ConfigurationError(
            f"beam: both ends are at {np.asarray(start).tolist()} m; they must be different points."
        )
    x = along / length
    # y, the global z cross x, is horizontal, so z, x cross y, is in the vertical plane through the beam.
    y = _cross(np.array([0.0, 0.0, 1.0]), x)
    if np.linalg.norm(y) < _PARALLEL:
        y = _cross(np.array([1.0, 0.0, 0.0]), x)
    y /= np.linalg.norm(y)
    return np.stack([x, y, _cross(x, y)])  # (3, 3)


def _cross(first: Vector, second: Vector) -> Vector:
    """Return the vector product; takes a tenth of the time of `np.cross`, for the hundreds of beams of a body."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


def beam_stiffness(start: ArrayLike, end: ArrayLike, section: BeamSection) -> Vector:
    """Return the stiffness of a beam in global axes [N/m, N, N m], (12, 12): T^T k T with T = diag(R, R, R, R).

    Args:
        start: position of the first node [m], shape (3,).
        end: position of the second node [m], shape (3,).
        section: cross-section stiffnesses.
    """
    rotation = np.zeros((12, 12))
    axes = local_axes(start, end)
    for block in range(0, 12, 3):
        rotation[block : block + 3, block : block + 3] = axes
    length = float(np.linalg.norm(np.asarray(end, dtype=float) - np.asarray(start, dtype=float)))
    return np.asarray(rotation.T @ local_stiffness(length, section) @ rotation)


def frame_stiffness(positions: Vector, beams: list[tuple[int, int, BeamSection]]) -> Vector:
    """Assemble the stiffness matrix of a space frame [N/m, N, N m], (6 n, 6 n): (ux, uy, uz, rx, ry, rz) node by node.

    Args:
        positions: node positions [m], shape (n, 3).
        beams: first node, second node and section of each beam.
    """
    stiffness = np.zeros((6 * len(positions), 6 * len(positions)))
    for first, second, section in beams:
        dofs = np.concatenate([np.arange(6 * first, 6 * first + 6), np.arange(6 * second, 6 * second + 6)])
        stiffness[dofs[:, None], dofs] += beam_stiffness(positions[first], positions[second], section)
    return stiffness
