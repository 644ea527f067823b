"""Posterior of unknowns learned from simulated drives: a regression, and the residuals of drives left out.

Gaussian process regression of each unknown y over the features x, with standardised features and unknowns,

    k(x, x') = exp(-|x - x'|^2/(s p)),    y(x) = k(x)' (K + l I)^-1 y,

p features. The noise l is that with the smallest error of drives left out. Drives with a common road or car are left
out together: the residuals of a block b are A_bb^-1 a_b, with A = (K + l I)^-1 and a = A y. So are the distances d^2 =
(x - m)' C^-1 (x - m) of a record from the drives, with the covariance C of the others. The unlikeness of a
record is ln d^2 less its usual value on a road of this level, over its standard deviation: dampers that stick at times
scatter more.

The residuals r of drives that were left out are the distribution of the error. Their scale depends on the record,
ln s = b0 + b1 u1 + ..., fitted by maximum likelihood over the predicted values; y(x) + s(x) r_j/s_j are
draws of the unknown, and drives with predictions near y(x) have large weights.

Sources: Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006, equations 2.25 and 5.12; Beaumont, Zhang
and Balding, Genetics 162 (2002) 2025, for the regression of simulations; Vovk, Gammerman and Shafer, Algorithmic
Learning in a Random World, 2005, for the intervals by drives left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.arrays import Vector

WIDTH = 8.0
"""s: half and double change the error of drives left out by less than 3 %."""

NOISES = 10.0 ** np.arange(-4.0, 2.1, 0.5)
"""Noises l that are tried."""

NEAR = 0.5
"""Distance of predictions, in standard deviations of the unknown, at which the weight of a drive falls to exp(-1/2)."""

FOLDS = 5
"""Parts of the drives for the distances of drives left out."""

SHRINKAGE = 0.02
"""Share of the diagonal in the covariance of the features: there are fewer drives than would determine all of it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Posterior:
    """Draws of an unknown with their weights.

    Attributes:
        draws: values; (n,).
        weights: their probabilities; (n,).
        prior: standard deviation of the unknown before the record.
    """

    draws: Vector
    weights: Vector
    prior: float

    def below(self, limit: float) -> float:
        """Return the probability that the unknown is below a limit."""
        return float(self.weights @ (self.draws < limit))

    def quantile(self, share: float) -> float:
        """Return the quantile of a probability."""
        order = np.argsort(self.draws)
        cumulated = np.cumsum(self.weights[order]) - 0.5 * self.weights[order]
        return float(np.interp(share, cumulated, self.draws[order]))

    @property
    def mean(self) -> float:
        """Return the expected value."""
        return float(self.weights @ self.draws)

    @property
    def deviation(self) -> float:
        """Return the standard deviation."""
        return float(np.sqrt(self.weights @ (self.draws - self.mean) ** 2))


