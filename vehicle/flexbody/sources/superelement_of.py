"""From modes of all nodes of a body to its modal superelement at the places of a car."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import scipy

from vehicle.flexbody.beam import FloatArray
from vehicle.flexbody.mass_properties import MassProperties
from vehicle.flexbody.modes import fix_signs
from vehicle.flexbody.sources.interfaces import Interface
from vehicle.flexbody.sources.matrices import BodyMatrices, BodyNodes, IntArray
from vehicle.flexbody.sources.reduction import free_modes, residual_flexibility
from vehicle.flexbody.superelement import Superelement


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyModes:
    """Elastic modes of a free body with modal mass 1, at all its nodes.

    Attributes:
        body: nodes, and what each row of the vectors is.
        frequencies: [Hz], shape (modes,).
        damping_ratio: [1], shape (modes,); NaN where the source tells none.
        vectors: [kg^-1/2], shape (dofs, modes).
        rigid: mass properties.
        names: of the modes.
        remarks: what was scaled, left out or could not be checked, in words.
        residual: flexibility of each interface [m/N], (3, 3), by name; none where the source has no K and M.
    """

    body: BodyNodes
    frequencies: FloatArray
    damping_ratio: FloatArray
    vectors: FloatArray
    rigid: MassProperties
    names: tuple[str, ...]
    remarks: tuple[str, ...] = ()
    residual: Mapping[str, FloatArray] = field(default_factory=dict)


def modes_of_matrices(body: BodyMatrices, up_to: float, places: list[Interface]) -> BodyModes:
    """Modes and residual flexibility of K and M.

    Args:
        body: in SI units and the vehicle frame.
        up_to: highest frequency [Hz].
        places: interfaces, which get their residual flexibility.

    Raises:
        DataError: as of `free_modes`.
    """
    found = free_modes(body, up_to)
    residual = residual_flexibility(body, found, [place.moved for place in places])
    count = len(found.frequencies)
    return BodyModes(
        body=body,
        frequencies=found.frequencies,
        damping_ratio=np.full(count, np.nan),
        vectors=found.vectors,
        rigid=found.rigid,
        names=tuple(f"mode {number}" for number in range(1, count + 1)),
        remarks=(
            f"{len(body.node)} degrees of freedom, modes to {up_to:g} Hz, modes above as residual flexibility",
            f"the stiffness gives rigid motions {found.rigid_frequency:.2g} Hz; modes orthogonal to them and to each "
            f"other within {found.orthogonality:.1e}",
        ),
        residual={place.name: value for place, value in zip(places, residual, strict=True)},
    )


def superelement_of(
    modes: BodyModes, places: list[Interface], *, name: str, damping: float, picture: int = 400
) -> Superelement:
    """The superelement at the interfaces of a car, with some of the other nodes for the picture.

    Args:
        modes: of the body.
        places: interfaces.
        name: of the body.
        damping: modal damping ratio [1] where the source tells none.
        picture: how many nodes at most, spread evenly, are kept for the picture.
    """
    body, vectors = modes.body, modes.vectors
    shown, edges = _picture(body, picture)
    at = np.array([place.moved.T @ vectors for place in places]).reshape(len(places), 3, vectors.shape[1])
    shapes = np.concatenate([at.transpose(2, 0, 1), body.displacements(vectors)[:, shown]], axis=1)
    signed = fix_signs(shapes)
    sign = np.where(np.einsum("ank,ank->a", signed, shapes) < 0.0, -1.0, 1.0)
    own = np.isfinite(modes.damping_ratio)
    told = [] if own.all() else [f"damping ratio {damping:g} of {'all' if not own.any() else (~own).sum()} modes given"]
    return Superelement(
        name=name,
        nodes=(*(place.name for place in places), *(f"node_{body.nodes[i]}" for i in shown)),
        positions=np.vstack([*(place.place for place in places), body.positions[shown]]),
        edges=edges + len(places),
        mass_properties=modes.rigid,
        frequencies=modes.frequencies,
        damping_ratio=np.where(own, modes.damping_ratio, damping),
        shapes=signed,
        rotations={
            place.name: sign[:, None] * (place.turned.T @ vectors).T for place in places if place.turned is not None
        },
        residual=modes.residual,
        mode_names=modes.names,
        provenance="; ".join([body.source, *modes.remarks, *told]),
    )


def _picture(body: BodyNodes, most: int) -> tuple[IntArray, IntArray]:
    """Nodes spread evenly over the body, farthest first, and lines along the edges of its elements between them."""
    count = len(body.nodes)
    if count <= most:
        return np.arange(count), body.edges
    chosen = [0]
    gap = np.linalg.norm(body.positions - body.positions[0], axis=1)
    for _ in range(most - 1):
        chosen.append(int(gap.argmax()))
        gap = np.minimum(gap, np.linalg.norm(body.positions - body.positions[chosen[-1]], axis=1))
    shown: IntArray = np.sort(chosen)
    if not len(body.edges):
        return shown, np.zeros((0, 2), dtype=int)
    # Each node belongs to the nearest one shown, along the elements; an edge between two regions is a line.
    length = np.linalg.norm(body.positions[body.edges[:, 0]] - body.positions[body.edges[:, 1]], axis=1)
    graph = scipy.sparse.coo_matrix((length, (body.edges[:, 0], body.edges[:, 1])), shape=(count, count))
    _, _, owner = scipy.sparse.csgraph.dijkstra(
        graph, directed=False, indices=shown, min_only=True, return_predecessors=True
    )
    index = {int(node): i for i, node in enumerate(shown)}
    pairs = {tuple(sorted((index.get(int(a), -1), index.get(int(b), -1)))) for a, b in owner[body.edges]}
    lines = sorted(pair for pair in pairs if pair[0] >= 0 and pair[0] != pair[1])
    return shown, np.array(lines, dtype=int).reshape(-1, 2)
