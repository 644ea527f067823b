"""Interfaces of a car with a finite-element body: a node at an attachment point, or the nodes around the point."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.carried_nodes import rigid_fit
from vehicle.model.flexbody.sources.body_matrices import BodyNodes
from vehicle.model.flexbody.sources.text_matrices import text_of
from vehicle.model.parameters.hardpoints import Point

_FLAT = 1e-3
"""Width over length of a group of nodes [1] below which the nodes are collinear and define no rotation."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Interface:
    """Attachment or output point of the car on the body.

    Attributes:
        name: name of the point.
        position: position of the point [m], shape (3,).
        moved: N of the displacement u = N' x for degrees of freedom x; sparse, shape (dofs, 3).
        turned: N of the rotation, sparse, shape (dofs, 3); None if the model has no rotation there.
        distance: distance of the nearest node used [m].
        nodes: number of nodes that carry the point.
    """

    name: str
    position: Vector
    moved: Any
    turned: Any
    distance: float
    nodes: int


def interfaces(
    body: BodyNodes,
    points: Mapping[str, Point],
    *,
    tolerance: float,
    spread: float = 0.0,
    named: Mapping[str, str] | None = None,
) -> list[Interface]:
    """Return the interfaces of a body at the points of a car.

    Args:
        body: nodes and degrees of freedom in the vehicle frame.
        points: attachment and output points of the car [m], by name.
        tolerance: maximum distance of the nearest node from its point [m].
        spread: radius around a point [m]; the nodes within carry the point by the rigid motion with the best fit, as
            the interpolation element RBE3. With 0, the nearest node carries the point.
        named: point name -> name of the node chosen by the user, at any distance.

    Raises:
        DataError: a point has no node within the distance, its chosen node does not exist, or its nodes within the
            radius cannot carry it; one message lists all faults.
    """
    chosen = dict(named or {})
    for point in chosen:
        if point not in points:
            raise DataError(f"map: the car has no point {point!r}; its points are {', '.join(points)}.")
    results, far, missing_nodes, weak = [], [], [], []
    moving = np.unique(body.node[body.direction < 3])  # a point mass or reference node may have rotations only
    for name, position in points.items():
        gap = np.linalg.norm(body.positions[moving] - np.array(position), axis=1)
        if name in chosen:
            if chosen[name] not in body.nodes:
                missing_nodes.append(f"node {chosen[name]!r}, chosen for {name}, does not exist in the body")
                continue
            results.append(_of_node(body, name, position, body.nodes.index(chosen[name])))
            continue
        near = moving[gap <= spread]
        if spread > 0.0 and near.size:
            carried = _of_nodes(body, name, position, near)
            if isinstance(carried, str):
                weak.append(f"{name}: {carried}")
            else:
                results.append(carried)
            continue
        best = int(moving[gap.argmin()])
        if gap.min() > max(tolerance, spread):
            far.append(f"{name}: node {body.nodes[best]}, {1e3 * gap.min():.1f} mm")
        results.append(_of_node(body, name, position, best))
    faults = []
    if missing_nodes:
        faults.append(f"map: {'; '.join(missing_nodes)}; the body has {len(body.nodes)} nodes")
    if far:
        faults.append(
            f"{len(far)} points of the car have no node of the body within {1e3 * max(tolerance, spread):g} mm; "
            f"nearest nodes: {'; '.join(far)}"
        )
    if weak:
        faults.append(
            f"{len(weak)} points cannot be carried by the nodes within {1e3 * spread:g} mm: {'; '.join(weak)}"
        )
    if faults:
        raise DataError(
            f"{'. '.join(faults)}. Choose nodes with --point-nodes, a larger radius with --spread, or a "
            "--point-distance up to 50 mm; check the frame with --axes and --origin, and the unit of length."
        )
    return results


def read_map(path: Path) -> dict[str, str]:
    """Read the nodes chosen by a user for points of the car, a table "point,node": node by point.

    Raises:
        DataError: the file is unreadable, a line is invalid, or a point occurs twice.
    """
    lines = [line.split(",") for line in text_of(path, encoding="utf-8").splitlines() if line.strip()]
    bad = [",".join(fields) for fields in lines if len(fields) != 2]
    if bad:
        raise DataError(f"{path}: {bad[0]!r} is not a line point,node.")
    pairs = [(point.strip(), node.strip()) for point, node in lines if point.strip() != "point"]
    duplicates = [point for i, (point, _) in enumerate(pairs) if point in dict(pairs[:i])]
    if duplicates:
        raise DataError(f"{path}: point {duplicates[0]!r} occurs twice; specify one node for it.")
    return dict(pairs)


def _of_node(body: BodyNodes, name: str, position: Point, node: int) -> Interface:
    """Return the interface of a point that moves with a node."""
    of_node = body.node == node
    at = [np.flatnonzero(of_node & (body.direction == axis)) for axis in range(6)]
    size = len(body.node)

    def columns(axes: range) -> Any:
        rows = [int(at[axis][0]) for axis in axes if at[axis].size]
        columns = [i for i, axis in enumerate(axes) if at[axis].size]
        return scipy.sparse.csc_matrix((np.ones(len(rows)), (rows, columns)), shape=(size, 3))

    return Interface(
        name=name,
        position=np.array(position),
        moved=columns(range(3)),
        turned=columns(range(3, 6)) if all(at[axis].size for axis in range(3, 6)) else None,
        distance=float(np.linalg.norm(body.positions[node] - np.array(position))),
        nodes=1,
    )


def _of_nodes(body: BodyNodes, name: str, position: Point, nodes: Any) -> Interface | str:
    """Return the interface of a point carried by the surrounding nodes, or the reason why they cannot carry it."""
    positions = body.positions[nodes]
    # Extents of the nodes along their principal axes: a second extent of zero is a line.
    widths = np.linalg.svd(positions - positions.mean(axis=0), compute_uv=False) if len(nodes) > 2 else np.zeros(3)
    if widths[1] <= _FLAT * widths[0] or widths[0] == 0.0:
        return f"{len(nodes)} node{'s on one line' if len(nodes) > 1 else ''}, too few to define a rotation"
    fit = rigid_fit(positions, np.ones(len(nodes)), np.array(position))  # (6, k, 3)
    row = {
        (int(node), int(direction)): i
        for i, (node, direction) in enumerate(zip(body.node, body.direction, strict=True))
        if direction < 3
    }
    dofs = np.array([[row.get((int(node), axis), -1) for axis in range(3)] for node in nodes])
    if np.any(dofs < 0):
        return "a node lacks a displacement"

    def columns(part: Vector) -> Any:
        values = part.reshape(3, -1)
        # (3, 3 k): row i has the weights of all displacements in component i; as entries (degree of freedom, i) of N.
        rows = np.broadcast_to(dofs.ravel(), values.shape)
        axes = np.repeat(np.arange(3), values.shape[1])
        return scipy.sparse.csc_matrix((values.ravel(), (rows.ravel(), axes)), shape=(len(body.node), 3))

    gap = np.linalg.norm(positions - np.array(position), axis=1)
    return Interface(
        name=name,
        position=np.array(position),
        moved=columns(fit[:3]),
        turned=columns(fit[3:]),
        distance=float(gap.min()),
        nodes=len(nodes),
    )
