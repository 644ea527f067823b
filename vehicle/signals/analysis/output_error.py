"""Local rational model of frequency windows, output-error estimate with one local pole.

Over the lines k + r, |r| <= n, x = r / n, with the inputs U_i,

    Y = [sum_i U_i (b_i0 + b_i1 x + b_i2 x^2) + t0 + t1 x] / (1 + a x) + e,

the noisy output is never a regressor, so noise does not bias b (an equation-error fit of the same model, which
multiplies by 1 + a x, makes peaks low by 10 % at coherence 0.9). For one pole the model is linear. Divided out,

    Y = sum_i U_i (c_i0 + c_i1 x + c_i2 / (1 + a x)) + d0 + d1 / (1 + a x) + e:

only the last term of each sum depends on the pole, so the other terms are projected out once for all responses, and a
grid of poles costs one matrix product. With the unknowns integrated out under flat priors the probability of a pole is
RSS^-(N - m), and the estimate is the mean over the poles: where noise hides the pole, the maximum would be
biased, with too small an error. If the pole is narrower than a grid cell, Gauss-Newton steps refine it; the refined
estimate is blended in.

Sources: Pintelon and Schoukens, System Identification, 2nd ed. 2012, sections 7.2 (transient) and 9.11 (output error);
Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973) 413 (projection); Bretthorst, Bayesian Spectrum Analysis, 1988.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Indices
from vehicle.signals.analysis.pole_grid import FARTHEST, PoleGrid, pole_grid, right_sides, sums_of_poles
from vehicle.signals.analysis.samples import Complex, Vector

STEPS = 8
"""Maximum Gauss-Newton steps; the start from the grid is within a cell, so that each step squares the error."""

ENOUGH = 0.1
"""Minimum step of the pole over its standard error; smaller steps are below the noise."""

SHARP_SHARE = 0.1
"""Minimum probability of the best grid node for Gauss-Newton steps; below it, the posterior covers some ten nodes and
their sum is accurate."""

FITS_IN_CACHE = 200
"""Fits (windows times responses) processed at once: their arrays over the grid, 300 kB each, stay in the cache."""

REFINED_AT_ONCE = 256
"""Poles refined at once: the terms of their windows stay in the cache."""

ROUNDING, TINY, SMALLEST = 1e-13, 1e-300, 1e-2
"""Lower bounds against division by zero: for a pole without a residue, and for a pole farther away than 100 n."""

EXACT = 1e-13
"""Minimum residual power over the power of the response: rounding of the transform."""


@dataclass(frozen=True, kw_only=True, slots=True)
class WindowFit:
    """Estimates at the centre lines of s windows, for k responses and p inputs."""

    response: Complex
    """FRF H, shape (s, k, p)"""
    covariance: Complex
    """covariance E dH_i conj(dH_j), shape (s, k, p, p)"""
    noise: Vector
    """power of the error e per line, shape (s, k)"""


def fit_windows(inputs: Complex, outputs: Complex, halves: NDArray[np.int_], *, wide: bool) -> WindowFit:
    """Fit the local rational model to all responses in s frequency windows, vectorised over windows and responses.

    Windows are centred in N lines; lines outside a window are zero.

    Args:
        inputs: spectra U of the inputs, scaled to unit mean power in each window, shape (s, p, N).
        outputs: spectra Y of the responses, scaled likewise, shape (N, s, k).
        halves: lines n on each side of the centre line of each window, in ascending order, shape (s,).
        wide: True if n is a share of the frequency, False if n is the minimum number of lines.
    """
    input_count, count, output_count = inputs.shape[1], *outputs.shape[1:]
    dof = (2 * halves + 1 - 3 * input_count - 3)[:, None]  # less b, t and a
    floor = EXACT * _column_power(outputs)
    windows = _Windows(inputs, halves)
    # Projection on the terms without a pole; what remains is for the pole to explain.
    coefficients = _adjoint(windows.basis) @ outputs.swapaxes(0, 1)  # (s, 2p + 1, k)
    residual = outputs - (windows.basis @ coefficients).swapaxes(0, 1)
    total = _column_power(residual)
    # H at the centre line, x = 0, of these terms alone.
    response = _transposed(windows.weights @ coefficients)
    covariance = np.empty((count, output_count, input_count, input_count), dtype=np.complex128)
    noise, share = np.empty((2, count, output_count))
    best = np.empty((count, output_count), dtype=np.intp)

    # All poles of the grid, preceded by a model without pole: x^2 and, for the transient, x replace 1 / (1 + a x).
    grid = pole_grid(wide, int(halves[0]))
    equations = _normal_equations(grid, windows, halves)
    size = max(FITS_IN_CACHE // max(output_count, 1), 1)
    for begin in range(0, count, size):
        block = slice(begin, min(begin + size, count))
        right = right_sides(grid, windows.tail[block], equations.smooth[block], residual[:, block], halves[block])
        best[block], share[block], noise[block], mean, covariance[block] = _posterior(
            equations, right, total[block], floor[block], dof[block], block
        )
        response[block] += np.moveaxis(mean, 0, -1)

    # Where the pole is narrower than a grid cell, the refined best node replaces the mean over the grid.
    of, sharp = np.nonzero((best > 0) & (share > SHARP_SHARE))
    for begin in range(0, sharp.size, REFINED_AT_ONCE):
        chosen = slice(begin, begin + REFINED_AT_ONCE)
        at = of[chosen], sharp[chosen]
        node, refined_windows = best[at] - 1, windows.of(at[0])
        refined = _refine(grid.poles[node], residual[:, at[0], at[1]].T, refined_windows, grid.sharpest)
        # Standard error of the pole in cells of the grid. Far below a cell the refined estimate replaces the mean,
        # above a cell the mean stays.
        power = np.maximum(refined.cost, floor[at]) / dof[at[0], 0]
        cells = np.sqrt(power) * refined.error / np.abs(refined.a) ** 2 / grid.spacing[node]
        trust = 1.0 / (1.0 + (2.0 * cells) ** 4)
        whole = (refined_windows.weights @ coefficients[at[0], :, at[1]][:, :, None])[:, :, 0] + refined.part
        node_covariance = (refined_windows.covariance + refined.covariance) * power[:, None, None]
        response[at] += trust[:, None] * (whole - response[at])
        covariance[at] += trust[:, None, None] * (node_covariance - covariance[at])
        noise[at] += trust * (power - noise[at])
    return WindowFit(response=response, covariance=covariance, noise=noise)


def _posterior(
    equations: _NormalEquations, right: list[Complex], total: Vector, floor: Vector, dof: NDArray[np.int_], block: slice
) -> tuple[Indices, Vector, Vector, Complex, Complex]:
    """Average the estimates of all poles of the grid, weighted by their probability.

    Args:
        equations: normal equations of all windows.
        right: right-hand sides of the windows of `block`, p + 1 arrays of shape (G, s, k); overwritten.
        total: residual power of the model without x^2 and pole, shape (s, k).
        floor: minimum residual power, shape (s, k).
        dof: degrees of freedom, shape (s, 1).
        block: indices of the windows.

    Returns:
        Index of the most probable pole, its probability and the noise power, shape (s, k); mean of the part in H,
        shape (p, s, k); covariance of H, shape (s, k, p, p).
    """
    gain, direct = equations.gain[..., block], equations.direct[..., block]
    residual_power: Vector = np.broadcast_to(total, right[0].shape)
    for i, row in enumerate(right):
        for j in range(i):
            # Forward substitution with L; each unknown lowers the residual power by |row|^2/D.
            row -= equations.lower[i][j][:, block, None] * right[j]
        residual_power = residual_power - (row.real**2 + row.imag**2) * equations.weights[i][:, block, None]
    residual_power = np.maximum(residual_power, floor)
    best = np.argmin(residual_power, axis=0)
    # RSS^-dof over its largest value, in logarithms against underflow.
    probability = np.log(residual_power)
    probability -= probability.min(axis=0)
    probability *= -dof
    np.exp(probability, out=probability)
    share = 1.0 / probability.sum(axis=0)  # of the most probable pole
    probability *= share
    residual_power *= probability
    noise = residual_power.sum(axis=0) / dof
    part = []
    for row_gain in gain:
        values = row_gain[0][:, :, None] * right[0]
        for j in range(1, len(right)):
            values += row_gain[j][:, :, None] * right[j]
        part.append(values)
    mean = np.array([np.sum(probability * values, axis=0) for values in part])  # (p, s, k)
    for values, middle in zip(part, mean, strict=True):
        values -= middle
    covariance = np.empty((*total.shape, len(part), len(part)), dtype=np.complex128)
    for i, j in np.ndindex(len(part), len(part)):
        node_covariance = equations.covariance[block, i, j] + np.sum(gain[i] * direct[j].conj(), axis=0)  # (G, s)
        real = part[i].real * part[j].real + part[i].imag * part[j].imag
        # Mean of the covariances of all poles, and the scatter of their estimates about the mean.
        covariance[..., i, j] = np.einsum("gsk,gs->sk", residual_power, node_covariance.real) / dof + np.einsum(
            "gsk,gsk->sk", probability, real
        )
        if i != j:
            imaginary = part[i].imag * part[j].real - part[i].real * part[j].imag
            spread = np.einsum("gsk,gs->sk", residual_power, node_covariance.imag) / dof
            covariance[..., i, j] += 1j * (spread + np.einsum("gsk,gsk->sk", probability, imaginary))
    return best, share, noise, mean, covariance


class _Windows:
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

    def __init__(self, inputs: Complex, halves: NDArray[np.int_]) -> None:
        input_count, lines = inputs.shape[1:]
        offset = np.arange(-(lines // 2), lines // 2 + 1) / halves[:, None]
        inside = np.abs(offset) <= 1.0
        self.size = 2 * halves + 1
        self.offset = np.where(inside, offset, 0.0)
        constant, x = inside[:, None].astype(np.float64), self.offset[:, None]
        self.tail = _transposed(np.concatenate([inputs, constant], axis=1))
        # [U, U x, 1] = Q R, so H, the coefficient of U at x = 0, is in the first rows of R^-1 Q' Y.
        self.basis, triangle = np.linalg.qr(_transposed(np.concatenate([inputs, inputs * x, constant], axis=1)))
        self.inverse = np.linalg.inv(triangle)
        self.weights = self.inverse[:, :input_count]
        self.covariance = self.weights @ _adjoint(self.weights)

    def of(self, indices: Indices) -> _Windows:
        """Return the windows with the given indices, repeated as listed."""
        chosen = copy.copy(self)
        for name in ("tail", "basis", "weights", "covariance", "offset", "size"):
            setattr(chosen, name, getattr(self, name)[indices])
        return chosen

    def without_pole(self) -> tuple[Complex, Complex, Complex]:
        """Return terms U x^2 and x less their projection on the basis (s, N, p + 1), Gram matrices, and parts in H."""
        smooth = self.tail * self.offset[:, :, None]
        smooth[:, :, :-1] *= self.offset[:, :, None]
        held = _adjoint(self.basis) @ smooth
        smooth -= self.basis @ held
        return smooth, _adjoint(smooth) @ smooth, -(self.weights @ held)

    def gram_each(self, with_pole: Complex, adjoint: Complex) -> tuple[Complex, Complex]:
        """Return Gram matrices (s, p + 1, p + 1) and parts in H (s, p, p + 1) of one pole per window.

        Args:
            with_pole: terms with the pole, s `tail`, shape (s, N, p + 1).
            adjoint: their conjugate transpose.
        """
        # Gram matrix of the terms less their projection: P - S' S with S = basis' terms; likewise their part in H.
        power, share = adjoint @ with_pole, _adjoint(adjoint @ self.basis)
        inputs, size = self.weights.shape[1], self.tail.shape[2]
        return power - _adjoint(share) @ share, np.eye(inputs, size) - self.weights @ share


class _NormalEquations(NamedTuple):
    """Normal equations L D L' of the terms with a pole, for no pole and all poles of the grid."""

    lower: list[list[Complex]]  # L below its diagonal, elements of shape (G, s)
    weights: list[Vector]  # 1 / D, elements of shape (G, s)
    direct: Complex  # part in H of the unknowns after the elimination (p, p + 1, G, s)
    gain: Complex  # the same over D
    covariance: Complex  # covariance of H without a pole per unit of noise power (s, p, p)
    smooth: Complex  # terms of the model without a pole (s, N, p + 1)


