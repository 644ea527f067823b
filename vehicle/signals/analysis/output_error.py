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
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

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

STEPS = 8
"""Maximum Gauss-Newton steps; the start from the grid is within a cell, so that each step squares the error."""

ENOUGH = 0.1
"""Minimum step of the pole over its standard error; smaller steps are below the noise."""

SHARP_SHARE = 0.1
"""Minimum probability of the best grid node for Gauss-Newton steps; below it, the posterior covers some ten nodes and
their sum is accurate."""

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
    noise: Real
    """power of the error e per line, shape (s, k)"""


def fit_windows(inputs: Complex, outputs: Complex, *, wide: bool) -> WindowFit:
    """Fit every response in every window; windows of equal length share the grid of poles and are fitted in a batch.

    Args:
        inputs: U on N = 2 n + 1 lines, scaled to unit mean power, shape (s, p, N).
        outputs: Y, scaled to unit mean power, shape (s, k, N).
        wide: True if n is above the minimum half width.
    """
    input_count, lines = inputs.shape[1:]
    half, dof = lines // 2, lines - 3 * input_count - 3  # less b, t and a
    offset = np.arange(-half, half + 1) / half
    floor = EXACT * _power(outputs)
    windows = _Windows(offset, inputs)
    coefficients = _adjoint(windows.basis) @ _transposed(outputs)  # (s, 2p + 1, k)
    residual = np.ascontiguousarray(outputs - _transposed(windows.basis @ coefficients))
    total = _power(residual)

    # All poles of the grid, preceded by a model without pole: x^2 and, for the transient, x replace 1 / (1 + a x).
    poles, spacing, sharpest, shapes = _pole_grid(half, wide)
    gram, direct = (np.concatenate(parts) for parts in zip(windows.without_pole(), windows.gram(shapes), strict=True))
    projected = windows.tail.conj().transpose(1, 0, 2)[:, :, :, None] * residual.transpose(2, 0, 1)[:, :, None]
    right = (shapes.conj() @ projected.reshape(lines, -1)).reshape(-1, *projected.shape[1:])  # (G, s, p + 1, k)
    right = np.concatenate([(_adjoint(windows.smooth) @ _transposed(residual))[None], right])
    inverse = np.linalg.inv(gram)
    unknowns = inverse @ right  # (G, s, p + 1, k)
    explained = np.sum(right.real * unknowns.real + right.imag * unknowns.imag, axis=2)
    residual_power = np.maximum(total - explained, floor)  # (G, s, k)
    probability = np.exp(dof * (np.log(residual_power.min(axis=0)) - np.log(residual_power)))
    probability /= probability.sum(axis=0)
    pole_part = direct @ unknowns  # (G, s, p, k)
    mean = np.sum(probability[:, :, None] * pole_part, axis=0)  # (s, p, k)
    noise = np.sum(probability * residual_power, axis=0) / dof
    node_covariance = windows.covariance + direct @ inverse @ _adjoint(direct)  # (G, s, p, p)
    spread = np.ascontiguousarray((probability * residual_power).transpose(1, 2, 0)) / dof  # (s, k, G)
    covariance = (spread @ node_covariance.reshape(*node_covariance.shape[:2], -1).swapaxes(0, 1)).reshape(
        *total.shape, input_count, input_count
    )
    scatter = pole_part - mean
    for i, j in np.ndindex(input_count, input_count):
        covariance[..., i, j] += np.sum(probability * scatter[:, :, i] * scatter[:, :, j].conj(), axis=0)
    response = _transposed(windows.weights @ coefficients + mean)

    # Where the pole is narrower than a grid cell, the refined best node replaces the mean over the grid.
    best = np.argmin(residual_power, axis=0)
    window, sharp = np.nonzero((best > 0) & (probability.max(axis=0) > SHARP_SHARE))
    if sharp.size:
        node, refined_windows = best[window, sharp] - 1, windows.of(window)
        refined = _refine(poles[node], residual[window, sharp], refined_windows, sharpest)
        spread = np.maximum(refined.cost, floor[window, sharp]) / dof
        cells = np.sqrt(spread) * refined.error / np.abs(refined.a) ** 2 / spacing[node]
        trust = 1.0 / (1.0 + (2.0 * cells) ** 4)
        whole = (refined_windows.weights @ coefficients[window, :, sharp][:, :, None])[:, :, 0] + refined.part
        node_covariance = (refined_windows.covariance + refined.covariance) * spread[:, None, None]
        response[window, sharp] += trust[:, None] * (whole - response[window, sharp])
        covariance[window, sharp] += trust[:, None, None] * (node_covariance - covariance[window, sharp])
        noise[window, sharp] += trust * (spread - noise[window, sharp])
    return WindowFit(response=response, covariance=covariance, noise=noise)


