"""Free-free modes and residual flexibility of a finite-element body, computed from K and M."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.sources.body_matrices import BodyMatrices

SHIFT = 1.0 / 40.0
"""Frequency of the shift s of K, needed to factorise a free body, over the highest frequency of interest [1]: below the
elastic modes, and near enough to them that the six rigid-body modes do not reduce their accuracy."""
FIRST_GUESS, _MORE = 30, 2
"""Initial number of Lanczos modes, and factor of increase while all modes are below the limit."""
DENSE = 300
"""Maximum number of degrees of freedom for a dense solution: faster there, and Lanczos fails with very few masses."""
REFINEMENTS = 60
"""Maximum number of iterative refinement passes; round-off ends the refinement much earlier."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FreeModes:
    """Elastic modes and rigid motions of a free body, all with modal mass 1.

    Attributes:
        rigid: mass properties.
        frequencies: frequencies of the elastic modes [Hz], shape (modes,).
        vectors: shapes Phi of the elastic modes [kg^-1/2], shape (dofs, modes).
        rigid_vectors: rigid motions R with R' M R = 1, shape (dofs, 6).
        rigid_frequency: highest frequency of a rigid motion [Hz], due to the rounded entries of K; ideally zero.
        orthogonality: maximum of |R' M Phi| and |Phi' M Phi - 1| [1].
        up_to: frequency limit of the elastic modes [Hz].
        factor: solver of (K + s M) x = b, s = (2 pi SHIFT up_to)^2.
    """

    rigid: MassProperties
    frequencies: Vector
    vectors: Vector
    rigid_vectors: Vector
    rigid_frequency: float
    orthogonality: float
    up_to: float
    factor: Any


def free_modes(body: BodyMatrices, up_to: float) -> FreeModes:
    """Solve (K - w^2 M) phi = 0 up to a frequency by shift-invert Lanczos about -(2 pi SHIFT up_to)^2.

    Args:
        body: K and M.
        up_to: frequency limit of the elastic modes [Hz].

    Raises:
        DataError: the body is supported, K + s M singular, no elastic mode below the limit, or Lanczos missed modes
            (counted by the signs of the pivots of K - w^2 M, Sylvester's law of inertia).

    Source: Grimes, Lewis and Simon, SIAM J. Matrix Anal. Appl. 15 (1994), on shift-invert Lanczos of structures.
    """
    rigid = body.mass_properties()
    unit = body.rigid_motions(rigid.cog)
    # R = unit L^-T with unit' M unit = L L', so that R' M R = 1.
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
            f"no elastic mode up to {up_to:g} Hz; the first is at {first:.4g} Hz. Check the units of the "
            "matrices, or raise --up-to."
        )
    rigid_frequency = body.rigid_frequency(rigid)
    body.require_free(rigid_frequency, float(np.sqrt(elastic[0])) / (2.0 * np.pi), body.rounding_frequency(rigid))
    kept = elastic <= limit
    missed = modes_below(body, limit) - 6 - int(kept.sum())
    if missed > 0:
        raise DataError(f"{missed} modes up to {up_to:g} Hz were not found; change --up-to slightly.")
    shapes: Vector = flexible[:, kept]
    shapes = shapes - motions @ (motions.T @ (body.mass @ shapes))  # removes the effect of rounded entries of K and M
    shapes = shapes / np.sqrt(np.einsum("ij,ij->j", shapes, body.mass @ shapes))
    among_modes = np.abs(shapes.T @ (body.mass @ shapes) - np.eye(shapes.shape[1])).max(initial=0.0)
    to_rigid = np.abs(motions.T @ (body.mass @ shapes)).max(initial=0.0)
    return FreeModes(
        rigid=rigid,
        frequencies=np.sqrt(elastic[kept]) / (2.0 * np.pi),
        vectors=shapes,
        rigid_vectors=motions,
        rigid_frequency=rigid_frequency,
        orthogonality=float(max(among_modes, to_rigid)),
        up_to=up_to,
        factor=factor,
    )


