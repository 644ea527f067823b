"""Difference in comfort between each car of a sweep and the first car, with the standard error on the same roads.

The values are the unweighted one, and after it the weighted one by which the cars are ranked. All cars drive on the
same road, so the random errors of their comfort values are correlated, and the error of a difference
(`vehicle.signals.analysis.comfort_error`) is far below the errors of both values. On a road that repeats after the
evaluated span it is what the linear twins of both cars leave. On another road it is the standard error over Gaussian
roads of the class; seeds of such a generated road, whose lines have fixed amplitudes, scatter less. One event, e.g. an
obstacle, has none. For a road with two or more seeds the mean over the seeds is also given, with the error estimated
from the scatter.
"""

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import islice
from typing import TextIO

import numpy as np
from scipy.special import stdtrit

from vehicle.signals.analysis.comfort_error import STUDENT_95, difference_error
from vehicle.signals.analysis.ride_comfort import ERROR, UNWEIGHTED, wave_names
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.formats.csv_table import RowWriter
from vehicle.studies.sweeps.case import Case, Input
from vehicle.studies.sweeps.case_result import Row
from vehicle.studies.sweeps.change_error import is_event
from vehicle.studies.sweeps.sweep_ranking import RANKED_BY, is_comfort
from vehicle.studies.sweeps.sweep_table import SweepTable

DIFFERENCES = "differences.csv"
"""Name of the file in the folder of a sweep."""

REPEATING, CLASS, SEEDS = "roads of this class", "Gaussian roads of this class", "seeds of the generated road"
RECORDS, EVENT = "Gaussian records with this spectrum", "one event: no random error"
"""Populations for which an error is stated: of a road that repeats, of another road, of its seeds, of a file; and an
input without an error."""

HEADS = (
    "{} [m/s2]",
    "{}standard_error [m/s2]",
    "{}difference [m/s2]",
    "{}standard_error_of_difference [m/s2]",
    "{}half_width_95 [m/s2]",
)
"""Heads of the columns of a comfort value; the weighted value adds its name in front."""

PER_VALUE = 2 + len(wave_names(UNWEIGHTED))
"""Numbers of a comfort value in a row: value, relative error and C_m."""

Numbers = tuple[float, ...]
"""Value, relative error and C_m of each comfort value of a row."""

ROWS_AT_ONCE = 1024
"""Number of rows whose errors are computed together."""


def has_differences(table: SweepTable) -> bool:
    """Return True for a sweep with `ComfortMeasure` of two or more cars."""
    # An override of a road, the speed of rolling tyres, does not make another car.
    cars = (case.overrides[case.shared :] for case in table.cases)
    first, good = next(cars, ()), (result for result in table.results if not result.reason)
    return (
        is_comfort(table.units)
        and any(car != first for car in cars)
        and any(wave_names(UNWEIGHTED)[0] in result.values for result in islice(good, 1))
    )


class DifferencesWriter:
    """Writes the difference in comfort between every car and the first car on the same road as CSV, row by row.

    Args:
        paths: the modified parameter paths of all cases.
        units: names of the values of the table.
    """

    def __init__(self, file: TextIO, paths: Sequence[str], units: Collection[str]) -> None:
        names = [UNWEIGHTED, *[name for name in RANKED_BY if name in units][:1]]
        self._values = [each for name in names for each in (name, f"{name}{ERROR}", *wave_names(name))]
        heads = [head.format(name if head == HEADS[0] else "" if name == UNWEIGHTED else f"{name}_")
                 for name in names for head in HEADS]  # fmt: skip
        self._writer = RowWriter(file)
        self._writer.writerow(["input", *paths, "cars differ on", *heads])
        self._factor = STUDENT_95
        self._first: dict[Input, Numbers] = {}
        self._seeds: dict[str, dict[tuple[str, ...], tuple[Sequence[str], list[Numbers]]]] = {}
        self._source: Input | None = None
        self._base: Numbers = ()
        self._road = ""
        self._waiting: list[tuple[str, Sequence[str], str, Numbers, Numbers]] = []

    def add(self, case: Case, parameters: Sequence[str], row: Row) -> None:
        """Add the row of a case.

        Args:
            case: the case, in the order of the table.
            parameters: values of its parameters, see `parameter_cells`.
            row: its values.
        """
        values = row["values"]
        numbers = tuple([float(values.get(name, math.nan)) for name in self._values])
        if case.source is not self._source:
            self._source, self._road = case.source, ""
            self._base = self._first.setdefault(case.source, numbers)
            if isinstance(case.source, RoadDrive) and case.source.tagged:
                self._road = replace(case.source, tagged=False).name
        by_source = RECORDS
        if isinstance(case.source, RoadDrive):
            by_source = CLASS if case.source.span is None else REPEATING
        population = EVENT if is_event(row, UNWEIGHTED) else by_source
        self._waiting.append((case.source.name, parameters, population, numbers, self._base))
        if self._road:
            cars = self._seeds.setdefault(self._road, {})
            cars.setdefault(case.overrides, (parameters, []))[1].append(numbers[::PER_VALUE])
        if len(self._waiting) == ROWS_AT_ONCE:
            self._flush()

    def finish(self) -> None:
        """Write the last rows, and the means over the seeds of each road with two or more seeds."""
        self._flush()
        for name, cars in self._seeds.items():
            base = np.array(next(iter(cars.values()))[1])
            for parameters, listed in cars.values():
                comfort = np.array(listed)  # (seeds, values)
                count, apart = len(comfort), comfort - base
                error, spread = (np.std(values, axis=0, ddof=1) / math.sqrt(count) for values in (comfort, apart))
                width = float(stdtrit(count - 1, 0.975)) * spread
                numbers = np.array([np.mean(comfort, axis=0), error, np.mean(apart, axis=0), spread, width])
                self._write(f"{name}, mean of {count} seeds", parameters, SEEDS, numbers.T.ravel().tolist())

    def _flush(self) -> None:
        """Write the waiting rows."""
        if not self._waiting:
            return
        names, parameters, populations, numbers, base = zip(*self._waiting, strict=True)
        cars, bases = (np.array(values).reshape(len(names), -1, PER_VALUE) for values in (numbers, base))
        comfort, relative = cars[..., 0], cars[..., 1]
        waves, base_waves = (values[..., 2::2] + 1j * values[..., 3::2] for values in (cars, bases))
        errors = difference_error(waves, base_waves)
        columns = [comfort, relative * comfort, comfort - bases[..., 0], errors, self._factor * errors]
        rows = np.stack(columns, axis=2).reshape(len(names), -1).tolist()
        for row in zip(names, parameters, populations, rows, strict=True):
            self._write(*row)
        self._waiting.clear()

    def _write(self, name: str, parameters: Sequence[str], population: str, numbers: Sequence[float]) -> None:
        cells = [f"{number:.6g}" if math.isfinite(number) else "" for number in numbers]
        self._writer.writerow([name, *parameters, population, *cells])
