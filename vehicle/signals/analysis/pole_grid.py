"""Grid of poles for the local rational model, and sums over the lines of a frequency window for all of them."""

import itertools
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vehicle.signals.analysis.samples import Complex, Vector

SHARPEST = 0.15
"""Minimum half-bandwidth of a pole relative to n: 0.3 % damping if n is 2 % of the frequency."""

LEAST_BANDWIDTH = 0.4
"""Minimum half-bandwidth [lines] at the minimum n: a narrower pole affects only two lines and is not identifiable."""

WIDEST = 3.0
"""Maximum half-bandwidth relative to n; the polynomial terms represent wider poles."""

FARTHEST = 1.3
"""Maximum distance of a pole from the centre of the window relative to n."""

POSITIONS, BANDWIDTHS = 21, 7
"""Number of positions and bandwidths of the pole grid, spacing 0.13 n. A grid of 27 by 9 changes the result by less
than 0.1 standard errors."""


class PoleGrid(NamedTuple):
    """Poles z in units of n lines, a = -1/z: those with Re z >= 0, then the mirrored ones of Re z > 0."""

    poles: Complex  # a (G,)
    spacing: Vector  # distance of neighbours in z (G,)
    sharpest: float  # least imaginary part of z
    mirrored: int  # number of mirrored poles
    wide: bool  # arguments of `pole_grid`
    half: int


@lru_cache(maxsize=4)
def pole_grid(wide: bool, half: int) -> PoleGrid:
    """Return the grid of poles of a window of n lines on each side; that of wide windows does not depend on n."""
    sharpest = max(SHARPEST if wide else 0.0, LEAST_BANDWIDTH / half)
    real, imaginary = np.linspace(0.0, FARTHEST, POSITIONS // 2 + 1), np.geomspace(sharpest, WIDEST, BANDWIDTHS)
    nodes: Complex = (real[:, None] + 1j * imaginary).ravel().astype(np.complex128)
    mirrored = nodes.size - BANDWIDTHS
    # Mirrored at the imaginary axis; a pole on the axis has no second image.
    nodes = np.concatenate([nodes, -nodes[BANDWIDTHS:].conj()])
    # Distance of neighbours: in position, or in bandwidth, which grows by a constant factor.
    spacing = np.minimum(real[1], (imaginary[1] / imaginary[0] - 1.0) * nodes.imag)
    return PoleGrid(-np.reciprocal(nodes), spacing, sharpest, mirrored, wide, half)


@lru_cache(maxsize=16)
def _shapes_of(wide: bool, half_of_grid: int, half: int) -> tuple[Vector, Vector]:
    """Return even and odd parts of 1 / (1 + a x) for x >= 0 and x > 0, real parts above imaginary parts."""
    grid = pole_grid(wide, half_of_grid)
    a = grid.poles[: len(grid.poles) - grid.mirrored, None]
    x = np.arange(half + 1) / half
    # 1 / (1 - (a x)^2) and -a x times it, in real numbers: SIMD
    real, imaginary = 1.0 - (a * a).real * x**2, (a * a).imag * x**2
    power = np.reciprocal(real**2 + imaginary**2)
    real *= power
    imaginary *= power
    odd_real = -x * (a.real * real - a.imag * imaginary)
    odd_imaginary = -x * (a.real * imaginary + a.imag * real)
    return np.concatenate([real, imaginary]), np.concatenate([odd_real, odd_imaginary])[:, 1:].copy()


def sums_of_poles(grid: PoleGrid, columns: Vector, halves: NDArray[np.int_]) -> tuple[Vector, Vector]:
    """Return the sums of s(x) y and s(-x) y over the lines, s = 1 / (1 + a x), for the poles of Re z >= 0.

    Args:
        grid: poles; s(-x) is returned for those with Re z > 0 only, s*(-x) is that of the mirrored pole.
        columns: y, shape (N, s, c).
        halves: lines n on each side of the centre of each window, in ascending order, shape (s,).

    Returns:
        Real and imaginary parts, shape (2, poles, s, c), of s(x) and of s(-x).
    """
    middle, (count, width) = len(columns) // 2, columns.shape[1:]
    # y(x) and y(-x) for x > 0: sum of s y = sum of s_even (y + y-) + s_odd (y - y-).
    after, before = columns[middle + 1 :], columns[middle - 1 :: -1]
    even, odd = np.empty((middle + 1, count * width)), (after - before).reshape(middle, -1)
    even[0] = columns[middle].ravel()
    np.add(after, before, out=even[1:].reshape(middle, count, width))
    nodes = len(grid.poles) - grid.mirrored
    # Real parts above imaginary parts; (2 nodes, windows columns).
    sums, odd_sums = np.empty((2, 2 * nodes, count * width))
    edges = [0, *(np.flatnonzero(halves[1:] != halves[:-1]) + 1), count]
    for begin, end in itertools.pairwise(edges):
        half, span = int(halves[begin]), slice(begin * width, end * width)
        shapes_even, shapes_odd = _shapes_of(grid.wide, grid.half, half)
        np.matmul(shapes_even, even[: half + 1, span], out=sums[:, span])
        np.matmul(shapes_odd, odd[:half, span], out=odd_sums[:, span])
    sums, odd_sums = (values.reshape(2, nodes, count, width) for values in (sums, odd_sums))
    # s(-x) has the odd part with the other sign.
    mirrored = sums[:, nodes - grid.mirrored :] - odd_sums[:, nodes - grid.mirrored :]
    sums += odd_sums
    return sums, mirrored


def right_sides(
    grid: PoleGrid, tail: Complex, smooth: Complex, residual: Complex, halves: NDArray[np.int_]
) -> list[Complex]:
    """Return the right-hand sides of the normal equations, for no pole and all poles of the grid.

    Args:
        grid: G - 1 poles.
        tail: factors t of s = 1 / (1 + a x), shape (s, N, p + 1); the last one is 1.
        smooth: terms of the model without pole, shape (s, N, p + 1).
        residual: spectra of the responses, shape (N, s, k).
        halves: half width n of each window, in ascending order, shape (s,).

    Returns:
        p + 1 arrays, shape (G, s, k).
    """
    none = np.swapaxes(smooth.conj(), 1, 2) @ residual.swapaxes(0, 1)  # (s, p + 1, k)
    middle, widest = len(residual) // 2, int(halves[-1])
    lines = slice(middle - widest, middle + widest + 1)
    right = []
    for i in range(none.shape[1]):
        columns = residual[lines].copy()
        if i < none.shape[1] - 1:
            columns *= tail[:, lines, i].T.conj()[:, :, None]
        first, mirrored = sums_of_poles(grid, columns.view(np.float64), halves)
        first, mirrored = first.view(np.complex128), mirrored.view(np.complex128)
        row = np.empty((len(grid.poles) + 1, *none.shape[::2]), dtype=np.complex128)
        row[0] = none[:, i]
        direct, mirror = row[1 : first.shape[1] + 1], row[first.shape[1] + 1 :]
        # conj(s) y from the sums of Re(s) y and Im(s) y; s of a mirrored pole is the conjugate of s(-x).
        np.add(first[0].real, first[1].imag, out=direct.real)
        np.subtract(first[0].imag, first[1].real, out=direct.imag)
        np.subtract(mirrored[0].real, mirrored[1].imag, out=mirror.real)
        np.add(mirrored[0].imag, mirrored[1].real, out=mirror.imag)
        right.append(row)
    return right
