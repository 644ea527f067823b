"""A local rational model of stretches of spectral lines, fitted to the error of the output.

Over the lines k + r, |r| <= n, x = r / n, with the inputs U_i,

    Y = [sum_i U_i (b_i0 + b_i1 x + b_i2 x^2) + t0 + t1 x] / (1 + a x) + e,

the noisy output is never a regressor, so noise does not bias b (an equation-error fit of the same model, which
multiplies by 1 + a x, makes peaks low by 10 % at coherence 0.9). For one pole the model is linear. Divided out,

    Y = sum_i U_i (c_i0 + c_i1 x + c_i2 / (1 + a x)) + d0 + d1 / (1 + a x) + e:

all but the last terms of each sum are the same for every pole, so they are projected out once for all responses, and a
grid of poles costs one matrix product. With the unknowns integrated out under flat priors the probability of a pole is
RSS^-(N - m), and the estimate is the mean over the poles: where noise hides the pole, a maximum alone would be biased
and far too sure of itself. Where the pole is sharper than the grid, Gauss-Newton steps refine it, blended in.

Sources: Pintelon and Schoukens, System Identification, 2nd ed. 2012, sections 7.2 (transient) and 9.11 (output error);
Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973) 413 (projection); Bretthorst, Bayesian Spectrum Analysis, 1988.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

SHARPEST = 0.15
"""Least half of the half-power bandwidth of a pole over n: damping of 0.3 % where n is 2 % of the frequency."""

LEAST_BANDWIDTH = 0.4
"""The same in lines, where n is the least: a sharper pole shows in a line or two and cannot be told."""

WIDEST = 3.0
"""Largest half of the half-power bandwidth of a pole over n; above it the rest of the model says the same."""

REACH = 1.3
"""Farthest pole from the centre of the stretch over n."""

POSITIONS, BANDWIDTHS = 21, 7
"""Poles of the grid, 0.13 n apart. A finer one, 27 by 9, changes nothing above 0.1 standard errors."""

STEPS = 8
"""Gauss-Newton steps at most; the grid starts within one cell, so that each step squares the error."""

ENOUGH = 0.1
"""A step of the pole over its standard error, below which it changes nothing that the noise would not."""

SHARP_SHARE = 0.1
"""Least share of the likeliest node of the grid at which Gauss-Newton is worth while: below, the posterior spreads over
some ten nodes, whose sum is good."""

ROUNDING, TINY, SMALLEST = 1e-13, 1e-300, 1e-2
"""Keep a pole without a residue, and one farther off than a hundred n, from dividing by zero."""

EXACT = 1e-13
"""Least residual power over the power of the response: rounding of the transform."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StretchFit:
    """What each of s stretches says about its centre line, for k responses and p inputs."""

    response: Complex
    """H, shape (s, k, p)"""
    covariance: Complex
    """E dH_i conj(dH_j), shape (s, k, p, p)"""
    noise: Real
    """power of e in a line, shape (s, k)"""


