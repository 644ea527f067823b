"""Annealed population: points from a prior to a posterior with several modes or modes at bounds, and a proposal to it.

The likelihood L is raised to a power that grows from 0 to 1. At each power the points are drawn again with the weights
L^(difference of powers), whose effective number stays at half of the points, and then moved by differential evolution
with the Metropolis rule. Each mode keeps a number of points near its probability, whereas the walkers of an ensemble
that starts anywhere stay in the mode that they reach first. The points only start the chains and shape the proposal:
their errors do not enter the samples.

The coordinates v have a standard normal prior: u = 2 Phi(v) - 1 in [-1, 1]. A mode at a bound of u is smooth in v.

Sources: Del Moral, Doucet, Jasra, Sequential Monte Carlo samplers, J. Royal Statistical Society B 68 (2006), 411-436;
Ter Braak, A Markov chain Monte Carlo version of the genetic algorithm differential evolution, Statistics and Computing
16 (2006), 239-249.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector

POINTS = 1000
"""Number of points of the population."""

SWEEPS = 4
"""Moves of all points at each power."""

MOST_POWERS = 200
"""Maximum number of powers; a likelihood over ten orders of magnitude of exp needs about 60."""

CLUSTERS = 8
"""Maximum number of components of the proposal."""

FREEDOM = 5.0
"""Degrees of freedom of the t distributions of the proposal: wider tails than a Gaussian posterior."""


def bounded(points: Vector) -> Vector:
    """Return u = 2 Phi(v) - 1 in [-1, 1]."""
    return np.asarray(2.0 * scipy.special.ndtr(points) - 1.0)


def annealed(log_likelihood: Callable[[Vector], Vector], size: int, random: np.random.Generator) -> Vector:
    """Return points with the density of the posterior, (points, size), in the coordinates v.

    Args:
        log_likelihood: function of points v, (points, size) -> (points,).
    """
    points = random.standard_normal((POINTS, size))
    level, power = log_likelihood(points), 0.0
    for _ in range(MOST_POWERS):
        step = _step(level - level.max(), 1.0 - power)
        power += step
        weights = np.exp(step * (level - level.max()))
        chosen = random.choice(POINTS, POINTS, p=weights / weights.sum())
        points, level = points[chosen], level[chosen]
        for _ in range(SWEEPS):
            first, second = random.permutation(POINTS), random.permutation(POINTS)
            jump = np.where(random.uniform(size=(POINTS, 1)) < 0.1, 1.0, 2.38 / np.sqrt(2.0 * size))
            new = points + jump * (points[first] - points[second]) + 1e-4 * random.standard_normal(points.shape)
            new_level = log_likelihood(new)
            gain = power * (new_level - level) + 0.5 * np.sum(points**2 - new**2, axis=1)
            accepted = np.log(random.uniform(size=POINTS)) < gain
            points[accepted], level[accepted] = new[accepted], new_level[accepted]
        if power >= 1.0:
            break
    return points


def _step(level: Vector, maximum: float) -> float:
    """Return the growth of the power, up to a maximum, at which exp(step level) counts as half of the points."""

    def missing(step: float) -> float:
        weights = np.exp(step * level)
        return float(weights.sum() ** 2 / np.sum(weights**2) - 0.5 * level.size)

    return maximum if missing(maximum) >= 0.0 else float(scipy.optimize.brentq(missing, 0.0, maximum, xtol=1e-12))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Mixture:
    """Mixture of t distributions, from which a sampler draws independent proposals."""

    shares: Vector  # share of each component, (k,)
    means: Vector  # centre of each component, (k, p)
    factors: Vector  # Cholesky factor of 1.5 times the covariance of each component, (k, p, p)

    def log_density(self, points: Vector) -> Vector:
        """Return ln of the density at points, (points, p) -> (points,)."""
        size = points.shape[1]
        gamma = scipy.special.gammaln
        constant = float(gamma(0.5 * (FREEDOM + size)) - gamma(0.5 * FREEDOM) - 0.5 * size * np.log(FREEDOM * np.pi))
        terms = []
        for share, mean, factor in zip(self.shares, self.means, self.factors, strict=True):
            scaled = scipy.linalg.solve_triangular(factor, (points - mean).T, lower=True)
            square = np.sum(scaled**2, axis=0)
            height = constant + np.log(share) - float(np.sum(np.log(np.diag(factor))))
            terms.append(height - 0.5 * (FREEDOM + size) * np.log1p(square / FREEDOM))
        return np.asarray(scipy.special.logsumexp(terms, axis=0))

    def draw(self, count: int, random: Any) -> Vector:
        """Return draws of a random generator of NumPy, (count, p)."""
        component = random.choice(self.shares.size, size=count, p=self.shares)
        normal = random.normal(size=(count, self.means.shape[1]))
        moved = np.einsum("cij,cj->ci", self.factors[component], normal)
        return np.asarray(self.means[component] + moved / np.sqrt(random.chisquare(FREEDOM, size=(count, 1)) / FREEDOM))

    def __call__(self, points: Vector, random: Any) -> tuple[Vector, Vector]:
        """Return independent new points and ln q(old) - ln q(new), as `emcee.moves.MHMove` needs."""
        new = self.draw(points.shape[0], random)
        return new, self.log_density(points) - self.log_density(new)


def fitted_mixture(points: Vector) -> Mixture:
    """Return a mixture for points (n, p): a component for each cluster (k-means)."""
    size = points.shape[1]
    scale = np.std(points, axis=0) + 1e-9
    _, label = scipy.cluster.vq.kmeans2(points / scale, CLUSTERS, minit="++", rng=np.random.default_rng(1))
    groups = [points[label == number] for number in range(CLUSTERS) if np.count_nonzero(label == number) > size]
    groups = groups or [points]
    counts = np.array([len(group) for group in groups])
    covariances = [np.atleast_2d(np.cov(group.T)) for group in groups]
    pooled = np.einsum("k,kij->ij", counts / counts.sum(), covariances)
    # The covariance of a small cluster is uncertain.
    trust = counts / (counts + 5.0 * size)
    spread = np.diag(1e-10 + 1e-4 * scale**2)
    return Mixture(
        shares=counts / counts.sum(),
        means=np.array([group.mean(axis=0) for group in groups]),
        factors=np.array(
            [
                np.linalg.cholesky(1.5 * (share * each + (1.0 - share) * pooled) + spread)
                for share, each in zip(trust, covariances, strict=True)
            ]
        ),
    )
