"""Polynomial emulator of outputs of a car over its parameters, with its leave-one-out error."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import ceil, comb

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError

CARS_PER_TERM = 2.5
"""Minimum number of cars per coefficient. With fewer, the leave-one-out error of a cubic exceeds a quadratic's."""

HIGHEST_DEGREE = 4
"""Maximum total degree."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Emulator:
    """Least-squares polynomials y_k(x) = sum_j c_jk prod_i P_aij(x_i) in Legendre polynomials P on [-1, 1].

    Source of the leave-one-out error e_i / (1 - h_i) with the leverage h_i: Allen, Technometrics 16 (1974), 125-127;
    polynomials of a random input: Xiu and Karniadakis, SIAM J. Sci. Comput. 24 (2002), 619-644.
    """

    powers: npt.NDArray[np.int64]  # degrees a of each term, (terms, parameters)
    coefficients: Vector  # c, (terms, outputs)
    left_out: Vector  # RMS of the leave-one-out errors of each output, (outputs,)

    def __call__(self, points: Vector) -> Vector:
        """Return the outputs at points in [-1, 1], (points, parameters) -> (points, outputs)."""
        return np.asarray(legendre_terms(points, self.powers) @ self.coefficients)


def legendre_terms(points: Vector, powers: npt.NDArray[np.int64]) -> Vector:
    """Return products of Legendre polynomials of degrees (terms, parameters) at points in [-1, 1], (points, terms)."""
    table = np.polynomial.legendre.legvander(points, int(powers.max(initial=0)))
    terms = table[:, 0, powers[:, 0]].copy()
    for index in range(1, points.shape[1]):
        terms *= table[:, index, powers[:, index]]
    return np.asarray(terms)


def fitted_emulator(points: Vector, outputs: Vector) -> Emulator:
    """Fit polynomials of the highest total degree that the number of cars allows.

    Args:
        points: parameters of the cars in [-1, 1], (cars, parameters).
        outputs: outputs of the cars, (cars, outputs).
    """
    cars, size = points.shape
    degrees = [degree for degree in range(1, HIGHEST_DEGREE + 1) if cars >= CARS_PER_TERM * comb(size + degree, degree)]
    if not degrees:
        raise ConfigurationError(
            f"--samples {cars}: must be at least {ceil(CARS_PER_TERM * (size + 1))} for {size} parameters"
        )
    powers = np.array(_powers(size, degrees[-1]))
    terms = legendre_terms(points, powers)
    orthogonal, triangle = np.linalg.qr(terms)
    coefficients = np.linalg.solve(triangle, orthogonal.T @ outputs)
    leverage = np.sum(orthogonal**2, axis=1, keepdims=True)
    errors = (outputs - terms @ coefficients) / np.maximum(1.0 - leverage, 1e-6)
    return Emulator(powers=powers, coefficients=coefficients, left_out=np.sqrt(np.mean(errors**2, axis=0)))


def _powers(size: int, degree: int) -> Sequence[tuple[int, ...]]:
    """Return the degrees of all terms up to a total degree."""
    return [
        tuple(chosen.count(index) for index in range(size))
        for total in range(degree + 1)
        for chosen in combinations_with_replacement(range(size), total)
    ]
