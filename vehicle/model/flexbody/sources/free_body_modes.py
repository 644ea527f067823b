"""Free-free modes and residual flexibility of a finite-element body: what a modal superelement holds of K and M."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices

SHIFT = 1.0 / 40.0
"""By which K is shifted, so that a free body can be factorised, over the highest frequency wanted [1]: below the
elastic modes, and near enough to them that the six rigid ones do not take their digits."""
FIRST_GUESS, _MORE = 30, 2
"""Modes that Lanczos is asked for at first, and the factor by which more are while all of them lie below the limit."""
DENSE = 300
"""Degrees of freedom up to which all modes are computed: faster there, and with hardly any mass too few for Lanczos."""
REFINEMENTS = 60
"""Passes of iterative refinement at most; round-off ends it much earlier."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FreeModes:
    """Elastic modes of a free body, and the six rigid ones, all with modal mass 1.

    Attributes:
        rigid: mass properties.
        frequencies: of the elastic modes [Hz], shape (modes,).
        vectors: their shapes [kg^-1/2], shape (dofs, modes).
        rigid_vectors: rigid motions with R' M R = 1, shape (dofs, 6).
        rigid_frequency: what the stiffness gives to them [Hz]; zero but for the digits of the source.
        orthogonality: largest |R' M Phi| and |Phi' M Phi - 1| [1].
        up_to: highest frequency that was asked for [Hz].
        factor: solver of (K + s M) x = b, s = (2 pi SHIFT up_to)^2.
    """

    rigid: MassProperties
    frequencies: FloatArray
    vectors: FloatArray
    rigid_vectors: FloatArray
    rigid_frequency: float
    orthogonality: float
    up_to: float
    factor: Any


def free_modes(body: BodyMatrices, up_to: float) -> FreeModes:
    """(K - w^2 M) phi = 0 up to a frequency, by shift-invert Lanczos about -(2 pi SHIFT up_to)^2.

    Args:
        body: K and M.
        up_to: highest frequency wanted [Hz].

    Raises:
        DataError: the body is held, cannot be factorised, has no elastic mode below, or modes were missed (counted by
            the signs of the pivots of K - w^2 M, Sylvester's law of inertia).

    Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994), on shift-invert Lanczos of structures.
    """
    rigid = body.mass_properties()
    unit = body.rigid_motions(rigid.cog)
    motions = np.asarray(np.linalg.solve(np.linalg.cholesky(unit.T @ (body.mass @ unit)), unit.T).T, dtype=float)
    shift = (2.0 * np.pi * SHIFT * up_to) ** 2
    factor = _factorised(body.stiffness + shift * body.mass)
    limit = (2.0 * np.pi * up_to) ** 2
    if len(body.node) <= DENSE:
        values, vectors = _all(body, shift)
    else:
        values, vectors = lowest_modes(body, shift, limit, factor.solve)
    elastic, flexible = values[6:], vectors[:, 6:]
    if not elastic.size or elastic[0] > limit:
        first = float(np.sqrt(elastic[0])) / (2.0 * np.pi) if elastic.size else np.inf
        raise DataError(
            f"no elastic mode up to {up_to:g} Hz; the first is at {first:.4g} Hz. Check the units of the matrices, or "
            "ask for modes to a higher frequency."
        )
    held = body.rigid_frequency(rigid)
    body.require_free(held, float(np.sqrt(elastic[0])) / (2.0 * np.pi))
    kept = elastic <= limit
    missed = modes_below(body, limit) - 6 - int(kept.sum())
    if missed > 0:
        raise DataError(f"{missed} modes up to {up_to:g} Hz were not found; ask for another frequency.")
    shapes: FloatArray = flexible[:, kept]
    shapes = shapes - motions @ (motions.T @ (body.mass @ shapes))  # of the digits of K and M
    shapes = shapes / np.sqrt(np.einsum("ij,ij->j", shapes, body.mass @ shapes))
    own = np.abs(shapes.T @ (body.mass @ shapes) - np.eye(shapes.shape[1])).max(initial=0.0)
    across = np.abs(motions.T @ (body.mass @ shapes)).max(initial=0.0)
    return FreeModes(
        rigid=rigid,
        frequencies=np.sqrt(elastic[kept]) / (2.0 * np.pi),
        vectors=shapes,
        rigid_vectors=motions,
        rigid_frequency=held,
        orthogonality=float(max(own, across)),
        up_to=up_to,
        factor=factor,
    )


