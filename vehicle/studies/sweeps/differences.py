"""Difference in comfort between each car of a sweep and the first car, with the standard error on the same roads.

All cars drive on the same road, so the random errors of their comfort values are correlated, and the error of a
difference (`vehicle.signals.analysis.comfort_error`) is far below the errors of both values. It is the standard error
over Gaussian roads of the class; seeds of a generated road, whose lines have fixed amplitudes, scatter less. For a road
with two or more seeds the mean over the seeds is also given, with the error estimated from the scatter.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy

from vehicle.signals.analysis.comfort_error import WAVES, difference_error
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.sweeps.case import Case, Input
from vehicle.studies.sweeps.measure import WAVE_NAMES
from vehicle.studies.sweeps.sweep_table import SweepTable, changes

DIFFERENCES = "differences.csv"
"""Name of the file in the folder of a sweep."""

CLASS, SEEDS = "Gaussian roads of this class", "seeds of the generated road"
"""Populations for which an error is stated."""

HEADS = (
    "cars differ on",
    "comfort_overall [m/s2]",
    "standard_error [m/s2]",
    "difference [m/s2]",
    "standard_error_of_difference [m/s2]",
    "half_width_95 [m/s2]",
)


def differences_text(table: SweepTable) -> str:
    """Return the difference in comfort between every car and the first car on the same road, as CSV.

    Args:
        table: table of a sweep with `ComfortMeasure`.

    Returns:
        The text; empty for a sweep with a single car or another measure.
    """
    if "comfort_overall" not in table.units or not any(WAVE_NAMES[0] in result.values for result in table.results):
        return ""
    paths = table.paths()
    comfort, relative = table.column("comfort_overall"), table.column("comfort_error")
    parts = np.array([[result.values.get(name, math.nan) for name in WAVE_NAMES] for result in table.results])
    waves = parts[:, 0::2] + 1j * parts[:, 1::2]
    # An override of a road, the speed of rolling tyres, does not make another car.
    if len({case.overrides[case.shared :] for case in table.cases}) < 2:
        return ""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["input", *paths, *HEADS])

    def write(name: str, case: Case, population: str, numbers: Sequence[float]) -> None:
        changed = changes(case)
        cells = [f"{number:.6g}" if math.isfinite(number) else "" for number in numbers]
        writer.writerow([name, *(changed.get(path, "") for path in paths), population, *cells])

    first: dict[Input, int] = {}
    base = np.array([first.setdefault(case.source, row) for row, case in enumerate(table.cases)])
    errors, gaps = difference_error(waves, waves[base]), comfort - comfort[base]
    factor = float(scipy.stats.t.ppf(0.975, 2 * WAVES))
    for row, case in enumerate(table.cases):
        numbers = [comfort[row], relative[row] * comfort[row], gaps[row], errors[row], factor * errors[row]]
        write(case.source.name, case, CLASS, numbers)
    for name, rows in _seeds(table.cases).items():
        base_rows = next(iter(rows.values()))
        for rows_of_car in rows.values():
            count = len(rows_of_car)
            apart = comfort[rows_of_car] - comfort[base_rows]
            error, spread = (
                float(np.std(values, ddof=1)) / math.sqrt(count) for values in (comfort[rows_of_car], apart)
            )
            width = float(scipy.stats.t.ppf(0.975, count - 1)) * spread
            numbers = [float(np.mean(comfort[rows_of_car])), error, float(np.mean(apart)), spread, width]
            write(f"{name}, mean of {count} seeds", table.cases[rows_of_car[0]], SEEDS, numbers)
    return file.getvalue()


def _seeds(cases: Sequence[Case]) -> dict[str, dict[tuple[str, ...], list[int]]]:
    """Return road to car to rows of the seeds, for roads with two or more seeds."""
    rows: dict[str, dict[tuple[str, ...], list[int]]] = {}
    for row, case in enumerate(cases):
        if isinstance(case.source, RoadDrive) and case.source.tagged:
            road = replace(case.source, tagged=False).name
            rows.setdefault(road, {}).setdefault(case.overrides, []).append(row)
    return rows
