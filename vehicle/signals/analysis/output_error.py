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


def fit_stretches(drives: Complex, answers: Complex, *, wide: bool) -> StretchFit:
    """Fit every response over every stretch; those of one length share the grid of poles, and are fitted at once.

    Args:
        drives: U on N = 2 n + 1 lines, scaled to unit mean power, shape (s, p, N).
        answers: Y, scaled likewise, shape (s, k, N).
        wide: whether n is a share of the frequency, not the least number of lines.
    """
    inputs, lines = drives.shape[1:]
    half, dof = lines // 2, lines - 3 * inputs - 3  # less b, t and a
    offset = np.arange(-half, half + 1) / half
    floor = EXACT * _power(answers)
    stretch = _Stretches(offset, drives)
    known = _adjoint(stretch.basis) @ _turned(answers)  # (s, 2p + 1, k)
    rest = np.ascontiguousarray(answers - _turned(stretch.basis @ known))
    total = _power(rest)

    # Every pole of the grid, and none: there x^2 and, for the transient, x take the place of 1 / (1 + a x).
    poles, spacing, sharpest, shapes = _pole_grid(half, wide)
    gram, direct = (np.concatenate(parts) for parts in zip(stretch.without_pole(), stretch.seen(shapes), strict=True))
    heard = stretch.tail.conj().transpose(1, 0, 2)[:, :, :, None] * rest.transpose(2, 0, 1)[:, :, None]
    right = (shapes.conj() @ heard.reshape(lines, -1)).reshape(-1, *heard.shape[1:])  # (G, s, p + 1, k)
    right = np.concatenate([(_adjoint(stretch.smooth) @ _turned(rest))[None], right])
    inverse = np.linalg.inv(gram)
    unknowns = inverse @ right  # (G, s, p + 1, k)
    explained = np.sum(right.real * unknowns.real + right.imag * unknowns.imag, axis=2)
    left = np.maximum(total - explained, floor)  # (G, s, k)
    likely = np.exp(dof * (np.log(left.min(axis=0)) - np.log(left)))
    likely /= likely.sum(axis=0)
    part = direct @ unknowns  # (G, s, p, k)
    mean = np.sum(likely[:, :, None] * part, axis=0)  # (s, p, k)
    noise = np.sum(likely * left, axis=0) / dof
    own = stretch.covariance + direct @ inverse @ _adjoint(direct)  # (G, s, p, p)
    spread = np.ascontiguousarray((likely * left).transpose(1, 2, 0)) / dof  # (s, k, G)
    covariance = (spread @ own.reshape(*own.shape[:2], -1).swapaxes(0, 1)).reshape(*total.shape, inputs, inputs)
    scatter = part - mean
    for i, j in np.ndindex(inputs, inputs):
        covariance[..., i, j] += np.sum(likely * scatter[:, :, i] * scatter[:, :, j].conj(), axis=0)
    response = _turned(stretch.weights @ known + mean)

    # Where the pole is sharper than a cell of the grid, the best node is refined and takes over.
    best = np.argmin(left, axis=0)
    of, sharp = np.nonzero((best > 0) & (likely.max(axis=0) > SHARP_SHARE))
    if sharp.size:
        node, own_stretch = best[of, sharp] - 1, stretch.of(of)
        refined = _refine(poles[node], rest[of, sharp], own_stretch, sharpest)
        spread = np.maximum(refined.cost, floor[of, sharp]) / dof
        cells = np.sqrt(spread) * refined.error / np.abs(refined.a) ** 2 / spacing[node]
        trust = 1.0 / (1.0 + (2.0 * cells) ** 4)
        whole = (own_stretch.weights @ known[of, :, sharp][:, :, None])[:, :, 0] + refined.part
        own = (own_stretch.covariance + refined.covariance) * spread[:, None, None]
        response[of, sharp] += trust[:, None] * (whole - response[of, sharp])
        covariance[of, sharp] += trust[:, None, None] * (own - covariance[of, sharp])
        noise[of, sharp] += trust * (spread - noise[of, sharp])
    return StretchFit(response=response, covariance=covariance, noise=noise)


