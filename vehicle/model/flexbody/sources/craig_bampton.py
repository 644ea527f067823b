"""Modes of a free body by way of its modes held at the attachments: the reduction of Craig and Bampton.

x = Psi u + Phi q: constraint modes Psi, the static shapes of a unit displacement u of one attachment while the others
are held, and the modes Phi of the body held at all of them. The pair K, M reduced to them is brought to diagonal form,
so that a superelement holds what it always holds: rigid motions, modes with modal mass 1, residual flexibility.

Source: R. R. Craig and M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal 6 (1968),
1313-1319.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy

from vehicle.model.flexbody.beam import FloatArray
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
    body: BodyMatrices, free: FreeModes, places: Sequence[Any], up_to: float, held_to: float
) -> tuple[ReducedModes, int]:
    """Modes of the reduced body.

    Args:
        body: K and M.
        free: its rigid motions and the solver of (K + s M) x = b.
        places: how the degrees of freedom move each attachment, u = N' x; sparse, shape (dofs, 3).
        up_to: highest mode of the reduced pair that is kept [Hz]; those above are residual flexibility.
        held_to: highest mode of the held body that is taken [Hz].

    Returns:
        Modes of the reduced pair; number of modes of the held body in it.
    """
    constraint = np.hstack([place.toarray() for place in places])
    answer = free.factor.solve(constraint)
    size, turn = scipy.linalg.eigh(constraint.T @ answer)
    real = size > DEPENDENT * size[-1]
    turn = turn[:, real] / np.sqrt(size[real])
    constraint, answer = constraint @ turn, answer @ turn  # N'(K + s M)^-1 N = 1

    def held(load: FloatArray) -> FloatArray:
        """(K + s M) x = load - N lambda with N' x = 0."""
        found = free.factor.solve(load)
        return np.asarray(found - answer @ (constraint.T @ found))

    static = answer.copy()  # N' x = 1, to be made a solution of K x = N lambda
    last = np.inf
    for _ in range(REFINEMENTS):
        change = -held(body.stiffness @ static)
        size_of_change = float(np.abs(change).max())
        # Passes gain a factor of 100 until the digits of K, whose rigid motions are not quite free of force, stop them.
        if size_of_change > 0.5 * last:
            break
        static, last = static + change, size_of_change
        if last <= 1e-12 * np.abs(static).max():
            break
    limit = (2.0 * np.pi * held_to) ** 2
    shift = (2.0 * np.pi * SHIFT * free.up_to) ** 2
    if len(body.node) <= DENSE:
        space = scipy.linalg.null_space(constraint.T)
        moved = body.stiffness + shift * body.mass
        inverse, mix = scipy.linalg.eigh(space.T @ (body.mass @ space), space.T @ (moved @ space))
        fixed = space @ mix[:, inverse >= 1.0 / (limit + shift)]
    else:
        # A held body has no more modes below a limit than the free one (Cauchy's interlacing).
        count = modes_below(body, limit) + 1
        values, vectors = lowest_modes(body, shift, limit, held, count)
        fixed = vectors[:, values <= limit]
    basis = np.hstack([static, fixed])
    rigid = free.rigid_vectors
    basis = basis - rigid @ (rigid.T @ (body.mass @ basis))  # the rigid motions are combinations of constraint modes
    stiffness, mix = scipy.linalg.eigh(basis.T @ (body.stiffness @ basis))
    basis = basis @ (mix[:, 6:] / np.sqrt(stiffness[6:]))
    inverse, mix = scipy.linalg.eigh(basis.T @ (body.mass @ basis))
    return kept_modes(inverse, mix, basis, places, up_to), fixed.shape[1]
