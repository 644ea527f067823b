"""Screening of a search: all cars are estimated without a run, then the best cars are run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.studies.optimisation.front import ends, front, thinned
from vehicle.studies.optimisation.outcome import BASE, Outcome, outcome
from vehicle.studies.optimisation.search import TriedCars
from vehicle.studies.optimisation.trials import Trials

Changes = Mapping[str, Mapping[str, float]]
"""Name of a car to criterion to estimate over run minus 1 [-]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Screening:
    """Result of a screening.

    Attributes:
        outcome: outcome of the cars that were run.
        estimated, refused: numbers of cars estimated, and of cars that the estimate does not cover.
        reason: the first reason for a refusal, or "".
        errors: estimate over run minus 1 of the unmodified and the named cars [-].
        spread: mean and standard deviation of estimate over run minus 1 over all cars run [-], by criterion.
    """

    outcome: Outcome
    estimated: int
    refused: int
    reason: str
    errors: Changes
    spread: Mapping[str, tuple[float, float]]

    @property
    def sentence(self) -> str:
        """Return the numbers of cars estimated, refused and run as text."""
        refused = f", {self.refused} not covered (the first: {self.reason})" if self.refused else ""
        return f"{self.estimated} cars estimated without a run{refused}; the {len(self.outcome.tried.reasons)} best run"

    @property
    def lines(self) -> list[str]:
        """Return the estimates over the runs as text, by car and over all cars run."""
        lines = []
        for name, errors in self.errors.items():
            texts = [f"{label} {100.0 * error:+.2f} %" for label, error in errors.items() if math.isfinite(error)]
            lines.append(f"{name}, estimate over run: {', '.join(texts) or 'no run'}")
        texts = [f"{label} {100.0 * m:+.2f} +- {100.0 * d:.2f} %" for label, (m, d) in self.spread.items()]
        return [*lines, f"all cars run, estimate over run, mean +- standard deviation: {', '.join(texts)}"]

    @property
    def summary(self) -> dict[str, Any]:
        """Return the data for `summary.json`."""
        return {
            "cars_estimated": self.estimated,
            "cars_not_covered": self.refused,
            "estimate_over_run": {
                name: {label: error if math.isfinite(error) else None for label, error in errors.items()}
                for name, errors in self.errors.items()
            },
            "mean_and_deviation": self.spread,
        }


def best_rows(costs: Vector, count: int) -> Indices:
    """Return the rows of the best cars: the front, then the front of the other cars, until `count`.

    Args:
        costs: objectives of the cars within all limits, less is better; (n, goals).
        count: number of rows; of a front that does not fit any more, well spread cars are taken.
    """
    if costs.shape[1] == 1:
        return np.argsort(costs[:, 0], kind="stable")[:count]
    left, chosen = np.arange(len(costs)), list[int]()
    while left.size and len(chosen) < count:
        rows, room = left[front(costs[left])], count - len(chosen)
        spread = thinned(costs[rows], list(dict.fromkeys(ends(costs[rows])))[:room], room)
        chosen += rows[spread].tolist()
        left = np.setdiff1d(left, rows)
    return np.array(chosen, dtype=np.intp)


def screening(runs: Trials, estimates: Outcome, count: int) -> Screening:
    """Run the best cars of a search over estimates.

    Args:
        runs: evaluation of cars by runs.
        estimates: outcome of the search.
        count: number of cars to run.

    Raises:
        SimulationError: no car that is run satisfies the limits.
    """
    tried, problem = estimates.tried, runs.problem
    kept = np.flatnonzero(tried.kept(problem))
    rows = kept[best_rows(problem.costs(tried.values[kept]), count)]
    values, reasons = runs(np.concatenate([estimates.base.points, tried.points[rows]]))
    base = TriedCars(points=estimates.base.points, values=values[:1], reasons=(reasons[0],))
    run_cars = TriedCars(points=tried.points[rows], values=values[1:], reasons=tuple(reasons[1:]))
    best = replace(outcome(problem, base, [run_cars]), reached=estimates.reached)
    labels = [criterion.label for criterion in problem.criteria]
    with np.errstate(divide="ignore", invalid="ignore"):
        errors = np.concatenate([estimates.base.values, tried.values[rows]]) / values - 1.0
    named = {BASE: 0} | {name: 1 + row for name, row in best.named.items()}
    return Screening(
        outcome=best,
        estimated=len(tried.reasons),
        refused=sum(map(bool, tried.reasons)),
        reason=next(filter(None, tried.reasons), ""),
        errors={name: dict(zip(labels, errors[row].tolist(), strict=True)) for name, row in named.items()},
        spread={
            label: (float(np.nanmean(column)), float(np.nanstd(column)))
            for label, column in zip(labels, errors[1:].T, strict=True)
        },
    )