def fit_stretches(drives: Complex, answers: Complex, halves: NDArray[np.int_], *, wide: bool) -> StretchFit:
    """Fit the local rational model to all responses in s frequency windows, vectorised over windows and responses.

    Windows are centred in N lines; lines outside a window are zero.

    Args:
        drives: spectra U of the inputs, scaled to unit mean power in each window, shape (s, p, N).
        answers: spectra Y of the responses, scaled likewise, shape (N, s, k).
        halves: lines n on each side of the centre line of each window, in ascending order, shape (s,).
        wide: True if n is a share of the frequency, False if n is the minimum number of lines.
    """
    inputs = drives.shape[1]
    dof = (2 * halves + 1 - 3 * inputs - 3)[:, None]  # less b, t and a
    total = _column_power(answers)
    floor = EXACT * total
    stretch = _Stretches(drives, halves)
    known = _adjoint(stretch.basis) @ answers.swapaxes(0, 1)  # (s, 2p + 1, k)
    rest = answers - (stretch.basis @ known).swapaxes(0, 1)
    total = _column_power(rest)

    # Every pole of the grid, and none: there x^2 and, for the transient, x take the place of 1 / (1 + a x).
    grid = _pole_grid(wide, int(halves[0]))
    gram, direct, right = _projected_sums(grid, stretch, rest, halves)
    lower, pivots = _triangular_factors(gram)
    explained = np.zeros(right[0].shape)  # (G, s, k)
    for i, row in enumerate(right):
        for j in range(i):
            row -= lower[i][j][:, :, None] * right[j]
            direct[:, i] -= direct[:, j] * lower[i][j].conj()
        explained += (row.real**2 + row.imag**2) * np.reciprocal(pivots[i])[:, :, None]
    left = np.maximum(total - explained, floor)
    best = np.argmin(left, axis=0)
    likely = np.exp(dof * (np.log(left.min(axis=0)) - np.log(left)))
    share = 1.0 / likely.sum(axis=0)  # of the likeliest node
    likely *= share
    spread = likely * left  # (G, s, k)
    noise = spread.sum(axis=0) / dof
    gain = direct / np.array(pivots)  # (p, p + 1, G, s)
    part = [sum(gain[i, j][:, :, None] * row for j, row in enumerate(right)) for i in range(inputs)]
    mean = np.array([np.sum(likely * rows, axis=0) for rows in part])  # (p, s, k)
    for rows, middle in zip(part, mean, strict=True):
        rows -= middle
    covariance = np.empty((*total.shape, inputs, inputs), dtype=np.complex128)
    for i, j in np.ndindex(inputs, inputs):
        own = stretch.covariance[:, i, j] + np.sum(gain[i] * direct[j].conj(), axis=0)  # (G, s)
        parallel = part[i].real * part[j].real + part[i].imag * part[j].imag
        covariance[..., i, j] = np.einsum("gsk,gs->sk", spread, own.real) / dof + np.sum(likely * parallel, axis=0)
        if i != j:
            crossed = part[i].imag * part[j].real - part[i].real * part[j].imag
            imaginary = np.einsum("gsk,gs->sk", spread, own.imag) / dof + np.sum(likely * crossed, axis=0)
            covariance[..., i, j] += 1j * imaginary
    response = _turned(stretch.weights @ known) + np.moveaxis(mean, 0, -1)

    # Where the pole is sharper than a cell of the grid, the best node is refined and takes over.
    of, sharp = np.nonzero((best > 0) & (share > SHARP_SHARE))
    if sharp.size:
        node, own_stretch = best[of, sharp] - 1, stretch.of(of)
        refined = _refine(grid.poles[node], rest[:, of, sharp].T, own_stretch, grid.sharpest)
        freedom = dof[of, 0]
        power = np.maximum(refined.cost, floor[of, sharp]) / freedom
        cells = np.sqrt(power) * refined.error / np.abs(refined.a) ** 2 / grid.spacing[node]
        trust = 1.0 / (1.0 + (2.0 * cells) ** 4)
        whole = (own_stretch.weights @ known[of, :, sharp][:, :, None])[:, :, 0] + refined.part
        own = (own_stretch.covariance + refined.covariance) * power[:, None, None]
        response[of, sharp] += trust[:, None] * (whole - response[of, sharp])
        covariance[of, sharp] += trust[:, None, None] * (own - covariance[of, sharp])
        noise[of, sharp] += trust * (power - noise[of, sharp])
    return StretchFit(response=response, covariance=covariance, noise=noise)


