"""Missing displacements: filled over short gaps when the user asks for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from vehicle.errors import DataError
from vehicle.excitation.csv_cells import CsvCells
from vehicle.excitation.signal import MINIMUM_SAMPLES
from vehicle.excitation.time_grid import UNIFORM_TOLERANCE, longest_gap


def fill_missing(
    path: Path, time: NDArray[np.float64], cells: CsvCells, column: int, place: str
) -> tuple[NDArray[np.float64], list[str]]:
    """Interpolate missing displacements by a cubic spline through the values on both sides.

    Args:
        path: file, for messages.
        time: increasing times [s], shape (n,).
        cells: the numbers of the file, NaN where one is missing.
        column: index of the column.
        place: name of the column, for messages.

    Returns:
        The column, shape (n,), and a notice with the count (none: nothing was missing).

    Raises:
        DataError: a gap too long, or at the beginning or end.
    """
    values = cells.values[:, column]
    valid = np.isfinite(values)
    missing = int(np.count_nonzero(~valid))
    if not missing:
        return values, []
    first = int(np.flatnonzero(~valid)[0])
    if not (valid[0] and valid[-1]) or np.count_nonzero(valid) < MINIMUM_SAMPLES:
        raise DataError(
            f"{path}:{cells.line_numbers[first]}:{column + 1}: {place} has missing values at its beginning or end, "
            "or hardly any others; "
            "interpolation needs values on both sides; remove those rows"
        )
    gaps = np.diff(time[valid])
    limit = longest_gap(float(np.median(np.diff(time))))
    worst = int(np.argmax(gaps))
    if gaps[worst] > limit * (1.0 + UNIFORM_TOLERANCE):
        line = cells.line_numbers[np.flatnonzero(valid)[worst] + 1]
        raise DataError(
            f"{path}:{line}:{column + 1}: {place} has no value for {gaps[worst]:.6g} s from this line on; "
            "interpolation bridges at most "
            f"{limit:.6g} s; use the part before or after it"
        )
    filled = values.copy()
    filled[~valid] = CubicSpline(time[valid], values[valid])(time[~valid])
    return filled, [
        f"{missing} missing values of {place} interpolated by a cubic spline, the first in line "
        f"{cells.line_numbers[first]}"
    ]
