"""Laws in series with an attachment whose residual flexibility couples the axes, as in finite-element bodies.

A bushing K, B in series with a spring G^-1 has the static stiffness K_s = K (1 + G K)^-1. Its share of the displacement
is T = (1 + G K)^-1; its damper acts as T' B T, and its Maxwell branch along T' e. Along directions p_i, which need not
be perpendicular, K_s = sum of k_i p_i p_i' and the damping sum of b_i p_i p_i': three rows again.

K_s is exact. The damper is to first order in G w B, the share by which its own force moves the attachment: 0.03 at
50 Hz of a mount with 2000 N s/m on 2e7 N/m, which changes the damping by its square.
"""

from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.laws.elastomer import Maxwell, in_series
from vehicle.model.parameters.composition import PlacedConnection
from vehicle.model.parameters.force_elements import Hydromount
from vehicle.names import AXES

STRUCTURAL_LOSS_TIME = 1e-4
"""Damping over stiffness [s] of the local stiffness in series with an ideal joint.

Assumed: a loss factor of 2 % at 30 Hz, usual for welded steel structures.
"""
_COUPLED = 1e-9
"""Maximum ratio of off-diagonal to diagonal flexibility at which the axes are those of the carrier."""
_STIFFEST = 1e-11
"""Minimum flexibility of an attachment [m/N]: stiffer than any sheet metal, but finite."""


def is_coupled(flexibility: Vector) -> bool:
    """Return True if a flexibility couples the axes, or is zero along an axis."""
    diagonal = np.diag(flexibility)
    coupling = np.abs(flexibility - np.diag(diagonal)).max()
    return bool(coupling > _COUPLED * diagonal.max() or diagonal.min() < _STIFFEST)


def coupled_law(connection: PlacedConnection, flexibility: Vector) -> dict[str, Any]:
    """Return the rows of a connection in series with an attachment.

    Args:
        connection: connection of the composition.
        flexibility: G in the axes of the carrier [m/N], shape (3, 3).

    Returns:
        Fields of `ElementLaw` along three directions, shape (3,), and these directions as rows, shape (3, 3).

    Raises:
        ConfigurationError: the law has a table over displacement, rubber friction, or an inertia track.
    """
    values, vectors = np.linalg.eigh(flexibility)
    attachment = vectors @ np.diag(np.maximum(values, _STIFFEST)) @ vectors.T
    law = connection.law
    if law is None:
        # An ideal joint leaves the attachment alone, along its principal axes.
        stiffness = 1.0 / np.maximum(values, _STIFFEST)
        return {"stiffness": stiffness, "damping": STRUCTURAL_LOSS_TIME * stiffness, "directions": vectors.T}
    nonlinear = {f"table_{name}": "a table" for name in AXES if getattr(law, f"table_{name}", None) is not None}
    if any(friction := getattr(law, "friction_force", ())):
        nonlinear["friction_force"] = f"{list(friction)} N"
    if isinstance(law, Hydromount) and law.chamber_stiffness:
        nonlinear["chamber_stiffness"] = "an inertia track"
    if nonlinear:
        key, shown = next(iter(nonlinear.items()))
        raise ConfigurationError(
            f"{connection.path}.{key}: found {shown}, but the body is flexible at this point and its flexibility "
            f"couples the axes, which excludes {key}; remove {key}, use a body model with a separate stiffness "
            "for each axis, or set body.attachment_flexibility = false"
        )
    axes = np.eye(3) if connection.axes is None else np.array(connection.axes)
    # K = A' diag(k) A with the axes of the bushing as rows of A.
    bushing_stiffness = (axes.T * law.stiffness) @ axes
    share = np.linalg.inv(np.eye(3) + attachment @ bushing_stiffness)
    static = bushing_stiffness @ share
    # Symmetric except for round-off.
    static = 0.5 * (static + static.T)
    damping = share.T @ (axes.T * law.damping) @ axes @ share
    if not isinstance(law, Hydromount) or law.maxwell is None:
        stiffness, drag, directions = _diagonalised(static, damping, np.eye(3))
        return {"stiffness": stiffness, "damping": drag, "directions": directions}
    branch = Maxwell(stiffness=law.stiffness[2], branch_stiffness=law.maxwell[0], branch_damping=law.maxwell[1])
    # The hydromount in series with the attachment along its z axis.
    joined = in_series(1.0 / float(axes[2] @ attachment @ axes[2]), branch)
    along = share.T @ axes[2] / np.linalg.norm(share.T @ axes[2])
    # Largest share k of along along' that leaves static - k along along' without a negative stiffness: the remainder
    # has rank two, and two further rows carry it.
    own_part = 1.0 / float(along @ np.linalg.solve(static, along))
    remainder = static - own_part * np.outer(along, along)
    _, basis = np.linalg.eigh(remainder)
    stiffness, drag, directions = _diagonalised(remainder, damping, basis[:, 1:])
    return {
        "stiffness": np.append(stiffness, own_part),
        "damping": np.append(drag, 0.0),
        "branch_stiffness": np.array([0.0, 0.0, float(joined.branch_stiffness)]),
        "branch_time": np.array([0.0, 0.0, float(joined.relaxation_time)]),
        "directions": np.vstack([directions, along]),
    }


def _diagonalised(stiffness: Vector, damping: Vector, basis: Vector) -> tuple[Vector, Vector, Vector]:
    """Return k, b and directions (k, 3) that diagonalise two symmetric matrices in the space of a basis (3, k)."""
    inner, drag = basis.T @ stiffness @ basis, basis.T @ damping @ basis
    scale = np.trace(inner) / max(float(np.trace(drag)), 1e-12)
    # Simultaneous diagonalisation of stiffness and damping: generalised eigenvectors of (B, K + B).
    whole = inner + scale * drag
    whole += 1e-12 * np.trace(whole) * np.eye(len(whole))  # for an axis without stiffness and damping
    shares, vectors = scipy.linalg.eigh(scale * drag, whole)  # V' whole V = 1
    # whole = V^-T V^-1: the rows of V^-1 are the directions p_i, scaled to unit length below.
    directions = np.linalg.inv(vectors) @ basis.T
    length = np.linalg.norm(directions, axis=1)
    shares = np.clip(shares, 0.0, 1.0)
    return (1.0 - shares) * length**2, shares / scale * length**2, directions / length[:, None]
