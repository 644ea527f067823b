"""Final steps of a fit with the full simulation, which remove the error of the fast models from the values."""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.runs.car import Car, Run
from vehicle.studies.tuning.fit_result import TuningResult, target_statistics
from vehicle.studies.tuning.target import Target

SMALL = 0.3
"""Maximum step in standard errors that is left out: it would not change any conclusion about the values."""

MOST_ROUNDS = 4
"""Maximum number of full simulations."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FullSteps:
    """Result of a fit after its final steps."""

    result: TuningResult  # the fit with values, errors and residuals of the full simulation
    # root of the mean square of the weighted residuals of the full simulation at the values of the fast models [-]
    first: float
    # path to change of the unknown in standard errors: the effect of the error of the fast models
    moved: Mapping[str, float]
    # largest step of each round in standard errors; the last step is the final check, and is left out if it is small
    largest_steps: tuple[float, ...]
    settled: bool  # True if the last step was small


def full_steps(
    result: TuningResult, targets: Sequence[Target], simulate: Callable[[Mapping[str, float]], Sequence[Car | Run]]
) -> FullSteps:
    """Continue a fit with the full simulation by Gauss-Newton steps with the Jacobian of the fast models.

        d u = -(J' J)^-1 J' r(full simulation at u)

    At convergence the gradient of the full simulation is zero: only derivatives come from the fast models, so the
    errors of the fast models do not enter the values. The last step is the remaining error.

    Args:
        targets: targets of the fit, in the same order.
        simulate: function of {path: value} that returns a run of that car on the signal of each target, or that car
            for a target without a signal.

    Source: Bandler et al., Space mapping: the state of the art, IEEE Transactions on Microwave Theory and Techniques
    52, 2004: a coarse model for the derivatives, the fine one for the residuals.
    """
    relative = {path: result.deviation_of_u(path) for path in result.free}
    values = dict(result.solution)
    steps: list[float] = []
    sizes: list[float] = []
    while True:
        current = dataclasses.replace(result, solution=values)
        runs = simulate(current.values)
        residuals = [
            target.misfit(target.response(run), current.groups(number), {})
            for number, (target, run) in enumerate(zip(targets, runs, strict=True))
        ]
        joined = np.concatenate([rows.ravel() for rows in residuals])
        weighted = joined * result.weights
        sizes.append(float(np.sqrt(np.mean(weighted**2))))
        shift = result.shift(joined)
        steps.append(max((abs(shift[path] / relative[path]) for path in result.free), default=0.0))
        settled = steps[-1] <= SMALL
        if settled or len(steps) == MOST_ROUNDS:
            break
        for unknown in result.unknowns:
            if unknown.path in shift:
                moved = unknown.value(unknown.coordinate(values[unknown.path]) + shift[unknown.path])
                values[unknown.path] = float(np.clip(moved, unknown.low, unknown.high))
    freedom = 1.0 - len(result.free) / joined.size
    return FullSteps(
        result=dataclasses.replace(
            result,
            solution=values,
            standard_errors={
                unknown.path: relative.get(unknown.path, float("nan")) * unknown.slope(values[unknown.path])
                for unknown in result.unknowns
            },
            misfit_errors={
                unknown.path: result.deviation_of_u(unknown.path, result.errors) * unknown.slope(values[unknown.path])
                for unknown in result.unknowns
                if unknown.path in result.misfit_errors
            },
            rows=tuple(
                row
                for target, rows in zip(targets, residuals, strict=True)
                for row in target_statistics(target.rows, rows, freedom)
            ),
            after=sizes[-1],
            cost=0.5 * float(np.sum(weighted**2)),
            converged=result.converged and settled,
        ),
        first=sizes[0],
        moved={
            unknown.path: (unknown.coordinate(values[unknown.path]) - unknown.coordinate(result.solution[unknown.path]))
            / relative[unknown.path]
            for unknown in result.unknowns
            if unknown.path in relative
        },
        largest_steps=tuple(steps),
        settled=settled,
    )
