"""Nodes where something new is fixed to a body: carried by the nodes around them, without a mass of their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.hardpoints import Point

CARRIERS = 6
"""Nodes that carry a new one: assumed; enough that they never lie on one line, few enough to be its surroundings."""


def with_carried_nodes(body: Superelement, places: Mapping[str, Point]) -> Superelement:
    """The body with a node at each point where it has none; masses and modes stay what they are.

    The node moves as the rigid motion t + theta x (r - c) that fits its carriers best, weighted by 1 / distance^2: a
    bracket that spreads its force over the structure around it (as the interpolation element RBE3 of Nastran).

    Args:
        body: the body model.
        places: points of the car in the vehicle frame [m], by name.

    Returns:
        The body; itself where it has all nodes.
    """
    for name, place in places.items():
        point = np.array(place)
        if np.linalg.norm(body.positions - point, axis=1).min() <= body.hardpoint_tolerance:
            continue
        carriers, follow = carried_by(body.positions, point)
        shape, turn = (np.einsum("ckj,mkj->mc", part, body.shapes[:, carriers]) for part in (follow[:3], follow[3:]))
        count, new = len(body.nodes), name if name not in body.nodes else f"{name}_attached"
        body = replace(
            body,
            nodes=(*body.nodes, new),
            positions=np.vstack([body.positions, point]),
            edges=np.vstack([body.edges, [(count, carrier) for carrier in carriers[:3]]]),
            node_mass=None if body.node_mass is None else np.append(body.node_mass, 0.0),
            shapes=np.concatenate([body.shapes, shape[:, None]], axis=1),
            rotations={**body.rotations, new: turn} if body.rotations else {},
        )
    return body


def carried_by(positions: FloatArray, point: FloatArray) -> tuple[NDArray[np.intp], FloatArray]:
    """Nodes that carry a point, and its displacement and rotation by theirs: sum over k of N[:, k] u_k.

    Args:
        positions: of all nodes [m], shape (n, 3).
        point: away from all of them [m], shape (3,).

    Returns:
        Indices of the carriers, shape (k,); N, shape (6, k, 3).
    """
    gap = np.linalg.norm(positions - point, axis=1)
    nearest = np.argsort(gap, kind="stable")[:CARRIERS]
    return nearest, rigid_fit(positions[nearest], 1.0 / gap[nearest] ** 2, point)


def rigid_fit(positions: FloatArray, weight: FloatArray, point: FloatArray) -> FloatArray:
    """Motion of a point with the rigid motion t + theta x (r - c) that fits nodes best.

    Args:
        positions: of the nodes [m], shape (k, 3).
        weight: of each [1], shape (k,).
        point: [m], shape (3,).

    Returns:
        N, displacement and rotation of the point by the displacements of the nodes, sum over k of N[:, k] u_k;
        shape (6, k, 3).
    """
    center = weight @ positions / weight.sum()
    rows = np.concatenate([_motion(place - center) for place in positions])  # (3 k, 6)
    scale = np.repeat(weight, 3)[:, None]
    fitted = np.linalg.pinv(rows.T @ (scale * rows)) @ (scale * rows).T  # (6, 3 k)
    moved = _motion(point - center) @ fitted
    return np.asarray(np.vstack([moved, fitted[3:]]).reshape(6, len(positions), 3))


def _motion(arm: FloatArray) -> FloatArray:
    """t + theta x arm as a matrix on (t, theta), (3, 6)."""
    x, y, z = arm
    return np.array([[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]])
