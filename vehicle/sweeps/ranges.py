"""Ranges of parameters, and samples over them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from vehicle.errors import ConfigurationError

Vector = npt.NDArray[np.float64]

METHODS = ("sobol", "lhs")


@dataclass(frozen=True, kw_only=True, slots=True)
class Range:
    """A parameter that varies between two values, evenly.

    Attributes:
        path: of the parameter, as "bushings.suspension_mount.stiffness.z".
        low, high: its limits.
        unit: of the parameter.
        reason: why these limits.
    """

    path: str
    low: float
    high: float
    unit: str
    reason: str

    def __post_init__(self) -> None:
        if not (np.isfinite([self.low, self.high]).all() and self.low < self.high):
            raise ConfigurationError(f"range of {self.path}: found {self.low!r} to {self.high!r}, must be ascending")


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
