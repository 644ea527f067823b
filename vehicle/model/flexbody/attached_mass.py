"""Modes of a flexible body with attached point masses, by component-mode assembly."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.frame_modes import signs
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Attached:
    """Flexible body with attached masses, and its new modes as combinations Phi X - R Y of the old modes.

    Attributes:
        body: body with its new modes.
        elastic: X, share of each old elastic mode Phi in each new mode, shape (modes, modes).
        rigid: Y, share of each mass-normalised rigid motion R of the bare body, shape (6, modes).
    """

    body: Superelement
    elastic: Vector
    rigid: Vector


def with_attached_masses(superelement: Superelement, masses: Mapping[str, float]) -> Superelement:
    """Return only the body of `attached`."""
    return attached(superelement, masses).body


def attached(superelement: Superelement, masses: Mapping[str, float]) -> Attached:
    """Fix point masses rigidly to nodes of a body, within the space of its rigid motions R and elastic modes Phi.

    With T = [R | Phi] and T' M T = 1 for the bare body, a mass m at node n adds m T_n' T_n. Rigid coordinates have no
    stiffness, so they are eliminated exactly, r = -M_rr^-1 M_rf q, which leaves
    (diag(w^2) - W^2 (M_ff - M_fr M_rr^-1 M_rf)) q = 0. Damping: the diagonal of the transformed modal damping.
    The mass is fixed to the node without the residual flexibility of that node in series.

    Args:
        superelement: the body.
        masses: node name -> mass to add [kg], not negative.

    Returns:
        Body with new mass properties, frequencies, damping ratios and mode shapes, and the combinations of old modes.
        A new mode is named after the old mode with the largest share in it.

    Raises:
        DataError: the body has no node of this name.
        ConfigurationError: a mass is negative or not finite.

    Source: R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2006, chapter 17, free-interface modes.
    """
    for node, mass in masses.items():
        if not (np.isfinite(mass) and mass >= 0.0):
            raise ConfigurationError(
                f"mass attached to body node {node!r}: found {mass} kg, must be finite and not negative"
            )
    loaded_nodes = np.array([superelement.node_index(node) for node in masses], dtype=int)
    added = np.array(list(masses.values()), dtype=float)
    positions = superelement.positions
    rigid, _ = superelement.rigid.rigid_motions(positions)
    # T_n of each loaded node; the added mass matrix is the sum of m T_n' T_n.
    motions = np.concatenate([rigid[:, loaded_nodes], superelement.shapes[:, loaded_nodes]])  # (6 + modes, masses, 3)
    properties, node_mass = superelement.rigid.with_points(added, positions[loaded_nodes]), superelement.node_mass
    loaded = with_added_mass(superelement, np.einsum("ank,bnk,n->ab", motions, motions, added), properties)
    if node_mass is None:
        return loaded
    node_mass = node_mass.copy()
    np.add.at(node_mass, loaded_nodes, added)
    return replace(loaded, body=replace(loaded.body, node_mass=node_mass, mass_properties=None))


def with_added_mass(superelement: Superelement, added: Vector, properties: MassProperties) -> Attached:
    """Solve for the modes of a body with an additional mass matrix; see `attached` for the equations.

    Args:
        superelement: the body.
        added: mass matrix to add to T' M T = 1 [1], shape (6 + modes, 6 + modes).
        properties: mass, CoG and inertia including the added mass.

    Returns:
        Body with these mass properties instead of node masses, and the combinations of old modes.
    """
    count, positions = len(superelement.frequencies), superelement.positions
    rigid, rigid_rotations = superelement.rigid.rigid_motions(positions)
    total = np.eye(6 + count) + added
    # -r over q: M_rr^-1 M_rf.
    rigid_per_mode = np.linalg.solve(total[:6, :6], total[:6, 6:])  # (6, modes)
    omega = 2.0 * np.pi * superelement.frequencies
    squared, mix = scipy.linalg.eigh(np.diag(omega**2), total[6:, 6:] - total[6:, :6] @ rigid_per_mode)
    rigid_share = mix.T @ rigid_per_mode.T  # share of the rigid motions in each new mode, (modes, 6)
    # New modes: Phi X - R Y.
    shapes = np.tensordot(mix.T, superelement.shapes, 1) - np.tensordot(rigid_share, rigid, 1)
    sign = signs(shapes)[:, None]
    rotations = {
        node: sign * (mix.T @ rotation - rigid_share @ rigid_rotations)
        for node, rotation in superelement.rotations.items()
    }
    new_omega = np.sqrt(squared)
    # Diagonal of X' diag(2 zeta w) X.
    damping = np.einsum("im,i,im->m", mix, 2.0 * superelement.damping_ratio * omega, mix)
    largest_share = np.abs(mix).argmax(axis=0)
    body = replace(
        superelement,
        node_mass=None,
        mass_properties=properties,
        frequencies=new_omega / (2.0 * np.pi),
        damping_ratio=damping / (2.0 * new_omega),
        shapes=sign[..., None] * shapes,
        rotations=rotations,
        mode_names=tuple(superelement.mode_names[i] for i in largest_share),
        derived=True,
    )
    return Attached(body=body, elastic=mix * sign.T, rigid=(sign * rigid_share).T)
