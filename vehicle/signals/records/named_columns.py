"""Columns of any measurement file by their names, in SI: profiles of roads, curves of springs and dampers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.reader import read_record
from vehicle.signals.records.table import Vector
from vehicle.signals.records.units import allowed_units, find_unit


def named_columns(path: Path, wanted: Mapping[str, str]) -> dict[str, Vector]:
    """Read columns of numbers.

    Args:
        path: the file, of any format.
        wanted: name of a column, in small letters, to the SI unit of what it measures.

    Returns:
        Name to values in SI, all of one length.

    Raises:
        ConfigurationError: there is no such file.
        DataError: a column is missing or there twice, measures something else, or lacks a value.
    """
    measurement, found = read_record(path), {}
    for name, si in wanted.items():
        those = [one for one in measurement.channels if one.name.strip().lower() == name]
        if len(those) != 1:
            shown = ", ".join(f"{one.name!r} [{one.unit}]" for one in measurement.channels[:12]) or "none"
            raise DataError(f"{path}: {len(those)} columns are called {name!r}; needed is one [{si}]; found {shown}")
        known, needed = find_unit(those[0].unit), find_unit(si)
        if known is None or needed is None or known.quantity != needed.quantity:
            units = allowed_units(needed.quantity if needed is not None else None)
            raise DataError(f"{path}: column {name!r} has the unit {those[0].unit!r}; allowed are {units}")
        values = np.asarray(those[0].si_values, dtype=np.float64)
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values))[0]) + 1
            raise DataError(f"{path}: column {name!r}: row {row} holds no number; repair or remove the row")
        found[name] = values
    if len({one.size for one in found.values()}) > 1:
        sizes = ", ".join(f"{name} {one.size}" for name, one in found.items())
        raise DataError(f"{path}: columns of different length ({sizes}); they must be equal")
    return found
