"""Point masses fixed to a flexible body: new modes of the body with them, by component-mode assembly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.frame_modes import fix_signs
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Attached:
    """A body with what is attached to it.

    Attributes:
        body: the body with its new modes.
        elastic: old elastic modes in each new mode X, shape (modes, modes).
        rigid: mass-normalised rigid motions of the body alone in each new mode Y, shape (6, modes): Phi X - R Y.
    """

    body: Superelement
    elastic: FloatArray
    rigid: FloatArray


def with_attached_masses(superelement: Superelement, masses: Mapping[str, float]) -> Superelement:
    """Return the body with point masses; see `attached`, whose body it is."""
    return attached(superelement, masses).body


def attached(superelement: Superelement, masses: Mapping[str, float]) -> Attached:
    """The body with point masses fixed rigidly to its nodes, inside the space of its rigid-body and elastic modes.

    With T = [R | Phi], T' M T = 1 of the body alone, a mass m at node n adds m T_n' T_n. Rigid coordinates have no
    stiffness, so they follow exactly, r = -M_rr^-1 M_rf q, which leaves
    (diag(w^2) - W^2 (M_ff - M_fr M_rr^-1 M_rf)) q = 0. Damping: the diagonal of the transformed modal damping.
    The residual flexibility of an attachment point is not between the mass and the node.

    Args:
        superelement: the body.
        masses: node name -> mass to add [kg], not negative.

    Returns:
        The body with new mass properties, frequencies, damping ratios and mode shapes, and what its modes are made of.
        A new mode keeps the name of the old one that it is mostly made of.

    Raises:
        DataError: no node of this name.
        ConfigurationError: a mass is negative or not finite.

    Source: R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2006, chapter 17, free-interface modes.
    """
    for node, mass in masses.items():
        if not (np.isfinite(mass) and mass >= 0.0):
            raise ConfigurationError(
                f"mass attached to body node {node!r}: {mass} kg; it must be finite and not negative."
            )
    where = np.array([superelement.node_index(node) for node in masses], dtype=int)
    added = np.array(list(masses.values()), dtype=float)
    places = superelement.positions
    rigid, _ = superelement.rigid.rigid_motions(places)
    both = np.concatenate([rigid[:, where], superelement.shapes[:, where]])  # (6 + modes, masses, 3)
    own, node_mass = superelement.rigid.with_points(added, places[where]), superelement.node_mass
    found = with_added_mass(superelement, np.einsum("ank,bnk,n->ab", both, both, added), own)
    if node_mass is None:
        return found
    node_mass = node_mass.copy()
    np.add.at(node_mass, where, added)
    return replace(found, body=replace(found.body, node_mass=node_mass, mass_properties=None))


def with_added_mass(superelement: Superelement, added: FloatArray, properties: MassProperties) -> Attached:
    """Solve for the modes of a body whose mass matrix grows; equations as of `attached`.

    Args:
        superelement: the body.
        added: what is added to T' M T = 1 [1], shape (6 + modes, 6 + modes).
        properties: mass, CoG and inertia with what is added.

    Returns:
        The body with these mass properties, in place of masses of its nodes, and what its modes are made of.
    """
    count, places = len(superelement.frequencies), superelement.positions
    rigid, turns = superelement.rigid.rigid_motions(places)
    total = np.eye(6 + count) + added
    follow = np.linalg.solve(total[:6, :6], total[:6, 6:])  # (6, modes)
    omega = 2.0 * np.pi * superelement.frequencies
    squared, mix = scipy.linalg.eigh(np.diag(omega**2), total[6:, 6:] - total[6:, :6] @ follow)
    rest = mix.T @ follow.T  # the rigid motion in each new mode, (modes, 6)
    shapes = np.tensordot(mix.T, superelement.shapes, 1) - np.tensordot(rest, rigid, 1)
    signed = fix_signs(shapes)
    sign = np.where(np.einsum("ank,ank->a", signed, shapes) < 0.0, -1.0, 1.0)[:, None]
    turned = {node: sign * (mix.T @ own - rest @ turns) for node, own in superelement.rotations.items()}
    new_omega = np.sqrt(squared)
    damping = np.einsum("im,i,im->m", mix, 2.0 * superelement.damping_ratio * omega, mix)
    mostly = np.abs(mix).argmax(axis=0)
    body = replace(
        superelement,
        node_mass=None,
        mass_properties=properties,
        frequencies=new_omega / (2.0 * np.pi),
        damping_ratio=damping / (2.0 * new_omega),
        shapes=signed,
        rotations=turned,
        mode_names=tuple(superelement.mode_names[i] for i in mostly),
        derived=True,
    )
    return Attached(body=body, elastic=mix * sign.T, rigid=(sign * rest).T)