class _Windows:
    """Inputs of s windows, and the projection on the terms without a pole, common to all poles and responses.

    A pole enters only by sums over the lines, with s = 1 / (1 + a x): |s|^2 U_i* U_j for the Gram matrix, s q* U for
    the projection on the basis q of the other terms. The last U is 1, for the transient.
    """

    def __init__(self, offset: Real, inputs: Complex) -> None:
        input_count, lines = inputs.shape[1:]
        unit = np.ones((len(inputs), 1, lines))
        self.offset = offset
        self.tail = _transposed(np.concatenate([inputs, unit], axis=1))  # (s, N, p + 1)
        smooth = _transposed(np.concatenate([inputs, inputs * offset, unit], axis=1))
        self.basis, triangle = np.linalg.qr(smooth)  # (s, N, 2p + 1)
        self.weights = np.linalg.inv(triangle)[:, :input_count]  # H = weights @ (basis' Y) + the part of the pole
        self.covariance = self.weights @ _adjoint(self.weights)
        smooth = _transposed(np.concatenate([inputs * offset**2, offset * unit], axis=1))
        overlap = _adjoint(self.basis) @ smooth
        self.smooth = smooth - self.basis @ overlap
        self.lost = self.weights @ overlap

    def of(self, indices: NDArray[np.intp]) -> _Windows:
        """Return the windows of the given indices; repeated indices repeat the window."""
        selected = copy.copy(self)
        for name in ("tail", "basis", "weights", "covariance"):
            setattr(selected, name, getattr(self, name)[indices])
        return selected

    def without_pole(self) -> tuple[Complex, Complex]:
        """Return Gram matrices (1, s, p + 1, p + 1) of x^2 and x, and their coefficients in H, (1, s, p, p + 1)."""
        return (_adjoint(self.smooth) @ self.smooth)[None], -self.lost[None]

    def gram(self, shapes: Complex) -> tuple[Complex, Complex]:
        """Return Gram matrices (G, s, p + 1, p + 1) of shapes 1 / (1 + a x), (G, N), and their coefficients in H."""
        count, _, size = self.tail.shape
        pairs = self.tail.conj()[..., None] * self.tail[:, :, None]
        shared = self.basis.conj()[..., None] * self.tail[:, :, None]
        power = (shapes.real**2 + shapes.imag**2) @ _lines_first(pairs).view(np.float64)
        share = (shapes @ _lines_first(shared)).reshape(len(shapes), count, -1, size)  # (G, s, 2p + 1, p + 1)
        return self._projected(power.view(np.complex128).reshape(-1, count, size, size), share)

    def gram_each(self, shapes: Complex) -> tuple[Complex, Complex]:
        """Return Gram matrices (s, p + 1, p + 1) of a shape per window, (s, N), and their coefficients in H."""
        with_pole = shapes[:, :, None] * self.tail
        return self._projected(_adjoint(with_pole) @ with_pole, _adjoint(self.basis) @ with_pole)

    def _projected(self, power: Complex, share: Complex) -> tuple[Complex, Complex]:
        """Return Gram matrices orthogonal to the terms without a pole, and the coefficients of the remainder in H."""
        inputs, size = self.weights.shape[1], self.tail.shape[2]
        return power - _adjoint(share) @ share, np.eye(inputs, size) - self.weights @ share


