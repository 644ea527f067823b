"""A closer look at what a search found: without tolerances, with the model of record, within the engine's validity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vehicle.runs.car import Car
from vehicle.studies.optimisation.outcome import BASE, Outcome
from vehicle.studies.optimisation.problem import Vector
from vehicle.studies.optimisation.trials import ALONE, Trials
from vehicle.studies.sweeps.case import overrides_of, signal_of

Differences = Mapping[str, Mapping[str, float | None]]
"""Name of a car to number to its relative difference between two engines, None where there is none."""

Shares = Mapping[str, Mapping[str, float]]
"""Name of a car to number to a share of cars [-]."""

NEW_CARS = 64
"""Number of new cars around each named one: a share of 0.9 is known within 0.04."""


def chosen_cars(trials: Trials, found: Outcome) -> dict[str, Car]:
    """The named cars, without what single inputs ask of them."""
    alone, cars = replace(trials, spread=ALONE), dict[str, Car]()
    for name, row in found.named.items():
        case = alone.cases(found.tried.points[row][None])[0]
        cars[name] = Car.load(trials.vehicle, [*trials.fixed, *case.overrides[case.shared :]])
    return cars


def without_tolerances(trials: Trials, found: Outcome) -> Vector:
    """The numbers of the cars of the front themselves; (f, wishes)."""
    return replace(trials, spread=ALONE)(found.tried.points[found.front])[0]


def new_cars(trials: Trials, found: Outcome, seed: int) -> Shares:
    """Return the share of new cars within the tolerances that are as good as each named car is stated to be.

    The search chooses among many cars with one sample of made cars, and so prefers those that this sample flatters.
    New cars, drawn independently, show what quantile the stated numbers are.

    Args:
        trials: of the search, with a quantile.
        found: the search.
        seed: of the search; the new cars have another one.

    Returns:
        Name to number to share p [-], with a standard error of sqrt(p (1 - p) / NEW_CARS). A car that cannot be run
        counts as worse.
    """
    drawn = np.random.default_rng([seed, NEW_CARS]).uniform(-1.0, 1.0, (NEW_CARS, len(trials.spread.tolerances)))
    fresh = replace(trials, spread=replace(trials.spread, bands=drawn))
    rows = list(found.named.values())
    values, _ = fresh.each(found.tried.points[rows])
    stated = found.tried.values[rows]
    sense = np.array([wish.sense for wish in trials.problem.wishes])
    # A number that equals the stated one but for rounding is as good.
    slack = 1e-9 * np.abs(stated)
    share = np.mean(sense * values <= (sense * stated + slack)[:, None, :], axis=1)
    labels = [wish.words for wish in trials.problem.wishes]
    return {name: dict(zip(labels, row.tolist(), strict=True)) for name, row in zip(found.named, share, strict=True)}


def compared(trials: Trials, found: Outcome) -> Differences:
    """The named cars and the car as it is with MuJoCo: (MuJoCo - the engine of the search) over the latter [-].

    Returns:
        Name to number to difference, None where a run failed or the number is 0.
    """
    rows = list(found.named.values())
    points = np.concatenate([found.base.points, found.tried.points[rows]])
    here = replace(trials, spread=ALONE)(points)[0]
    there = replace(trials, spread=ALONE, engine="mujoco")(points)[0]
    labels = [wish.label for wish in trials.problem.wishes]
    return {
        name: {
            label: float(b / a - 1.0) if a and np.isfinite(b / a) else None
            for label, a, b in zip(labels, *pair, strict=True)
        }
        for name, *pair in zip([BASE, *found.named], here, there, strict=True)
    }


def left_validity(trials: Trials, cars: Mapping[str, Car]) -> list[str]:
    """Where the reduced engine left its validity with a named car; empty where it did not, or another one ran."""
    if trials.engine != "reduced":
        return []
    found = []
    for name, car in cars.items():
        for source in trials.inputs:
            run = car.varied(overrides_of(source)).run(
                signal_of(source), engine="reduced", channels=trials.measure.channels
            )
            found += [f"{name} on {source.name}: {warning}" for warning in run.recording.statistics.warnings]
    return found
