"""Free-free modes of a frame with translational mass at its nodes."""

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError

ROUNDING = 4.0 * float(np.finfo(np.float64).eps)
"""Error of the eigenvalues over the largest one [-]."""


def condense_rotations(stiffness: Vector) -> tuple[Vector, Vector]:
    """Eliminate the node rotations; exact, because the rotations have no inertia.

    K = K_tt - K_tr K_rr^-1 K_rt, and the rotations are -K_rr^-1 K_rt u.

    Args:
        stiffness: frame stiffness, shape (6 n, 6 n), six degrees of freedom node by node.

    Returns:
        Stiffness of the translations [N/m], shape (3 n, 3 n); recovery of all degrees of freedom from the
        translations, shape (6 n, 3 n).

    Raises:
        ConfigurationError: a node can rotate freely.
    """
    count = stiffness.shape[0] // 6
    # (nodes, degrees of freedom): translations t and rotations r of all nodes, node by node.
    dofs = np.arange(6 * count).reshape(count, 6)
    t, r = dofs[:, :3].ravel(), dofs[:, 3:].ravel()
    try:
        factor = scipy.linalg.cho_factor(stiffness[np.ix_(r, r)])
    except np.linalg.LinAlgError as error:
        raise ConfigurationError(
            "space frame: a node can rotate freely, because no beam resists its rotation. Connect every node to "
            "a beam that resists bending and torsion."
        ) from error
    recovery = np.zeros((6 * count, 3 * count))
    recovery[t, np.arange(3 * count)] = 1.0
    recovery[r] = -scipy.linalg.cho_solve(factor, stiffness[np.ix_(r, t)])
    condensed = stiffness[np.ix_(t, t)] + stiffness[np.ix_(t, r)] @ recovery[r]
    return 0.5 * (condensed + condensed.T), recovery  # removes the asymmetry of round-off


def rigid_shapes(positions: Vector, center: Vector) -> Vector:
    """Return unit translations and unit rotations about a centre at every node [1 and m], shape (6, n, 3).

    Args:
        positions: node positions [m], shape (n, 3).
        center: centre of the rotations [m], shape (3,).
    """
    shapes = np.zeros((6, len(positions), 3))
    for axis in range(3):
        shapes[axis, :, axis] = 1.0
        shapes[3 + axis] = np.cross(np.eye(3)[axis], positions - center)
    return shapes


def free_free_modes(
    stiffness: Vector, node_mass: Vector, positions: Vector, count: int, added: Vector | None = None
) -> tuple[Vector, Vector]:
    """Compute the lowest elastic modes of the free structure, mass-normalised and orthogonal to the rigid-body modes.

    (K - w^2 M) phi = 0 with phi_i^T M phi_j = delta_ij. The rigid-body modes are shifted above the spectrum, so that
    the elastic modes are orthogonal to them to round-off.

    Args:
        stiffness: translational stiffness [N/m], shape (3 n, 3 n).
        node_mass: lumped masses [kg], all positive, shape (n,).
        positions: node positions [m], shape (n, 3).
        count: number of elastic modes.
        added: mass matrix in addition to the lumped masses [kg], shape (3 n, 3 n).

    Returns:
        Frequencies [Hz], shape (count,); shapes [kg^-1/2], shape (count, n, 3), signs by `signs`.

    Raises:
        DataError: a mode without stiffness beside the rigid-body modes.
    """
    root = np.sqrt(np.repeat(node_mass, 3))
    center = node_mass @ positions / node_mass.sum()
    rigid = rigid_shapes(positions, center).reshape(6, -1)
    if added is None:
        # With M = L L' the modes of L^-1 K L^-T are L' phi: orthonormal, and easy to separate from the rigid motions.
        rigid, dynamic = rigid * root, stiffness / np.outer(root, root)  # mass-weighted
    else:
        lower = np.linalg.cholesky(np.diag(root**2) + added)
        half = scipy.linalg.solve_triangular(lower, stiffness, lower=True)
        rigid, dynamic = rigid @ lower, scipy.linalg.solve_triangular(lower, half.T, lower=True)
    basis, _ = np.linalg.qr(rigid.T)  # (3 n, 6)
    # Projector onto the complement of the rigid motions; these get an eigenvalue far above the elastic modes instead
    # of 0.
    away = np.eye(len(root)) - basis @ basis.T
    shift = 10.0 * float(np.trace(dynamic))
    dynamic = away @ dynamic @ away + shift * (basis @ basis.T)
    values, vectors = scipy.linalg.eigh(dynamic, subset_by_index=(0, count - 1))
    if not values[0] > ROUNDING * shift:
        raise DataError(
            "body frame: a part can move with no or almost no stiffness; check the sections, materials and "
            "masses of the body design"
        )
    # Back to displacements: phi = L^-T y.
    plain = vectors / root[:, None] if added is None else scipy.linalg.solve_triangular(lower.T, vectors)
    shapes = plain.T.reshape(count, -1, 3)
    return np.sqrt(values) / (2.0 * np.pi), signs(shapes)[:, None, None] * shapes


def signs(shapes: Vector) -> Vector:
    """Return 1 or -1 for each mode (modes, n, 3), which makes its largest component positive, so reproducible."""
    flat = shapes.reshape(len(shapes), -1)
    largest = flat[np.arange(len(flat)), np.argmax(np.abs(flat), axis=1)]
    return np.where(largest < 0.0, -1.0, 1.0)