def _normal_equations(grid: PoleGrid, windows: _Windows, halves: NDArray[np.int_]) -> _NormalEquations:
    """Return the normal equations of the terms with a pole, less their projection on the basis.

    With s = 1 / (1 + a x), the sums over the lines of s |U|^2, s U and s are sufficient.
    """
    size = windows.tail.shape[2]
    inputs, a = size - 1, grid.poles[:, None]
    tail = np.ascontiguousarray(windows.tail.transpose(1, 0, 2))  # (N, s, p + 1)
    upper = [(i, j) for i in range(size) for j in range(i, size)]
    products = np.stack([tail[:, :, i].conj() * tail[:, :, j] for i, j in upper], axis=2)
    first, mirrored = sums_of_poles(grid, products.view(np.float64), halves)
    shape = (size, size, len(a), len(halves))
    sums = np.empty(shape, dtype=np.complex128)  # sum of s conj(t_i) t_j, t = (U, 1)
    for number, (i, j) in enumerate(upper):
        # Sums of s times real and imaginary part of the product; s of a mirrored pole is conj(s(-x)).
        columns = slice(2 * number, 2 * number + 2)
        real, imaginary = np.moveaxis(
            np.concatenate([first[0, ..., columns] + 1j * first[1, ..., columns],
                            mirrored[0, ..., columns] - 1j * mirrored[1, ..., columns]]), -1, 0)  # fmt: skip
        sums[i, j], sums[j, i] = real + 1j * imaginary, real - 1j * imaginary
    smooth, gram_none, direct_none = windows.without_pole()
    gram = np.empty((size, size, len(a) + 1, len(halves)), dtype=np.complex128)
    direct = np.empty((inputs, *gram.shape[1:]), dtype=np.complex128)
    gram[:, :, 0], direct[:, :, 0] = gram_none.transpose(1, 2, 0), direct_none.transpose(1, 2, 0)
    # sum |s|^2 conj(t_i) t_j by |s|^2 = (a s - a* s*)/(a - a*).
    gram[:, :, 1:] = (a * sums - (a * sums.swapaxes(0, 1)).conj()) / (a - a.conj())
    direct[:, :, 1:] = np.eye(inputs, size)[:, :, None, None]
    plain = (_adjoint(windows.tail) @ windows.tail).transpose(1, 2, 0)[:, :, None]  # (p + 1, p + 1, 1, s)
    # Products with U, with U x by x s = (1 - s)/a, and with 1.
    held = np.concatenate([sums[:-1], (plain[:-1] - sums[:-1]) / a, sums[-1:]])
    inverse = windows.inverse.transpose(1, 2, 0)  # (2p + 1, 2p + 1, s)
    # basis' terms = R^-H (U, U x, 1)' terms, column by column, and subtract its square.
    for column in range(len(held)):
        share = inverse[0, column].conj() * held[0]  # (p + 1, G, s)
        for row in range(1, column + 1):
            share += inverse[row, column].conj() * held[row]
        for i in range(size):
            gram[i, : i + 1, 1:] -= share[i].conj() * share[: i + 1]
        direct[:, :, 1:] -= inverse[:inputs, column, None, None] * share
    lower: list[list[Complex]] = []
    pivots: list[Vector] = []
    for i in range(size):
        row_of: list[Complex] = []
        # L D L' without square roots, and L^-1 applied to the part in H, for all windows and poles at once.
        for j in range(i):
            element = gram[i, j].copy()
            for m in range(j):
                element -= row_of[m] * lower[j][m].conj() * pivots[m]
            row_of.append(element / pivots[j])
            direct[:, i] -= direct[:, j] * row_of[j].conj()
        pivot = gram[i, i].real.copy()
        for m in range(i):
            pivot -= np.abs(row_of[m]) ** 2 * pivots[m]
        lower.append(row_of)
        pivots.append(pivot)
    weights = [np.reciprocal(pivot) for pivot in pivots]
    return _NormalEquations(lower, weights, direct, direct * np.array(weights), windows.covariance, smooth)


