"""Where the car is fixed to a finite-element body: a node of it, or the nodes around the place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.carried_nodes import rigid_fit
from vehicle.model.flexbody.sources.body_matrices import BodyNodes
from vehicle.model.parameters.hardpoints import Point

_FLAT = 1e-3
"""Width of the nodes around a place over their length, below which they lie on one line and hold no rotation."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Interface:
    """A place of the car on the body.

    Attributes:
        name: of the point.
        place: of the point [m], shape (3,).
        moved: N of its displacement u = N' x by the degrees of freedom x; sparse, shape (dofs, 3).
        turned: the same of its rotation; None where the model does not know it.
        distance: of the nearest node that was used [m].
        nodes: how many nodes move it.
    """

    name: str
    place: FloatArray
    moved: Any
    turned: Any
    distance: float
    nodes: int


def interfaces(
    body: BodyNodes,
    places: Mapping[str, Point],
    *,
    tolerance: float,
    spread: float = 0.0,
    named: Mapping[str, str] | None = None,
) -> list[Interface]:
    """The interfaces of a body at the points of a car.

    Args:
        body: the body, in the vehicle frame.
        places: points of the car where something acts on the body or is measured, by name [m].
        tolerance: largest distance of the nearest node from its point [m].
        spread: radius of the nodes that carry a point together, as the interpolation element RBE3: they move it with
            the rigid motion that fits them best [m]; 0: the nearest node alone.
        named: node for a point, chosen by the user, at any distance.

    Raises:
        DataError: points without a node within the distance, whose chosen node does not exist, or whose nodes within
            the radius cannot carry them: all of them in one message.
    """
    chosen = dict(named or {})
    for point in chosen:
        if point not in places:
            raise DataError(f"map: no point {point!r} of the car; its points are {', '.join(places)}.")
    found, far, lost, weak = [], [], [], []
    moving = np.unique(body.node[body.direction < 3])  # of a point mass or a reference node there may be rotations only
    for name, place in places.items():
        gap = np.linalg.norm(body.positions[moving] - np.array(place), axis=1)
        if name in chosen:
            if chosen[name] not in body.nodes:
                lost.append(f"no node {chosen[name]!r} for {name}")
                continue
            found.append(_of_node(body, name, place, body.nodes.index(chosen[name])))
            continue
        near = moving[gap <= spread]
        if spread > 0.0 and near.size:
            carried = _of_nodes(body, name, place, near)
            if isinstance(carried, str):
                weak.append(f"{name}: {carried}")
            else:
                found.append(carried)
            continue
        best = int(moving[gap.argmin()])
        if gap.min() > max(tolerance, spread):
            far.append(f"{name}: node {body.nodes[best]}, {1e3 * gap.min():.1f} mm")
        found.append(_of_node(body, name, place, best))
    faults = []
    if lost:
        faults.append(f"map: {'; '.join(lost)}; the body has {len(body.nodes)} nodes")
    if far:
        faults.append(
            f"{len(far)} points of the car have no node within {1e3 * max(tolerance, spread):g} mm; the nearest are "
            f"{'; '.join(far)}"
        )
    if weak:
        faults.append(f"{len(weak)} points are not held by the nodes within {1e3 * spread:g} mm: {'; '.join(weak)}")
    if faults:
        raise DataError(
            f"{'. '.join(faults)}. Choose nodes with --point-nodes, a larger radius with --spread, or a "
            "--point-distance up to 50 mm; check the frame with --axes and --origin, and the unit of length."
        )
    return found


def read_map(path: Path) -> dict[str, str]:
    """Nodes that a user chose for points of the car: a table "point,node".

    Raises:
        DataError: unreadable, a line that is none, or a point given twice.
    """
    try:
        lines = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read ({error}).") from error
    bad = [",".join(words) for words in lines if len(words) != 2]
    if bad:
        raise DataError(f"{path}: {bad[0]!r} is no line point,node.")
    found = [(point.strip(), node.strip()) for point, node in lines if point.strip() != "point"]
    twice = [point for i, (point, _) in enumerate(found) if point in dict(found[:i])]
    if twice:
        raise DataError(f"{path}: point {twice[0]!r} is given twice; give one node for it.")
    return dict(found)


def _of_node(body: BodyNodes, name: str, place: Point, node: int) -> Interface:
    """A place that moves with one node."""
    own = body.node == node
    at = [np.flatnonzero(own & (body.direction == axis)) for axis in range(6)]
    size = len(body.node)

    def columns(axes: range) -> Any:
        rows = [int(at[axis][0]) for axis in axes if at[axis].size]
        columns = [i for i, axis in enumerate(axes) if at[axis].size]
        return scipy.sparse.csc_matrix((np.ones(len(rows)), (rows, columns)), shape=(size, 3))

    return Interface(
        name=name,
        place=np.array(place),
        moved=columns(range(3)),
        turned=columns(range(3, 6)) if all(at[axis].size for axis in range(3, 6)) else None,
        distance=float(np.linalg.norm(body.positions[node] - np.array(place))),
        nodes=1,
    )


def _of_nodes(body: BodyNodes, name: str, place: Point, nodes: Any) -> Interface | str:
    """A place that moves as the nodes around it; what keeps them from carrying it."""
    positions = body.positions[nodes]
    widths = np.linalg.svd(positions - positions.mean(axis=0), compute_uv=False) if len(nodes) > 2 else np.zeros(3)
    if widths[1] <= _FLAT * widths[0] or widths[0] == 0.0:
        return f"{len(nodes)} node{'s on one line' if len(nodes) > 1 else ''}, which hold no rotation"
    fit = rigid_fit(positions, np.ones(len(nodes)), np.array(place))  # (6, k, 3)
    row = {
        (int(node), int(direction)): i
        for i, (node, direction) in enumerate(zip(body.node, body.direction, strict=True))
        if direction < 3
    }
    dofs = np.array([[row.get((int(node), axis), -1) for axis in range(3)] for node in nodes])
    if np.any(dofs < 0):
        return "one of the nodes lacks a displacement"

    def columns(part: FloatArray) -> Any:
        values = part.reshape(3, -1)
        rows = np.broadcast_to(dofs.ravel(), values.shape)
        axes = np.repeat(np.arange(3), values.shape[1])
        return scipy.sparse.csc_matrix((values.ravel(), (rows.ravel(), axes)), shape=(len(body.node), 3))

    gap = np.linalg.norm(positions - np.array(place), axis=1)
    return Interface(
        name=name,
        place=np.array(place),
        moved=columns(fit[:3]),
        turned=columns(fit[3:]),
        distance=float(gap.min()),
        nodes=len(nodes),
    )
