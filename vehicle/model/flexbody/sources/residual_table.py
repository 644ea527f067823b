"""Residual flexibility of attachments as a table: what a modal test adds to its modes, measured at each attachment.

At an attachment the static driving-point flexibility of the free body less the share of the modes that are kept,
H(0) - sum of phi^2 / w^2 [m/N], is what the modes above give way; a local stiffness [N/m] is its inverse.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Collection
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.names import AXES

UNITS = {"m/N": (1.0, 1), "mm/N": (1e-3, 1), "N/m": (1.0, -1), "N/mm": (1e3, -1)}
"""Unit to its size in SI, and whether it is a flexibility or a stiffness."""


def read_residuals(path: Path, places: Collection[str]) -> dict[str, FloatArray]:
    """Residual flexibility of some attachments, along the axes of the car.

    Args:
        path: table with the head `point,x [N/m],y [N/m],z [N/m]`; other units are those of `UNITS`.
        places: points of the car.

    Returns:
        Point to flexibility [m/N], shape (3, 3).

    Raises:
        DataError: unreadable, a bad head, an unknown or repeated point, or a value that is no positive number.
    """
    try:
        rows = [row for row in csv.reader(path.read_text(encoding="utf-8").splitlines()) if row and row[0][:1] != "#"]
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DataError(f"{path}: cannot be read ({error}).") from error
    heads = [word.strip() for word in rows[0]] if rows else []
    units = [head.partition("[")[2].rstrip("]") for head in heads[1:]]
    names = [head.partition("[")[0].strip() for head in heads]
    if names != ["point", *AXES] or not set(units) <= set(UNITS):
        raise DataError(
            f"{path}: found the head {','.join(heads)!r}, needed is point,x [N/m],y [N/m],z [N/m] for stiffnesses, or "
            f"another unit of {', '.join(UNITS)}."
        )
    found: dict[str, FloatArray] = {}
    for row in rows[1:]:
        point, values = row[0].strip(), [_number(word) for word in row[1:]]
        if point not in places or point in found:
            what = "given twice" if point in found else f"no point of the car; its points are {', '.join(places)}"
            raise DataError(f"{path}: {point!r} is {what}.")
        if len(values) != len(AXES) or not all(0.0 < value < math.inf for value in values):
            raise DataError(f"{path}: {point}: found {','.join(row[1:])}, needed are three numbers above 0.")
        own = [(UNITS[unit][0] * value) ** UNITS[unit][1] for unit, value in zip(units, values, strict=True)]
        found[point] = np.diag(own)
    return found


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