class _Refined(NamedTuple):
    """Estimates with a separate pole for each response."""

    a: Complex
    cost: Vector  # residual power (k,)
    step: Complex  # Gauss-Newton step of a
    error: Vector  # standard error of a per unit of noise
    part: Complex  # of the pole in H (k, p)
    covariance: Complex  # of that part per unit of noise power (k, p, p)


def _solved(a: Complex, residual: Complex, total: Vector, windows: _Windows) -> _Refined:
    """Solve the least squares with a given pole for each response, and compute the Gauss-Newton step of the pole."""
    shapes = 1.0 / (1.0 + a[:, None] * windows.offset)  # (k, N)
    terms = shapes[:, :, None] * windows.tail  # (k, N, p + 1)
    adjoint = _adjoint(terms)
    gram, direct = windows.gram_each(terms, adjoint)
    inverse = np.linalg.inv(gram)
    right = adjoint @ residual[:, :, None]  # (k, p + 1, 1)
    theta = inverse @ right
    # d(model) / da = -x s^2 (sum_i c_i2 U_i + d1), minus its projection on the terms without a pole, then on the terms
    # with the pole (Schur complement).
    slope = -windows.offset * shapes * (terms @ theta)[:, :, 0]
    floor = ROUNDING * _power(slope) + TINY
    overlap = _adjoint(slope[:, None].conj() @ windows.basis)  # (k, 2p + 1, 1)
    slope -= (windows.basis @ overlap)[:, :, 0]
    with_pole = adjoint @ slope[:, :, None]
    coupled = inverse @ with_pole
    power_of_slope = np.maximum(_power(slope) - _inner(with_pole, coupled).real, floor)
    gradient = np.sum(slope.conj() * residual, axis=1) - _inner(with_pole, theta)
    sensitivity = (windows.weights @ overlap + direct @ coupled)[:, :, 0]  # dH / da, (k, p)
    return _Refined(
        a=a,
        cost=total - _inner(right, theta).real,
        step=gradient / power_of_slope,
        error=1.0 / np.sqrt(power_of_slope),
        part=(direct @ theta)[:, :, 0],
        covariance=direct @ inverse @ _adjoint(direct)
        + sensitivity[:, :, None] * sensitivity[:, None].conj() / power_of_slope[:, None, None],
    )


