"""Samples over ranges of parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from vehicle.errors import ConfigurationError
from vehicle.parameters.ranges import Range

Vector = npt.NDArray[np.float64]

METHODS = ("sobol", "lhs")


def sample(ranges: Sequence[Range], count: int, *, method: str = "sobol", seed: int = 0) -> Vector:
    """Points that fill the box of the ranges evenly; (count, ranges).

    Args:
        ranges: the parameters.
        count: number of points; a power of two keeps the balance of Sobol's sequence.
        method: "sobol" (scrambled) or "lhs" (Latin hypercube).
        seed: of the scrambling.

    Raises:
        ConfigurationError: an unknown method or fewer than two points.

    Source: scipy.stats.qmc.
    """
    if method not in METHODS:
        raise ConfigurationError(f"method: found {method!r}, allowed are {', '.join(METHODS)}")
    if count < 2 or not ranges:
        raise ConfigurationError(
            f"sample: found {count} points of {len(ranges)} parameters, needed are 2 and 1 or more"
        )
    kind = qmc.Sobol if method == "sobol" else qmc.LatinHypercube
    sampler = kind(d=len(ranges), rng=np.random.default_rng(seed))
    if method == "sobol":
        # Sobol's sequence is balanced at powers of two: draw the next one and keep the first points.
        points = sampler.random_base2(int(np.ceil(np.log2(count))))[:count]
    else:
        points = sampler.random(count)
    return np.asarray(qmc.scale(points, [r.low for r in ranges], [r.high for r in ranges]))
