"""Sample of the pieces of a long record: the total of a quantity over all pieces, with its error, from a few of them.

The sizes x_j of all pieces are known, and the quantity y_j, which is nearly in proportion to them, of the chosen ones.
Pieces are drawn systematically in the order of their levels l_j, each with the probability p_j = m x_j/X; those that
would reach 1, and others that must be, are certain. With the known x'_j of any other size, as near to y_j as possible,

    Y = sum over certain y_j + X'_rest R,    R = sum (y_s/p_s)/sum (x'_s/p_s),
    Var Y = m/(2 (m - 1)) sum (d_(i+1) - d_i)^2,    d_i = sqrt(1 - p_i) (y_i - R x'_i)/p_i,

where neighbours in the order of level are compared, because the ratio y/x' may change with the level (a stratified
sample). The estimate has 2 (m - 1)^2/(3 m - 4) degrees of freedom.

Sources: Cochran, Sampling Techniques (1977), chapters 6, 8 and 9A; Wolter, Introduction to Variance Estimation (2007),
chapter 8; von Neumann et al., Annals of Mathematical Statistics 12 (1941) 153.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.special import stdtrit

from vehicle.signals.analysis.samples import Vector


class PieceSample(NamedTuple):
    """Pieces that are chosen from n, in the order of the record; (k,) each."""

    chosen: npt.NDArray[np.intp]
    """Numbers of the pieces."""
    probability: Vector
    """Probabilities p_s with which they are drawn; 1 for certain ones."""
    levels: Vector
    """Levels l_s by which they are ordered."""

    @property
    def drawn(self) -> npt.NDArray[np.bool_]:
        """Return True for pieces with a probability below 1."""
        return np.asarray(self.probability < 1.0)

    def total(self, values: Vector, sizes: Vector) -> tuple[float, Vector]:
        """Return the total Y and the residuals d_i of the drawn pieces in the order of level, (m,).

        Args:
            values: y_s of the chosen pieces; (k,).
            sizes: x'_j of all pieces; (n,).
        """
        drawn, size = self.drawn, sizes[self.chosen]
        certain = float(np.sum(values[~drawn]))
        if not drawn.any():
            return certain, np.zeros(0)
        remainder = float(np.sum(sizes) - np.sum(size[~drawn]))
        p, y, x = self.probability[drawn], values[drawn], size[drawn]
        ratio, scale = np.sum(y / p) / np.sum(x / p), remainder / np.sum(x / p)
        order = np.argsort(self.levels[drawn], kind="stable")
        return certain + remainder * float(ratio), (scale * np.sqrt(1.0 - p) * (y - ratio * x) / p)[order]


def half_interval(residuals: Vector) -> float:
    """Return half of the 95 % interval of a total, or of a function of totals, from its residuals; 0 without any."""
    m = residuals.size
    if m < 2:
        return 0.0
    variance = m / (2.0 * (m - 1)) * float(np.sum(np.diff(residuals) ** 2))
    return float(stdtrit(2.0 * (m - 1) ** 2 / (3.0 * m - 4.0), 0.975)) * float(np.sqrt(variance))


def sample_pieces(sizes: Vector, levels: Vector, count: int, always: npt.NDArray[np.bool_]) -> PieceSample:
    """Return a sample of pieces.

    Args:
        sizes: sizes x_j of all pieces, at least 0; (n,).
        levels: levels l_j of all pieces; (n,).
        count: number m of pieces to draw beside the certain ones.
        always: True for pieces that must be in the sample; (n,).
    """
    certain = np.array(always)
    while True:
        remainder = np.flatnonzero(~certain)
        total = np.sum(sizes[remainder])
        probability = count * sizes / total if total > 0.0 else np.ones(sizes.size)
        if remainder.size <= count or not np.any(large := probability[remainder] >= 1.0):
            break
        certain[remainder[large]] = True
    probability[certain if remainder.size > count else slice(None)] = 1.0
    if remainder.size <= count:
        return PieceSample(np.arange(sizes.size), probability, levels)
    # Systematic: the total size has m equal parts, and the piece at the middle of each is drawn.
    order = remainder[np.argsort(levels[remainder], kind="stable")]
    drawn = order[np.searchsorted(np.cumsum(probability[order]), np.arange(count) + 0.5)]
    chosen = np.sort(np.concatenate([np.flatnonzero(certain), drawn]))
    return PieceSample(chosen, probability[chosen], levels[chosen])
