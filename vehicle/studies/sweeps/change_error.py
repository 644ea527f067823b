"""Standard error of the change of a comfort value from the first car to each car of a sweep, on the same inputs.

The error of the difference on one random road is from `vehicle.signals.analysis.comfort_error`, with 2 `WAVES`
degrees of freedom. The differences on n inputs are independent, so their mean has the variance sum var_i / n^2. One
event, for example an obstacle, is the same for every car: its differences have no random error.
"""

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.special import stdtrit

from vehicle.arrays import Vector
from vehicle.signals.analysis.comfort_error import WAVES, difference_error
from vehicle.signals.analysis.ride_comfort import wave_names
from vehicle.studies.sweeps.case_result import Row

MEANING_OF_ERROR = "+-: half-width of the 95 % interval of a change, for random inputs like these"
NO_ERROR = "no +- given: neither a single event nor an estimate without a run has a random error"
UNKNOWN_ERROR = "no +- given: the uncertainty of a change in this figure is unknown"
"""Words of tables with and without errors."""

NO_PERCENTAGE = "changes cannot be given in percent; choose another figure or another input"
"""End of the message on a figure that is 0, or undefined, for the unchanged car."""


def is_event(row: Row, name: str) -> bool:
    """Return True for a run on one event, whose comfort value has no random error; see `Signal`."""
    return row["values"].get(wave_names(name)[0]) == "nan"


def change_errors(rows: Iterable[Row], cars: Sequence[Sequence[int]], name: str) -> tuple[Vector, Vector]:
    """Return the standard errors of the changes from the first car, in the unit of the value.

    Args:
        rows: all rows of a sweep, with numbers as texts of all digits.
        cars: numbers of the rows of each car on n inputs.
        name: comfort value, for example "weighted".

    Returns:
        Errors, (cars, n), 0 on an input that is one event; NaN for a failed run, and for a car without n rows. 1 for
        each input that is one event, 0 for the others, (n,).
    """
    names, listed = wave_names(name), [(is_event(row, name), row["values"]) for row in rows]
    parts = np.array([[float(values.get(each, "nan")) for each in names] for _, values in listed])
    waves = parts[:, 0::2] + 1j * parts[:, 1::2]
    first = list(cars[0])
    events = np.array([float(listed[number][0]) for number in first])
    errors = np.full((len(cars), len(first)), np.nan)
    for car, numbers in enumerate(cars):
        if len(numbers) == len(first):
            errors[car] = np.where(events, 0.0, difference_error(waves[list(numbers)], waves[first]))
    return errors, events


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
