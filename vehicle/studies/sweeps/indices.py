"""Global sensitivity: variance-based indices (Sobol) and elementary effects (Morris).

First-order index S1: share of the variance of y due to x_i without interactions, Var(E[y|x_i]) / Var(y). Total index
ST: share with all interactions of x_i. Elementary effect: change of y over a step of x_i, mu* its mean absolute value,
sigma its standard deviation.

With base points a and b, ab_i = a with coordinate i of b, y centred at its mean and V its variance,

    S1_i = mean(y(b) (y(ab_i) - y(a))) / V,     ST_i = mean((y(a) - y(ab_i))^2) / (2 V)

The base points are R independent scramblings of the Sobol sequence. The points of one scrambling depend on each other,
so a bootstrap over points does not give the error of the estimate; the scramblings are independent. The interval is
that of Student's t with R - 1 degrees of freedom and the jackknife error over the scramblings (each left out once).
A failed run costs its base point, with the p + 2 runs of that point.

A trajectory of Morris starts at a point of a grid of L levels and moves one coordinate after the other, in random order
and direction, by L / (2 (L - 1)) of its range.

Sources: Saltelli et al., Comput. Phys. Commun. 181 (2010); L'Ecuyer, Randomized quasi-Monte Carlo (2018): independent
replicates; Efron and Tibshirani, An Introduction to the Bootstrap (1993), chapter 11; Morris, Technometrics 33 (1991),
with the mu* of Campolongo et al. (2007).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.ranges import Range

Vector = npt.NDArray[np.float64]

CONFIDENCE = 0.95
RESAMPLES = 200
"""Bootstrap samples for the interval of an elementary effect: the half width is then exact to about 5 %."""
SCRAMBLINGS = 16
"""Maximum number of independent scramblings. With 15 degrees of freedom an interval is 9 % wider than with many."""
POINTS = 4
"""Minimum number of base points of a scrambling, if there are enough for two scramblings."""
LEAST_LEFT = 0.5
"""Minimum share of the base points without a failed run."""
MORRIS_LEVELS = 6
MORRIS_STEP = MORRIS_LEVELS / (2.0 * (MORRIS_LEVELS - 1))


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MorrisEffects:
    """Elementary effects of a quantity, over the whole range of each parameter.

    Attributes:
        paths: paths of the parameters.
        mean_size: mean absolute effect mu* [unit of the quantity]; (p,).
        mean_size_error: half width of the 95 % interval of mu*; (p,).
        mean: mean effect mu; (p,).
        scatter: standard deviation sigma of the effects; (p,).
    """

    paths: tuple[str, ...]
    mean_size: Vector
    mean_size_error: Vector
    mean: Vector
    scatter: Vector


def sobol_sample(ranges: Sequence[Range], base: int, *, seed: int = 0) -> Vector:
    """Return Saltelli's sample for `sobol_indices`, one scrambling after the other; (base (p + 2), p).

    Args:
        ranges: parameters with bounds.
        base: number of base points, a power of two.
        seed: seed of the scramblings.

    Raises:
        ConfigurationError: `base` is no power of two.
    """
    if base < 2 or base & (base - 1):
        raise ConfigurationError(
            f"base points: found {base}, must be a power of two (a Sobol sequence of this length is balanced)"
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


def sobol_indices(ranges: Sequence[Range], values: npt.ArrayLike) -> SobolIndices:
    """Return the indices from the values at the points of `sobol_sample`.

    Args:
        ranges: the parameters.
        values: value of the quantity at each point, NaN for a failed run.

    Raises:
        DataError: too many values are missing, or all are equal.
    """
    y = _table(values, len(ranges) + 2)
    base, count = len(y), _scramblings(len(y))
    finite = np.isfinite(y).all(axis=1)
    group = np.repeat(np.arange(count), base // count)
    left = base - int(np.count_nonzero(finite))
    if left > (1.0 - LEAST_LEFT) * base or len(np.unique(group[finite])) < 2:
        raise DataError(
            f"values: {left} of {base} base points have a failed run, must be at most half; see the reasons in "
            "table.csv, narrow the ranges, or repeat with --retry-failed"
        )
    y, group = y[finite], group[finite]
    whole = _indices(y)
    without = np.array([_indices(y[group != excluded]) for excluded in np.unique(group)])
    replicates = len(without)
    deviation = np.sqrt((replicates - 1) / replicates * np.sum((without - without.mean(axis=0)) ** 2, axis=0))
    width = scipy.stats.t.ppf(0.5 + 0.5 * CONFIDENCE, replicates - 1) * deviation
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
    )


def _indices(y: Vector) -> Vector:
    """Return S1 and ST of values (base points, p + 2) in the order a, ab_1 ... ab_p, b; (2, p)."""
    first, last = y[:, :1], y[:, -1:]
    middle = 0.5 * (first.mean() + last.mean())
    variance = 0.5 * (np.mean((first - middle) ** 2) + np.mean((last - middle) ** 2))
    change = y[:, 1:-1] - first
    shares = np.array([np.mean((last - middle) * change, axis=0), 0.5 * np.mean(change**2, axis=0)])
    return np.asarray(shares / variance)


def morris_sample(ranges: Sequence[Range], trajectories: int, *, seed: int = 0) -> Vector:
    """Return the trajectories of Morris for `morris_effects`; (trajectories (p + 1), p)."""
    generator, size, points = np.random.default_rng(seed), len(ranges), []
    for _ in range(trajectories):
        order = np.eye(size)
        generator.shuffle(order)
        direction = generator.choice([-1, 1], size)
        start = generator.choice(np.linspace(0.0, 1.0 - MORRIS_STEP, MORRIS_LEVELS // 2), size)
        moved = np.tril(np.ones((size + 1, size)), -1) @ order.T
        points.append(start + MORRIS_STEP / 2.0 * ((2.0 * moved - 1.0) * direction + 1.0))
    return _scaled(np.concatenate(points), ranges)


def morris_effects(
    ranges: Sequence[Range], points: npt.ArrayLike, values: npt.ArrayLike, *, seed: int = 0
) -> MorrisEffects:
    """Return the elementary effects from the values at the points of `morris_sample`.

    Raises:
        DataError: a value is missing or all are equal.
    """
    size = len(ranges)
    changes = np.diff(_checked(values, size + 1).reshape(-1, size + 1), axis=1)
    # Each step of a trajectory moves one coordinate; (trajectories, steps, coordinates).
    moves = np.sign(np.diff(np.asarray(points, dtype=float).reshape(-1, size + 1, size), axis=1))
    effects = np.einsum("ts,tsc->ct", changes, moves) / MORRIS_STEP
    sizes, generator = np.abs(effects), np.random.default_rng(seed)
    count = sizes.shape[1]
    means = np.array([row[generator.integers(count, size=(RESAMPLES, count))].mean(axis=1) for row in sizes])
    return MorrisEffects(
        paths=tuple(r.path for r in ranges),
        mean_size=sizes.mean(axis=1),
        mean_size_error=scipy.stats.norm.ppf(0.5 + 0.5 * CONFIDENCE) * means.std(axis=1, ddof=1),
        mean=effects.mean(axis=1),
        scatter=effects.std(axis=1, ddof=1),
    )


def _scaled(points: Vector, ranges: Sequence[Range]) -> Vector:
    """Return points of the unit cube within the ranges."""
    low, high = (np.array([getattr(bounds, end) for bounds in ranges]) for end in ("low", "high"))
    return np.asarray(points * (high - low) + low)


def latin_hypercube(ranges: Sequence[Range], count: int, *, seed: int = 0) -> Vector:
    """Return a Latin hypercube sample within the ranges, (count, ranges), by scipy.stats.qmc."""
    points = scipy.stats.qmc.LatinHypercube(d=len(ranges), rng=np.random.default_rng(seed)).random(count)
    return np.asarray(
        scipy.stats.qmc.scale(points, [bounds.low for bounds in ranges], [bounds.high for bounds in ranges])
    )


def _table(values: npt.ArrayLike, group: int) -> Vector:
    """Check values and reshape them to rows of `group` values; (rows, group)."""
    y = np.asarray(values, dtype=float)
    if y.ndim != 1 or not y.size or y.size % group:
        raise DataError(f"values: found {y.size}, must be a multiple of {group}: one value for each point")
    if np.any(np.isfinite(y)) and float(np.nanmax(y) - np.nanmin(y)) == 0.0:
        raise DataError("values: all values are equal; vary a parameter with an effect")
    return y.reshape(-1, group)


def _checked(values: npt.ArrayLike, group: int) -> Vector:
    """Check that no value is missing, and return the values as an array."""
    y = _table(values, group).ravel()
    missing = int(np.count_nonzero(~np.isfinite(y)))
    if missing:
        raise DataError(
            f"values: {missing} of {y.size} are missing (failed runs), and the effects need every point; see the "
            "reasons in table.csv, narrow the ranges, or repeat with --retry-failed"
        )
    return y
