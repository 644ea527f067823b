"""Modal superelement at the points of a car, from the modes of a body at all nodes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.digits import number
from vehicle.model.flexbody.frame_modes import signs
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources import METHODS
from vehicle.model.flexbody.sources.attachment_modes import ReducedModes, attachment_modes
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices, BodyNodes
from vehicle.model.flexbody.sources.craig_bampton import craig_bampton
from vehicle.model.flexbody.sources.free_body_modes import FreeModes, free_modes, residual_flexibility
from vehicle.model.flexbody.sources.interfaces import Interface
from vehicle.model.flexbody.superelement import Superelement
from vehicle.signals.analysis.thinned_wireframe import neighbours, thinned


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyModes:
    """Elastic modes of a free body with modal mass 1, at all its nodes.

    Attributes:
        body: nodes, with the node and direction of each row of the vectors.
        frequencies: natural frequencies [Hz], shape (modes,).
        damping_ratio: modal damping ratios [1], shape (modes,); NaN where unknown.
        vectors: mass-normalised shapes [kg^-1/2], shape (dofs, modes).
        rigid: mass properties.
        names: names of the modes.
        remarks: scaling, omissions and missing checks, as text.
        residual: interface name -> residual flexibility [m/N], shape (3, 3); empty for a source without K and M.
        notices: statements on the accuracy for the user, as text.
    """

    body: BodyNodes
    frequencies: Vector
    damping_ratio: Vector
    vectors: Vector
    rigid: MassProperties
    names: tuple[str, ...]
    remarks: tuple[str, ...] = ()
    residual: Mapping[str, Vector] = field(default_factory=dict)
    notices: tuple[str, ...] = ()


ATTACHMENTS_TO = 5.0
"""Default frequency limit of the attachment modes over that of the free-free modes [1], assumed. FRFs of a car on a
frame of solids are then within 2 % up to 0.6 of the latter limit; with static attachment modes, within 4 %."""


HELD_TO = (3.0, 6.0)
"""Highest fixed-interface mode over the highest mode of the free body [1], tried in this order by "craig-bampton"."""
NEAR = 0.01
"""Maximum relative error of the Craig-Bampton frequencies [1]: mode frequencies of two car bodies of the same type
differ by a few percent."""


def modes_of_matrices(
    body: BodyMatrices,
    up_to: float,
    attachments: list[Interface],
    method: str = METHODS[0],
    attachments_to: float | None = None,
) -> BodyModes:
    """Compute modes and residual flexibility of a body from K and M by a reduction method.

    Args:
        body: K and M in SI units and the vehicle frame.
        up_to: frequency limit of the free-free modes [Hz]. "craig-bampton" uses fixed-interface modes up to a multiple
            of the limit, chosen so that the modes below the limit are within 1 % of the free-free modes.
        attachments: interfaces, for which the residual flexibility is computed.
        method: one of `METHODS`.
        attachments_to: highest attachment mode of "rubin", or highest mode of the reduced body of "craig-bampton" [Hz].

    Raises:
        DataError: see `free_modes`.
    """
    free = free_modes(body, up_to)
    displacements, count = [attachment.moved for attachment in attachments], len(free.frequencies)
    limit = attachments_to or ATTACHMENTS_TO * up_to
    frequencies, vectors = free.frequencies, free.vectors
    names = [f"mode {number}" for number in range(1, count + 1)]
    notices: tuple[str, ...] = ()
    if method == "rubin":
        added = attachment_modes(body, free, displacements, limit)
        frequencies = np.concatenate([frequencies, added.frequencies])
        vectors, residual = np.hstack([vectors, added.vectors]), added.residual
        names += [f"attachment mode {number}" for number in range(1, len(added.frequencies) + 1)]
        summary = (
            f"{count} modes up to {up_to:g} Hz and {len(added.frequencies)} attachment modes up to {limit:g} Hz (Rubin)"
        )
    elif method == "craig-bampton":
        added, held, held_to, above = _near_enough(body, free, displacements, limit)
        frequencies, vectors, residual = added.frequencies, added.vectors, added.residual
        names = [f"mode {number}" for number in range(1, len(frequencies) + 1)]
        summary = (
            f"Craig-Bampton: {held} modes up to {held_to:g} Hz of the body fixed at {len(attachments)} points, "
            f"kept up to {limit:g} Hz; up to {up_to:g} Hz they are at most {above:.2%} above the {count} "
            "free-free modes"
        )
        notices = (
            f"Craig-Bampton: with modes of the fixed body up to {held_to:g} Hz, the modes up to {up_to:g} Hz are "
            f"up to {above:.2%} higher than the {count} free-free modes",
        )
    else:
        residual = residual_flexibility(body, free, displacements)
        summary = f"modes to {up_to:g} Hz"
    return BodyModes(
        body=body,
        frequencies=frequencies,
        damping_ratio=np.full(len(frequencies), np.nan),
        vectors=vectors,
        rigid=free.rigid,
        notices=notices,
        names=tuple(names),
        remarks=(
            f"{len(body.node)} degrees of freedom, {summary}; higher modes act statically (residual flexibility)",
            f"check: rigid motions have at most {number(free.rigid_frequency, 2)} Hz (0 is exact); modes are "
            f"orthogonal to them and to each other within {free.orthogonality:.1e}",
        ),
        # With all attachment modes in the model the residual is zero: omit it, the attachment is rigid.
        residual={
            attachment.name: value for attachment, value in zip(attachments, residual, strict=True) if value.any()
        },
    )


def _near_enough(
    body: BodyMatrices, free: FreeModes, moved: list[Any], limit: float
) -> tuple[ReducedModes, int, float, float]:
    """Reduce a body by Craig-Bampton with enough fixed-interface modes for the accuracy `NEAR`; see `craig_bampton`.

    Returns:
        Modes of the reduced body; number of fixed-interface modes; their frequency limit [Hz]; largest relative error
        of the frequencies below the limit of the free-free modes [1].
    """
    for factor in HELD_TO:
        reduced, held = craig_bampton(body, free, moved, limit, factor * free.up_to)
        both = min(len(free.frequencies), len(reduced.frequencies))
        above = float(np.max(reduced.frequencies[:both] / free.frequencies[:both] - 1.0, initial=0.0))
        if above <= NEAR:
            break
    return reduced, held, factor * free.up_to, above


def superelement_of(
    modes: BodyModes, attachments: list[Interface], *, name: str, damping: float, picture: int = 400
) -> Superelement:
    """Build the superelement at the interfaces of a car, with additional nodes for the wireframe picture.

    Args:
        modes: modes of the body at all nodes.
        attachments: interfaces of the car.
        name: name of the body.
        damping: modal damping ratio [1] of modes without one in the source.
        picture: maximum number of evenly distributed nodes for the picture.
    """
    body, vectors = modes.body, modes.vectors
    shown, edges = _picture(body, picture)
    attachment_shapes = np.array([attachment.moved.T @ vectors for attachment in attachments]).reshape(
        len(attachments), 3, vectors.shape[1]
    )
    shapes = np.concatenate([attachment_shapes.transpose(2, 0, 1), body.displacements(vectors)[:, shown]], axis=1)
    sign = signs(shapes)[:, None]
    has_damping = np.isfinite(modes.damping_ratio)
    damping_remark = (
        []
        if has_damping.all()
        else [f"damping ratio {damping:g} is set for {'all' if not has_damping.any() else (~has_damping).sum()} modes"]
    )
    return Superelement(
        name=name,
        nodes=(*(attachment.name for attachment in attachments), *(f"node_{body.nodes[i]}" for i in shown)),
        positions=np.vstack([*(attachment.position for attachment in attachments), body.positions[shown]]),
        edges=edges + len(attachments),
        mass_properties=modes.rigid,
        frequencies=modes.frequencies,
        damping_ratio=np.where(has_damping, modes.damping_ratio, damping),
        shapes=sign[..., None] * shapes,
        rotations={
            attachment.name: sign * (attachment.turned.T @ vectors).T
            for attachment in attachments
            if attachment.turned is not None
        },
        residual=modes.residual,
        mode_names=modes.names,
        provenance="; ".join([body.source, *modes.remarks, *damping_remark]),
    )


def _picture(body: BodyNodes, maximum: int) -> tuple[Indices, Indices]:
    """Select nodes and lines of the picture; without lines in the source, each node is joined to its neighbours."""
    if not len(body.edges):
        shown = np.unique(np.linspace(0, len(body.nodes) - 1, maximum).astype(int))
        return shown, neighbours(body.positions[shown])
    lines = thinned(body.positions, body.edges, maximum)
    shown, index = np.unique(lines, return_inverse=True)
    return shown, index.reshape(-1, 2)
