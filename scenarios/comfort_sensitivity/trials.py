"""Effect of model parts and unprinted inputs on the ends of the comfort curves."""

from collections.abc import Iterator

import numpy as np

from scenarios.comfort_runs import SEAT_RAIL_Z, Changes, ComfortRuns, Numbers
from scenarios.comfort_sensitivity.claims import RIGID_BODY, SOURCE
from scenarios.comfort_sensitivity.histories import WINDOW_S, ends_of
from scenarios.evidence import COMFORT_ENDS, LEVELS
from scenarios.signals.exact_road import RATE_HZ, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED
from vehicle.signals.analysis.segments import window_extremes
from vehicle.studies.sweeps.case import Case
from vehicle.studies.sweeps.case_evaluation import recordings_of

EDGE_FACTORS = (0.6, 1.7)
"""Of the lower edge of the roads, which is not printed."""

DAMPING = 0.06
"""Damping ratio of the body's modes, which is not printed."""

COUNT = 2
"""Records of each trial: ratios on common records scatter by a few tenths of a point."""


def trials_of(comfort: ComfortRuns) -> dict[str, tuple[Changes, float]]:
    """Return label of a trial to the overrides of all its cars and the band edge of its roads [Hz]."""
    modes = range(1, len(comfort.runs.car().trimmed_body.frequencies) + 1)
    damped = tuple(f"body.modes.{number}.damping_ratio={DAMPING!r}" for number in modes)
    return {
        **{f"roads from {factor * ROAD_EDGE_HZ:.2g} Hz": ((), factor * ROAD_EDGE_HZ) for factor in EDGE_FACTORS},
        "body rigid": (RIGID_BODY, ROAD_EDGE_HZ),
        f"body damping {100.0 * DAMPING:g} %": (damped, ROAD_EDGE_HZ),
        "Ixx 1200": (("body.inertia.ixx=1200",), ROAD_EDGE_HZ),
    }


def end_trials(comfort: ComfortRuns) -> dict[str, dict[tuple[str, str, float], float]]:
    """Return relative comfort [%] at the ends of the curves, by trial, and (parameter, road, value)."""
    comfort_values: dict[str, dict[tuple[str, str, float], float]] = {}
    for label, (base, edge) in trials_of(comfort).items():
        for name, road, value, car in _ends(comfort, base):
            ours, reference = (_comfort(comfort(_cases(comfort, varied_car, road, edge))) for varied_car in (car, base))
            comfort_values.setdefault(label, {})[name, road, value] = float(100.0 * np.mean(ours / reference))
    return comfort_values


def trial_cases(comfort: ComfortRuns) -> list[Case]:
    """Return all cases of the trials, to be run as a batch."""
    return [
        case
        for base, edge in trials_of(comfort).values()
        for _, road, _, car in _ends(comfort, base)
        for varied_car in (car, base)
        for case in _cases(comfort, varied_car, road, edge)
    ]


def level_trials(comfort: ComfortRuns) -> dict[str, dict[str, float]]:
    """Return the mean of the largest |seat rail, vertical| of the figures [m/s2], by trial and figure; one record."""
    record = slice(round(comfort.records.lead * RATE_HZ) + 1, None)
    by_trial: dict[str, dict[str, float]] = {}
    for label, (base, edge) in trials_of(comfort).items():
        for road in ROAD_RMS:
            cars = {variation.name: list(ends_of(comfort, variation, base).values()) for variation in SOURCE}
            all_cars = list(dict.fromkeys(car for ends in cars.values() for car in ends))
            cases = [_cases(comfort, car, road, edge)[0] for car in all_cars]
            recordings = recordings_of(cases, SEAT_RAIL_Z)
            extremes = {
                car: window_extremes(1.0 / RATE_HZ, entry[SEAT_RAIL_Z[0]][record], WINDOW_S)
                for car, entry in zip(all_cars, recordings, strict=True)
            }
            for figure, name, *_ in (entry for entry in LEVELS if entry[2] == road):
                largest = np.max([extremes[car] for car in cars[name]], axis=0)
                by_trial.setdefault(label, {})[figure] = float(np.mean(largest))
    return by_trial


def _ends(comfort: ComfortRuns, base: Changes) -> Iterator[tuple[str, str, float, Changes]]:
    cars = {variation.name: comfort.cars(variation, base) for variation in SOURCE}
    for name, _, road, _, value, _ in COMFORT_ENDS:
        yield name, road, value, cars[name][value]


def _cases(comfort: ComfortRuns, car: Changes, road: str, edge: float) -> list[Case]:
    return comfort.cases(car, road, edge=edge, count=min(COUNT, comfort.records.count))


def _comfort(numbers: list[Numbers]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array([record[UNWEIGHTED] for record in numbers])
