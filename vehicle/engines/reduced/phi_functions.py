"""The phi functions of exponential integrators (Hochbruck and Ostermann, Acta Numerica 2010, eq. 2.10)."""

from math import factorial

import numpy as np

from vehicle.arrays import Complex

SERIES_BELOW = 2.0
"""|x| below which the recursion is inaccurate and the series of phi is summed."""
SERIES_TERMS = 30
"""Terms of that series: 2^30 / 30! is far below round-off."""


def phi_functions(x: Complex, highest: int) -> list[Complex]:
    """Return phi_1 ... phi_highest at x, phi_k(x) = sum_i x^i / (i + k)!."""
    use_recursion, zeros = np.abs(x) >= SERIES_BELOW, np.zeros_like(x)
    safe, small = np.where(use_recursion, x, 1.0), np.where(use_recursion, 0.0, x)
    # phi_{k+1} = (phi_k - 1/k!)/x cancels for small x.
    recursive = [np.expm1(safe) / safe]
    for k in range(1, highest):
        recursive.append((recursive[-1] - 1.0 / factorial(k)) / safe)
    values = []
    for k, by_recursion in enumerate(recursive, start=1):
        by_series = zeros
        # Horner: the highest power first.
        for i in reversed(range(SERIES_TERMS)):
            by_series = by_series * small + 1.0 / factorial(i + k)
        values.append(np.where(use_recursion, by_recursion, by_series))
    return values
