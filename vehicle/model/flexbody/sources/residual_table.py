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
    try:
        rows = [row for row in csv.reader(path.read_text(encoding="utf-8").splitlines()) if row and row[0][:1] != "#"]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DataError(f"{path}: cannot be read ({error}).") from error
    header = [word.strip() for word in rows[0]] if rows else []
    units = [head.partition("[")[2].rstrip("]") for head in header[1:]]
    names = [head.partition("[")[0].strip() for head in header]
    if names != ["point", *AXES] or not set(units) <= set(UNITS):
        raise DataError(
            f"{path}: found the header {','.join(header)!r}, must be point,x [N/m],y [N/m],z [N/m] for stiffnesses, or "
            f"another unit of {', '.join(UNITS)}."
        )
    flexibilities: dict[str, Vector] = {}
    for row in rows[1:]:
        point, values = row[0].strip(), [_number(word) for word in row[1:]]
        if point not in points or point in flexibilities:
            fault = (
                "occurs twice"
                if point in flexibilities
                else f"is not a point of the car; choose from {', '.join(points)}"
            )
            raise DataError(f"{path}: {point!r} {fault}.")
        if len(values) != len(AXES) or not all(0.0 < value < math.inf for value in values):
            raise DataError(f"{path}: {point}: found {','.join(row[1:])}, must be three numbers above 0.")
        axes = [(UNITS[unit][0] * value) ** UNITS[unit][1] for unit, value in zip(units, values, strict=True)]
        flexibilities[point] = np.diag(axes)
    return flexibilities


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
