"""Global sensitivity: variance-based indices (Sobol).

First-order index S1: share of the variance of y due to x_i without interactions, Var(E[y|x_i]) / Var(y). Total index
ST: share with all interactions of x_i.

With base points a and b, ab_i = a with coordinate i of b, y centred at its mean and V its variance,

    S1_i = mean(y(b) (y(ab_i) - y(a))) / V,     ST_i = mean((y(a) - y(ab_i))^2) / (2 V)

The base points are R independent scramblings of the Sobol sequence. The points of one scrambling depend on each other,
so a bootstrap over points does not give the error of the estimate; the scramblings are independent. The interval uses
Student's t with R - 1 degrees of freedom and the jackknife error over the scramblings (each left out once). A failed
run excludes its base point, with the p + 2 runs of this point.

Sources: Saltelli et al., Comput. Phys. Commun. 181 (2010); L'Ecuyer, Randomized quasi-Monte Carlo (2018): independent
replicates; Efron and Tibshirani, An Introduction to the Bootstrap (1993), chapter 11.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.ranges import Range

CONFIDENCE = 0.95
SCRAMBLINGS = 16
"""Maximum number of independent scramblings. With 15 degrees of freedom an interval is 9 % wider than with many."""
POINTS = 4
"""Minimum number of base points of a scrambling."""
LEAST_BASE = 64
"""Minimum number of base points. Measured with the Ishigami function, g-functions of 4 and 8 parameters and linear
functions: 95 % of all errors are below 0.36, and the intervals contain 92 to 96 % of the indices. With 32 points an
error reaches 0.5, with 16 an interval of +-0.9 is wider than the range of an index, 0 to 1."""
LEAST_LEFT = 0.5
"""Minimum share of the base points without a failed run."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SobolIndices:
    """Sobol indices of a quantity.

    Attributes:
        paths: paths of the parameters.
        first, total: S1 and ST [-]; (p,).
        first_error, total_error: half widths of their 95 % intervals (jackknife over the scramblings); (p,).
        drift: largest change of a total index from the first half of the scramblings to the whole sample [-].
        scramblings: number of independent scramblings.
        base: number of base points.
        left_out: number of excluded base points, which have a failed run.
        contradictions: indices that violate 0 <= S1 <= ST <= 1 by more than their error (jackknife, at 95 % for all
            differences together), in words.
    """

    paths: tuple[str, ...]
    first: Vector
    first_error: Vector
    total: Vector
    total_error: Vector
    drift: float
    scramblings: int
    base: int
    left_out: int
    contradictions: tuple[str, ...]


