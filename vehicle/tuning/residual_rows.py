"""Statistics of residuals that lie in rows: how large they are, and how much neighbours know of each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

SURE = 3.0
"""A correlation of neighbours counts from this many of its own standard errors 1/sqrt(n) on."""

LEAST_VALUES = 8
"""Values that a row must hold for its size to be found from them; a shorter one is taken as assumed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RowStatistics:
    """Residuals of one row over the standard deviation that was assumed for it.

    Attributes:
        name: what the row is.
        count: values that count.
        mean: [-].
        rms: of the residuals, freed from the share that the parameters took; 1 where the assumption was right.
        neighbours: correlation of neighbours, 0 where they know nothing of each other.
        inflation: (1 + rho) / (1 - rho) for a correlation rho that counts, else 1: as many neighbours make one
            independent value.
    """

    name: str
    count: int
    mean: float
    rms: float
    neighbours: float
    inflation: float

    @property
    def scale(self) -> float:
        """What the assumed standard deviation has to be multiplied by for the sum of squares of the row to count as its
        independent values do."""
        return float(self.rms * np.sqrt(self.inflation))


def row_statistics(name: str, row: Vector, freedom: float) -> RowStatistics:
    """Statistics of one row.

    Neighbours are taken as an autoregression of first order, whose mean over n values varies like that of
    n (1 - rho) / (1 + rho) independent ones.

    Args:
        name: what the row is.
        row: residuals, zero where a value does not count; (n,).
        freedom: degrees of freedom of all residuals over their number [-].

    Returns:
        The statistics.

    Source: Bartlett, On the theoretical specification and sampling properties of autocorrelated time-series, Journal of
    the Royal Statistical Society B 8, 1946.
    """
    counts = row != 0.0
    values = row[counts]
    if values.size < LEAST_VALUES:
        mean = float(np.mean(values)) if values.size else 0.0
        return RowStatistics(name=name, count=int(values.size), mean=mean, rms=1.0, neighbours=0.0, inflation=1.0)
    square = float(np.sum(values**2))
    neighbours = float(np.sum(values[1:] * values[:-1]) / square)
    bounded = float(np.clip(neighbours, 0.0, 0.98))
    inflation = (1.0 + bounded) / (1.0 - bounded) if bounded * np.sqrt(values.size) > SURE else 1.0
    return RowStatistics(
        name=name,
        count=int(values.size),
        mean=float(np.mean(values)),
        rms=float(np.sqrt(square / (values.size * freedom))),
        neighbours=neighbours,
        inflation=inflation,
    )
