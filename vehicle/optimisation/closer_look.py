"""A closer look at what a search found: without tolerances, with the model of record, within the engine's validity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from vehicle.car import Car
from vehicle.optimisation.outcome import BASE, Outcome
from vehicle.optimisation.problem import Vector
from vehicle.optimisation.trials import ALONE, Trials
from vehicle.sweeps.case import overrides_of, signal_of

Differences = Mapping[str, Mapping[str, float | None]]
"""Name of a car to number to its relative difference between two engines, None where there is none."""


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