def residual_flexibility(body: BodyMatrices, modes: FreeModes, places: Sequence[Any]) -> list[FloatArray]:
    """What the modes that are left out give way to a force at a place: G = P' K^-1 P, P taking out what is kept.

    The load f - M R R'f - M Phi Phi'f reaches neither the rigid motions (inertia relief) nor the kept modes; K u = f is
    solved by u += (K + s M)^-1 (f - K u), which gains a factor of s / w^2 of the first mode left out in each pass.

    Args:
        body: K and M.
        modes: of it.
        places: how the degrees of freedom move each place, u = N' x; sparse, shape (dofs, 3).

    Returns:
        Symmetric flexibilities [m/N], shape (3, 3); a direction that no degree of freedom moves is zero.

    Source: R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2006, section 17.6.
    """
    found = []
    for place in places:
        flexibility = np.asarray(place.T @ residual_vectors(body, modes, place.toarray()))
        found.append(0.5 * (flexibility + flexibility.T))
    return found


def residual_vectors(body: BodyMatrices, modes: FreeModes, load: FloatArray) -> FloatArray:
    """P' K^-1 P f of each column f of a load [N], as of `residual_flexibility`; shape of the load."""
    kept = np.hstack([modes.rigid_vectors, modes.vectors])
    load = load - body.mass @ (kept @ (kept.T @ load))
    answer = np.zeros_like(load)
    for _ in range(REFINEMENTS):
        change = modes.factor.solve(load - body.stiffness @ answer)
        change -= kept @ (kept.T @ (body.mass @ change))
        answer += change
        if np.abs(change).max() <= 1e-12 * np.abs(answer).max():
            break
    return answer


def _all(body: BodyMatrices, shift: float) -> tuple[FloatArray, FloatArray]:
    """All modes, by M phi = (K + s M) phi / (w^2 + s), which massless degrees of freedom do not disturb."""
    moved = (body.stiffness + shift * body.mass).toarray()
    inverse, vectors = scipy.linalg.eigh(body.mass.toarray(), moved)
    real = inverse > 1e-12 * inverse[-1]
    values = 1.0 / inverse[real][::-1] - shift
    return values, vectors[:, real][:, ::-1] / np.sqrt(inverse[real][::-1])


def lowest_modes(
    body: BodyMatrices,
    shift: float,
    limit: float,
    solve: Callable[[FloatArray], FloatArray],
    count: int = FIRST_GUESS,
) -> tuple[FloatArray, FloatArray]:
    """The lowest modes, at least one of them above a limit.

    Args:
        body: K and M.
        shift: s [rad2/s2].
        limit: largest eigenvalue wanted [rad2/s2].
        solve: of (K + s M) x = b, in the space where modes are looked for.
        count: how many are computed at first, doubled while all lie below the limit.

    Returns:
        Eigenvalues, ascending; vectors.
    """
    size = len(body.node)
    operator = scipy.sparse.linalg.LinearOperator((size, size), solve)
    start = solve(body.mass @ np.random.default_rng(1).standard_normal(size))  # the same bytes each time
    while True:
        values, vectors = scipy.sparse.linalg.eigsh(
            body.stiffness, min(count, size - 1), body.mass, sigma=-shift, which="LM", OPinv=operator, v0=start
        )
        if values.max() > limit or _MORE * count >= size:
            order = np.argsort(values)
            return values[order], vectors[:, order]
        count *= _MORE


def _factorised(matrix: Any) -> Any:
    try:
        return scipy.sparse.linalg.splu(
            matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError as error:
        raise DataError(
            f"stiffness and mass: K + s M is singular ({error}): some motion has neither stiffness nor mass, as the "
            "rotation of a point mass without rotational inertia on a node of solid elements. Leave the degree of "
            "freedom out, or give it inertia."
        ) from error


def modes_below(body: BodyMatrices, limit: float) -> int:
    """Return the number of eigenvalues below a limit: negative pivots of K - limit M (Sylvester's law of inertia).

    Args:
        body: K and M of the free body.
        limit: largest eigenvalue counted [rad2/s2].
    """
    factor = _factorised(body.stiffness - limit * (1.0 + 1e-9) * body.mass)
    return int(np.sum(factor.U.diagonal() < 0.0))
