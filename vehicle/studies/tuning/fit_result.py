"""What a fit found, how far to trust it, and the statistics of its residuals, which lie in rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.model.parameters.ranges import Range
from vehicle.studies.tuning.identifiability import Unidentified

Vector = npt.NDArray[np.float64]


SURE = 2.0
"""A correlation of neighbours counts from this many of its own standard errors 1/sqrt(n) on, n values of all rows."""

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
        inflation: (1 + rho) / (1 - rho) for a correlation rho of all rows of the target that counts, else 1: as many
            neighbours make one independent value.
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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TuningResult:
    """Fitted parameters with standard errors, correlation and residual statistics.

    Attributes:
        parameters: all that were given.
        values: path to fitted value; the start for those held.
        standard_errors: path to standard error, in the unit of the value; NaN for those held or at a bound.
        free: paths that were fitted and are not at a bound: rows of `correlation`.
        correlation: of the free ones, (p, p).
        unidentified: parameters that the data cannot tell; they were held at their start.
        at_bound: paths whose value ended at a bound: wrong bounds, or a model that cannot follow.
        condition: largest over smallest singular value of the weighted Jacobian, columns in half widths [-].
        rows: statistics of the residuals, row by row.
        before: root of the mean square of the weighted residuals at the start [-].
        after: the same at the fitted values; 1 where the residuals are as large as the noise found from them.
        cost: half the sum of squares of the weighted residuals.
        evaluations: of the model, those for the Jacobians included.
        converged: whether the iteration ended at a minimum.
        message: of the iteration.
        sensitivity: -(J' J)^-1 J' of the free ones, (p, residuals): d ln(value) / d (weighted residuals).
        weights: of the residuals, one for each row: 1 / (assumed standard deviation times its scale).
    """

    parameters: tuple[Range, ...]
    values: Mapping[str, float]
    standard_errors: Mapping[str, float]
    free: tuple[str, ...]
    correlation: Vector
    unidentified: tuple[Unidentified, ...]
    at_bound: tuple[str, ...]
    condition: float
    rows: tuple[RowStatistics, ...]
    before: float
    after: float
    cost: float
    evaluations: int
    converged: bool
    message: str
    sensitivity: Vector
    weights: Vector

    def deviation(self, path: str, value: float) -> float:
        """(fitted - value) of a parameter over its standard error [-]."""
        return (self.values[path] - value) / self.standard_errors[path]

    def shift(self, residuals: Vector) -> dict[str, float]:
        """Gauss-Newton step of the free parameters for given residuals.

        Args:
            residuals: without the weights, in the order of the targets and their rows, (residuals,).

        Returns:
            Path to step of ln(value).
        """
        step = self.sensitivity @ (residuals * self.weights)
        return {path: float(one) for path, one in zip(self.free, step, strict=True)}


def target_statistics(names: Sequence[str], rows: Sequence[Vector], freedom: float) -> tuple[RowStatistics, ...]:
    """Return the statistics of the rows of one target.

    Neighbours are taken as an autoregression of first order, whose mean over n values varies like that of
    n (1 - rho) / (1 + rho) independent ones. One rho for all rows, since one estimator or filter made all of them: that
    of a single short row would scatter and with it the weights.

    Args:
        names: what each row is.
        rows: residuals, zero where a value does not count; (n,) each.
        freedom: degrees of freedom of all residuals over their number [-].

    Returns:
        One for each row; `neighbours` is that of the row, `inflation` that of all.

    Source: Bartlett, On the theoretical specification and sampling properties of autocorrelated time-series, Journal of
    the Royal Statistical Society B 8, 1946.
    """
    values = [row[row != 0.0] for row in rows]
    own = [float(np.sum(one[1:] * one[:-1]) / np.sum(one**2)) if one.size >= LEAST_VALUES else 0.0 for one in values]
    counts = np.array([one.size if one.size >= LEAST_VALUES else 0 for one in values])
    total = int(counts.sum())
    inflation = 1.0
    if total:
        shared = float(counts @ own) / total
        if shared * np.sqrt(total) > SURE:
            shared = min(shared, 0.98)
            inflation = (1.0 + shared) / (1.0 - shared)
    return tuple(
        RowStatistics(
            name=name,
            count=int(one.size),
            mean=float(np.mean(one)) if one.size else 0.0,
            rms=float(np.sqrt(np.mean(one**2) / freedom)) if one.size >= LEAST_VALUES else 1.0,
            neighbours=rho,
            inflation=inflation if one.size >= LEAST_VALUES else 1.0,
        )
        for name, one, rho in zip(names, values, own, strict=True)
    )
