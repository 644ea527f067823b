"""Craig-Bampton reduction: modes of a free body from constraint modes and fixed-interface modes.

x = Psi u + Phi q: constraint modes Psi, the static shapes of a unit displacement u of an attachment with all other
attachments fixed, and the modes Phi of the body with all attachments fixed. The reduced K and M are then diagonalised,
which gives the usual content of a superelement: rigid motions, modes with modal mass 1, residual flexibility.

Source: R. R. Craig and M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal 6 (1968),
1313-1319.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.model.flexbody.sources.attachment_modes import DEPENDENT, ReducedModes, kept_modes
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices
from vehicle.model.flexbody.sources.free_body_modes import (
    DENSE,
    REFINEMENTS,
    SHIFT,
    FreeModes,
    lowest_modes,
    modes_below,
)


def craig_bampton(
    body: BodyMatrices, free: FreeModes, attachments: Sequence[Any], up_to: float, held_to: float
) -> tuple[ReducedModes, int]:
    """Return the modes of the free body by Craig-Bampton reduction, and the number of fixed-interface modes used.

    Args:
        body: K and M.
        free: free modes with the rigid motions and the solver of (K + s M) x = b.
        attachments: N of each attachment, with displacement u = N' x for degrees of freedom x; sparse, shape (dofs, 3).
        up_to: highest mode of the reduced K and M [Hz]; modes above become residual flexibility.
        held_to: highest fixed-interface mode in the basis [Hz].
    """
    constraint = np.hstack([attachment.toarray() for attachment in attachments])
    displacement = free.factor.solve(constraint)
    # Independent combinations of the attachments: two attachments at a node would make the constraints singular.
    size, combinations = scipy.linalg.eigh(constraint.T @ displacement)
    independent = size > DEPENDENT * size[-1]
    combinations = combinations[:, independent] / np.sqrt(size[independent])
    constraint, displacement = constraint @ combinations, displacement @ combinations  # N'(K + s M)^-1 N = 1

    def solve_fixed(load: Vector) -> Vector:
        """Solve (K + s M) x = load - N lambda with N' x = 0."""
        unconstrained = free.factor.solve(load)
        return np.asarray(unconstrained - displacement @ (constraint.T @ unconstrained))

    static = displacement.copy()  # satisfies N' x = 1; refined below to a solution of K x = N lambda
    last_change = np.inf
    for _ in range(REFINEMENTS):
        change = -solve_fixed(body.stiffness @ static)
        size_of_change = float(np.abs(change).max())
        # Each pass gains a factor of 100, until limited by the rounded entries of K, which resist rigid motions.
        if size_of_change > 0.5 * last_change:
            break
        static, last_change = static + change, size_of_change
        if last_change <= 1e-12 * np.abs(static).max():
            break
    limit = (2.0 * np.pi * held_to) ** 2
    shift = (2.0 * np.pi * SHIFT * free.up_to) ** 2
    if len(body.node) <= DENSE:
        space = scipy.linalg.null_space(constraint.T)
        shifted = body.stiffness + shift * body.mass
        inverse, mix = scipy.linalg.eigh(space.T @ (body.mass @ space), space.T @ (shifted @ space))
        # M x = (K + s M) x/(w^2 + s): eigenvalues above 1/(limit + s) are modes below the limit.
        fixed = space @ mix[:, inverse >= 1.0 / (limit + shift)]
    else:
        # A constrained body has at most as many modes below a limit as the free body (Cauchy's interlacing).
        count = modes_below(body, limit) + 1
        values, vectors = lowest_modes(body, shift, limit, solve_fixed, count)
        fixed = vectors[:, values <= limit]
    basis = np.hstack([static, fixed])
    rigid = free.rigid_vectors
    basis = basis - rigid @ (rigid.T @ (body.mass @ basis))  # rigid motions are combinations of constraint modes
    stiffness, mix = scipy.linalg.eigh(basis.T @ (body.stiffness @ basis))
    # The six rigid combinations have no stiffness; the others are scaled to basis' K basis = 1.
    basis = basis @ (mix[:, 6:] / np.sqrt(stiffness[6:]))
    inverse, mix = scipy.linalg.eigh(basis.T @ (body.mass @ basis))
    return kept_modes(inverse, mix, basis, attachments, up_to), fixed.shape[1]
