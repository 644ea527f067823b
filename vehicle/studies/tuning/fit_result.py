"""Result of a fit: values, standard errors, correlation, and residual statistics row by row."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.model.parameters.ranges import Range
from vehicle.studies.tuning.identifiability import Unidentified
from vehicle.studies.tuning.response_delays import DelayRange

Unknown = Range | DelayRange
"""Unknown of a fit: a parameter of the model, or the delay of a group of channels."""


def known(value: float | None) -> float | None:
    """Return a number; None for a missing or infinite number and for NaN."""
    return value if value is not None and np.isfinite(value) else None


SURE = 2.0
"""Minimum significant correlation of neighbours, in standard errors 1/sqrt(n) of the correlation, n values of all rows.
"""

LEAST_VALUES = 8
"""Minimum number of values from which the scale of a row is estimated; a shorter row uses the assumed deviation."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RowStatistics:
    """Statistics of the residuals of one row over the assumed standard deviation."""

    name: str  # name of the row
    count: int  # number of included values
    mean: float  # mean of the residuals [-]
    # RMS of the residuals, corrected for the degrees of freedom of the parameters; 1 if the assumed deviation was right
    # [-]
    rms: float
    neighbours: float  # correlation of neighbouring samples, 0 for independent samples [-]
    # samples per independent value, (1 + rho) / (1 - rho) for a significant correlation rho of all rows of the target,
    # else 1 [-]
    inflation: float

    @property
    def scale(self) -> float:
        """Return the factor on the assumed standard deviation that weights a row by its independent values [-]."""
        return float(self.rms * np.sqrt(self.inflation))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class TuningResult:
    """Fitted parameters and delays with standard errors, correlation and residual statistics.

    Attributes:
        unknowns: parameters with bounds and start values, then delays.
        solution: path of an unknown to its value; the start value of a held one. Delays in s.
        standard_errors: path to standard error from noise alone, in the unit of the value: random residuals with the
            correlation of neighbours; NaN for an unknown held or at a bound.
        misfit_errors: path of a free unknown to its standard error with stretches of data as observations, which holds
            noise and the varying part of the misfit of the model, at least from noise alone; see `error_sources`.
        lag_shifts: path of a free unknown to its largest shift if one channel, or all, lag by half a sample; NaN for
            an unknown sampling interval.
        free: paths that were fitted and are not at a bound: rows of `correlation`.
        correlation: correlation of the free unknowns, (p, p).
        unidentified: unidentifiable parameters, held at their start values.
        at_bound: paths whose value ended at a bound: wrong bounds, or a model that cannot reproduce the data.
        condition: largest over smallest singular value of the weighted Jacobian, columns in half widths [-].
        rows: statistics of the residuals, row by row.
        before: root of the mean square of the weighted residuals at the start [-]. The weights follow from the
            residuals of this fit: compare fits by `TunedCar.total_error`, not by this number.
        after: root of the mean square at the fitted values [-]; 1 if the residuals are as large as the estimated noise.
        cost: half the sum of squares of the weighted residuals.
        evaluations: number of model evaluations, including those for the Jacobians.
        converged: True if the iteration ended at a minimum.
        message: message of the optimiser.
        sensitivity: -(J' J)^-1 J' of the free unknowns, (p, residuals): d u / d (weighted residuals).
        weights: weights of the residuals, (residuals,): 1 over the scale of the row.
    """

    unknowns: tuple[Unknown, ...]
    solution: Mapping[str, float]
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
    misfit_errors: Mapping[str, float]
    lag_shifts: Mapping[str, float]

    @property
    def parameters(self) -> tuple[Range, ...]:
        """Parameters of the model with bounds and start values."""
        return tuple(unknown for unknown in self.unknowns if isinstance(unknown, Range))

    @property
    def delays(self) -> tuple[DelayRange, ...]:
        """Return the delays of groups of channels."""
        return tuple(unknown for unknown in self.unknowns if isinstance(unknown, DelayRange))

    @cached_property
    def values(self) -> dict[str, float]:
        """Return the values of the parameters of the model by path."""
        return {parameter.path: self.solution[parameter.path] for parameter in self.parameters}

    def groups(self, target: int) -> dict[str, float]:
        """Return group of channels to fitted delay of a measurement [s]."""
        return {delay.group: self.solution[delay.path] for delay in self.delays if delay.target == target}

    @cached_property
    def errors(self) -> dict[str, float]:
        """Path to the standard error that is stated beside the value: that from noise and misfit."""
        return {**self.standard_errors, **self.misfit_errors}

    def deviation_of_u(self, path: str, errors: Mapping[str, float] | None = None) -> float:
        """Return the standard error of the coordinate u of an unknown [-]: relative for a parameter.

        Args:
            path: path of the unknown.
            errors: standard errors in the unit of the unknown; by default those from noise alone.
        """
        unknown = next(each for each in self.unknowns if each.path == path)
        return (errors or self.standard_errors)[path] / unknown.slope(self.solution[path])

    def __repr__(self) -> str:
        """Return the fitted values with their standard errors in a line."""
        values = [f"{path} {value:.5g} +- {number(self.errors[path], 2)}" for path, value in self.solution.items()]
        return f"TuningResult({'; '.join(values)})"

    def deviation(self, path: str, value: float) -> float:
        """Return (fitted - value) of an unknown over its standard error [-]."""
        return (self.solution[path] - value) / self.standard_errors[path]

    def shift(self, residuals: Vector) -> dict[str, float]:
        """Return path to Gauss-Newton step of u of the free unknowns.

        Args:
            residuals: unweighted residuals in the order of the targets and their rows, (residuals,).
        """
        step = self.sensitivity @ (residuals * self.weights)
        return {path: float(component) for path, component in zip(self.free, step, strict=True)}


def target_statistics(names: Sequence[str], rows: Vector, freedom: float) -> tuple[RowStatistics, ...]:
    """Return the statistics of the rows of one target.

    The residuals are modelled as a first-order autoregression, whose mean over n values varies like the mean of
    n (1 - rho) / (1 + rho) independent values. All rows share one rho, because one estimator or filter made all rows;
    the rho of a single short row would scatter, and so would the weights.

    Args:
        rows: residuals, zero where a value is excluded; (rows, n).
        freedom: degrees of freedom of all residuals over their number [-].

    Returns:
        Statistics of each row; `neighbours` is computed from the row, `inflation` from all rows.

    Source: Bartlett, On the theoretical specification and sampling properties of autocorrelated time-series, Journal of
    the Royal Statistical Society B 8, 1946.
    """
    values = [row[row != 0.0] for row in rows]
    correlations = [
        float(np.sum(residuals[1:] * residuals[:-1]) / np.sum(residuals**2)) if residuals.size >= LEAST_VALUES else 0.0
        for residuals in values
    ]
    counts = np.array([residuals.size if residuals.size >= LEAST_VALUES else 0 for residuals in values])
    total = int(counts.sum())
    inflation = 1.0
    if total:
        shared = float(counts @ correlations) / total
        if shared * np.sqrt(total) > SURE:
            shared = min(shared, 0.98)
            inflation = (1.0 + shared) / (1.0 - shared)
    return tuple(
        RowStatistics(
            name=name,
            count=int(residuals.size),
            mean=float(np.mean(residuals)) if residuals.size else 0.0,
            rms=float(np.sqrt(np.mean(residuals**2) / freedom)) if residuals.size >= LEAST_VALUES else 1.0,
            neighbours=rho,
            inflation=inflation if residuals.size >= LEAST_VALUES else 1.0,
        )
        for name, residuals, rho in zip(names, values, correlations, strict=True)
    )
