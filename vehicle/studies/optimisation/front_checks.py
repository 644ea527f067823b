"""Checks on the front of a search: values without tolerances, runs with MuJoCo, validity of the reduced engine."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.runs.car import Car
from vehicle.studies.optimisation.outcome import BASE, Outcome
from vehicle.studies.optimisation.trials import NO_TOLERANCES, Trials
from vehicle.studies.sweeps.case import overrides_of, signal_of

Differences = Mapping[str, Mapping[str, float | None]]
"""Name of a car to quantity to relative difference between two engines [-], None where undefined."""

Shares = Mapping[str, Mapping[str, float]]
"""Name of a car to quantity to share of cars [-]."""

NEW_CARS = 64
"""Number of new cars around each named car: a share of 0.9 has a standard error of 0.04."""


def named_cars(trials: Trials, outcome: Outcome) -> dict[str, Car]:
    """Return the named cars, without the overrides of single inputs."""
    nominal, cars = replace(trials, spread=NO_TOLERANCES), dict[str, Car]()
    base = Car.load(trials.vehicle, trials.fixed)
    for name, row in outcome.named.items():
        case = nominal.cases(outcome.tried.points[row][None])[0]
        cars[name] = Car.load(trials.vehicle, base.with_(case.overrides[case.shared :]).overrides)
    return cars


def without_tolerances(trials: Trials, outcome: Outcome) -> Vector:
    """Return the values of the cars of the front without tolerances; (f, criteria)."""
    return replace(trials, spread=NO_TOLERANCES)(outcome.tried.points[outcome.front])[0]


def shares_as_good(trials: Trials, outcome: Outcome, seed: int) -> Shares:
    """Return the share of new cars within the tolerances whose values are at least as good as the stated values.

    The search chooses among many cars with one sample of tolerances, so it prefers cars for which this sample is
    favourable. New cars, drawn independently, show the true quantile of the stated values.

    Args:
        trials: evaluation of the search, with a quantile.
        outcome: outcome of the search.
        seed: seed of the search; new cars use a different random stream.

    Returns:
        Name of the car to quantity to share p [-], with a standard error of sqrt(p (1 - p) / NEW_CARS). A car that
        cannot be run counts as worse.
    """
    drawn = np.random.default_rng([seed, NEW_CARS]).uniform(-1.0, 1.0, (NEW_CARS, len(trials.spread.tolerances)))
    fresh = replace(trials, spread=replace(trials.spread, bands=drawn))
    rows = list(outcome.named.values())
    values, _ = fresh.per_sample(outcome.tried.points[rows])
    stated = outcome.tried.values[rows]
    sense = np.array([criterion.sense for criterion in trials.problem.criteria])
    # A value equal to the stated value within rounding is as good.
    slack = 1e-9 * np.abs(stated)
    share = np.mean(sense * values <= (sense * stated + slack)[:, None, :], axis=1)
    labels = [criterion.expression for criterion in trials.problem.criteria]
    return {name: dict(zip(labels, row.tolist(), strict=True)) for name, row in zip(outcome.named, share, strict=True)}


def mujoco_differences(trials: Trials, outcome: Outcome) -> Differences:
    """Return the relative differences of MuJoCo to the engine of the search, for unmodified and named cars [-].

    Returns:
        Name of the car to quantity to difference, None where a run failed or the value is 0.
    """
    rows = list(outcome.named.values())
    points = np.concatenate([outcome.base.points, outcome.tried.points[rows]])
    values = replace(trials, spread=NO_TOLERANCES)(points)[0]
    mujoco_values = replace(trials, spread=NO_TOLERANCES, engine="mujoco")(points)[0]
    labels = [criterion.label for criterion in trials.problem.criteria]
    return {
        name: {
            label: float(b / a - 1.0) if a and np.isfinite(b / a) else None
            for label, a, b in zip(labels, *pair, strict=True)
        }
        for name, *pair in zip([BASE, *outcome.named], values, mujoco_values, strict=True)
    }


def validity_warnings(trials: Trials, cars: Mapping[str, Car]) -> list[str]:
    """Return warnings for named cars outside the valid range of the reduced engine; empty for other engines."""
    if trials.engine != "reduced":
        return []
    warnings = []
    for name, car in cars.items():
        for source in trials.inputs:
            run = car.with_(overrides_of(source)).run(
                signal_of(source), engine="reduced", channels=trials.measure.channels
            )
            warnings += [f"{name} on {source.name}: {warning}" for warning in run.recording.statistics.warnings]
    return warnings
