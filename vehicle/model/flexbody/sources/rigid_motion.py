"""Least squares of the rigid motion of a hung body, with the stiffness of its support and its elastic motion.

See `rigid_fit` for the equation. The terms s w^2 + t w^4 of each accelerance are eliminated by the projection on their
orthogonal complement (variable projection; Golub and Pereyra, 1973), so 31 unknowns are left.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import DataError

_NOISE_FLOOR = 0.01
"""Minimum standard error of a line over the RMS of all accelerances [-]: the transverse sensitivity of accelerometers
is 1 to 3 %, so that small accelerances have no large weight."""

_SMALLEST = 1e-10
"""Minimum singular value over the largest [-]; those below belong to stiffnesses of the support without effect."""


_STEPS = 30
"""Maximum number of evaluations; 5 to 12 are usual, a range with undamped modes of the support needs 1000."""


def _mass_terms() -> Vector:
    """Return dM/dp of the mass m, the moments m c and the tensor J (xx, yy, zz, xy, zx, yz integrals), (10, 6, 6)."""
    terms = np.zeros((10, 6, 6))
    terms[0, :3, :3] = np.eye(3)
    for axis in range(3):
        # [c x] of a unit vector c: a force m a_c = m (a + alpha x c), a moment m c x a.
        cross = np.cross(np.eye(3)[axis], np.eye(3)).T
        terms[1 + axis, :3, 3:], terms[1 + axis, 3:, :3] = -cross, cross
    for number, (row, column) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))):
        sign = 1.0 if row == column else -1.0
        terms[4 + number, 3 + row, 3 + column] = terms[4 + number, 3 + column, 3 + row] = sign
    return terms


MASS = _mass_terms()
"""dM/dp for each of the ten parameters; (10, 6, 6)."""

_STIFFNESS = np.array(
    [np.maximum(np.outer(a, b), np.outer(b, a)) for n, a in enumerate(np.eye(6)) for b in np.eye(6)[n:]]
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SolvedProblem:
    """Solution of `solved`; lengths in units of the mean arm.

    Attributes:
        parameters: m, m c, J, then the upper triangle of K; (31,).
        covariance: of the parameters from the lack of fit, from the scatter between outputs, and between inputs,
            (3, 31, 31).
        support: natural frequencies of the rigid body on K [Hz], rising, (6,).
        misfits: RMS of what the rigid body does not explain in each accelerance [m/s2/N], (n,).
        misfit, scatter: RMS of it, and of the random scatter, over the RMS of the accelerances [-].
        elastic: RMS of s w^2 + t w^4 over rigid motion at the last line [-].
        lines: number of lines.
        converged: False if the fit is not complete.
    """

    parameters: Vector
    covariance: Vector
    support: Vector
    misfits: Vector
    misfit: float
    scatter: float
    elastic: float
    lines: int
    converged: bool


def solved(frequency: Vector, response: Vector, rows: Vector) -> SolvedProblem:
    """Fit M and K to the real part of accelerances.

    Args:
        frequency: frequencies [Hz], (m,).
        response: real parts [m/s2/N], (n, m).
        rows: rows of output and input, (2, n, 6).

    Raises:
        DataError: the accelerances have a negative mass.
    """
    squared = (2.0 * np.pi * frequency) ** 2
    count, lines = response.shape
    # A smooth curve for each accelerance: 1, the support to second order, the elastic motion to second order.
    low, high = squared[0] / squared, squared / squared[-1]
    basis, mixing = np.linalg.qr(np.stack([np.ones(lines), low, low**2, high, high**2], axis=1))
    smooth = response @ basis
    free = response - smooth @ basis.T
    level = float(np.sqrt(np.mean(response**2)))
    deviation = np.maximum(np.sqrt((free**2).sum(axis=1) / (lines - 5)), _NOISE_FLOOR * level)[:, None]
    elastic = np.linalg.qr(np.stack([high, high**2], axis=1))[0]

    def projected(values: Vector) -> Vector:
        return np.asarray((values - (values @ elastic) @ elastic.T) / deviation)

    start = _start(smooth @ np.linalg.inv(mixing).T[:, 0], rows)
    mass = float(start[0])
    if mass <= 0.0:
        raise DataError(
            f"these FRFs have a mass of {mass:.3g} kg, must be above 0; check signs and directions of forces and "
            "accelerations"
        )
    scale = mass * np.concatenate([np.ones(10), np.full(21, 0.3 * squared[0])])

    def rigid(parameters: Vector) -> tuple[Vector, Vector, Vector]:
        dynamic = (
            np.tensordot(parameters[:10], MASS, 1)
            - np.tensordot(parameters[10:], _STIFFNESS, 1) / squared[:, None, None]
        )
        right = np.broadcast_to(rows.transpose(0, 2, 1)[:, None], (2, lines, 6, count))
        of_output, of_input = np.linalg.solve(dynamic[None], right)
        return np.einsum("na,man->nm", rows[0], of_input), of_output, of_input

    def residual(parameters: Vector) -> Vector:
        return projected(rigid(parameters)[0] - response).ravel()

    def slopes(parameters: Vector) -> Vector:
        # dH = -r_o' Z^-1 dZ Z^-1 r_i with Z = M - K / w^2, which is symmetric.
        _, left, right = rigid(parameters)
        of_mass = -np.einsum("man,pab,mbn->pnm", left, MASS, right, optimize=True)
        of_stiffness = np.einsum("man,pab,mbn->pnm", left, _STIFFNESS, right, optimize=True) / squared
        return projected(np.concatenate([of_mass, of_stiffness])).reshape(31, -1).T

    first = np.concatenate([start, np.zeros(21)])
    solution = scipy.optimize.least_squares(residual, first, jac=slopes, x_scale=scale, method="lm", max_nfev=_STEPS)
    parameters = solution.x
    values, vectors = np.linalg.svd(slopes(parameters) * scale, full_matrices=False)[1:]
    kept = values > _SMALLEST * values[0]
    # Variance of a line, raised by the lack of fit: what the smooth curves contain and the rigid body does not.
    of_lines = float(np.sum((free / deviation) ** 2)) / (count * (lines - 5))
    of_curves = (2.0 * solution.cost - of_lines * count * (lines - 5)) / (3 * count - int(kept.sum()))
    inverse = (vectors[kept].T / values[kept] ** 2) @ vectors[kept]
    covariances = [inverse * max(of_lines, of_curves)]
    # Errors of gain, direction and position are common to all accelerances of a sensor, or of a force: the scatter of
    # their sums (sandwich estimator for clusters; Liang and Zeger, Biometrika 73 (1986) 13).
    scores = solution.fun.reshape(count, 1, lines) @ (scale * solution.jac).reshape(count, lines, 31)
    for end in rows:
        which = np.unique(end.round(9), axis=0, return_inverse=True)[1].ravel()
        sums = np.array([scores[which == number, 0].sum(axis=0) for number in range(which.max() + 1)]) @ inverse
        covariances.append(sums.T @ sums * len(sums) / max(len(sums) - 1, 1))
    left = response - rigid(parameters)[0]
    bending = (left @ elastic) @ elastic.T
    misfits = np.sqrt(np.mean((((left - bending) @ basis) @ basis.T) ** 2, axis=1))
    stiffness, inertia = (
        np.tensordot(parameters[10:], _STIFFNESS, 1),
        np.tensordot(parameters[:10], MASS, 1),
    )
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).real)
    return SolvedProblem(
        parameters=parameters,
        covariance=np.array(covariances) * np.outer(scale, scale),
        support=np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi),
        misfits=misfits,
        misfit=float(np.sqrt(np.mean(misfits**2))) / level,
        scatter=float(np.sqrt(np.mean(free**2))) / level,
        elastic=float(np.linalg.norm(bending[:, -1]) / np.linalg.norm((response - left)[:, -1])),
        lines=lines,
        converged=solution.status > 0,
    )


def _start(plateau: Vector, rows: Vector) -> Vector:
    """Return m, m c and J of the accelerances at the middle of the range, (10,): M a = r_i for each force, linear.

    Args:
        plateau: accelerances without support and elastic motion, (n,).
        rows: rows of output and input, (2, n, 6).
    """
    inputs, which = np.unique(rows[1].round(9), axis=0, return_inverse=True)
    equations, forces = [], []
    for number, force in enumerate(inputs):
        rows_of = which.ravel() == number
        motion = np.linalg.lstsq(rows[0, rows_of], plateau[rows_of], rcond=None)[0]
        equations.append((MASS @ motion).T)
        forces.append(force)
    return np.asarray(np.linalg.lstsq(np.concatenate(equations), np.concatenate(forces), rcond=None)[0])
