"""From modes of all nodes of a body to its modal superelement at the places of a car."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.frame_modes import fix_signs
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources import METHODS
from vehicle.model.flexbody.sources.attachment_modes import ReducedModes, attachment_modes
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices, BodyNodes, IntArray
from vehicle.model.flexbody.sources.craig_bampton import craig_bampton
from vehicle.model.flexbody.sources.free_body_modes import FreeModes, free_modes, residual_flexibility
from vehicle.model.flexbody.sources.interfaces import Interface
from vehicle.model.flexbody.superelement import Superelement
from vehicle.signals.analysis.thinned_wireframe import neighbours, thinned


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
        notices: what the user must know of the accuracy, in words.
    """

    body: BodyNodes
    frequencies: FloatArray
    damping_ratio: FloatArray
    vectors: FloatArray
    rigid: MassProperties
    names: tuple[str, ...]
    remarks: tuple[str, ...] = ()
    residual: Mapping[str, FloatArray] = field(default_factory=dict)
    notices: tuple[str, ...] = ()


ATTACHMENTS_TO = 5.0
"""Up to which frequency modes of the attachments are kept, over that of the modes, where none is given [1]: assumed;
FRFs of a car on a frame of solids are then within 2 % up to 0.6 of the latter, 4 % with these modes static."""


HELD_TO = (3.0, 6.0)
"""Highest modes of the held body over the highest one wanted, tried in turn by "craig-bampton" [1]."""
NEAR = 0.01
"""Relative error of the frequencies of modes of the free body at which these are enough [1]: that of a car body's own
modes between two cars of a type is a few percent."""


def modes_of_matrices(
    body: BodyMatrices,
    up_to: float,
    places: list[Interface],
    method: str = METHODS[0],
    attachments_to: float | None = None,
) -> BodyModes:
    """Modes and residual flexibility of K and M.

    Args:
        body: in SI units and the vehicle frame.
        up_to: highest frequency of modes of the free body; "craig-bampton" takes modes of the body held at its places
            to a multiple of it, until the modes to here are within 1 % of those of the free body [Hz].
        places: interfaces, which get their residual flexibility.
        method: one of `METHODS`.
        attachments_to: highest mode that "rubin" adds, or that "craig-bampton" keeps of the reduced pair [Hz].

    Raises:
        DataError: as of `free_modes`.
    """
    found = free_modes(body, up_to)
    moved, count = [place.moved for place in places], len(found.frequencies)
    limit = attachments_to or ATTACHMENTS_TO * up_to
    frequencies, vectors = found.frequencies, found.vectors
    names = [f"mode {number}" for number in range(1, count + 1)]
    notices: tuple[str, ...] = ()
    if method == "rubin":
        added = attachment_modes(body, found, moved, limit)
        frequencies = np.concatenate([frequencies, added.frequencies])
        vectors, residual = np.hstack([vectors, added.vectors]), added.residual
        names += [f"attachment mode {number}" for number in range(1, len(added.frequencies) + 1)]
        kept = f"{count} modes to {up_to:g} Hz, {len(added.frequencies)} of the attachments to {limit:g} Hz (Rubin)"
    elif method == "craig-bampton":
        added, held, held_to, above = _near_enough(body, found, moved, limit)
        frequencies, vectors, residual = added.frequencies, added.vectors, added.residual
        names = [f"mode {number}" for number in range(1, len(frequencies) + 1)]
        kept = (
            f"Craig-Bampton with {held} modes to {held_to:g} Hz of the body held at {len(places)} points, modes of it "
            f"to {limit:g} Hz, those to {up_to:g} Hz up to {above:.2%} above the {count} of the free body"
        )
        notices = (
            f"Craig-Bampton: the modes to {up_to:g} Hz are up to {above:.2%} too high against the {count} of the free "
            f"body, with modes to {held_to:g} Hz of the held body",
        )
    else:
        residual = residual_flexibility(body, found, moved)
        kept = f"modes to {up_to:g} Hz"
    return BodyModes(
        body=body,
        frequencies=frequencies,
        damping_ratio=np.full(len(frequencies), np.nan),
        vectors=vectors,
        rigid=found.rigid,
        notices=notices,
        names=tuple(names),
        remarks=(
            f"{len(body.node)} degrees of freedom, {kept}, modes above as residual flexibility",
            f"the stiffness gives rigid motions {found.rigid_frequency:.2g} Hz; modes orthogonal to them and to each "
            f"other within {found.orthogonality:.1e}",
        ),
        # Where every mode of the attachments is kept nothing is left: the place is rigid, not of infinite stiffness.
        residual={place.name: value for place, value in zip(places, residual, strict=True) if value.any()},
    )


def _near_enough(
    body: BodyMatrices, free: FreeModes, moved: list[Any], limit: float
) -> tuple[ReducedModes, int, float, float]:
    """Craig-Bampton with as many modes of the held body as the first modes of the free one need.

    Args:
        body: K and M.
        free: modes of the free body, against which the reduced ones are measured.
        moved: places, as of `craig_bampton`.
        limit: highest mode of the reduced pair that is kept [Hz].

    Returns:
        The modes; number of modes of the held body and their highest frequency [Hz]; largest relative error of the
        frequencies up to that of the free modes [1].
    """
    for factor in HELD_TO:
        reduced, held = craig_bampton(body, free, moved, limit, factor * free.up_to)
        both = min(len(free.frequencies), len(reduced.frequencies))
        above = float(np.max(reduced.frequencies[:both] / free.frequencies[:both] - 1.0, initial=0.0))
        if above <= NEAR:
            break
    return reduced, held, factor * free.up_to, above


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
    """Nodes and lines of the picture; of a source without lines each node is joined to its neighbours."""
    if not len(body.edges):
        shown = np.unique(np.linspace(0, len(body.nodes) - 1, most).astype(int))
        return shown, neighbours(body.positions[shown])
    lines = thinned(body.positions, body.edges, most)
    shown, index = np.unique(lines, return_inverse=True)
    return shown, index.reshape(-1, 2)
