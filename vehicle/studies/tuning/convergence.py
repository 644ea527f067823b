"""Convergence of Markov chains: rank-normalised split R-hat and effective sample size.

Source: Vehtari, Gelman, Simpson, Carpenter, Buerkner, Rank-normalization, folding, and localization: an improved R-hat
for assessing convergence of MCMC, Bayesian Analysis 16 (2021), 667-718, equations 1 to 14.
"""

import numpy as np
import scipy

from vehicle.arrays import Vector


def rank_normalised(chains: Vector) -> Vector:
    """Return normal scores z = Phi^-1((r - 3/8) / (S + 1/4)) of the ranks r among all S samples, shape as `chains`."""
    ranks = scipy.stats.rankdata(chains).reshape(chains.shape)
    return np.asarray(scipy.special.ndtri((ranks - 0.375) / (chains.size + 0.25)))


def r_hat(chains: Vector) -> float:
    """Return the larger of the rank-normalised split R-hat of samples, (chains, n), and of |sample - median|.

    R-hat^2 = ((N - 1) / N W + B / N) / W with W the mean variance within a half chain and B the variance between them.

    Returns:
        R-hat [-]; infinite for chains without variance.
    """
    halves = _halves(chains)
    return max(_split_r_hat(rank_normalised(part)) for part in (halves, np.abs(halves - np.median(halves))))


def effective_samples(chains: Vector) -> float:
    """Return the bulk effective size S / (1 + 2 sum rho_t) [-] of samples, (chains, n)."""
    scores = rank_normalised(_halves(chains))
    count, length = scores.shape
    centred = scores - scores.mean(axis=1, keepdims=True)
    spectrum = np.fft.rfft(centred, 2 * length, axis=1)
    autocovariance = np.fft.irfft(np.abs(spectrum) ** 2, axis=1)[:, :length] / length
    within = float(np.mean(autocovariance[:, 0]) * length / (length - 1))
    total = within * (length - 1) / length + float(np.var(scores.mean(axis=1), ddof=1))
    rho = 1.0 - (within - np.mean(autocovariance, axis=0) * length / (length - 1)) / total
    rho[0] = 1.0
    pairs = rho[: length - length % 2].reshape(-1, 2).sum(axis=1)
    positive = pairs[: int(np.argmax(pairs < 0.0))] if np.any(pairs < 0.0) else pairs
    tau = max(2.0 * float(np.sum(np.minimum.accumulate(positive))) - 1.0, 1.0 / np.log10(count * length))
    return float(count * length / tau)


def _halves(chains: Vector) -> Vector:
    """Return the first and second halves of all chains, (2 chains, n // 2)."""
    half = chains.shape[1] // 2
    return np.concatenate([chains[:, :half], chains[:, -half:]])


def _split_r_hat(scores: Vector) -> float:
    length = scores.shape[1]
    within = float(np.mean(np.var(scores, axis=1, ddof=1)))
    between = float(np.var(scores.mean(axis=1), ddof=1))
    return float(np.sqrt(((length - 1) / length * within + between) / within)) if within > 0.0 else float("inf")
