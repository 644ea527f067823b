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
from scipy.special import stdtrit

from vehicle.signals.analysis.comfort_error import WAVES, difference_error
from vehicle.signals.analysis.ride_comfort import ERROR, UNWEIGHTED, WAVE_NAMES
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.sweeps.case import Case, Input
from vehicle.studies.sweeps.case_result import Row
from vehicle.studies.sweeps.sweep_table import SweepTable

DIFFERENCES = "differences.csv"
"""Name of the file in the folder of a sweep."""

CLASS, SEEDS = "Gaussian roads of this class", "seeds of the generated road"
"""Populations for which an error is stated."""

HEADS = (
    "cars differ on",
    "unweighted [m/s2]",
    "standard_error [m/s2]",
    "difference [m/s2]",
    "standard_error_of_difference [m/s2]",
    "half_width_95 [m/s2]",
)


VALUES = (UNWEIGHTED, ERROR, *WAVE_NAMES)
"""Names of the values of a row that the differences need."""

Numbers = tuple[float, ...]
"""The `VALUES` of a row."""

ROWS_AT_ONCE = 1024
"""Number of rows whose errors are computed together."""


def has_differences(table: SweepTable) -> bool:
    """Return True for a sweep with `ComfortMeasure` of two or more cars."""
    # An override of a road, the speed of rolling tyres, does not make another car.
    cars = (case.overrides[case.shared :] for case in table.cases)
    first, good = next(cars, ()), (result for result in table.results if not result.reason)
    return (
        UNWEIGHTED in table.units
        and any(car != first for car in cars)
        and any(WAVE_NAMES[0] in result.values for result in islice(good, 1))
    )


class DifferencesWriter:
    """Writes the difference in comfort between every car and the first car on the same road as CSV, row by row.

    Args:
        file: the open file.
        paths: the modified parameter paths of all cases.
    """

    def __init__(self, file: TextIO, paths: Sequence[str]) -> None:
        self._writer = csv.writer(file, lineterminator="\n")
        self._writer.writerow(["input", *paths, *HEADS])
        self._factor = float(stdtrit(2 * WAVES, 0.975))
        self._first: dict[Input, Numbers] = {}
        self._seeds: dict[str, dict[tuple[str, ...], tuple[Sequence[str], list[float]]]] = {}
        self._source: Input | None = None
        self._base: Numbers = ()
        self._road = ""
        self._waiting: list[tuple[str, Sequence[str], Numbers, Numbers]] = []

    def add(self, case: Case, parameters: Sequence[str], row: Row) -> None:
        """Add the row of a case.

        Args:
            case: the case, in the order of the table.
            parameters: values of its parameters, see `parameter_cells`.
            row: its values.
        """
        values = row["values"]
        numbers = tuple([float(values.get(name, math.nan)) for name in VALUES])
        if case.source is not self._source:
            self._source, self._road = case.source, ""
            self._base = self._first.setdefault(case.source, numbers)
            if isinstance(case.source, RoadDrive) and case.source.tagged:
                self._road = replace(case.source, tagged=False).name
        self._waiting.append((case.source.name, parameters, numbers, self._base))
        if self._road:
            cars = self._seeds.setdefault(self._road, {})
            cars.setdefault(case.overrides, (parameters, []))[1].append(numbers[0])
        if len(self._waiting) == ROWS_AT_ONCE:
            self._flush()

    def finish(self) -> None:
        """Write the last rows, and the means over the seeds of each road with two or more seeds."""
        self._flush()
        for name, cars in self._seeds.items():
            base = np.array(next(iter(cars.values()))[1])
            for parameters, listed in cars.values():
                comfort = np.array(listed)
                count, apart = len(comfort), comfort - base
                error, spread = (float(np.std(values, ddof=1)) / math.sqrt(count) for values in (comfort, apart))
                width = float(stdtrit(count - 1, 0.975)) * spread
                numbers = [float(np.mean(comfort)), error, float(np.mean(apart)), spread, width]
                self._write(f"{name}, mean of {count} seeds", parameters, SEEDS, numbers)

    def _flush(self) -> None:
        """Write the waiting rows."""
        if not self._waiting:
            return
        names, parameters, numbers, base = zip(*self._waiting, strict=True)
        (comfort, relative, *waves), (base_comfort, _, *base_waves) = np.array(numbers).T, np.array(base).T
        first, second = (
            np.stack(parts[0::2], axis=1) + 1j * np.stack(parts[1::2], axis=1) for parts in (waves, base_waves)
        )
        errors = difference_error(first, second)
        columns = [comfort, relative * comfort, comfort - base_comfort, errors, self._factor * errors]
        for name, cells, row in zip(names, parameters, np.stack(columns, axis=1).tolist(), strict=True):
            self._write(name, cells, CLASS, row)
        self._waiting.clear()

    def _write(self, name: str, parameters: Sequence[str], population: str, numbers: Sequence[float]) -> None:
        cells = [f"{number:.6g}" if math.isfinite(number) else "" for number in numbers]
        self._writer.writerow([name, *parameters, population, *cells])
