"""The last steps of a fit with the full simulation: what the fast models left wrong is found and taken out."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.runs.car import Run
from vehicle.studies.tuning.fit_result import TuningResult, target_statistics
from vehicle.studies.tuning.least_squares import Target

Vector = npt.NDArray[np.float64]

SMALL = 0.3
"""Step in standard errors below which the values stay: taking it would change no statement about them."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FullSteps:
    """A fit after its last steps.

    Attributes:
        result: with the values, errors and residuals of the full simulation.
        first: root of the mean square of the weighted residuals of the full simulation at the values of the fast
            models [-].
        moved: path to the way from the values of the fast models, in standard errors: what the model error of the fast
            models had done to the value.
        largest_steps: largest step of each round in standard errors; the last one is the final check, and is not taken
            where it is small.
        settled: whether it is.
    """

    result: TuningResult
    first: float
    moved: Mapping[str, float]
    largest_steps: tuple[float, ...]
    settled: bool


def full_steps(
    result: TuningResult,
    targets: Sequence[Target],
    simulate: Callable[[Mapping[str, float]], Sequence[Run]],
    *,
    most_rounds: int = 4,
) -> FullSteps:
    """Go on with the full simulation, Gauss-Newton steps with the Jacobian of the fast models:

        d u = -(J' J)^-1 J' r(full simulation at u)

    Where the steps end, the gradient of the full simulation is zero: the fast models lend their derivatives alone, and
    their errors do not enter the values. What is left of them stands in the last step.

    Args:
        result: of `fit`.
        targets: all that it was fitted to, in their order.
        simulate: path to value -> a run of that car on the signal of each target.
        most_rounds: of full simulations.

    Returns:
        The fit with the values that it led to.

    Source: Bandler et al., Space mapping: the state of the art, IEEE Transactions on Microwave Theory and Techniques
    52, 2004: a coarse model for the derivatives, the fine one for the residuals.
    """
    relative = {path: result.standard_errors[path] / result.values[path] for path in result.free}
    values = dict(result.values)
    steps: list[float] = []
    first = 0.0
    while True:
        runs = simulate(values)
        residuals = [target.residuals(run) for target, run in zip(targets, runs, strict=True)]
        joined = np.concatenate([row for rows in residuals for row in rows])
        if not steps:
            first = float(np.sqrt(np.mean((joined * result.weights) ** 2)))
        shift = result.shift(joined)
        steps.append(max((abs(shift[path] / relative[path]) for path in result.free), default=0.0))
        settled = steps[-1] <= SMALL
        if settled or len(steps) == most_rounds:
            break
        for parameter in result.parameters:
            if parameter.path in shift:
                moved = values[parameter.path] * float(np.exp(shift[parameter.path]))
                values[parameter.path] = float(np.clip(moved, parameter.low, parameter.high))
    freedom = 1.0 - len(result.free) / joined.size
    weighted = joined * result.weights
    return FullSteps(
        result=dataclasses.replace(
            result,
            values=values,
            standard_errors={path: relative.get(path, float("nan")) * value for path, value in values.items()},
            rows=tuple(
                row
                for target, rows in zip(targets, residuals, strict=True)
                for row in target_statistics(target.rows, list(rows), freedom)
            ),
            after=float(np.sqrt(np.mean(weighted**2))),
            cost=0.5 * float(np.sum(weighted**2)),
            converged=result.converged and settled,
        ),
        first=first,
        moved={path: float(np.log(values[path] / result.values[path]) / relative[path]) for path in result.free},
        largest_steps=tuple(steps),
        settled=settled,
    )
