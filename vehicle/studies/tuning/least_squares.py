"""Least squares over any number of measurements, with what the data say about the answer.

    minimise  sum over rows of  (r / scale)^2,   r = residuals over their assumed deviation,  u = ln(value / start)

A first, coarse iteration takes the assumed deviations. Then the scale of each row is found from its own residuals
(their RMS, and how much neighbours know of each other), and the fit repeated with it: assumed deviations only have to
be right within a row. The covariance of u is (J' J)^-1 C (J' J)^-1 with the residuals over their scale and
C = sum rho_ij J_i' J_j, rho_ij the correlation of rows i and j of a measurement, of the parameters that the data can
tell; the others are held at their start.

Source of the covariance: Zellner, Journal of the American Statistical Association 57 (1962): equations whose errors are
correlated.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.parameters.ranges import Range, checked_ranges
from vehicle.studies.tuning.fit_result import RowStatistics, TuningResult, target_statistics
from vehicle.studies.tuning.identifiability import Unidentified, covariance, worst_direction

Vector = npt.NDArray[np.float64]

COARSE_STEP, STEP = 0.1, 1e-3
"""Step of ln(value) for the difference quotients: a wide one far away, where slips that come and go make the sum of
squares rough, and one that leaves a thousandth of second order at the end."""

COARSE, FINE = 1e-2, 1e-5
"""Relative change of the sum of squares at which an iteration ends: the first only finds the sizes of the residuals; in
the others it is far below one, the change that one standard error brings, for the thousands of values of a measurement.
"""

STEADY = 1.3
"""Factor within which the scales of the rows must stay from one iteration to the next for the fit to be done."""

MOST_ROUNDS = 8
"""Iterations with new scales at most."""

LEASH = 1e-3
"""Weight of |u| in half widths of the bounds during the iterations: it moves a value that the data tell by a
millionth of its standard error, and keeps one that they do not tell from running away."""

AT_BOUND = 1e-4
"""Distance from a bound, in half widths, that counts as being there."""


class Target(Protocol):
    """A measurement that a model is compared with."""

    @property
    def rows(self) -> tuple[str, ...]:
        """What each row of the residuals is."""

    def residuals(self, model: Any, /) -> Vector:
        """Residuals over their assumed standard deviation, (rows, samples); 0 where a value does not count."""


def fit(
    parameters: Sequence[Range],
    targets: Sequence[Target],
    build: Callable[[Mapping[str, float]], Any],
    *,
    most_iterations: int = 40,
    progress: Callable[[int, float], None] | None = None,
) -> TuningResult:
    """Fit parameters to measurements.

    Args:
        parameters: with bounds and start.
        targets: measurements; each weighs as its own residuals say.
        build: path to value -> the model that the targets ask for its residuals.
        most_iterations: of each iteration: one to find the sizes of the residuals, one with them, and more where
            parameters have to be held.
        progress: called with the number of evaluations and the root of the mean square of the weighted residuals.

    Returns:
        The values and how far to trust them.

    Raises:
        ConfigurationError: no parameter or target, a parameter twice, or more parameters than values.
        SimulationError: the model gives residuals that are not finite.
    """
    problem = _Problem(checked_ranges(parameters), targets, build, progress)
    start = problem.residuals(np.zeros(len(parameters)))
    problem.weights = np.ones(start.size)
    point, answer = problem.solve(np.zeros(len(parameters)), COARSE, most_iterations)
    held: list[Unidentified] = []
    problem.step = STEP
    rounds = 0
    while True:
        raw = problem.residuals(point)
        before = problem.weights
        problem.use_scales(problem.statistics(raw, len(problem.free)))
        steady = rounds > 0 and bool(np.max(np.abs(np.log(problem.weights / before))) < np.log(STEADY))
        inner = problem.inside(point)
        jacobian = problem.jacobian(point, inner)
        found = _open_directions(jacobian, [problem.parameters[index] for index in inner])
        if (steady or rounds >= MOST_ROUNDS) and not found:
            break
        held += found
        problem.hold([one.path for one in found], point)
        if not problem.free:
            raise ConfigurationError(
                "the data can tell none of the parameters: " + "; ".join(one.sentence() for one in held)
            )
        point, answer = problem.solve(point, FINE, most_iterations)
        rounds += 1
    return problem.result(point, start, raw, inner, jacobian, tuple(held), answer)


def _open_directions(jacobian: Vector, parameters: list[Range]) -> list[Unidentified]:
    """Parameters to hold, one after the other, until every direction that is left is known."""
    found: list[Unidentified] = []
    left = list(range(len(parameters)))
    while left:
        worst = worst_direction(jacobian[:, left], [parameters[index] for index in left])
        if worst is None:
            break
        found.append(worst)
        left = [index for index in left if parameters[index].path != worst.path]
    return found


class _Problem:
    """Residuals and Jacobian over u = ln(value / start), with a count of the evaluations.

    Args:
        parameters: all of them.
        targets: measurements.
        build: of the model.
        progress: as of `fit`.
    """

    def __init__(
        self,
        parameters: tuple[Range, ...],
        targets: Sequence[Target],
        build: Callable[[Mapping[str, float]], Any],
        progress: Callable[[int, float], None] | None,
    ) -> None:
        if not targets:
            raise ConfigurationError("targets: none to fit to; give at least one measurement")
        self.parameters, self.targets, self.progress = parameters, targets, progress
        self.build = build
        self.step = COARSE_STEP
        self.free = list(range(len(parameters)))
        self.lengths: list[int] = []
        self.weights = np.ones(1)
        self.scaled: tuple[RowStatistics, ...] = ()
        self.evaluations = 0
        self.last: tuple[bytes, Vector] | None = None

    def values(self, point: Vector) -> dict[str, float]:
        """Path to value."""
        return {one.path: one.value(float(u)) for one, u in zip(self.parameters, point, strict=True)}

    def residuals(self, point: Vector) -> Vector:
        """All residuals without the scales, (n,)."""
        if self.last is not None and self.last[0] == point.tobytes():
            return self.last[1]
        model = self.build(self.values(point))
        rows = [row for target in self.targets for row in target.residuals(model)]
        self.evaluations += 1
        self.lengths = [row.size for row in rows]
        joined = np.concatenate(rows)
        if not np.isfinite(joined).all():
            text = ", ".join(f"{path}={value:.5g}" for path, value in self.values(point).items())
            raise SimulationError(f"residuals that are not finite at {text}; narrow the bounds")
        if joined.size < len(self.parameters):
            raise ConfigurationError(
                f"{joined.size} values for {len(self.parameters)} parameters; give more data or fewer parameters"
            )
        self.last = (point.tobytes(), joined)
        return joined

    def statistics(self, raw: Vector, parameters: int) -> tuple[RowStatistics, ...]:
        """Of all rows, with the degrees of freedom that a number of parameters leaves."""
        freedom = max(1.0 - parameters / max(int(np.count_nonzero(raw)), parameters + 1), 1e-3)
        rows, first = np.split(raw, np.cumsum(self.lengths)[:-1]), 0
        found: list[RowStatistics] = []
        for target in self.targets:
            last = first + len(target.rows)
            found += target_statistics(target.rows, rows[first:last], freedom)
            first = last
        return tuple(found)

    def use_scales(self, statistics: tuple[RowStatistics, ...]) -> None:
        """Weigh the rows by what was found of their residuals."""
        scales = np.array([one.scale for one in statistics])
        known = scales[scales > 0.0]
        least = 1e-6 * float(np.max(known)) if known.size else 1.0
        self.scaled = statistics
        self.weights = np.repeat(1.0 / np.maximum(scales, least), self.lengths)

    def jacobian(self, point: Vector, columns: Sequence[int]) -> Vector:
        """d (weighted residuals) / d u by forward differences, away from a bound that is near; (n, columns)."""
        base = self.residuals(point)
        table = np.empty((base.size, len(columns)))
        for place, index in enumerate(columns):
            step = self.step if point[index] + self.step < self.bounds(index)[1] else -self.step
            moved = point.copy()
            moved[index] += step
            table[:, place] = (self.residuals(moved) - base) / step * self.weights
            self.last = (point.tobytes(), base)
        return table

    def information(self, jacobian: Vector, weighted: Vector) -> Vector:
        """Return sum over i, j of rho_ij J_i' J_j over the rows of each target, (columns, columns).

        Noise at one place of a measurement, of the input for example, is in all of its rows. rho_ij is the correlation
        of the residuals of two rows, sample by sample. With rows that know nothing of each other it is J' J.

        Args:
            jacobian: of the weighted residuals, (n, columns).
            weighted: residuals, (n,).
        """
        found = np.zeros((jacobian.shape[1], jacobian.shape[1]))
        ends = np.cumsum(self.lengths)
        row = 0
        for target in self.targets:
            rows = range(row, row + len(target.rows))
            row = rows.stop
            begin, end = ends[rows.start] - self.lengths[rows.start], ends[rows[-1]]
            # (rows, samples): the rows of a target are those of one array.
            residuals = weighted[begin:end].reshape(len(rows), -1)
            columns = jacobian[begin:end].reshape(*residuals.shape, -1)
            sizes = np.sqrt(np.sum(residuals**2, axis=1))
            related = residuals @ residuals.T / np.maximum(np.outer(sizes, sizes), 1e-300)
            np.fill_diagonal(related, 1.0)
            found += np.einsum("ij,isp,jsq->pq", related, columns, columns, optimize=True)
        return found

    def bounds(self, index: int) -> tuple[float, float]:
        """Bounds of u."""
        one = self.parameters[index]
        return float(np.log(one.low / one.start)), float(np.log(one.high / one.start))

    def inside(self, point: Vector) -> list[int]:
        """The free parameters that are not at a bound."""
        return [
            index
            for index in self.free
            if min(abs(point[index] - bound) for bound in self.bounds(index))
            > AT_BOUND * self.parameters[index].half_width
        ]

    def hold(self, paths: Sequence[str], point: Vector) -> None:
        """Take parameters out of the fit and set them back to their start in `point`."""
        for index, parameter in enumerate(self.parameters):
            if parameter.path in paths:
                self.free.remove(index)
                point[index] = 0.0

    def solve(self, start: Vector, tolerance: float, most_iterations: int) -> tuple[Vector, tuple[bool, str]]:
        """Iterate from a point with the present scales; returns the end, and whether and why it ended there."""

        def whole(free: Vector) -> Vector:
            point = start.copy()
            point[self.free] = free
            return point

        def function(free: Vector) -> Vector:
            weighted = self.residuals(whole(free)) * self.weights
            if self.progress is not None:
                self.progress(self.evaluations, float(np.sqrt(np.mean(weighted**2))))
            return np.concatenate([weighted, leash * free])

        widths = np.array([self.parameters[index].half_width for index in self.free])
        leash = LEASH / widths
        low, high = np.array([self.bounds(index) for index in self.free]).T
        margin = 1e-9 * (high - low)
        answer = scipy.optimize.least_squares(
            function,
            np.clip(start[self.free], low + margin, high - margin),
            jac=lambda free: np.vstack([self.jacobian(whole(free), self.free), np.diag(leash)]),
            bounds=(low, high),
            x_scale=widths,
            ftol=tolerance,
            xtol=tolerance,
            gtol=None,
            max_nfev=most_iterations,
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
        """Put together what was found."""
        values = self.values(point)
        errors = dict.fromkeys(values, float("nan"))
        inverse = covariance(jacobian) if inner else np.zeros((0, 0))
        weighted = raw * self.weights
        spread = inverse @ self.information(jacobian, weighted) @ inverse
        deviations = np.sqrt(np.diag(spread))
        free = tuple(self.parameters[index].path for index in inner)
        errors.update({path: float(one * values[path]) for path, one in zip(free, deviations, strict=True)})
        widths = np.array([self.parameters[index].half_width for index in inner])
        return TuningResult(
            parameters=self.parameters,
            values=values,
            standard_errors=errors,
            free=free,
            correlation=spread / np.outer(deviations, deviations),
            unidentified=held,
            at_bound=tuple(self.parameters[index].path for index in self.free if index not in inner),
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
        )
