"""Standard error of the change of a comfort value from the first car to each car of a sweep, on the same inputs.

The error of the difference on one random road is that of `vehicle.signals.analysis.comfort_error`, with 2 `WAVES`
degrees of freedom. The differences on n inputs are independent, so their mean has the variance sum var_i / n^2. One
event, as an obstacle, is the same for every car: its differences have no random error, and add none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.special import stdtrit

from vehicle.signals.analysis.comfort_error import WAVES, difference_error
from vehicle.signals.analysis.ride_comfort import wave_names
from vehicle.studies.sweeps.case import Case, is_random
from vehicle.studies.sweeps.case_result import Row

Vector = npt.NDArray[np.float64]

MEANING_OF_ERROR = "+-: half width of the 95 % interval of a change, over random inputs like this"
NO_ERROR = "no +-: one event has no random error"
"""Words of tables with and without errors."""


class StoredCases(Protocol):
    """Cases of a sweep with their rows, see `SweptCases`."""

    @property
    def cases(self) -> Sequence[Case]:
        """Cases in the order of the rows."""

    def rows(self) -> Iterator[Row]:
        """Return the rows with numbers as texts of all digits."""


def change_errors(table: StoredCases, cars: Sequence[Sequence[int]], name: str) -> Vector:
    """Return the standard errors of the changes from the first car, (cars, inputs), in the unit of the value.

    Args:
        table: table of a sweep.
        cars: numbers of the rows of each car on n inputs.
        name: comfort value, as "weighted".

    Returns:
        Errors, 0 on an input that is one event; NaN for a failed run, and for a car without n rows.
    """
    names, inputs = wave_names(name), len(cars[0])
    parts = np.array([[float(row["values"].get(each, "nan")) for each in names] for row in table.rows()])
    waves = parts[:, 0::2] + 1j * parts[:, 1::2]
    random = [is_random(table.cases[number].source) for number in cars[0]]
    errors = np.full((len(cars), inputs), np.nan)
    for car, numbers in enumerate(cars):
        if len(numbers) == inputs:
            errors[car] = np.where(random, difference_error(waves[list(numbers)], waves[list(cars[0])]), 0.0)
    return errors


def half_width(errors: Vector) -> Vector:
    """Return the half width of the 95 % interval of the mean change over n inputs, (cars,).

    Args:
        errors: standard errors of the changes from the first car on each input, see `change_errors`; (cars, n).

    Returns:
        t_0.975 sqrt(sum error^2) / n, with 2 `WAVES` degrees of freedom for each random input; NaN if all inputs are
        events.
    """
    random = int(np.sum(np.any(np.nan_to_num(errors, nan=0.0) > 0.0, axis=0)))
    factor = float(stdtrit(2 * WAVES * random, 0.975)) if random else np.nan
    return np.asarray(factor * np.sqrt(np.sum(errors**2, axis=1)) / errors.shape[1])