class _PoleGrid(NamedTuple):
    """Grid of poles z in units of n lines, a = -1/z."""

    poles: Complex  # a (G,)
    spacing: Real  # distance of neighbours in z (G,)
    sharpest: float  # least imaginary part of z
    shapes: Complex  # 1 / (1 + a x) (G, N)


@lru_cache(maxsize=4)
def _pole_grid(half: int, wide: bool) -> _PoleGrid:
    """Return the pole grid of a window of half width n [lines]."""
    sharpest = max(SHARPEST if wide else 0.0, LEAST_BANDWIDTH / half)
    real, imaginary = np.linspace(-FARTHEST, FARTHEST, POSITIONS), np.geomspace(sharpest, WIDEST, BANDWIDTHS)
    nodes: Complex = (real[:, None] + 1j * imaginary).ravel().astype(np.complex128)
    spacing = np.minimum(real[1] - real[0], (imaginary[1] / imaginary[0] - 1.0) * nodes.imag)
    offset = np.arange(-half, half + 1) / half
    inverse: Complex = -np.reciprocal(nodes)
    shapes: Complex = np.reciprocal(1.0 + inverse[:, None] * offset)
    return _PoleGrid(inverse, spacing, sharpest, shapes)


class _Refined(NamedTuple):
    """Estimates with a separate pole for each response."""

    a: Complex
    cost: Real  # residual power (k,)
    step: Complex  # Gauss-Newton step of a
    error: Real  # standard error of a per unit of noise
    part: Complex  # of the pole in H (k, p)
    covariance: Complex  # of that part per unit of noise power (k, p, p)


def _solved(a: Complex, residual: Complex, total: Real, windows: _Windows) -> _Refined:
    """Solve the least squares with a given pole for each response, and compute the Gauss-Newton step of the pole."""
    shapes = 1.0 / (1.0 + a[:, None] * windows.offset)  # (k, N)
    gram, direct = windows.gram_each(shapes)
    inverse = np.linalg.inv(gram)
    adjoint = _adjoint(windows.tail)  # (k, p + 1, N)
    right = adjoint @ (shapes.conj() * residual)[:, :, None]  # (k, p + 1, 1)
    theta = inverse @ right
    # d(model) / da = -x s^2 (sum_i c_i2 U_i + d1), minus its projection on the terms without a pole, then on the terms
    # with the pole (Schur complement).
    slope = -windows.offset * shapes**2 * (windows.tail @ theta)[:, :, 0]
    floor = ROUNDING * _power(slope) + TINY
    overlap = _adjoint(windows.basis) @ slope[:, :, None]  # (k, 2p + 1, 1)
    slope -= (windows.basis @ overlap)[:, :, 0]
    with_pole = adjoint @ (shapes.conj() * slope)[:, :, None]
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
        error = current.error * np.sqrt(np.maximum(current.cost, EXACT * total) / residual.shape[1])
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
        scale[active] = np.where(better, 1.0, 0.3 * scale[active])
        for stored, new in zip(current, trial, strict=True):
            stored[active[better]] = new[better]
    return current


def _power(rows: Complex) -> Real:
    """Return the sum of |z|^2 over the last axis."""
    return np.asarray(np.sum(rows.real**2 + rows.imag**2, axis=-1))


def _transposed(matrices: Complex) -> Complex:
    """Transpose a stack of matrices."""
    return np.swapaxes(matrices, -1, -2)


def _adjoint(matrices: Complex) -> Complex:
    """Return the conjugate transpose of a stack of matrices."""
    return np.swapaxes(matrices.conj(), -1, -2)


def _lines_first(products: Complex) -> Complex:
    """Reshape products (s, N, i, j) to columns over the lines, (N, s i j)."""
    return np.ascontiguousarray(products.swapaxes(0, 1)).reshape(products.shape[1], -1)


def _inner(first: Complex, second: Complex) -> Complex:
    """Return the inner products, conj(first) times second, of columns (k, n, 1); shape (k,)."""
    return np.asarray(np.sum(first.conj() * second, axis=(1, 2)))
