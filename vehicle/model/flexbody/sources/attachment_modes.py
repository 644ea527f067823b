"""Attachment modes, added to the free-free modes of a body: residual flexibility including its inertia (Rubin).

The static deflection of the truncated modes under a force F at the attachments is psi = P' K^-1 P F. As additional
shapes, orthogonal to the free-free modes by the projection P, these deflections include the inertia of the moving mass:
(psi'K psi - w^2 psi'M psi) q = 0 yields mass-normalised modes of positive frequency. The flexibility at an attachment
is then statically exact, and its change with frequency correct to the order of w^2.

Source: S. Rubin, Improved component-mode representation for structural dynamic analysis, AIAA Journal 13 (1975),
995-1006; R. R. Craig and C.-J. Chang, On the use of attachment modes in substructure coupling, AIAA 77-405 (1977).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices
from vehicle.model.flexbody.sources.free_body_modes import FreeModes, residual_vectors

DEPENDENT = 1e-10
"""Flexibility over the largest [1] below which attachments are linearly dependent, such as two at one node."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ReducedModes:
    """Modes of a reduced body up to a frequency, and the static flexibility of the modes above.

    Attributes:
        frequencies: natural frequencies [Hz], ascending, shape (modes,).
        vectors: shapes with modal mass 1 [kg^-1/2], shape (dofs, modes).
        residual: static flexibility of the modes above at each attachment [m/N], shape (3, 3).
    """

    frequencies: Vector
    vectors: Vector
    residual: list[Vector]


def attachment_modes(body: BodyMatrices, modes: FreeModes, attachments: Sequence[Any], up_to: float) -> ReducedModes:
    """Compute the attachment modes of a body from its residual flexibility.

    Args:
        body: K and M.
        modes: free-free modes of the body, which the attachment modes complement.
        attachments: N of each attachment, with displacement u = N' x for degrees of freedom x; sparse, shape (dofs, 3).
        up_to: highest attachment mode [Hz]; the modes above stay residual flexibility.
    """
    load = np.hstack([attachment.toarray() for attachment in attachments])
    psi = residual_vectors(body, modes, load)
    # psi' K psi = F' P' K^-1 P F: flexibility; nearly zero for combinations that are linearly dependent.
    flexibility, combinations = scipy.linalg.eigh(psi.T @ (body.stiffness @ psi))
    independent = flexibility > DEPENDENT * flexibility[-1]
    psi = psi @ (combinations[:, independent] / np.sqrt(flexibility[independent]))  # psi' K psi = 1
    inverse, mix = scipy.linalg.eigh(psi.T @ (body.mass @ psi))
    return kept_modes(inverse, mix, psi, attachments, up_to)


def kept_modes(inverse: Vector, mix: Vector, basis: Vector, attachments: Sequence[Any], up_to: float) -> ReducedModes:
    """Split the modes of a stiffness-orthonormal basis into modes up to a frequency and residual flexibility.

    Args:
        inverse: 1 / w^2, ascending; zero for a shape without mass [s2].
        mix: eigenvectors of basis' M basis, orthonormal.
        basis: shapes with basis' K basis = 1.
        attachments: see `attachment_modes`.
        up_to: frequency limit [Hz].
    """
    # Ascending frequency.
    shapes = (basis @ mix)[:, ::-1]
    kept = inverse[::-1] >= 1.0 / (2.0 * np.pi * up_to) ** 2
    root = np.sqrt(inverse[::-1][kept])
    higher = (attachment.T @ shapes[:, ~kept] for attachment in attachments)
    # Static flexibility of a mode with psi' K psi = 1 is psi psi'.
    residual = [np.asarray(local @ local.T) for local in higher]
    return ReducedModes(frequencies=1.0 / (2.0 * np.pi * root), vectors=shapes[:, kept] / root, residual=residual)