def residual_flexibility(body: BodyMatrices, modes: FreeModes, attachments: Sequence[Any]) -> list[Vector]:
    """Compute the residual flexibility of attachments, the static flexibility of the truncated modes: G = P' K^-1 P.

    The projected load P f = f - M R R'f - M Phi Phi'f excites neither the rigid motions (inertia relief) nor the modes
    Phi. K u = P f is solved by u += (K + s M)^-1 (P f - K u); each pass reduces the error by a factor of s / w^2 of the
    first truncated mode.

    Args:
        body: K and M.
        modes: rigid motions R and modes Phi of the body.
        attachments: N of each attachment, with displacement u = N' x for degrees of freedom x; sparse, shape (dofs, 3).

    Returns:
        Symmetric flexibilities [m/N], shape (3, 3); zero in directions without a degree of freedom.

    Source: R. R. Craig and A. J. Kurdila, Fundamentals of Structural Dynamics, 2006, section 17.6.
    """
    flexibilities = []
    for attachment in attachments:
        flexibility = np.asarray(attachment.T @ residual_vectors(body, modes, attachment.toarray()))
        flexibilities.append(0.5 * (flexibility + flexibility.T))
    return flexibilities


def residual_vectors(body: BodyMatrices, modes: FreeModes, load: Vector) -> Vector:
    """Return P' K^-1 P f for each column f of a load [N], in the shape of the load; see `residual_flexibility`."""
    kept = np.hstack([modes.rigid_vectors, modes.vectors])
    # P f = f - M (R R' + Phi Phi') f.
    load = load - body.mass @ (kept @ (kept.T @ load))
    displacement = np.zeros_like(load)
    for _ in range(REFINEMENTS):
        change = modes.factor.solve(load - body.stiffness @ displacement)
        # Without the parts that round-off adds along R and Phi.
        change -= kept @ (kept.T @ (body.mass @ change))
        displacement += change
        if np.abs(change).max() <= 1e-12 * np.abs(displacement).max():
            break
    return displacement


def _all(body: BodyMatrices, shift: float) -> tuple[Vector, Vector]:
    """Compute all modes from M phi = (K + s M) phi / (w^2 + s), which allows massless degrees of freedom."""
    shifted = (body.stiffness + shift * body.mass).toarray()
    inverse, vectors = scipy.linalg.eigh(body.mass.toarray(), shifted)
    # A massless degree of freedom has an infinite w^2, an eigenvalue of zero here.
    real = inverse > 1e-12 * inverse[-1]
    # Ascending w^2, and modal mass 1.
    values = 1.0 / inverse[real][::-1] - shift
    return values, vectors[:, real][:, ::-1] / np.sqrt(inverse[real][::-1])


def lowest_modes(
    body: BodyMatrices, shift: float, limit: float, solve: Callable[[Vector], Vector], count: int = FIRST_GUESS
) -> tuple[Vector, Vector]:
    """Compute the lowest modes by Lanczos iteration until an eigenvalue exceeds a limit.

    Args:
        body: K and M.
        shift: s [rad2/s2].
        limit: eigenvalue limit [rad2/s2].
        solve: solver of (K + s M) x = b, restricted to the search space of the modes.
        count: initial number of modes, doubled while all eigenvalues are below the limit.

    Returns:
        Eigenvalues in ascending order [rad2/s2]; vectors, shape (dofs, modes).
    """
    size = len(body.node)
    operator = scipy.sparse.linalg.LinearOperator((size, size), solve)
    start = solve(body.mass @ np.random.default_rng(1).standard_normal(size))  # reproducible start
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
            f"stiffness and mass: a motion has neither stiffness nor mass (K + s M is singular: {error}), for "
            "example the rotation of a point mass on a node of solid elements. Leave out this degree of "
            "freedom, or add inertia."
        ) from error


def modes_below(body: BodyMatrices, limit: float) -> int:
    """Return the number of eigenvalues below a limit: negative pivots of K - limit M (Sylvester's law of inertia).

    Args:
        body: K and M of the free body.
        limit: eigenvalue limit [rad2/s2].
    """
    factor = _factorised(body.stiffness - limit * (1.0 + 1e-9) * body.mass)
    return int(np.sum(factor.U.diagonal() < 0.0))