class _Stretches:
    """Terms of the model without a pole, and the inputs, for a number of frequency windows.

    Attributes:
        offset: x of every line, zero outside a window, shape (s, N).
        tail: inputs and 1 (transient), the factors of s = 1 / (1 + a x), shape (s, N, p + 1).
        basis: orthonormal basis of the terms U, U x and 1, shape (s, N, 2p + 1).
        inverse: transform of the terms to the basis, shape (s, 2p + 1, 2p + 1).
        weights: first p rows of `inverse`; H = weights @ (basis' Y) + the part of the pole.
        covariance: covariance of H without a pole per unit of noise power, shape (s, p, p).
        size: lines of each window, shape (s,).
    """

    def __init__(self, drives: Complex, halves: NDArray[np.int_]) -> None:
        inputs, lines = drives.shape[1:]
        offset = np.arange(-(lines // 2), lines // 2 + 1) / halves[:, None]
        inside = np.abs(offset) <= 1.0
        self.size = 2 * halves + 1
        self.offset = np.where(inside, offset, 0.0)
        one, x = inside[:, None].astype(np.float64), self.offset[:, None]
        self.tail = _turned(np.concatenate([drives, one], axis=1))
        self.basis, triangle = np.linalg.qr(_turned(np.concatenate([drives, drives * x, one], axis=1)))
        self.inverse = np.linalg.inv(triangle)
        self.weights = self.inverse[:, :inputs]
        self.covariance = self.weights @ _adjoint(self.weights)

    def of(self, which: NDArray[np.intp]) -> _Stretches:
        """Return the windows with the given indices, repeated as listed."""
        chosen = copy.copy(self)
        for name in ("tail", "basis", "weights", "covariance", "offset", "size"):
            setattr(chosen, name, getattr(self, name)[which])
        return chosen

    def without_pole(self) -> tuple[Complex, Complex, Complex]:
        """Return terms U x^2 and x less their projection on the basis (s, N, p + 1), Gram matrices, and parts in H."""
        smooth = self.tail * self.offset[:, :, None]
        smooth[:, :, :-1] *= self.offset[:, :, None]
        held = _adjoint(self.basis) @ smooth
        smooth -= self.basis @ held
        return smooth, _adjoint(smooth) @ smooth, -(self.weights @ held)

    def seen_each(self, shapes: Complex) -> tuple[Complex, Complex]:
        """Return Gram matrices (s, p + 1, p + 1) and parts in H (s, p, p + 1) of one pole per window.

        Args:
            shapes: 1 / (1 + a x), shape (s, N).
        """
        with_pole = shapes[:, :, None] * self.tail
        power, share = _adjoint(with_pole) @ with_pole, _adjoint(self.basis) @ with_pole
        inputs, size = self.weights.shape[1], self.tail.shape[2]
        return power - _adjoint(share) @ share, np.eye(inputs, size) - self.weights @ share


def _projected_sums(
    grid: _PoleGrid, stretch: _Stretches, rest: Complex, halves: NDArray[np.int_]
) -> tuple[Complex, Complex, list[Complex]]:
    """Return the normal equations of the terms with a pole, for no pole and all poles of the grid.

    With s = 1 / (1 + a x), the sums over the lines of s |U|^2, s U and s are sufficient, because

        x s = (1 - s) / a   and   |s|^2 = (a s - a* s*) / (a - a*).

    Mirrored poles, z and -z*, have s(x) and s*(-x): the even and odd parts of the spectra are summed once for both.

    Returns:
        Gram matrices less their projection on the basis, shape (p + 1, p + 1, G, s); parts in H, shape (p, p + 1, G, s);
        right-hand sides, p + 1 arrays of shape (G, s, k).
    """
    lines, count, outputs = rest.shape
    size = stretch.tail.shape[2]
    inputs, pairs = size - 1, size * size
    tail = np.ascontiguousarray(stretch.tail.transpose(1, 0, 2))  # (N, s, p + 1)
    columns = np.empty((lines, count, pairs + 2 * size * outputs))
    places = {}
    for i, j in np.ndindex(size, size):
        if i <= j:
            product = tail[:, :, i].conj() * tail[:, :, j]
            places[i, j] = len(places)
            columns[:, :, places[i, j]] = product.real
            if i < j:
                places[j, i] = len(places)
                columns[:, :, places[j, i]] = product.imag
    heard = columns[:, :, pairs:].view(np.complex128).reshape(lines, count, size, outputs)
    np.multiply(tail.conj()[..., None], rest[:, :, None], out=heard)

    middle = lines // 2
    even, odd = columns[middle:].copy(), columns[middle:].copy()
    even[1:] += columns[middle - 1 :: -1] if middle else 0.0
    odd[1:] -= columns[middle - 1 :: -1]
    width = columns.shape[2]
    even, odd = even.reshape(middle + 1, -1), odd.reshape(middle + 1, -1)
    nodes = len(grid.poles) - (grid.mirrored)
    up, down = np.empty((2, 2 * nodes, count * width))
    edges = np.flatnonzero(np.diff(halves, prepend=-1, append=-1))
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        half, some = int(halves[begin]), slice(begin * width, end * width)
        shapes_even, shapes_odd = _grid_shapes(grid, half)
        np.matmul(shapes_even, even[: half + 1, some], out=up[:, some])
        np.matmul(shapes_odd, odd[1 : half + 1, some], out=down[:, some])
    up, down = up + down, up - down
    up, down = up.reshape(2, nodes, count, width), down.reshape(2, nodes, count, width)[:, nodes - grid.mirrored :]

    # Sums of s conj(t_i) t_j, t = (U, 1), from their real and imaginary columns.
    real = np.concatenate([up[0, :, :, :pairs], down[0, :, :, :pairs]])
    imaginary = np.concatenate([up[1, :, :, :pairs], -down[1, :, :, :pairs]])
    sums = np.moveaxis(real + 1j * imaginary, -1, 0)  # (pairs, G, s)
    a = grid.poles[:, None]
    plain = (_adjoint(stretch.tail) @ stretch.tail).transpose(1, 2, 0)  # (p + 1, p + 1, s)
    weighted = np.empty((size, size, len(grid.poles), count), dtype=np.complex128)
    for i, j in np.ndindex(size, size):
        first, second = sums[places[min(i, j), max(i, j)]], sums[places[max(i, j), min(i, j)]]
        weighted[i, j] = first if i == j else first + (1j if i < j else -1j) * second
    smooth, gram_none, direct_none = stretch.without_pole()
    gram = np.empty((size, size, len(grid.poles) + 1, count), dtype=np.complex128)
    direct = np.empty((inputs, size, len(grid.poles) + 1, count), dtype=np.complex128)
    gram[:, :, 0], direct[:, :, 0] = gram_none.transpose(1, 2, 0), direct_none.transpose(1, 2, 0)
    gram[:, :, 1:] = a * weighted
    gram[:, :, 1:] -= a.conj() * weighted.swapaxes(0, 1).conj()
    gram[:, :, 1:] /= a - a.conj()
    held = np.concatenate([weighted[:-1], (plain[:-1, :, None] - weighted[:-1]) / a, weighted[-1:]])
    direct[:, :, 1:] = np.eye(inputs, size)[:, :, None, None]
    inverse = stretch.inverse.transpose(1, 2, 0)  # (2p + 1, 2p + 1, s)
    for column in range(len(held)):
        share = sum(inverse[row, column].conj() * held[row] for row in range(column + 1))  # (p + 1, G, s)
        gram[:, :, 1:] -= share.conj()[:, None] * share
        direct[:, :, 1:] -= inverse[:inputs, column][:, None, None] * share

    right = []
    none = _adjoint(smooth) @ rest.swapaxes(0, 1)  # (s, p + 1, k)
    for i in range(size):
        row = np.empty((len(grid.poles) + 1, count, outputs), dtype=np.complex128)
        row[0] = none[:, i]
        begin = pairs + 2 * i * outputs
        for target, parts, sign in ((row[1 : nodes + 1], up, -1.0), (row[nodes + 1 :], down, 1.0)):
            values = parts[..., begin : begin + 2 * outputs].view(np.complex128)
            turned = np.subtract if sign > 0.0 else np.add
            turned(values[0].real, values[1].imag, out=target.real)
            turned = np.add if sign > 0.0 else np.subtract
            turned(values[0].imag, values[1].real, out=target.imag)
        right.append(row)
    return gram, direct, right


def _triangular_factors(gram: Complex) -> tuple[list[list[Complex]], list[Real]]:
    """Return L below its diagonal and D of gram = L D L', for matrices (m, m, G, s), element by element."""
    lower: list[list[Complex]] = []
    pivots: list[Real] = []
    for i in range(len(gram)):
        row: list[Complex] = []
        for j in range(i):
            row.append((gram[i, j] - sum(row[m] * lower[j][m].conj() * pivots[m] for m in range(j))) / pivots[j])
        lower.append(row)
        pivots.append(gram[i, i].real - sum((np.abs(row[m]) ** 2 * pivots[m] for m in range(i)), np.float64(0.0)))
    return lower, pivots


class _PoleGrid(NamedTuple):
    """Poles z in units of n lines, a = -1/z: those with Re z >= 0, then the mirrored ones of Re z > 0."""

    poles: Complex  # a (G,)
    spacing: Real  # distance of neighbours in z (G,)
    sharpest: float  # least imaginary part of z
    mirrored: int  # number of mirrored poles


@lru_cache(maxsize=4)
def _pole_grid(wide: bool, half: int) -> _PoleGrid:
    """Return the grid of poles of a window of n lines on each side; that of wide windows does not depend on n."""
    sharpest = max(SHARPEST if wide else 0.0, LEAST_BANDWIDTH / half)
    real, imaginary = np.linspace(0.0, REACH, POSITIONS // 2 + 1), np.geomspace(sharpest, WIDEST, BANDWIDTHS)
    nodes: Complex = (real[:, None] + 1j * imaginary).ravel().astype(np.complex128)
    mirrored = nodes.size - BANDWIDTHS
    nodes = np.concatenate([nodes, -nodes[BANDWIDTHS:].conj()])
    spacing = np.minimum(real[1], (imaginary[1] / imaginary[0] - 1.0) * nodes.imag)
    return _PoleGrid(-np.reciprocal(nodes), spacing, sharpest, mirrored)


def _grid_shapes(grid: _PoleGrid, half: int) -> tuple[Real, Real]:
    """Return even and odd parts of 1 / (1 + a x) for x >= 0 and x > 0, real parts above imaginary parts."""
    ax = grid.poles[: len(grid.poles) - grid.mirrored, None] * (np.arange(half + 1) / half)
    even = np.reciprocal(1.0 - ax * ax)
    odd = (-ax * even)[:, 1:]
    return np.concatenate([even.real, even.imag]), np.concatenate([odd.real, odd.imag])


class _Refined(NamedTuple):
    """Every response with its own pole."""

    a: Complex
    cost: Real  # residual power (k,)
    step: Complex  # Gauss-Newton step of a
    error: Real  # standard error of a per unit of noise
    part: Complex  # of the pole in H (k, p)
    covariance: Complex  # of that part per unit of noise power (k, p, p)


def _at(a: Complex, rest: Complex, total: Real, stretch: _Stretches) -> _Refined:
    """Least squares with one pole for each response, and the Gauss-Newton step of the pole."""
    shapes = 1.0 / (1.0 + a[:, None] * stretch.offset)  # (k, N)
    gram, direct = stretch.seen_each(shapes)
    inverse = np.linalg.inv(gram)
    adjoint = _adjoint(stretch.tail)  # (k, p + 1, N)
    right = adjoint @ (shapes.conj() * rest)[:, :, None]  # (k, p + 1, 1)
    theta = inverse @ right
    # d(model) / da = -x s^2 (sum_i c_i2 U_i + d1), less its share in all other terms: those without a pole, then those
    # with it (Schur complement).
    slope = -stretch.offset * shapes**2 * (stretch.tail @ theta)[:, :, 0]
    least = ROUNDING * _power(slope) + TINY
    held = _adjoint(stretch.basis) @ slope[:, :, None]  # (k, 2p + 1, 1)
    slope -= (stretch.basis @ held)[:, :, 0]
    with_pole = adjoint @ (shapes.conj() * slope)[:, :, None]
    coupled = inverse @ with_pole
    alone = np.maximum(_power(slope) - _inner(with_pole, coupled).real, least)
    pull = np.sum(slope.conj() * rest, axis=1) - _inner(with_pole, theta)
    turn = (stretch.weights @ held + direct @ coupled)[:, :, 0]  # dH / da, (k, p)
    return _Refined(
        a=a,
        cost=total - _inner(right, theta).real,
        step=pull / alone,
        error=1.0 / np.sqrt(alone),
        part=(direct @ theta)[:, :, 0],
        covariance=direct @ inverse @ _adjoint(direct) + turn[:, :, None] * turn[:, None].conj() / alone[:, None, None],
    )


def _refine(start: Complex, rest: Complex, stretch: _Stretches, least: float) -> _Refined:
    """Output-error Gauss-Newton on the pole of every response; the linear unknowns follow exactly."""
    total = _power(rest)
    now, scale = _at(start, rest, total, stretch), np.ones(len(start))
    for _ in range(STEPS):
        error = now.error * np.sqrt(np.maximum(now.cost, EXACT * total) / stretch.size)
        active = np.flatnonzero(scale * np.abs(now.step) > ENOUGH * error)
        if not active.size:
            break
        a = now.a[active] + scale[active] * now.step[active]
        a = np.where(np.abs(a) > SMALLEST, a, now.a[active])
        trial = _at(a, rest[active], total[active], stretch.of(active))
        pole = -1.0 / a
        better = (trial.cost < now.cost[active]) & ((pole.imag >= least) | (np.abs(pole.real) > REACH + 0.2))
        scale[active] = np.where(better, 1.0, 0.3 * scale[active])
        for kept, new in zip(now, trial, strict=True):
            kept[active[better]] = new[better]
    return now


def _power(rows: Complex) -> Real:
    """Sum of |z|^2 over the last axis."""
    return np.asarray(np.sum(rows.real**2 + rows.imag**2, axis=-1))


def _column_power(columns: Complex) -> Real:
    """Return the sum of |z|^2 over the first axis."""
    return np.asarray(np.sum(columns.real**2 + columns.imag**2, axis=0))


def _turned(matrices: Complex) -> Complex:
    """Transposed matrices."""
    return np.swapaxes(matrices, -1, -2)


def _adjoint(matrices: Complex) -> Complex:
    """Transposed and conjugate matrices."""
    return np.swapaxes(matrices.conj(), -1, -2)


def _inner(first: Complex, second: Complex) -> Complex:
    """first' second of columns (k, n, 1), shape (k,)."""
    return np.asarray(np.sum(first.conj() * second, axis=(1, 2)))
