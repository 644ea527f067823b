"""Determinant D of the half car as printed below equation 6, against that of its matrix.

Rows and columns are rear wheel, front wheel, heave and pitch; a12 = a21 = 0. The scan lost the signs of the terms: each
has that of its permutation.
"""

import numpy as np

from scenarios.lumped.damper_choice import RoadHoldingHalfCar
from scenarios.lumped.road_holding import half_car_model
from vehicle.arrays import Complex

Term = tuple[int, tuple[int, ...]]
"""Sign, and the factors by row and column: (11, 22, 33, 44)."""

PRINTED_TERMS: tuple[Term, ...] = (
    (+1, (11, 22, 33, 44)), (-1, (11, 22, 34, 43)), (-1, (11, 32, 23, 44)),
    (+1, (11, 32, 24, 43)), (+1, (11, 42, 23, 34)), (-1, (11, 42, 24, 33)),
    (-1, (31, 22, 13, 44)), (+1, (31, 22, 14, 43)), (+1, (31, 42, 13, 24)),
    (-1, (31, 42, 14, 24)), (+1, (41, 22, 13, 34)), (-1, (41, 22, 14, 33)),
    (-1, (41, 32, 13, 24)), (+1, (41, 32, 14, 23)),
)  # fmt: skip
"""Terms as printed; a permutation has each row and each column once."""

ORDER = ("rear_wheel", "front_wheel", "heave", "pitch")
"""Coordinates in the order of the source."""


def half_car_matrix(car: RoadHoldingHalfCar, frequency: float) -> Complex:
    """Return a = K + i w C - w^2 M at a frequency [Hz] in the order of the source, (4, 4)."""
    system, rate = half_car_model(car).model, 2j * np.pi * frequency
    order = [system.coordinates.index(name) for name in ORDER]
    matrix = system.stiffness + rate * system.damping + rate**2 * system.mass
    return np.asarray(matrix[np.ix_(order, order)])


def printed_determinant(matrix: Complex) -> complex:
    """Return D of the printed terms for a matrix, (4, 4)."""
    return complex(
        sum(
            sign * complex(np.prod([matrix[factor // 10 - 1, factor % 10 - 1] for factor in term]))
            for sign, term in PRINTED_TERMS
        )
    )


def wrong_terms() -> list[str]:
    """Return the printed terms that are no permutation, for example "a31 a42 a14 a24"."""
    return [
        " ".join(f"a{factor}" for factor in term)
        for _, term in PRINTED_TERMS
        if {factor // 10 for factor in term} != {1, 2, 3, 4} or {factor % 10 for factor in term} != {1, 2, 3, 4}
    ]
