"""Weighted least squares over any number of measurements, with standard errors and identifiability.

    minimise  sum over rows of  (r / scale)^2,   r = residuals over their assumed deviation,  u = ln(value / start)

A first, coarse iteration uses the assumed deviations. Then the scale of each row is estimated from the residuals of the
row (RMS, and correlation of neighbouring samples) and the fit is repeated with these scales: assumed deviations only
have to be right within a row. The covariance of u is (J' J)^-1 C (J' J)^-1 with the residuals over their scale and
C = sum rho_ij J_i' J_j, where rho_ij is the correlation of rows i and j of a measurement. It covers the identifiable
parameters; the other parameters are held at their start. Delays of groups of channels are further unknowns, with
u = (delay - start) / 1 ms. See `error_sources` for the effect of other causes than noise.

Source of the covariance: Zellner, Journal of the American Statistical Association 57 (1962): equations whose errors are
correlated.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError, SimulationError
from vehicle.model.parameters.ranges import Range, checked_ranges
from vehicle.studies.tuning.error_sources import lag_shifts, misfit_errors
from vehicle.studies.tuning.fit_result import RowStatistics, TuningResult, Unknown, target_statistics
from vehicle.studies.tuning.identifiability import Unidentified, covariance, worst_direction
from vehicle.studies.tuning.response_delays import DelayRange
from vehicle.studies.tuning.target import Target
from vehicle.threads import one_blas_thread

COARSE_STEP, STEP = 0.1, 1e-3
"""Steps of ln(value) for difference quotients. The coarse step is for values far from the minimum, where slips that
appear and vanish make the sum of squares rough. The fine step leaves a second-order error of a thousandth."""

NEAR_STEP = 1e-5
"""Step of ln(value) of a fit that begins at a solution in other coordinates: of m r2 in a moment about the origin 1e-3
is up to a hundredth of the moment about the centre of gravity, and a quotient over it was wrong by 40 %."""

SMALLEST_STEP = 1e-6
"""Step of ln(value) below which a difference quotient is not halved further where its model is impossible."""

COARSE, FINE = 1e-2, 1e-5
"""Relative changes of the sum of squares at which an iteration ends. The coarse iteration only estimates the sizes of
the residuals. In a fine iteration the sum of squares then changes by far less than 1, the change due to one standard
error, for the thousands of values of a measurement."""

FAR = 10.0
"""Predicted reduction of the sum of squares, over its final tolerance, above which a fit beside impossible models has
not reached the minimum."""

STEADY = 1.3
"""Maximum factor by which the scales of the rows may change in the last iteration."""

MOST_ROUNDS, MOST_ITERATIONS = 8, 40
"""Maximum number of solutions with new scales, and of iterations of each solution."""

REGULARISATION = 1e-3
"""Weight of |u| in half widths of the bounds during the iterations. It moves an identifiable value by a millionth of
the standard error, and keeps an unidentifiable value from running away."""

AT_BOUND = 1e-4
"""Distance from a bound, in half widths, below which a value counts as at the bound."""


@one_blas_thread()
def fit(
    parameters: Sequence[Range],
    targets: Sequence[Target],
    build: Callable[[Mapping[str, float]], Any],
    *,
    delays: Sequence[DelayRange] = (),
    begin: Mapping[str, float] | None = None,
    progress: Callable[[int, float], None] | None = None,
) -> TuningResult:
    """Fit parameters to measurements by weighted least squares.

    Args:
        parameters: parameters with bounds and start values.
        targets: measurements; the weights are estimated from the residuals of each row.
        build: function of {path: value} that returns the model for `Target.response`.
        delays: delays of groups of channels of a `Target`, further unknowns.
        begin: path to value of a previous fit, within the bounds, at which the iteration begins with `NEAR_STEP`; by
            default it begins at the start values.
        progress: called with the number of evaluations and the root of the mean square of the weighted residuals.

    Returns:
        Fitted values with standard errors, correlation and residual statistics.

    Raises:
        ConfigurationError: no parameter or target, a parameter twice, or more parameters than values.
        SimulationError: the model gives residuals that are not finite.
    """
    problem = _Problem((*checked_ranges(parameters), *delays), targets, build, progress)
    start = problem.residuals(np.zeros(len(problem.unknowns)))
    problem.weights = np.ones(start.size)
    begun = [unknown.coordinate((begin or {}).get(unknown.path, unknown.start)) for unknown in problem.unknowns]
    problem.step = NEAR_STEP if begin else COARSE_STEP
    point, answer = problem.solve(np.array(begun), COARSE)
    held: list[Unidentified] = []
    problem.step = NEAR_STEP if begin else STEP
    rounds = 0
    while True:
        raw = problem.residuals(point)
        before = problem.weights
        problem.use_scales(problem.statistics(raw, len(problem.free)))
        steady = rounds > 0 and bool(np.max(np.abs(np.log(problem.weights / before))) < np.log(STEADY))
        inner = problem.inside(point)
        jacobian = problem.jacobian(point, inner)
        undetermined = _open_directions(jacobian, [problem.unknowns[index] for index in inner])
        if (steady or rounds >= MOST_ROUNDS) and not undetermined:
            break
        held += undetermined
        problem.hold([parameter.path for parameter in undetermined], point)
        if not problem.free:
            raise ConfigurationError(
                "the data determine no parameter: " + "; ".join(parameter.message() for parameter in held)
            )
        point, answer = problem.solve(point, FINE)
        rounds += 1
    return problem.result(point, start, raw, inner, jacobian, tuple(held), answer)


def _open_directions(jacobian: Vector, parameters: list[Unknown]) -> list[Unidentified]:
    """Return parameters to hold, in the order of selection, so that all remaining directions are identifiable."""
    held: list[Unidentified] = []
    left = list(range(len(parameters)))
    while left:
        worst = worst_direction(jacobian[:, left], [parameters[index] for index in left])
        if worst is None:
            break
        held.append(worst)
        left = [index for index in left if parameters[index].path != worst.path]
    return held


class _ImpossibleModelError(ConfigurationError):
    """The values of a trial, each within its bounds, together make no model."""


class _Problem:
    """Residuals and Jacobian over u = ln(value / start), with a count of the evaluations."""

    def __init__(
        self,
        unknowns: tuple[Unknown, ...],
        targets: Sequence[Target],
        build: Callable[[Mapping[str, float]], Any],
        progress: Callable[[int, float], None] | None,
    ) -> None:
        if not targets:
            raise ConfigurationError("targets: the measurement is missing; give at least one")
        self.unknowns, self.targets, self.progress = unknowns, targets, progress
        self.build = build
        self.step = COARSE_STEP
        self.free = list(range(len(unknowns)))
        self.responses: dict[tuple[float, ...], list[Any]] = {}
        self.shapes: list[tuple[int, ...]] = []  # rows and samples of the residuals of each target
        self.weights = np.ones(1)
        self.scaled: tuple[RowStatistics, ...] = ()
        self.evaluations = 0
        self.last: tuple[bytes, Vector] | None = None

    def values(self, point: Vector) -> dict[str, float]:
        """Return path to value at a point u."""
        return {unknown.path: unknown.value(float(u)) for unknown, u in zip(self.unknowns, point, strict=True)}

    def groups(self, target: int, values: Mapping[str, float]) -> dict[str, float]:
        """Return group to delay of a measurement [s]."""
        delays = [unknown for unknown in self.unknowns if isinstance(unknown, DelayRange) and unknown.target == target]
        return {delay.group: values[delay.path] for delay in delays}

    def response(self, values: Mapping[str, float]) -> list[Any]:
        """Return the response of the model for each target."""
        parameters = {unknown.path: values[unknown.path] for unknown in self.unknowns if isinstance(unknown, Range)}
        key = tuple(parameters.values())
        if key not in self.responses:
            try:
                model = self.build(parameters)
                self.responses = {key: [target.response(model) for target in self.targets]}
            except (ConfigurationError, DataError) as error:
                # Each value may lie within its bounds, but not all together: a mass beside moments about the origin.
                raise _ImpossibleModelError(str(error)) if self.evaluations else error from None
            self.evaluations += 1
        return self.responses[key]

    def joined(self, values: Mapping[str, float], lags: Mapping[str, float] | None = None) -> Vector:
        """Return the residuals of all rows before scaling, (n,), with further delays by channel [s]."""
        tables = [
            target.misfit(response, self.groups(number, values), lags or {})
            for number, (target, response) in enumerate(zip(self.targets, self.response(values), strict=True))
        ]
        self.shapes = [table.shape for table in tables]
        return np.concatenate([table.ravel() for table in tables])

    def tables(self, joined: Vector) -> list[Vector]:
        """Return values of all residuals, (n, ...), by target, (rows, samples, ...) each."""
        parts = np.split(joined, np.cumsum([rows * samples for rows, samples in self.shapes])[:-1])
        return [part.reshape(*shape, *joined.shape[1:]) for part, shape in zip(parts, self.shapes, strict=True)]

    def residuals(self, point: Vector) -> Vector:
        """Return the residuals of all rows before scaling, (n,)."""
        if self.last is not None and self.last[0] == point.tobytes():
            return self.last[1]
        joined = self.joined(self.values(point))
        if not np.isfinite(joined).all():
            text = ", ".join(f"{path}={value:.5g}" for path, value in self.values(point).items())
            raise SimulationError(f"the model gives no finite result at {text}; narrow the bounds")
        if joined.size < len(self.unknowns):
            raise ConfigurationError(
                f"found {joined.size} measured values for {len(self.unknowns)} parameters; use more data or "
                "fewer parameters"
            )
        self.last = (point.tobytes(), joined)
        return joined

    def statistics(self, raw: Vector, parameters: int) -> tuple[RowStatistics, ...]:
        """Return the statistics of all rows, with the degrees of freedom reduced by the number of parameters."""
        freedom = max(1.0 - parameters / max(int(np.count_nonzero(raw)), parameters + 1), 1e-3)
        return tuple(
            row
            for target, table in zip(self.targets, self.tables(raw), strict=True)
            for row in target_statistics(target.rows, table, freedom)
        )

    def use_scales(self, statistics: tuple[RowStatistics, ...]) -> None:
        """Set the weights of the rows to the inverse of their estimated scales."""
        scales = np.array([row.scale for row in statistics])
        nonzero = scales[scales > 0.0]
        minimum = 1e-6 * float(np.max(nonzero)) if nonzero.size else 1.0
        self.scaled = statistics
        lengths = [samples for rows, samples in self.shapes for _ in range(rows)]
        self.weights = np.repeat(1.0 / np.maximum(scales, minimum), lengths)

    def jacobian(self, point: Vector, columns: Sequence[int]) -> Vector:
        """Return d (weighted residuals) / d u, (n, columns), by forward differences.

        They are backward near an upper bound, and smaller where the step would leave the possible models.
        """
        base, responses = self.residuals(point), self.responses
        table = np.empty((base.size, len(columns)))
        for column, index in enumerate(columns):
            step = self.step if point[index] + self.step < self.bounds(index)[1] else -self.step
            while True:
                moved = point.copy()
                moved[index] += step
                try:
                    table[:, column] = (self.residuals(moved) - base) / step * self.weights
                    break
                except _ImpossibleModelError as error:
                    if abs(step) < SMALLEST_STEP:
                        raise ConfigurationError(f"parameter {self.unknowns[index].path}: {error}") from None
                    backward = point[index] - abs(step) > self.bounds(index)[0]
                    step = -step if step > 0.0 and backward else 0.5 * abs(step)
            self.last, self.responses = (point.tobytes(), base), responses
        return table

    def information(self, jacobian: Vector, weighted: Vector) -> Vector:
        """Return sum over i, j of rho_ij J_i' J_j over the rows of each target, (p, p), of J, (n, p), and residuals.

        Noise in one signal of a measurement, for example the input, appears in all rows of the measurement. rho_ij is
        the correlation of the residuals of two rows, sample by sample. For uncorrelated rows the sum is J' J.
        """
        weighted_sum = np.zeros((jacobian.shape[1], jacobian.shape[1]))
        for residuals, columns in zip(self.tables(weighted), self.tables(jacobian), strict=True):
            sizes = np.sqrt(np.sum(residuals**2, axis=1))
            related = residuals @ residuals.T / np.maximum(np.outer(sizes, sizes), 1e-300)
            np.fill_diagonal(related, 1.0)
            weighted_sum += np.einsum("ij,isp,jsq->pq", related, columns, columns, optimize=True)
        return weighted_sum

    def bounds(self, index: int) -> tuple[float, float]:
        """Return lower and upper bound of u of an unknown."""
        unknown = self.unknowns[index]
        return unknown.coordinate(unknown.low), unknown.coordinate(unknown.high)

    def inside(self, point: Vector) -> list[int]:
        """Return the indices of the free parameters that are not at a bound."""
        return [
            index
            for index in self.free
            if min(abs(point[index] - bound) for bound in self.bounds(index))
            > AT_BOUND * self.unknowns[index].half_width
        ]

    def hold(self, paths: Sequence[str], point: Vector) -> None:
        """Remove parameters from the fit and reset them to their start values in `point`."""
        for index, unknown in enumerate(self.unknowns):
            if unknown.path in paths:
                self.free.remove(index)
                point[index] = 0.0

    def solve(self, start: Vector, tolerance: float) -> tuple[Vector, tuple[bool, str]]:
        """Minimise from a point with the present scales; return the final point, (converged, message)."""

        def whole(free: Vector) -> Vector:
            point = start.copy()
            point[self.free] = free
            return point

        def function(free: Vector) -> Vector:
            try:
                weighted = self.residuals(whole(free)) * self.weights
            except _ImpossibleModelError as error:  # makes the trust region smaller
                impossible.append(str(error))
                return np.full(size, np.inf)
            if self.progress is not None:
                self.progress(self.evaluations, float(np.sqrt(np.mean(weighted**2))))
            return np.concatenate([weighted, regularisation * free])

        widths = np.array([self.unknowns[index].half_width for index in self.free])
        regularisation = REGULARISATION / widths
        size, impossible = self.residuals(start).size + widths.size, list[str]()
        low, high = np.array([self.bounds(index) for index in self.free]).T
        margin = 1e-9 * (high - low)
        answer = scipy.optimize.least_squares(
            function,
            np.clip(start[self.free], low + margin, high - margin),
            jac=lambda free: np.vstack([self.jacobian(whole(free), self.free), np.diag(regularisation)]),
            bounds=(low, high),
            x_scale=widths,
            ftol=tolerance,
            xtol=tolerance,
            gtol=None,
            max_nfev=MOST_ITERATIONS,
        )
        # Beside impossible models the trust region may shrink far from the minimum: the reduction that a full step
        # predicts is then still large.
        predicted = np.sum((answer.jac @ np.linalg.lstsq(answer.jac, -answer.fun)[0]) ** 2) if impossible else 0.0
        if predicted > FAR * tolerance * np.sum(answer.fun**2):
            return whole(answer.x), (
                False,
                f"the fit stopped because the trial values do not give a valid model ({impossible[-1]})",
            )
        return whole(answer.x), (answer.status > 0, str(answer.message))

    def result(
        self,
        point: Vector,
        start: Vector,
        raw: Vector,
        inner: list[int],
        jacobian: Vector,
        held: tuple[Unidentified, ...],
        answer: tuple[bool, str],
    ) -> TuningResult:
        """Return the result of the fit at its final point."""
        values = self.values(point)
        errors = dict.fromkeys(values, float("nan"))
        inverse = covariance(jacobian) if inner else np.zeros((0, 0))
        weighted = raw * self.weights
        spread = inverse @ self.information(jacobian, weighted) @ inverse
        deviations = np.sqrt(np.diag(spread))
        free = tuple(self.unknowns[index].path for index in inner)
        slopes = np.array([self.unknowns[index].slope(values[self.unknowns[index].path]) for index in inner])
        errors.update(dict(zip(free, (deviations * slopes).tolist(), strict=True)))
        widths = np.array([self.unknowns[index].half_width for index in inner])
        misfit = np.maximum(misfit_errors(self.tables(jacobian), self.tables(weighted), inverse), deviations) * slopes
        lag = lag_shifts(self._lagged(values, raw), -inverse @ jacobian.T) * slopes
        return TuningResult(
            unknowns=self.unknowns,
            solution=values,
            standard_errors=errors,
            free=free,
            correlation=spread / np.outer(deviations, deviations),
            unidentified=held,
            at_bound=tuple(self.unknowns[index].path for index in self.free if index not in inner),
            condition=float(np.linalg.cond(jacobian * widths)) if inner else float("inf"),
            rows=self.scaled,
            before=float(np.sqrt(np.mean((start * self.weights) ** 2))),
            after=float(np.sqrt(np.mean(weighted**2))),
            cost=0.5 * float(np.sum(weighted**2)),
            evaluations=self.evaluations,
            converged=answer[0],
            message=answer[1],
            sensitivity=-inverse @ jacobian.T,
            weights=self.weights,
            misfit_errors=dict(zip(free, misfit.tolist(), strict=True)),
            lag_shifts=dict(zip(free, lag.tolist(), strict=True)),
        )

    def _lagged(self, values: Mapping[str, float], raw: Vector) -> Vector:
        """Return the changes of the weighted residuals if a channel, or all, lag by half a sample, (cases, n)."""
        targets = [target for target in self.targets if target.half_sample > 0.0]
        half = {name: target.half_sample for target in targets for name in target.recorded}
        cases = [{name: lag} for name, lag in half.items()] + [half] * (len(half) > 1)
        changes = [(self.joined(values, case) - raw) * self.weights for case in cases]
        return np.array(changes).reshape(len(cases), raw.size)
