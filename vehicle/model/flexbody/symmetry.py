"""Mirror symmetry about the plane y = 0: opposite nodes, and symmetric or antisymmetric modes."""

import numpy as np

from vehicle.arrays import Indices, Vector

_FACING = 0.10
"""Maximum distance of a node from the mirror image of its counterpart [m]: the two engine mounts differ by 82 mm."""


def mirror_nodes(positions: Vector) -> Indices:
    """Return the counterpart of every node on the other side of the car.

    Args:
        positions: node positions [m], shape (n, 3).

    Returns:
        Index of the node nearest to the mirror image, shape (n,): the node itself if in the plane, -1 without a
        counterpart.
    """
    images = positions * (1.0, -1.0, 1.0)
    distance = np.linalg.norm(images[:, None] - positions[None], axis=2)  # (n, n)
    nearest = distance.argmin(axis=1)
    has_counterpart = distance[np.arange(len(positions)), nearest] <= _FACING
    return np.where(has_counterpart, nearest, -1)


def parity(shapes: Vector, positions: Vector, node_mass: Vector) -> Vector:
    """Return the similarity of mass-normalised shapes to their mirror images.

    Sum of m phi . S phi' over the nodes with a counterpart, S = diag(1, -1, 1), phi' at the counterpart.

    Args:
        shapes: mass-normalised shapes [kg^-1/2], shape (modes, n, 3).
        positions: node positions [m], shape (n, 3).
        node_mass: lumped masses [kg], shape (n,).

    Returns:
        1 for a symmetric mode, -1 for an antisymmetric mode, else in between [1], shape (modes,).
    """
    facing = mirror_nodes(positions)
    paired = np.flatnonzero(facing >= 0)
    images = shapes[:, facing[paired]] * np.array([1.0, -1.0, 1.0])
    return np.asarray(np.einsum("mni,mni,n->m", shapes[:, paired], images, node_mass[paired]))
