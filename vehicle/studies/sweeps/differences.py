"""Difference in comfort between each car of a sweep and the first car, with the standard error on the same roads.

All cars drive on the same road, so the random errors of their comfort values are correlated, and the error of a
difference (`vehicle.signals.analysis.comfort_error`) is far below the errors of both values. It is the standard error
over Gaussian roads of the class; seeds of a generated road, whose lines have fixed amplitudes, scatter less. For a road
with two or more seeds the mean over the seeds is also given, with the error estimated from the scatter.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import islice
from typing import TextIO

import numpy as np
import scipy

from vehicle.signals.analysis.comfort_error import WAVES, difference_error
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.sweeps.case import Case, Input
from vehicle.studies.sweeps.measure import WAVE_NAMES
from vehicle.studies.sweeps.sweep_table import Row, SweepTable, changes

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


ROWS_AT_ONCE = 4096
"""Number of rows whose errors are computed together."""


def has_differences(table: SweepTable) -> bool:
    """Return True for a sweep with `ComfortMeasure` of two or more cars."""
    # An override of a road, the speed of rolling tyres, does not make another car.
    cars = (case.overrides[case.shared :] for case in table.cases)
    first, good = next(cars, ()), (result for result in table.results if not result.reason)
    return (
        "comfort_overall" in table.units
        and any(car != first for car in cars)
        and any(WAVE_NAMES[0] in result.values for result in islice(good, 1))
    )


class DifferencesWriter:
    """Writes the difference in comfort between every car and the first car on the same road as CSV, row by row.

    Args:
        file: the open file.
        table: table with `has_differences`.
    """

    def __init__(self, file: TextIO, table: SweepTable) -> None:
        self.cases, self.paths = table.cases, table.paths()
        self._writer = csv.writer(file, lineterminator="\n")
        self._writer.writerow(["input", *self.paths, *HEADS])
        self._factor = float(scipy.stats.t.ppf(0.975, 2 * WAVES))
        self._first: dict[Input, list[float]] = {}
        self._roads: dict[Input, str] = {}
        self._seeds: dict[str, dict[tuple[str, ...], tuple[int, list[float]]]] = {}
        self._waiting: list[tuple[Case, list[float]]] = []
        self._number = 0

    def add(self, case: Case, row: Row) -> None:
        """Add the row of a case.

        Args:
            case: the case, in the order of the table.
            row: its values.
        """
        values = row["values"]
        numbers = [float(values.get(name, math.nan)) for name in ("comfort_overall", "comfort_error", *WAVE_NAMES)]
        self._first.setdefault(case.source, numbers)
        self._waiting.append((case, numbers))
        if road := self._road(case.source):
            cars = self._seeds.setdefault(road, {})
            cars.setdefault(case.overrides, (self._number, []))[1].append(numbers[0])
        self._number += 1
        if len(self._waiting) == ROWS_AT_ONCE:
            self._flush()

    def finish(self) -> None:
        """Write the last rows, and the means over the seeds of each road with two or more seeds."""
        self._flush()
        for name, cars in self._seeds.items():
            base = np.array(next(iter(cars.values()))[1])
            for number, listed in cars.values():
                comfort = np.array(listed)
                count, apart = len(comfort), comfort - base
                error, spread = (float(np.std(values, ddof=1)) / math.sqrt(count) for values in (comfort, apart))
                width = float(scipy.stats.t.ppf(0.975, count - 1)) * spread
                numbers = [float(np.mean(comfort)), error, float(np.mean(apart)), spread, width]
                self._write(f"{name}, mean of {count} seeds", self.cases[number], SEEDS, numbers)

    def _road(self, source: Input) -> str:
        """Return the name of a road with two or more seeds; else empty."""
        if source not in self._roads:
            self._roads[source] = ""
            if isinstance(source, RoadDrive) and source.tagged:
                self._roads[source] = replace(source, tagged=False).name
        return self._roads[source]

    def _flush(self) -> None:
        """Write the waiting rows."""
        if not self._waiting:
            return
        numbers = np.array([numbers for _, numbers in self._waiting])
        base = np.array([self._first[case.source] for case, _ in self._waiting])
        waves, base_waves = (rows[:, 2::2] + 1j * rows[:, 3::2] for rows in (numbers, base))
        errors, comfort = difference_error(waves, base_waves), numbers[:, 0]
        columns = [comfort, numbers[:, 1] * comfort, comfort - base[:, 0], errors, self._factor * errors]
        for (case, _), row in zip(self._waiting, np.stack(columns, axis=1).tolist(), strict=True):
            self._write(case.source.name, case, CLASS, row)
        self._waiting.clear()

    def _write(self, name: str, case: Case, population: str, numbers: Sequence[float]) -> None:
        changed = changes(case)
        cells = [f"{number:.6g}" if math.isfinite(number) else "" for number in numbers]
        self._writer.writerow([name, *(changed.get(path, "") for path in self.paths), population, *cells])
