"""Cubic spline through samples, with not-a-knot ends.

Source: de Boor, A Practical Guide to Splines, chapter IV. Bitwise the same values as `scipy.interpolate.CubicSpline`,
whose import takes a quarter of a second, mostly for the rest of scipy.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.float64]


class CubicSpline:
    """Cubic spline y(x) with continuous y', y''; the first two and the last two segments are one cubic each.

    On the segment from x_k on, with h = x - x_k: y = y_k + s_k h + c_k h^2 + d_k h^3. Three samples give a parabola,
    two a straight line.

    Args:
        x: increasing knots, (n,) with n > 1.
        y: values, (n,).
    """

    def __init__(self, x: Real, y: Real) -> None:
        width = np.diff(x)
        secant = np.diff(y) / width
        slope = self._slopes(x, y, width, secant)
        excess = (slope[:-1] + slope[1:] - 2.0 * secant) / width
        self.knots = x
        self.coefficients = (y[:-1], slope[:-1], (secant - slope[:-1]) / width - excess, excess / width)

    @staticmethod
    def _slopes(x: Real, y: Real, width: Real, secant: Real) -> Real:
        """Return the slopes at the knots, (n,): the solution of a tridiagonal system for a continuous y''."""
        if x.size < 4:
            polynomial = np.polyfit(x - x[0], y, x.size - 1)
            return np.asarray(np.polyval(np.polyder(polynomial), x - x[0]))
        matrix, right = np.zeros((3, x.size)), np.empty(x.size)  # rows of the matrix: above, on, below the diagonal
        matrix[1, 1:-1] = 2.0 * (width[:-1] + width[1:])
        matrix[0, 2:], matrix[2, :-2] = width[:-1], width[1:]
        right[1:-1] = 3.0 * (width[1:] * secant[:-1] + width[:-1] * secant[1:])
        both = x[2] - x[0]
        matrix[1, 0], matrix[0, 1] = width[1], both
        right[0] = ((width[0] + 2.0 * both) * width[1] * secant[0] + width[0] ** 2 * secant[1]) / both
        both = x[-1] - x[-3]
        matrix[1, -1], matrix[2, -2] = width[-2], both
        right[-1] = (width[-1] ** 2 * secant[-2] + (2.0 * both + width[-1]) * width[-2] * secant[-1]) / both
        return np.asarray(scipy.linalg.solve_banded((1, 1), matrix, right, overwrite_ab=True, overwrite_b=True))

    def __call__(self, at: ArrayLike, order: int = 0) -> Real:
        """Return y, or its first or second derivative.

        Args:
            at: values of x; beyond the knots the first and the last segment are continued.
            order: order of the derivative, 0 to 2.

        Returns:
            The values, with the shape of `at`.
        """
        x = np.asarray(at, dtype=np.float64)
        segment = np.clip(np.searchsorted(self.knots, x, side="right") - 1, 0, self.knots.size - 2)
        h = x - self.knots[segment]
        value, slope, second, third = (column[segment] for column in self.coefficients)
        if order == 0:
            return np.asarray(value + slope * h + second * (h * h) + third * (h * h * h))
        if order == 1:
            return np.asarray(slope + second * h * 2.0 + third * (h * h) * 3.0)
        return np.asarray(second * 2.0 + third * h * 6.0)