def sobol_sample(ranges: Sequence[Range], base: int, *, seed: int = 0) -> Vector:
    """Return Saltelli's sample for `sobol_indices`, one scrambling after the other; (base (p + 2), p).

    Args:
        ranges: parameters with bounds.
        base: number of base points, a power of two, at least `LEAST_BASE`.
        seed: seed of the scramblings.
    """
    if base < 1 or base & (base - 1):
        raise ConfigurationError(
            f"base points: found {base}, must be a power of two (a Sobol sequence of this length is balanced), "
            f"at least {LEAST_BASE}"
        )
    if base < LEAST_BASE:
        raise ConfigurationError(
            f"base points: found {base}, must be at least {LEAST_BASE}: with fewer, the error of an index (0 to 1) "
            "can exceed 0.5"
        )
    count, size, blocks = _scramblings(base), len(ranges), []
    # Children of one seed are independent of each other and of those of every other seed.
    seeds = np.random.SeedSequence(seed).generate_state(count)
    for child in seeds:
        both = scipy.stats.qmc.Sobol(2 * size, scramble=True, seed=int(child)).random(base // count)
        a, b = both[:, None, :size], both[:, None, size:]
        # One coordinate of b in a after the other: p rows between a and b.
        blocks.append(np.concatenate([a, np.where(np.eye(size, dtype=bool), b, a), b], axis=1).reshape(-1, size))
    return _scaled(np.concatenate(blocks), ranges)


def _scramblings(base: int) -> int:
    """Return the number of scramblings of a sample with `base` points."""
    return min(SCRAMBLINGS, max(base // POINTS, 2))


def _contradictions(ranges: Sequence[Range], whole: Vector, without: Vector) -> tuple[str, ...]:
    """Return the violations of 0 <= S1 <= ST <= 1 in words, see `SobolIndices.contradictions`.

    Args:
        whole: S1 and ST of the sample; (2, p).
        without: S1 and ST without each scrambling; (replicates, 2, p).
    """

    def margins(shares: Vector) -> Vector:
        """Return S1 - 0, ST - S1 and 1 - ST; (..., 3, p)."""
        first, total = shares[..., 0, :], shares[..., 1, :]
        return np.stack([first, total - first, 1.0 - total], axis=-2)

    margin, deviation = margins(whole), _deviation(margins(without))
    level = (1.0 - CONFIDENCE) / margin.size
    below = margin + scipy.stats.t.ppf(1.0 - level, len(without) - 1) * deviation < 0.0
    violations = ("S1 is below 0", "S1 is above ST", "ST is above 1")
    return tuple(
        f"{ranges[at].path}: {violations[which]} by more than its error (S1 {whole[0, at]:.3f}, ST {whole[1, at]:.3f})"
        for which, at in zip(*np.nonzero(below), strict=True)
    )


def _deviation(without: Vector) -> Vector:
    """Return the jackknife standard error of estimates without each replicate; (replicates, ...)."""
    replicates = len(without)
    return np.asarray(np.sqrt((replicates - 1) / replicates * np.sum((without - without.mean(axis=0)) ** 2, axis=0)))


def sobol_indices(ranges: Sequence[Range], values: npt.ArrayLike) -> SobolIndices:
    """Return the indices from the values at the points of `sobol_sample`.

    Args:
        values: value of the quantity at each point, NaN for a failed run.
    """
    y = _table(values, len(ranges) + 2)
    base, count = len(y), _scramblings(len(y))
    finite = np.isfinite(y).all(axis=1)
    group = np.repeat(np.arange(count), base // count)
    left = base - int(np.count_nonzero(finite))
    if left > (1.0 - LEAST_LEFT) * base or len(np.unique(group[finite])) < 2:
        raise DataError(
            f"values: {left} of {base} base points have a failed run or no value, but at most half may have none; "
            "table.csv "
            "has the reasons: narrow the ranges, or repeat with --retry-failed"
        )
    y, group = y[finite], group[finite]
    whole = _indices(y)
    without = np.array([_indices(y[group != excluded]) for excluded in np.unique(group)])
    replicates = len(without)
    width = scipy.stats.t.ppf(0.5 + 0.5 * CONFIDENCE, replicates - 1) * _deviation(without)
    return SobolIndices(
        paths=tuple(r.path for r in ranges),
        first=whole[0],
        first_error=width[0],
        total=whole[1],
        total_error=width[1],
        drift=float(np.max(np.abs(whole[1] - _indices(y[group < count // 2])[1])))
        if np.any(group < count // 2)
        else 0.0,
        scramblings=replicates,
        base=base,
        left_out=left,
        contradictions=_contradictions(ranges, whole, without),
    )


def _indices(y: Vector) -> Vector:
    """Return S1 and ST of values (base points, p + 2) in the order a, ab_1 ... ab_p, b; (2, p)."""
    first, last = y[:, :1], y[:, -1:]
    middle = 0.5 * (first.mean() + last.mean())
    variance = 0.5 * (np.mean((first - middle) ** 2) + np.mean((last - middle) ** 2))
    change = y[:, 1:-1] - first
    shares = np.array([np.mean((last - middle) * change, axis=0), 0.5 * np.mean(change**2, axis=0)])
    return np.asarray(shares / variance)


def _scaled(points: Vector, ranges: Sequence[Range]) -> Vector:
    """Return points of the unit cube within the ranges."""
    low, high = (np.array([getattr(bounds, end) for bounds in ranges]) for end in ("low", "high"))
    return np.asarray(points * (high - low) + low)


def _table(values: npt.ArrayLike, group: int) -> Vector:
    """Check values and reshape them to rows of `group` values; (rows, group)."""
    y = np.asarray(values, dtype=float)
    if y.ndim != 1 or not y.size or y.size % group:
        raise DataError(f"values: found {y.size}, must be a multiple of {group}: one value for each point")
    if np.any(np.isfinite(y)) and float(np.nanmax(y) - np.nanmin(y)) == 0.0:
        raise DataError("values: all values are equal; vary a parameter with an effect")
    return y.reshape(-1, group)
