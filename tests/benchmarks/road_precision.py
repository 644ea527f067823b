"""Part `precision` of `python -m tests.benchmarks.coverage`: runs whose length a wanted precision has chosen."""

import itertools
from typing import Any

import numpy as np

from vehicle.runs.car import Car, Road
from vehicle.signals.analysis.ride_comfort import WEIGHTED


def precision(repetitions: int) -> list[dict[str, Any]]:
    """Runs whose length a precision of 1 % has chosen: chosen span, stated half interval, scatter, coverage."""
    rows: list[dict[str, Any]] = []
    cars: list[tuple[str, dict[str, float]]] = [
        ("sedan", {}),
        ("focus_road", {}),
        ("sedan", {"front.damper.coulomb_friction": 120.0}),
    ]
    for (name, changes), road in itertools.product(cars, "AC"):
        car, found = Car.load(name, changes), []
        for seed in range(1, repetitions + 1):
            run = car.run(Road(road, 80.0, precision=1.0, seed=seed), engine="reduced", stated_errors=False)
            comfort = run.comfort()
            half = 196.0 * comfort.errors[WEIGHTED]
            found.append((run.signal.duration - run.skip, half, comfort.weighted.overall))
        span, half, value = np.array(found).T
        gap = 100.0 * (value / value.mean() - 1.0)
        rows.append(
            {
                "car": f"{name} {road}, {changes or 'unchanged'}",
                "span_median_s": np.median(span),
                "span_max_s": span.max(),
                "half_median_percent": np.median(half),
                "half_below_1.3": np.mean(half <= 1.3),
                "scatter_percent": gap.std(ddof=1),
                "covers_95": np.mean(np.abs(gap) < half),
            }
        )
    return rows
