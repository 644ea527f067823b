"""Table of residual flexibilities measured at the attachments, a supplement to the modes of a modal test.

The residual flexibility of an attachment is the static driving-point flexibility of the free body minus the share of
the modes of the model, H(0) - sum of phi^2 / w^2 [m/N]; a local stiffness [N/m] is its inverse.
"""

import csv
import math
from collections.abc import Collection
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number_in
from vehicle.errors import DataError
from vehicle.names import AXES

UNITS = {"m/N": (1.0, 1), "mm/N": (1e-3, 1), "N/m": (1.0, -1), "N/mm": (1e3, -1)}
"""Unit -> its size in SI, and the exponent that converts to flexibility: 1 for a flexibility, -1 for a stiffness."""


def read_residuals(path: Path, points: Collection[str]) -> dict[str, Vector]:
    """Read the residual flexibility of attachments along the axes of the car [m/N], shape (3, 3) by point.

    Args:
        path: table with the header `point,x [N/m],y [N/m],z [N/m]`, or other units of `UNITS`.
        points: names of the points of the car.

    Raises:
        DataError: the file is unreadable, the header invalid, a point unknown or repeated, or a value not positive.
    """
    rows, units = read_point_table(path, UNITS, "point,x [N/m],y [N/m],z [N/m] for stiffnesses")
    flexibilities: dict[str, Vector] = {}
    for point, values in rows.items():
        if point not in points:
            raise DataError(f"{path}: {point!r} is not a point of the car; choose from {', '.join(points)}.")
        if not all(0.0 < value < math.inf for value in values):
            numbers = ",".join(f"{each:g}" for each in values)
            raise DataError(f"{path}: {point}: found {numbers}, must be three numbers above 0.")
        axes = [(UNITS[unit][0] * value) ** UNITS[unit][1] for unit, value in zip(units, values, strict=True)]
        flexibilities[point] = np.diag(axes)
    return flexibilities


def read_point_table(path: Path, units: Collection[str], example: str) -> tuple[dict[str, list[float]], list[str]]:
    """Read a table of three numbers for each point: the numbers by point, and the unit of each column.

    Args:
        path: table with the header "point,x [unit],y [unit],z [unit]".
        units: allowed units.
        example: header for the message.

    Raises:
        DataError: the file is unreadable, the header or a row invalid, or a point repeated.
    """
    try:
        rows = [row for row in csv.reader(path.read_text(encoding="utf-8").splitlines()) if row and row[0][:1] != "#"]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DataError(f"{path}: cannot be read ({error}).") from error
    header = [word.strip() for word in rows[0]] if rows else []
    column_units = [head.partition("[")[2].rstrip("]") for head in header[1:]]
    names = [head.partition("[")[0].strip() for head in header]
    if names != ["point", *AXES] or not set(column_units) <= set(units):
        raise DataError(
            f"{path}: found the header {','.join(header)!r}, must be {example}, or another unit of {', '.join(units)}."
        )
    table: dict[str, list[float]] = {}
    for row in rows[1:]:
        point, values = row[0].strip(), [number_in(word) for word in row[1:]]
        if point in table:
            raise DataError(f"{path}: {point!r} occurs twice.")
        if len(values) != len(AXES):
            raise DataError(f"{path}: {point}: found {','.join(row[1:])}, must be three numbers.")
        table[point] = values
    return table, column_units