class Learned:
    """Regression of unknowns over features.

    Args:
        features: features of the simulated drives; (n, p).
        values: unknowns of the drives, the level of the road last; (n, q).
        block: number of successive drives that are left out as one.
    """

    def __init__(self, features: Vector, values: Vector, block: int) -> None:
        self.center, self.scale = features.mean(axis=0), features.std(axis=0)
        self.x = (features - self.center) / self.scale
        self.low, self.high = values.min(axis=0), values.max(axis=0)
        self.mean, self.prior = values.mean(axis=0), values.std(axis=0)
        y = (values - self.mean) / self.prior
        eigenvalues, vectors = np.linalg.eigh(self._kernel(self.x))
        blocks = [slice(first, first + block) for first in range(0, len(y), block)]
        error = np.full(y.shape[1], np.inf)
        self.coefficients, self.left_out, self.noise = np.zeros_like(y), np.zeros_like(y), np.zeros(y.shape[1])
        for noise in NOISES:
            inverse = (vectors / (eigenvalues + noise)) @ vectors.T
            solved = inverse @ y
            residuals = np.concatenate([np.linalg.solve(inverse[rows, rows], solved[rows]) for rows in blocks])
            mean_square = np.mean(residuals**2, axis=0)
            better = mean_square < error
            error[better], self.noise[better] = mean_square[better], noise
            self.coefficients[:, better], self.left_out[:, better] = solved[:, better], residuals[:, better]
        self.predicted = y - self.left_out
        distances = np.zeros(len(y))
        folds = np.arange(len(y)) // block % FOLDS
        for fold in range(FOLDS):
            inside = folds != fold
            distances[~inside] = _distance(self.x[inside], self.x[~inside])
        terms = _of_level(self.predicted[:, -1])
        self.usual = np.linalg.lstsq(terms, np.log(distances), rcond=None)[0]
        beyond = np.log(distances) - terms @ self.usual
        self.spread = float(np.std(beyond))
        self.unlike = beyond / self.spread
        self.scales = [self._fit_scale(unknown) for unknown in range(y.shape[1])]

    def _kernel(self, other: Vector) -> Vector:
        """Return k of features (m, p) and all drives; (m, n)."""
        square = scipy.spatial.distance.cdist(other, self.x, "sqeuclidean")
        return np.asarray(np.exp(-square / (WIDTH * self.x.shape[1])))

    def _terms(self, predicted: Vector, unknown: int) -> Vector:
        """Return the terms u of the scale of an unknown, from the predictions of all unknowns (m, q); (m, terms)."""
        y, level = predicted[:, unknown], predicted[:, -1]
        return np.column_stack([np.ones(len(y)), y, y**2, level, level**2])

    def _fit_scale(self, unknown: int) -> Vector:
        """Return the coefficients b of ln s, which minimise the mean of ln s + r^2/(2 s^2)."""
        terms, square = self._terms(self.predicted, unknown), self.left_out[:, unknown] ** 2

        def cost(b: Vector) -> tuple[float, Vector]:
            log_scale = terms @ b
            ratio = square * np.exp(-2.0 * log_scale)
            return float(np.mean(log_scale + 0.5 * ratio)), np.asarray(terms.T @ (1.0 - ratio) / len(square))

        start = np.zeros(terms.shape[1])
        start[0] = 0.5 * np.log(np.mean(square))
        return np.asarray(scipy.optimize.minimize(cost, start, jac=True, method="BFGS").x)

    def unlikeness(self, features: Vector) -> float:
        """Return the unlikeness of a record; `unlike` are the values of the drives left out."""
        x = (features - self.center)[None] / self.scale
        level = np.clip(self._kernel(x) @ self.coefficients[:, -1], *_range(self.predicted[:, -1]))
        beyond = np.log(_distance(self.x, x)) - _of_level(level) @ self.usual
        return float(beyond[0]) / self.spread

    def rougher(self, features: Vector, unknown: int, more: float) -> float:
        """Return the ratio of the errors of an unknown on a rougher road and on the road of the record.

        Args:
            features: features of the record; (p,).
            unknown: number of the unknown.
            more: increase of the level.
        """
        predicted = self._kernel((features - self.center)[None] / self.scale) @ self.coefficients
        other = predicted.copy()
        other[:, -1] = np.minimum(other[:, -1] + more / self.prior[-1], self.predicted[:, -1].max())
        change = (self._terms(other, unknown) - self._terms(predicted, unknown)) @ self.scales[unknown]
        return float(np.exp(change[0]))

    def posteriors(self, features: Vector, widened: float = 1.0) -> list[Posterior]:
        """Return the posterior of each unknown.

        Args:
            features: features of the record; (p,).
            widened: factor of the scale of the errors, at least 1.
        """
        predicted = self._kernel((features - self.center)[None] / self.scale) @ self.coefficients
        deviations = self.predicted.std(axis=0)
        # Distances of the predictions of the level.
        of_level = ((self.predicted[:, -1] - predicted[0, -1]) / (NEAR * deviations[-1])) ** 2
        posteriors = []
        for unknown, scales in enumerate(self.scales):
            at_drives = self._terms(self.predicted, unknown)
            terms = np.clip(self._terms(predicted, unknown)[0], at_drives.min(axis=0), at_drives.max(axis=0))
            ratio = widened * np.exp((terms - at_drives) @ scales)
            apart = (self.predicted[:, unknown] - predicted[0, unknown]) / (NEAR * deviations[unknown])
            exponent = -0.5 * (apart**2 + of_level)
            weights = np.exp(exponent - exponent.max())
            draws = predicted[0, unknown] + ratio * self.left_out[:, unknown]
            draws = np.clip(self.mean[unknown] + self.prior[unknown] * draws, self.low[unknown], self.high[unknown])
            posteriors.append(Posterior(draws=draws, weights=weights / weights.sum(), prior=float(self.prior[unknown])))
        return posteriors


def _of_level(level: Vector) -> Vector:
    """Return the terms of the usual logarithm of a distance over the predicted last unknown; (m, 3)."""
    return np.column_stack([np.ones(len(level)), level, level**2])


def _range(values: Vector) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _distance(others: Vector, x: Vector) -> Vector:
    """Return d^2 of features (m, p) from others (n, p); (m,)."""
    mean = others.mean(axis=0)
    covariance = np.cov(others.T)
    covariance = (1.0 - SHRINKAGE) * covariance + SHRINKAGE * np.diag(np.diag(covariance))
    apart = x - mean
    return np.asarray(np.einsum("mp,mp->m", apart, np.linalg.solve(covariance, apart.T).T))
