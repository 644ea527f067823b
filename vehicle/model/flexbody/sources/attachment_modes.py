"""Modes that the attachments of a body add to its free-free modes: residual flexibility with its inertia.

What the modes that are left out give way to a force F at the attachments is psi = P' K^-1 P F, statically. Taken as
shapes of their own, on top of the modes that are kept and orthogonal to them by P, they carry the mass that moves with
them: (psi'K psi - w^2 psi'M psi) q = 0 makes modes of them, mass-normalised, of positive frequency. A force at an
attachment meets the static flexibility exactly and its change with frequency to the order of w^2.

Source: S. Rubin, Improved component-mode representation for structural dynamic analysis, AIAA Journal 13 (1975),
995-1006; R. R. Craig and C.-J. Chang, On the use of attachment modes in substructure coupling, AIAA 77-405 (1977).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices
from vehicle.model.flexbody.sources.free_body_modes import FreeModes, residual_vectors

DEPENDENT = 1e-10
"""Flexibility over the largest, below which a combination of attachments is another one's: two at one node."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ReducedModes:
    """Modes of a reduced body that are kept, and what the others give way to.

    Attributes:
        frequencies: [Hz], ascending, shape (modes,).
        vectors: with modal mass 1 [kg^-1/2], shape (dofs, modes).
        residual: static flexibility of the modes above, at each place [m/N], (3, 3).
    """

    frequencies: FloatArray
    vectors: FloatArray
    residual: list[FloatArray]


def attachment_modes(body: BodyMatrices, modes: FreeModes, places: Sequence[Any], up_to: float) -> ReducedModes:
    """The modes of the residual flexibility.

    Args:
        body: K and M.
        modes: of it, which are kept.
        places: how the degrees of freedom move each place, u = N' x; sparse, shape (dofs, 3).
        up_to: those above stay residual flexibility [Hz].
    """
    load = np.hstack([place.toarray() for place in places])
    psi = residual_vectors(body, modes, load)
    flexibility, turn = scipy.linalg.eigh(psi.T @ (body.stiffness @ psi))
    real = flexibility > DEPENDENT * flexibility[-1]
    psi = psi @ (turn[:, real] / np.sqrt(flexibility[real]))  # psi' K psi = 1
    inverse, mix = scipy.linalg.eigh(psi.T @ (body.mass @ psi))
    return kept_modes(inverse, mix, psi, places, up_to)


def kept_modes(
    inverse: FloatArray, mix: FloatArray, basis: FloatArray, places: Sequence[Any], up_to: float
) -> ReducedModes:
    """Modes of a basis that is orthonormal in K, up to a frequency, the others as residual flexibility.

    Args:
        inverse: 1 / w^2, ascending; zero of a shape without mass [s2].
        mix: eigenvectors of basis' M basis, orthonormal.
        basis: shapes with basis' K basis = 1.
        places: as of `attachment_modes`.
        up_to: highest mode kept [Hz].
    """
    shapes = (basis @ mix)[:, ::-1]
    kept = inverse[::-1] >= 1.0 / (2.0 * np.pi * up_to) ** 2
    root = np.sqrt(inverse[::-1][kept])
    residual = [np.asarray(at @ at.T) for at in (place.T @ shapes[:, ~kept] for place in places)]
    return ReducedModes(frequencies=1.0 / (2.0 * np.pi * root), vectors=shapes[:, kept] / root, residual=residual)
