"""Point masses fixed to a flexible body: new modes of the body with them, by component-mode assembly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.flexbody.modes import fix_signs, rigid_shapes
from vehicle.flexbody.superelement import Superelement


def with_attached_masses(superelement: Superelement, masses: Mapping[str, float]) -> Superelement:
    """The body with point masses fixed rigidly to its nodes, inside the space of its rigid-body and elastic modes.

    With T = [R | Phi] and the new diagonal mass M, the reduced mass is T^T M T and the reduced stiffness diag(0, w^2).
    Rigid coordinates have no stiffness, so they follow exactly, r = -M_rr^-1 M_rf q, which leaves
    (diag(w^2) - W^2 (M_ff - M_fr M_rr^-1 M_rf)) q = 0. Damping: the diagonal of the transformed modal damping.
    The local stiffness of an attachment point is not between the mass and the node.

    Args:
        superelement: the body.
        masses: node name -> mass to add [kg], not negative.

    Returns:
        A superelement with the new node masses, frequencies, damping ratios and mode shapes. A new mode keeps the name
        of the old one that it is mostly made of.

    Raises:
        DataError: no node of this name.
        ConfigurationError: a mass is negative or not finite.

    Source: R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2006, chapter 17, free-interface modes.
    """
    node_mass = superelement.node_mass.copy()
    for node, mass in masses.items():
        if not (np.isfinite(mass) and mass >= 0.0):
            raise ConfigurationError(
                f"mass attached to body node {node!r}: {mass} kg; it must be finite and not negative."
            )
        node_mass[superelement.node_index(node)] += mass
    count = len(superelement.frequencies)
    cog = node_mass @ superelement.positions / node_mass.sum()
    rigid = rigid_shapes(superelement.positions, cog).reshape(6, -1)
    flexible = superelement.shapes.reshape(count, -1)
    weight = np.repeat(node_mass, 3)
    follow = np.linalg.solve((rigid * weight) @ rigid.T, (rigid * weight) @ flexible.T)  # (6, modes)
    free = flexible - follow.T @ rigid  # orthogonal to the new rigid-body modes, (modes, 3 n)
    omega = 2.0 * np.pi * superelement.frequencies
    squared, mix = scipy.linalg.eigh(np.diag(omega**2), (free * weight) @ free.T)
    shapes = fix_signs((mix.T @ free).reshape(count, -1, 3))
    new_omega = np.sqrt(squared)
    damping = np.einsum("im,i,im->m", mix, 2.0 * superelement.damping_ratio * omega, mix)
    mostly = np.abs(mix).argmax(axis=0)
    return replace(
        superelement,
        node_mass=node_mass,
        frequencies=new_omega / (2.0 * np.pi),
        damping_ratio=damping / (2.0 * new_omega),
        shapes=shapes,
        mode_names=tuple(superelement.mode_names[i] for i in mostly),
    )