class _Stretches:
    """What all poles and responses of a stretch share: the inputs, and the terms without a pole, projected out.

    A pole enters by sums over the lines only: of |s|^2 U_i* U_j for the Gram matrix and of s q* U for what the basis q
    of the other terms already holds, s = 1 / (1 + a x), with 1 as the last U for the transient.
    """

    def __init__(self, offset: Real, drives: Complex) -> None:
        inputs, lines = drives.shape[1:]
        one = np.ones((len(drives), 1, lines))
        self.offset = offset
        self.tail = _turned(np.concatenate([drives, one], axis=1))  # (s, N, p + 1)
        smooth = _turned(np.concatenate([drives, drives * offset, one], axis=1))
        self.basis, triangle = np.linalg.qr(smooth)  # (s, N, 2p + 1)
        self.weights = np.linalg.inv(triangle)[:, :inputs]  # H = weights @ (basis' Y) + the part of the pole
        self.covariance = self.weights @ _adjoint(self.weights)
        smooth = _turned(np.concatenate([drives * offset**2, offset * one], axis=1))
        held = _adjoint(self.basis) @ smooth
        self.smooth = smooth - self.basis @ held
        self.lost = self.weights @ held

    def of(self, which: NDArray[np.intp]) -> _Stretches:
        """These stretches, each as often as it is named."""
        found = copy.copy(self)
        for name in ("tail", "basis", "weights", "covariance"):
            setattr(found, name, getattr(self, name)[which])
        return found

    def without_pole(self) -> tuple[Complex, Complex]:
        """Gram matrices (1, s, p + 1, p + 1) of x^2 and x, and their parts in H, (1, s, p, p + 1)."""
        return (_adjoint(self.smooth) @ self.smooth)[None], -self.lost[None]

    def seen(self, shapes: Complex) -> tuple[Complex, Complex]:
        """Gram matrices (G, s, p + 1, p + 1) of poles of given s, (G, N), and their parts in H, (G, s, p, p + 1)."""
        count, _, size = self.tail.shape
        pairs = self.tail.conj()[..., None] * self.tail[:, :, None]
        shared = self.basis.conj()[..., None] * self.tail[:, :, None]
        power = (shapes.real**2 + shapes.imag**2) @ _lines_first(pairs).view(np.float64)
        share = (shapes @ _lines_first(shared)).reshape(len(shapes), count, -1, size)  # (G, s, 2p + 1, p + 1)
        return self._projected(power.view(np.complex128).reshape(-1, count, size, size), share)

    def seen_each(self, shapes: Complex) -> tuple[Complex, Complex]:
        """The same of a pole for each stretch, shapes (s, N): (s, p + 1, p + 1) and (s, p, p + 1)."""
        with_pole = shapes[:, :, None] * self.tail
        return self._projected(_adjoint(with_pole) @ with_pole, _adjoint(self.basis) @ with_pole)

    def _projected(self, power: Complex, share: Complex) -> tuple[Complex, Complex]:
        """Gram matrices less what the other terms hold of them, and the part in H of what is left."""
        inputs, size = self.weights.shape[1], self.tail.shape[2]
        return power - _adjoint(share) @ share, np.eye(inputs, size) - self.weights @ share


class _PoleGrid(NamedTuple):
    """Poles z in units of n lines, a = -1/z."""

    poles: Complex  # a (G,)
    spacing: Real  # distance of neighbours in z (G,)
    sharpest: float  # least imaginary part of z
    shapes: Complex  # 1 / (1 + a x) (G, N)


@lru_cache(maxsize=4)
def _pole_grid(half: int, wide: bool) -> _PoleGrid:
    """The grid of a stretch of n lines on each side, the least n or a wider one."""
    sharpest = max(SHARPEST if wide else 0.0, LEAST_BANDWIDTH / half)
    real, imaginary = np.linspace(-REACH, REACH, POSITIONS), np.geomspace(sharpest, WIDEST, BANDWIDTHS)
    nodes: Complex = (real[:, None] + 1j * imaginary).ravel().astype(np.complex128)
    spacing = np.minimum(real[1] - real[0], (imaginary[1] / imaginary[0] - 1.0) * nodes.imag)
    offset = np.arange(-half, half + 1) / half
    inverse: Complex = -np.reciprocal(nodes)
    shapes: Complex = np.reciprocal(1.0 + inverse[:, None] * offset)
    return _PoleGrid(inverse, spacing, sharpest, shapes)


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
        error = now.error * np.sqrt(np.maximum(now.cost, EXACT * total) / rest.shape[1])
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


def _turned(matrices: Complex) -> Complex:
    """Transposed matrices."""
    return np.swapaxes(matrices, -1, -2)


def _adjoint(matrices: Complex) -> Complex:
    """Transposed and conjugate matrices."""
    return np.swapaxes(matrices.conj(), -1, -2)


def _lines_first(products: Complex) -> Complex:
    """Products (s, N, i, j) as columns over the lines, (N, s i j)."""
    return np.ascontiguousarray(products.swapaxes(0, 1)).reshape(products.shape[1], -1)


def _inner(first: Complex, second: Complex) -> Complex:
    """first' second of columns (k, n, 1), shape (k,)."""
    return np.asarray(np.sum(first.conj() * second, axis=(1, 2)))
