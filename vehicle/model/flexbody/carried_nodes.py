"""Massless nodes added to a body at attachment points, carried by the surrounding nodes."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.hardpoints import Point

CARRIERS = 6
"""Number of nodes that carry an added node (assumed): enough never to lie on one line, few enough to be close to it."""


def with_carried_nodes(body: Superelement, points: Mapping[str, Point]) -> Superelement:
    """Add a massless node to a body at each point without a node; masses and modes of the body do not change.

    The added node follows the rigid motion t + theta x (r - c) with the best weighted fit to its carrier nodes, weights
    1 / distance^2: a bracket that spreads its force over the surrounding structure (like RBE3 of Nastran).

    Args:
        body: body model.
        points: points of the car in the vehicle frame [m], by name.

    Returns:
        Body with a node at each point; the same object if no node was added.
    """
    for name, position in points.items():
        point = np.array(position)
        if np.linalg.norm(body.positions - point, axis=1).min() <= body.hardpoint_tolerance:
            continue
        carriers, follow = carried_by(body.positions, point)
        shape, turn = (np.einsum("ckj,mkj->mc", part, body.shapes[:, carriers]) for part in (follow[:3], follow[3:]))
        count, added = len(body.nodes), name if name not in body.nodes else f"{name}_attached"
        body = replace(
            body,
            nodes=(*body.nodes, added),
            positions=np.vstack([body.positions, point]),
            edges=np.vstack([body.edges, [(count, carrier) for carrier in carriers[:3]]]),
            node_mass=None if body.node_mass is None else np.append(body.node_mass, 0.0),
            shapes=np.concatenate([body.shapes, shape[:, None]], axis=1),
            rotations={**body.rotations, added: turn} if body.rotations else {},
        )
    return body


def carried_by(positions: Vector, point: Vector) -> tuple[Indices, Vector]:
    """Select the nodes that carry a point; the point's displacement and rotation are sum over k of N[:, k] u_k.

    Args:
        positions: positions of all nodes [m], shape (n, 3).
        point: position that coincides with no node [m], shape (3,).

    Returns:
        Indices of the carrier nodes, shape (k,); N, shape (6, k, 3).
    """
    gap = np.linalg.norm(positions - point, axis=1)
    nearest = np.argsort(gap, kind="stable")[:CARRIERS]
    return nearest, rigid_fit(positions[nearest], 1.0 / gap[nearest] ** 2, point)


def rigid_fit(positions: Vector, weight: Vector, point: Vector) -> Vector:
    """Return the motion of a point in the rigid motion t + theta x (r - c) with the weighted best fit to nodes.

    Args:
        positions: node positions [m], shape (k, 3).
        weight: weight of each node [1], shape (k,).
        point: position of the point [m], shape (3,).

    Returns:
        N with displacement and rotation of the point = sum over k of N[:, k] u_k for node displacements u_k;
        shape (6, k, 3).
    """
    center = weight @ positions / weight.sum()
    rows = np.concatenate([_motion(position - center) for position in positions])  # (3 k, 6)
    scale = np.repeat(weight, 3)[:, None]
    # Weighted least squares (t, theta) = (A' W A)^-1 A' W u; pinv for carriers on a line, about which no rotation
    # follows.
    fitted = np.linalg.pinv(rows.T @ (scale * rows)) @ (scale * rows).T  # (6, 3 k)
    moved = _motion(point - center) @ fitted
    return np.asarray(np.vstack([moved, fitted[3:]]).reshape(6, len(positions), 3))


def _motion(arm: Vector) -> Vector:
    """Return the matrix of t + theta x arm, acting on (t, theta), shape (3, 6)."""
    x, y, z = arm
    return np.array([[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]])
