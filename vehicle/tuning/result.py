"""What a fit found, and how far to trust it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.parameters.ranges import Range
from vehicle.tuning.identifiability import Unidentified
from vehicle.tuning.residual_rows import RowStatistics

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TuningResult:
    """Fitted values with their uncertainty.

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
