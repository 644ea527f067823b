"""Cubic spline through samples, without `scipy.interpolate`, whose import takes longer than the splines of a run."""

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.signals.analysis.samples import Vector


class CubicSpline:
    """Cubic spline with not-a-knot ends: the first two and the last two segments are one cubic.

    On segment i, y = y_i + s_i u + c_i u^2 + d_i u^3 with u = x - x_i. The slopes s make y'' continuous:

        dx_i s_(i-1) + 2 (dx_(i-1) + dx_i) s_i + dx_(i-1) s_(i+1) = 3 (dx_i m_(i-1) + dx_(i-1) m_i),   m_i = dy_i/dx_i.

    Source: de Boor, A Practical Guide to Splines, 1978, chapter IV.

    Args:
        x: ascending positions, at least four; (n,).
        y: values; (n,).
    """

    def __init__(self, x: Vector, y: Vector) -> None:
        dx = np.diff(x)
        slope = np.diff(y) / dx
        bands, right = np.zeros((3, x.size)), np.empty(x.size)
        # Tridiagonal system for the slopes s; rows: above, on and below the diagonal.
        bands[1, 1:-1], bands[0, 2:], bands[2, :-2] = 2.0 * (dx[:-1] + dx[1:]), dx[:-1], dx[1:]
        right[1:-1] = 3.0 * (dx[1:] * slope[:-1] + dx[:-1] * slope[1:])
        # Not-a-knot: equal third derivative in the first two segments eliminates s_2 from the first row; likewise at
        # the end.
        first, last = x[2] - x[0], x[-1] - x[-3]
        bands[1, 0], bands[0, 1], bands[1, -1], bands[2, -2] = dx[1], first, dx[-2], last
        right[0] = ((dx[0] + 2.0 * first) * dx[1] * slope[0] + dx[0] ** 2 * slope[1]) / first
        right[-1] = (dx[-1] ** 2 * slope[-2] + (2.0 * last + dx[-1]) * dx[-2] * slope[-1]) / last
        s = scipy.linalg.solve_banded((1, 1), bands, right, overwrite_ab=True, overwrite_b=True, check_finite=False)
        # d_i = bend/dx_i and c_i = (m_i - s_i)/dx_i - bend.
        bend = (s[:-1] + s[1:] - 2.0 * slope) / dx
        self.x = x
        self.terms = (y[:-1], s[:-1], (slope - s[:-1]) / dx - bend, bend / dx)

    def __call__(self, position: npt.ArrayLike, order: int = 0) -> Vector:
        """Return the spline or a derivative; beyond the ends, of the cubic there.

        Args:
            position: positions x.
            order: order of the derivative, 0 to 2.
        """
        at = np.asarray(position, dtype=float)
        segment = np.clip(np.searchsorted(self.x, at, side="right") - 1, 0, self.x.size - 2)
        value, slope, square, cube = (term[segment] for term in self.terms)
        u = at - self.x[segment]
        if order == 0:
            return np.asarray(value + u * (slope + u * (square + u * cube)))
        if order == 1:
            return np.asarray(slope + u * (2.0 * square + 3.0 * u * cube))
        return np.asarray(2.0 * square + 6.0 * u * cube)
