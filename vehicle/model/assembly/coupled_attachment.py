"""Laws behind an attachment whose residual flexibility couples the axes, as that of every finite-element body does.

A bushing K, B in series with a spring G^-1 has the static stiffness K_s = K (1 + G K)^-1, of which it takes the share
T = (1 + G K)^-1 of the displacement; its damper acts as T' B T, and its Maxwell branch along T' e. Along directions
p_i, which need not be perpendicular, K_s = sum of k_i p_i p_i' and the damping sum of b_i p_i p_i': three rows again.

K_s is exact. The damper is to first order in G w B, the share by which its own force moves the attachment: 0.03 at
50 Hz of a mount with 2000 N s/m on 2e7 N/m, which changes the damping by its square.
"""

from __future__ import annotations

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.laws.maxwell import Maxwell
from vehicle.model.laws.series import in_series
from vehicle.model.parameters.composition import PlacedConnection
from vehicle.model.parameters.force_elements import Bushing, Hydromount
from vehicle.names import AXES

STRUCTURAL_LOSS_TIME = 1e-4
"""Damping over stiffness [s] of the local stiffness behind an ideal joint.

Assumed: a loss factor of 2 % at 30 Hz, usual for welded steel structures.
"""
_COUPLED = 1e-9
"""Off-diagonal flexibility over the largest one below which the axes are those of the carrier."""
_STIFFEST = 1e-11
"""Flexibility below which an attachment counts as this [m/N]: stiffer than any sheet metal, and not without bound."""


def is_coupled(flexibility: FloatArray) -> bool:
    """Whether a flexibility couples the axes, or is zero along one."""
    own = np.diag(flexibility)
    apart = np.abs(flexibility - np.diag(own)).max()
    return bool(apart > _COUPLED * own.max() or own.min() < _STIFFEST)


def coupled_law(
    connection: PlacedConnection, flexibility: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Rows of a connection behind an attachment.

    Args:
        connection: as composed.
        flexibility: G in the axes of the carrier [m/N], shape (3, 3).

    Returns:
        Stiffness [N/m], damping [N s/m], branch stiffness [N/m] and branch time [s] along three directions, shape (3,);
        the directions, a row each, shape (3, 3).

    Raises:
        ConfigurationError: the law is a table over displacement.
    """
    values, vectors = np.linalg.eigh(flexibility)
    attachment = vectors @ np.diag(np.maximum(values, _STIFFEST)) @ vectors.T
    none = np.zeros(3)
    law = connection.law
    if law is None:
        stiffness = 1.0 / np.maximum(values, _STIFFEST)
        return stiffness, STRUCTURAL_LOSS_TIME * stiffness, none, none, vectors.T
    for name in AXES:
        if getattr(law, f"table_{name}", None) is not None:
            raise ConfigurationError(
                f"{connection.path}.table_{name}: found a table behind an attachment whose residual flexibility "
                "couples the axes; leave the table out, use a body model with one stiffness along each axis, or "
                "body.attachment_flexibility = false"
            )
    axes = np.eye(3) if connection.axes is None else np.array(connection.axes)
    own = (axes.T * law.stiffness) @ axes
    share = np.linalg.inv(np.eye(3) + attachment @ own)
    static = own @ share
    static = 0.5 * (static + static.T)
    damping = share.T @ (axes.T * law.damping) @ axes @ share
    branch = _branch(law)
    if branch is None:
        stiffness, drag, directions = _together(static, damping, np.eye(3))
        return stiffness, drag, none, none, directions
    joined = in_series(1.0 / float(axes[2] @ attachment @ axes[2]), branch)
    along = share.T @ axes[2] / np.linalg.norm(share.T @ axes[2])
    own_part = 1.0 / float(along @ np.linalg.solve(static, along))
    rest = static - own_part * np.outer(along, along)
    _, basis = np.linalg.eigh(rest)
    stiffness, drag, directions = _together(rest, damping, basis[:, 1:])
    return (
        np.append(stiffness, own_part),
        np.append(drag, 0.0),
        np.array([0.0, 0.0, float(joined.branch_stiffness)]),
        np.array([0.0, 0.0, float(joined.relaxation_time)]),
        np.vstack([directions, along]),
    )


def _branch(law: Bushing | Hydromount) -> Maxwell | None:
    if not isinstance(law, Hydromount) or law.maxwell_stiffness <= 0.0 or law.maxwell_damping <= 0.0:
        return None
    return Maxwell(
        stiffness=law.stiffness[2], branch_stiffness=law.maxwell_stiffness, branch_damping=law.maxwell_damping
    )


def _together(
    stiffness: FloatArray, damping: FloatArray, basis: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Directions along which two symmetric matrices are diagonal, in the space of a basis (3, k): k, b, P (k, 3)."""
    inner, drag = basis.T @ stiffness @ basis, basis.T @ damping @ basis
    scale = np.trace(inner) / max(float(np.trace(drag)), 1e-12)
    whole = inner + scale * drag
    whole += 1e-12 * np.trace(whole) * np.eye(len(whole))  # where an axis has neither
    shares, vectors = scipy.linalg.eigh(scale * drag, whole)  # V' whole V = 1
    directions = np.linalg.inv(vectors) @ basis.T
    length = np.linalg.norm(directions, axis=1)
    shares = np.clip(shares, 0.0, 1.0)
    return (1.0 - shares) * length**2, shares / scale * length**2, directions / length[:, None]
