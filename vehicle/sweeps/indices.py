"""Global sensitivity: variance-based indices (Sobol) and elementary effects (Morris), through SALib.

First-order index S1: share of the variance of y that x_i explains alone, Var(E[y|x_i]) / Var(y). Total index ST: share
with all interactions of x_i. Elementary effect: change of y over a step of x_i, mu* its mean size, sigma its scatter.

Sources: Saltelli et al., Comput. Phys. Commun. 181 (2010); Morris, Technometrics 33 (1991), with the mu* of Campolongo
et al. (2007).
"""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, DataError, MissingPartError
from vehicle.parameters.ranges import Range

Vector = npt.NDArray[np.float64]

CONFIDENCE = 0.95
RESAMPLES = 200
"""Bootstrap samples of a confidence interval: its half width is then known to about 5 %."""
MORRIS_LEVELS = 6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SobolIndices:
    """Sobol indices of one number.

    Attributes:
        paths: parameters.
        first, total: S1 and ST [-]; (p,).
        first_error, total_error: half widths of their 95 % intervals (bootstrap); (p,).
        drift: largest change of a total index from the first half of the sample to the whole [-].
    """

    paths: tuple[str, ...]
    first: Vector
    first_error: Vector
    total: Vector
    total_error: Vector
    drift: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MorrisEffects:
    """Elementary effects of one number, over the whole range of each parameter.

    Attributes:
        paths: parameters.
        mean_size: mu* [unit of the number]; (p,).
        mean_size_error: half width of its 95 % interval; (p,).
        mean: mu, with its sign; (p,).
        scatter: sigma; (p,).
    """

    paths: tuple[str, ...]
    mean_size: Vector
    mean_size_error: Vector
    mean: Vector
    scatter: Vector


def sobol_sample(ranges: Sequence[Range], base: int, *, seed: int = 0) -> Vector:
    """Saltelli's sample for `sobol_indices`; (base (p + 2), p).

    Args:
        ranges: the parameters.
        base: number of base points, a power of two.
        seed: of the scrambling.

    Raises:
        ConfigurationError: `base` is no power of two.
        MissingPartError: SALib is not installed.
    """
    if base < 2 or base & (base - 1):
        raise ConfigurationError(
            f"base points: found {base}, must be a power of two (Sobol's sequence is balanced there)"
        )
    draw = _salib("sample.sobol").sample
    return np.asarray(draw(_problem(ranges), base, calc_second_order=False, scramble=True, seed=seed))


def sobol_indices(ranges: Sequence[Range], values: npt.ArrayLike, *, seed: int = 0) -> SobolIndices:
    """Indices from the values at the points of `sobol_sample`.

    Args:
        ranges: the parameters.
        values: one number for each point.
        seed: of the bootstrap.

    Raises:
        DataError: a value is missing or all are equal.
        MissingPartError: SALib is not installed.
    """
    y = _checked(values, len(ranges) + 2)
    analyze = _salib("analyze.sobol").analyze

    def indices(part: Vector) -> Any:
        return analyze(
            _problem(ranges),
            part,
            calc_second_order=False,
            num_resamples=RESAMPLES,
            conf_level=CONFIDENCE,
            print_to_console=False,
            seed=seed,
        )

    whole = indices(y)
    # The points of one base point stand together, so the first half is a sample too.
    half = indices(y[: (len(y) // (len(ranges) + 2) // 2) * (len(ranges) + 2)])
    return SobolIndices(
        paths=tuple(r.path for r in ranges),
        first=np.asarray(whole["S1"]),
        first_error=np.asarray(whole["S1_conf"]),
        total=np.asarray(whole["ST"]),
        total_error=np.asarray(whole["ST_conf"]),
        drift=float(np.max(np.abs(np.asarray(whole["ST"]) - np.asarray(half["ST"])))),
    )


def morris_sample(ranges: Sequence[Range], trajectories: int, *, seed: int = 0) -> Vector:
    """Morris's trajectories for `morris_effects`; (trajectories (p + 1), p).

    Raises:
        MissingPartError: SALib is not installed.
    """
    draw = _salib("sample.morris").sample
    return np.asarray(draw(_problem(ranges), trajectories, num_levels=MORRIS_LEVELS, seed=seed))


def morris_effects(
    ranges: Sequence[Range], points: npt.ArrayLike, values: npt.ArrayLike, *, seed: int = 0
) -> MorrisEffects:
    """Elementary effects from the values at the points of `morris_sample`.

    Raises:
        DataError: a value is missing or all are equal.
        MissingPartError: SALib is not installed.
    """
    y = _checked(values, len(ranges) + 1)
    analyze = _salib("analyze.morris").analyze
    found: Any = analyze(
        _problem(ranges),
        np.asarray(points, dtype=float),
        y,
        num_levels=MORRIS_LEVELS,
        num_resamples=RESAMPLES,
        conf_level=CONFIDENCE,
        print_to_console=False,
        seed=seed,
    )
    return MorrisEffects(
        paths=tuple(r.path for r in ranges),
        mean_size=np.asarray(found["mu_star"], dtype=float),
        mean_size_error=np.asarray(found["mu_star_conf"], dtype=float),
        mean=np.asarray(found["mu"], dtype=float),
        scatter=np.asarray(found["sigma"], dtype=float),
    )


def latin_hypercube(ranges: Sequence[Range], count: int, *, seed: int = 0) -> Vector:
    """Points that fill the box of the ranges evenly, (count, ranges); arguments as of `sobol_sample`.

    Source: scipy.stats.qmc.
    """
    points = scipy.stats.qmc.LatinHypercube(d=len(ranges), rng=np.random.default_rng(seed)).random(count)
    return np.asarray(scipy.stats.qmc.scale(points, [one.low for one in ranges], [one.high for one in ranges]))


def _checked(values: npt.ArrayLike, group: int) -> Vector:
    y = np.asarray(values, dtype=float)
    if y.ndim != 1 or not y.size or y.size % group:
        raise DataError(f"values: found {y.size}, needed is a multiple of {group}: one for each point of the sample")
    missing = int(np.count_nonzero(~np.isfinite(y)))
    if missing:
        raise DataError(
            f"values: {missing} of {y.size} are missing (failed runs), and the indices need every point; look at the "
            "reasons in table.csv, narrow the ranges, or repeat with --retry-failed"
        )
    if float(np.ptp(y)) == 0.0:
        raise DataError("values: all are equal; none of the parameters changes them")
    return y


def _problem(ranges: Sequence[Range]) -> dict[str, Any]:
    return {
        "num_vars": len(ranges),
        "names": [r.path for r in ranges],
        "bounds": [[r.low, r.high] for r in ranges],
    }


def _salib(part: str) -> Any:
    try:
        return importlib.import_module(f"SALib.{part}")
    except ImportError:
        raise MissingPartError(
            "global sensitivity: needs SALib, of the extra 'sensitivity' (pip install SALib)"
        ) from None