def _refine(start: Complex, residual: Complex, windows: _Windows, least_imaginary: float) -> _Refined:
    """Refine the pole of every response by Gauss-Newton on the output error; the linear unknowns are eliminated."""
    total = _power(residual)
    current, scale = _solved(start, residual, total, windows), np.ones(len(start))
    for _ in range(STEPS):
        error = current.error * np.sqrt(np.maximum(current.cost, EXACT * total) / windows.size)
        active = np.flatnonzero(scale * np.abs(current.step) > ENOUGH * error)
        if not active.size:
            break
        a = current.a[active] + scale[active] * current.step[active]
        a = np.where(np.abs(a) > SMALLEST, a, current.a[active])
        trial = _solved(a, residual[active], total[active], windows.of(active))
        pole = -1.0 / a
        better = (trial.cost < current.cost[active]) & (
            (pole.imag >= least_imaginary) | (np.abs(pole.real) > FARTHEST + 0.2)
        )
        # Shorten a step that does not lower the residual, and retry from the same pole.
        scale[active] = np.where(better, 1.0, 0.3 * scale[active])
        for stored, new in zip(current, trial, strict=True):
            stored[active[better]] = new[better]
    return current


def _power(rows: Complex) -> Vector:
    """Return the sum of |z|^2 over the last axis."""
    return np.asarray(np.sum(rows.real**2 + rows.imag**2, axis=-1))


def _column_power(columns: Complex) -> Vector:
    """Return the sum of |z|^2 over the first axis."""
    return np.asarray(np.sum(columns.real**2 + columns.imag**2, axis=0))


def _transposed(matrices: Complex) -> Complex:
    """Transpose a stack of matrices."""
    return np.swapaxes(matrices, -1, -2)


def _adjoint(matrices: Complex) -> Complex:
    """Return the conjugate transpose of a stack of matrices."""
    return np.swapaxes(matrices.conj(), -1, -2)


def _inner(first: Complex, second: Complex) -> Complex:
    """Return the inner products, conj(first) times second, of columns (k, n, 1); shape (k,)."""
    return np.asarray(np.sum(first.conj() * second, axis=(1, 2)))
